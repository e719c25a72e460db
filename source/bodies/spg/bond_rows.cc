// Rows of neighbors in one array, and places of global numbers.
#include "sabot/bodies/spg/bond_rows.h"

#include <algorithm>

namespace sabot
{
void BondRows::merge_and_end_row(const std::vector<GlobalIndex> &some,
                                 const GlobalIndex *const first,
                                 const GlobalIndex *const last)
{
  if (first == last)
  {
    add(some.begin(), some.end());
    return end_row();
  }
  const std::size_t begin = neighbors.size();
  neighbors.resize(begin + some.size() + (last - first));
  std::merge(some.begin(), some.end(), first, last, neighbors.begin() + begin);
  end_row();
}

void BondRows::sort_and_end_row()
{
  const auto first = neighbors.begin() + start.back();
  std::sort(first, neighbors.end());
  neighbors.erase(std::unique(first, neighbors.end()), neighbors.end());
  end_row();
}

NumberIndex::NumberIndex(const GlobalIndex *const numbers, const std::size_t n)
    : numbers(numbers), n(n)
{
  if (n == 0)
    return;
  const std::size_t range = numbers[n - 1] - numbers[0];
  has_no_gaps = range == n - 1;
  if (has_no_gaps)
    return;
  while (range >> shift > 2 * n)
    ++shift;
  first.resize((range >> shift) + 1);
  std::size_t k = 0;
  for (std::size_t entry = 0; entry < first.size(); ++entry)
  {
    while (static_cast<std::size_t>(numbers[k] - numbers[0]) >> shift < entry)
      ++k;
    first[entry] = k;
  }
}
} // namespace sabot
