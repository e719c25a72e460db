// States that some ranks saved, dealt out among others.
#include "sabot/output/state_blocks.h"

#include "sabot/base/error.h"
#include "sabot/base/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace sabot;

namespace
{
constexpr GlobalIndex n_items = 23;

/** Item k has a value, k % 4 entries in a row and its neighbors k + 1 to
    k + k % 4 round about; part r of n has every n-th item, and the next ones as
    ghosts. */
struct Part
{
  std::vector<GlobalIndex> keys; // owned, then ghosts
  std::size_t n_owned = 0;
  std::vector<double> value; // with ghosts
  std::vector<float> packed; // two entries a cell, four cells a pack
  std::vector<std::uint32_t> length;
  std::vector<std::size_t> start = {0};
  std::vector<double> entries;
  std::vector<GlobalIndex> neighbors; // keys
  ExactSum sum;
  double largest = 0., dt = 1.;
  GlobalIndex slowest = -1;
  std::vector<int> all;
  int same = 5;

  Part(const int rank, const int n)
  {
    for (GlobalIndex k = rank; k < n_items; k += n)
      keys.push_back(k);
    n_owned = keys.size();
    if (n > 1)
      for (GlobalIndex k = (rank + 1) % n; k < n_items; k += n)
        keys.push_back(k);
    value.resize(keys.size());
    packed.resize((n_owned + 3) / 4 * 8);
    for (std::size_t i = 0; i < n_owned; ++i)
    {
      length.push_back(keys[i] % 4);
      start.push_back(start.back() + length.back() + 1); // an unused place
    }
    entries.resize(start.back());
    neighbors.resize(start.back());
  }
  float &at(const std::size_t i, const std::size_t c)
  {
    return packed[(i / 4 * 2 + c) * 4 + i % 4];
  }
  void fill(const int rank)
  {
    for (std::size_t i = 0; i < keys.size(); ++i)
      value[i] = i < n_owned ? 1. / (1. + keys[i]) : -1.; // ghosts: stale
    for (std::size_t i = 0; i < n_owned; ++i)
    {
      at(i, 0) = keys[i];
      at(i, 1) = -keys[i];
      for (std::uint32_t k = 0; k < length[i]; ++k)
      {
        entries[start[i] + k] = 100. * keys[i] + k;
        neighbors[start[i] + k] = (keys[i] + 1 + k) % n_items;
      }
      sum.add(0.1 * keys[i]);
    }
    largest = rank;
    dt = 1. / (rank + 1);
    slowest = rank;
    all.assign(rank, rank);
  }
  void visit(StateVisitor &visitor)
  {
    visitor.section = "part";
    const StateItems items = {"part/nodes", keys.data(), n_owned, keys.size()},
                     owned = {"part/nodes", keys.data(), n_owned, n_owned};
    visitor.visit_keys(items);
    visitor.visit_items("value", value, items);
    visitor.visit_items("packed", packed.data(), packed.size() / 2,
                        sizeof(float), owned, 2, 4);
    const StateRows rows = {owned, "part/rows", start.data(), length.data()};
    visitor.visit_shape(rows);
    visitor.visit_rows("entries", entries, rows);
    if (visitor.is_restoring())
      visitor.restore_neighbors("neighbors", neighbors.data(), neighbors.size(),
                                rows);
    else
    {
      // Local numbers of a list of all, in another order on each rank.
      std::vector<GlobalIndex> known(n_items);
      std::iota(known.begin(), known.end(), 0);
      std::rotate(known.begin(), known.begin() + n_owned, known.end());
      std::vector<std::uint32_t> local;
      for (const GlobalIndex k : neighbors)
        local.push_back(std::find(known.begin(), known.end(), k) -
                        known.begin());
      visitor.visit_neighbors("neighbors", local.data(), local.size(),
                              known.data(), known.size(), rows);
    }
    visitor.visit_sum("sum", sum);
    visitor.visit_largest("largest", largest);
    visitor.visit_step("step", dt, slowest);
    visitor.visit_all("all", all);
    visitor.visit_value("same", same);
  }
};

std::shared_ptr<StateCopies> saved_by(const int n)
{
  const auto saved = std::make_shared<StateCopies>();
  for (int r = 0; r < n; ++r)
  {
    Part part(r, n);
    part.fill(r);
    saved->add_rank([&](StateVisitor &visitor) { part.visit(visitor); });
  }
  return saved;
}

TEST(StateBlocks, any_number_of_ranks_gets_what_any_other_saved)
{
  Part whole(0, 1);
  whole.fill(0);
  for (const int n : {1, 2, 3, 4, 30}) // the last ones have no items
    for (const int m : {1, 2, 3, 5, 25})
    {
      const auto saved = saved_by(n);
      ExactSum sum;
      for (int r = 0; r < m; ++r)
      {
        Part part(r, m);
        StateRestorer restorer(saved, r, m);
        part.visit(restorer);
        for (std::size_t i = 0; i < part.keys.size(); ++i)
          EXPECT_EQ(part.value[i], 1. / (1. + part.keys[i]));
        for (std::size_t i = 0; i < part.n_owned; ++i)
        {
          EXPECT_EQ(part.at(i, 0), part.keys[i]);
          EXPECT_EQ(part.at(i, 1), -part.keys[i]);
          for (std::uint32_t k = 0; k < part.length[i]; ++k)
          {
            EXPECT_EQ(part.entries[part.start[i] + k], 100. * part.keys[i] + k);
            EXPECT_EQ(part.neighbors[part.start[i] + k],
                      (part.keys[i] + 1 + k) % n_items);
          }
        }
        for (std::size_t i = part.n_owned; i < part.packed.size() / 2; ++i)
          EXPECT_EQ(part.at(i, 0), part.at(part.n_owned - 1, 0)) << "padding";
        sum.add(part.sum);
        EXPECT_EQ(part.largest, n - 1.);
        EXPECT_EQ(part.dt, 1. / n);
        EXPECT_EQ(part.slowest, n - 1);
        EXPECT_EQ(part.all.size(), std::size_t(n * (n - 1) / 2));
        EXPECT_TRUE(std::is_sorted(part.all.begin(), part.all.end()));
        EXPECT_EQ(part.same, 5);
      }
      EXPECT_EQ(sum.value(), whole.sum.value());
    }
}

TEST(StateBlocks, what_is_not_there_is_told)
{
  const auto saved = saved_by(2);
  Part part(0, 1);
  part.keys.push_back(n_items);
  part.value.push_back(0.);
  StateRestorer restorer(saved, 0, 1);
  try
  {
    part.visit(restorer);
    ADD_FAILURE() << "an item that nobody saved";
  }
  catch (const IOError &e)
  {
    EXPECT_NE(std::string(e.what()).find("lacks 1 of the 24 \"part/nodes\""),
              std::string::npos)
        << e.what();
  }
}
} // namespace
