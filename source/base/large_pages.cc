// Aligned memory of the program (AlignedVector) in pages of 2 MB: loops through
// it wait less for the tables that say where pages are.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace
{
#ifdef __linux__
/** Let the heap grow by many large pages at once, which advise_around() then
   asks for before anything stands in them. Once this is set glibc no longer
   adapts its other limits, which then are set as it would set them after arrays
   of 32 MB have come and gone: what is let go stays for the next kernel update
    instead of being cleared anew by the kernel. */
bool prepare_heap()
{
  constexpr int most = 32 << 20; // glibc takes no more for M_MMAP_THRESHOLD
  return mallopt(M_TOP_PAD, most) == 1 &&
         mallopt(M_MMAP_THRESHOLD, most) == 1 &&
         mallopt(M_TRIM_THRESHOLD, 2 * most) == 1;
}

/** Ask for large pages from @p begin to @p end. The kernel gives one where it
    has been asked before the first byte of 2 MB is touched, and later only
    slowly. One that has none, or is told to give none, says no, and nothing is
    lost. */
void advise(char *const begin, char *const end)
{
  constexpr std::uintptr_t page = 4096;
  const std::uintptr_t first =
      (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page;
  if (first < reinterpret_cast<std::uintptr_t>(end))
    madvise(reinterpret_cast<void *>(first),
            reinterpret_cast<std::uintptr_t>(end) - first, MADV_HUGEPAGE);
}

/** Of an array at @p p of @p size bytes: the part of the heap that has come
    with it, or, beyond the heap, the array. Arrays on the heap share pages with
    their neighbors. */
void advise_around(char *const p, const std::size_t size)
{
  static std::atomic<char *> heap_end(nullptr);
  char *const now = static_cast<char *>(sbrk(0));
  if (p >= now)
    return advise(p, p + size);
  char *const before = heap_end.exchange(now);
  if (before != now)
    advise(before == nullptr || before > now ? p : before, now);
}
#endif
} // namespace

// Replaces those of the standard library in the whole program. Arrays of
// unaligned types on the same heap share the large pages.
void *operator new(const std::size_t size, const std::align_val_t alignment)
{
#ifdef __linux__
  static const bool is_prepared = prepare_heap();
#endif
  const std::size_t step = static_cast<std::size_t>(alignment);
  // A multiple of the alignment, as the standard demands.
  const std::size_t whole = (size + step) / step * step;
  void *const p = whole < size ? nullptr : std::aligned_alloc(step, whole);
  if (p == nullptr)
    throw std::bad_alloc();
#ifdef __linux__
  constexpr std::size_t least = 1 << 16; // of which it is worth to ask
  if (is_prepared && size >= least)
    advise_around(static_cast<char *>(p), size);
#endif
  return p;
}

void operator delete(void *const p, std::align_val_t) noexcept
{
  std::free(p);
}

void operator delete(void *const p, std::size_t, std::align_val_t) noexcept
{
  std::free(p);
}
