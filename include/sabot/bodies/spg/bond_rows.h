#ifndef sabot_bodies_spg_bond_rows_h
#define sabot_bodies_spg_bond_rows_h

#include "sabot/base/types.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sabot
{
/**
 * Neighbors by global number, row by row in one array: two allocations for a
 * body, where a vector per row would be one for each particle. Rows are written
 * one after the other,
 *
 *     rows.add(7); rows.add(9); rows.end_row();
 *
 * and read as ranges, `for (const GlobalIndex j : rows[i])`. Those for BondList
 * ascend, which the writer sees to.
 */
class BondRows
{
public:
  struct Row
  {
    const GlobalIndex *first, *last;
    const GlobalIndex *begin() const { return first; }
    const GlobalIndex *end() const { return last; }
    std::size_t size() const { return last - first; }
  };

  void add(const GlobalIndex j) { neighbors.push_back(j); }
  template <typename Iterator>
  void add(const Iterator first, const Iterator last)
  {
    neighbors.insert(neighbors.end(), first, last);
  }
  void end_row() { start.push_back(neighbors.size()); }
  /** Add what two ascending lists without a number in common hold, in order,
      and end the row. */
  void merge_and_end_row(const std::vector<GlobalIndex> &some,
                         const GlobalIndex *first, const GlobalIndex *last);
  /** Sort what has been added since the last row, each number once, and end
      it. */
  void sort_and_end_row();
  void reserve(const std::size_t n_rows, const std::size_t n_neighbors)
  {
    start.reserve(n_rows + 1);
    neighbors.reserve(n_neighbors);
  }

  /** Of rows, without the one that has not ended. */
  std::size_t size() const { return start.size() - 1; }
  Row operator[](const std::size_t i) const
  {
    return {neighbors.data() + start[i], neighbors.data() + start[i + 1]};
  }
  /** Of all rows together. */
  std::size_t n_neighbors() const { return neighbors.size(); }

private:
  std::vector<std::size_t> start = {0};
  std::vector<GlobalIndex> neighbors;
};

/** Where global numbers stand in an ascending list, by a table of about as many
    entries: a place or two to look at, whatever part of the body a rank has.
    The list must outlive it. */
class NumberIndex
{
public:
  NumberIndex(const GlobalIndex *numbers, const std::size_t n);
  /** Place of @p j, or the length of the list where it is not in it. */
  std::size_t operator()(const GlobalIndex j) const
  {
    if (n == 0 || j < numbers[0] || j > numbers[n - 1])
      return n;
    if (has_no_gaps)
      return j - numbers[0];
    const std::size_t entry = (j - numbers[0]) >> shift;
    // Images of a few particles may share one entry.
    const GlobalIndex *const at = std::lower_bound(
        numbers + first[entry],
        entry + 1 < first.size() ? numbers + first[entry + 1] : numbers + n, j);
    return at != numbers + n && *at == j ? at - numbers : n;
  }

private:
  const GlobalIndex *const numbers;
  const std::size_t n;
  bool has_no_gaps = false; // as those of one rank alone
  unsigned int shift = 0;
  std::vector<std::uint32_t> first; // at or after this multiple of 2^shift
};
} // namespace sabot

#endif
