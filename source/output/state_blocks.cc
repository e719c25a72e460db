// States on their way out of their owners, and back to as many ranks as there
// are.
#include "sabot/output/state_blocks.h"

#include "sabot/base/error.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace sabot
{
void StateSaver::visit(const StateArray &array)
{
  take({static_cast<char>(array.share), array.n, array.size, "", array.name},
       array.data);
}

void StateCopies::add_rank(const std::function<void(StateVisitor &)> &visit)
{
  OfRank its;
  StateSaver saver(
      [&](const StateLine &line, const void *const data)
      {
        const char *const begin = static_cast<const char *>(data);
        its.lines.push_back(line);
        its.bytes.emplace_back(begin, begin + line.n_bytes());
      });
  visit(saver);
  saved.push_back(std::move(its));
}

StateRestorer::StateRestorer(std::shared_ptr<const StateSource> its_source,
                             const int rank, const int n_ranks)
    : source(std::move(its_source)), rank(rank), n_ranks(n_ranks)
{
  const std::vector<StateLine> &lines = source->lines(0);
  for (std::size_t i = 0; i < lines.size(); ++i)
    places[lines[i].name] = i;
}

const StateLine &StateRestorer::next(const StateArray &array) const
{
  const std::vector<StateLine> &lines = source->lines(0);
  if (position >= lines.size() || lines[position].name != array.name)
    throw IOError("the checkpoint does not fit this program: \"" + array.name +
                  "\" was expected, found " +
                  (position < lines.size() ? "\"" + lines[position].name + "\""
                                           : "nothing"));
  return lines[position];
}

void StateRestorer::misfit(const StateArray &array, const StateLine &line) const
{
  throw IOError("the checkpoint does not fit this scene: \"" + line.name +
                "\" has " + std::to_string(line.n) + " entries of " +
                std::to_string(line.size) + " bytes, expected " +
                std::to_string(array.n) + " of " + std::to_string(array.size));
}

std::vector<int> StateRestorer::ranks_of(const StateArray &array) const
{
  std::vector<int> found;
  const bool all =
      array.share == StateShare::all || array.share == StateShare::bound;
  for (int r = all ? 0 : rank; r < source->n_ranks(); r += all ? 1 : n_ranks)
    found.push_back(r);
  return found;
}

std::size_t StateRestorer::n_entries(const StateArray &array) const
{
  const StateLine &line = next(array);
  if (array.share == StateShare::same)
    return line.n;
  std::size_t n = 0;
  for (const int r : ranks_of(array))
    n += source->lines(r)[position].n;
  return n;
}

void StateRestorer::visit(const StateArray &array)
{
  next(array);
  switch (array.share)
  {
  case StateShare::same:
    restore_same(array);
    break;
  case StateShare::items:
    restore_items(array);
    break;
  case StateShare::rows:
  case StateShare::neighbors:
    restore_rows(array);
    break;
  case StateShare::sum:
  case StateShare::bound:
    restore_sum(array);
    break;
  case StateShare::all:
  case StateShare::anywhere:
    restore_list(array);
    break;
  case StateShare::own:
    if (array.items != nullptr) // others may be held since the last visit
      known.erase(array.items->name);
    break; // read with the arrays that need it
  }
  ++position;
}

void StateRestorer::restore_same(const StateArray &array)
{
  const StateLine &first = source->lines(0)[position];
  if (first.n != array.n || first.size != array.size)
    misfit(array, first);
  const bool is_like_first =
      rank >= source->n_ranks() ||
      source->lines(rank)[position].share == static_cast<char>(array.share);
  if (!is_like_first && source->n_ranks() != n_ranks)
    throw IOError("the checkpoint was written on " +
                  std::to_string(source->n_ranks()) + " ranks, among which \"" +
                  array.name + "\" differs; it can only be resumed on as many");
  const std::vector<char> bytes =
      source->read(is_like_first ? 0 : rank, position);
  std::copy(bytes.begin(), bytes.end(), static_cast<char *>(array.data));
}

void StateRestorer::restore_list(const StateArray &array)
{
  std::size_t n = 0;
  for (const int r : ranks_of(array))
  {
    const StateLine &line = source->lines(r)[position];
    if (line.size != array.size || n + line.n > array.n)
      misfit(array, line);
    const std::vector<char> bytes = source->read(r, position);
    std::copy(bytes.begin(), bytes.end(),
              static_cast<char *>(array.data) + n * array.size);
    n += line.n;
  }
}

void StateRestorer::restore_sum(const StateArray &array)
{
  char *const data = static_cast<char *>(array.data);
  for (std::size_t i = 0; i < array.n; ++i)
    array.clear(data + i * array.size);
  for (const int r : ranks_of(array))
  {
    const StateLine &line = source->lines(r)[position];
    if (line.n != array.n || line.size != array.size)
      misfit(array, line);
    // Entries may want a better alignment than bytes have.
    const std::vector<char> bytes = source->read(r, position);
    std::vector<std::max_align_t> entry(
        (array.size + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t));
    for (std::size_t i = 0; i < array.n; ++i)
    {
      std::memcpy(entry.data(), &bytes[i * array.size], array.size);
      array.add(data + i * array.size, entry.data());
    }
  }
}

template <typename T>
std::vector<T> StateRestorer::numbers(const int of_rank,
                                      const std::string &name) const
{
  const auto at = places.find(name);
  if (at == places.end())
    throw IOError("the checkpoint does not fit this program: it has no \"" +
                  name + "\"");
  const std::vector<char> bytes = source->read(of_rank, at->second);
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty())
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

const std::vector<StateRestorer::Pairs> &
StateRestorer::pairs_of(const StateItems &items)
{
  Known &its = known[items.name];
  if (!its.pairs.empty() && its.n_held == items.n_held)
    return its.pairs;
  its.n_held = items.n_held;
  its.pairs.assign(source->n_ranks(), {});
  std::vector<std::size_t> wanted(items.n_held);
  std::iota(wanted.begin(), wanted.end(), std::size_t(0));
  std::sort(wanted.begin(), wanted.end(),
            [&](const std::size_t a, const std::size_t b)
            { return items.keys[a] < items.keys[b]; });
  std::vector<char> is_found(items.n_held, 0);
  std::size_t n_missing = items.n_held;
  // On as many ranks as before, all that a rank owns is in its own part.
  for (int i = 0; i < source->n_ranks() && n_missing > 0; ++i)
  {
    const int r = (rank + i) % source->n_ranks();
    const auto keys = numbers<GlobalIndex>(r, items.name + " keys");
    for (std::size_t k = 0; k < keys.size(); ++k)
    {
      const auto at =
          std::lower_bound(wanted.begin(), wanted.end(), keys[k],
                           [&](const std::size_t a, const GlobalIndex key)
                           { return items.keys[a] < key; });
      if (at == wanted.end() || items.keys[*at] != keys[k] || is_found[*at])
        continue;
      is_found[*at] = 1;
      its.pairs[r].emplace_back(k, *at);
      --n_missing;
    }
  }
  if (n_missing > 0)
    throw IOError("the checkpoint does not fit this scene: it lacks " +
                  std::to_string(n_missing) + " of the " +
                  std::to_string(items.n_held) + " \"" + items.name + "\"");
  return its.pairs;
}

void StateRestorer::restore_items(const StateArray &array)
{
  const std::size_t per = array.per_item, lanes = array.lanes,
                    n_items = array.n / per;
  char *const data = static_cast<char *>(array.data);
  const auto place = [&](const std::size_t e, const std::size_t c)
  { return ((e / lanes * per + c) * lanes + e % lanes) * array.size; };
  const std::vector<Pairs> &pairs = pairs_of(*array.items);
  for (int r = 0; r < source->n_ranks(); ++r)
  {
    const StateLine &line = source->lines(r)[position];
    if (pairs[r].empty() ||
        (array.n == 0 && (line.n == 0 || array.items->n_saved == 0)))
      continue;
    if (line.size != array.size || line.n == 0 || array.n == 0)
      misfit(array, line);
    const std::vector<char> bytes = source->read(r, position);
    for (const auto &[there, here] : pairs[r])
    {
      if (here >= n_items) // a ghost, of what only owned items have
        continue;
      if (there >= line.n / per)
        misfit(array, line);
      if (lanes == 1)
        std::memcpy(data + place(here, 0), &bytes[place(there, 0)],
                    per * array.size);
      else
        for (std::size_t c = 0; c < per; ++c)
          std::memcpy(data + place(here, c), &bytes[place(there, c)],
                      array.size);
    }
  }
  // Lanes without an item go along with the last one.
  const std::size_t n = array.items->n_held;
  for (std::size_t e = n; lanes > 1 && n > 0 && e < n_items; ++e)
    for (std::size_t c = 0; c < per; ++c)
      std::memcpy(data + place(e, c), data + place(n - 1, c), array.size);
}

void StateRestorer::restore_rows(const StateArray &array)
{
  const bool are_neighbors = array.share == StateShare::neighbors;
  const StateRows &rows = *array.rows;
  const std::vector<Pairs> &pairs = pairs_of(rows.items);
  char *const data = static_cast<char *>(array.data);
  for (int r = 0; r < source->n_ranks(); ++r)
  {
    if (pairs[r].empty())
      continue;
    const StateLine &line = source->lines(r)[position];
    if (line.size != (are_neighbors ? sizeof(std::uint32_t) : array.size))
      misfit(array, line);
    const auto start = numbers<std::size_t>(r, rows.name + " starts");
    const auto length = numbers<std::uint32_t>(r, rows.name + " lengths");
    const std::vector<char> bytes = source->read(r, position);
    std::vector<GlobalIndex> keys;
    if (are_neighbors)
      keys = numbers<GlobalIndex>(r, rows.name + " numbers");
    for (const auto &[there, here] : pairs[r])
    {
      const std::size_t n = length.at(there), first = start.at(there);
      if (n != rows.length[here] || first + n > line.n ||
          rows.start[here] + n > array.n)
        misfit(array, line);
      if (!are_neighbors && n > 0)
        std::memcpy(data + rows.start[here] * array.size,
                    &bytes[first * array.size], n * array.size);
      for (std::size_t k = 0; k < n && are_neighbors; ++k)
      {
        std::uint32_t local;
        std::memcpy(&local, &bytes[(first + k) * sizeof(local)], sizeof(local));
        reinterpret_cast<GlobalIndex *>(data)[rows.start[here] + k] =
            keys.at(local);
      }
    }
  }
}
} // namespace sabot
