// Arrays for hot loops lie in memory for which large pages have been asked.
#include "sabot/base/types.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

namespace
{
using namespace sabot;

/** Whether the kernel has been asked for large pages at this address: flag "hg"
    of the mapping. */
bool is_advised(const void *const p)
{
  const auto address = reinterpret_cast<std::uintptr_t>(p);
  std::ifstream file("/proc/self/smaps");
  bool is_here = false;
  for (std::string line; std::getline(file, line);)
  {
    std::uintptr_t begin, end;
    char dash;
    std::istringstream words(line);
    if (words >> std::hex >> begin >> dash >> end && dash == '-')
      is_here = begin <= address && address < end;
    else if (is_here && line.rfind("VmFlags:", 0) == 0)
      return line.find(" hg") != std::string::npos;
  }
  return false;
}

TEST(LargePages, hold_arrays_of_all_sizes)
{
  if (!std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"))
    GTEST_SKIP() << "this kernel has no large pages";
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer has a heap of its own";
#endif
  // On the heap and, from 32 MB on, beyond it.
  for (const std::size_t n : {100000u, 400000u, 1600000u, 10000000u})
  {
    const AlignedVector<double> array(n);
    EXPECT_TRUE(is_advised(&array[n / 2])) << n;
  }
}

TEST(LargePages, alignment_is_kept)
{
  for (const std::size_t n : {1u, 7u, 64u, 8193u, 300001u})
  {
    const AlignedVector<char> array(n);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % 64, 0u) << n;
  }
}
} // namespace
