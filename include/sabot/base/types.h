#ifndef sabot_base_types_h
#define sabot_base_types_h

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

namespace sabot
{
/**
 * Number of a node or cell in its body, the same on every rank and for every
 * number of ranks; from 0, negative for none.
 * 64 bits, as the number of a body and that of an item are packed into one
 * where the least step is agreed on; MPI_INT64_T in messages.
 */
using GlobalIndex = std::int64_t;

/**
 * Allocator for arrays of Vec, which needs 32 bytes, and for loops that the
 * compiler vectorizes: 64 bytes are a line of the cache and a register of
 * AVX-512. Without state: all are equal, so vectors may be moved and swapped.
 */
template <typename T>
struct AlignedAllocator
{
  using value_type = T;
  AlignedAllocator() = default;
  /** Containers rebind to another type; there is nothing to take over. */
  template <typename U>
  AlignedAllocator(const AlignedAllocator<U> &)
  {
  }
  /**
   * Throws std::bad_alloc as the standard's does.
   * Memory for @p n objects, not initialized, at a multiple of 64 bytes. @p n
   * times the size must not overflow: it is not checked, the standard's vectors
   * bound it.
   */
  T *allocate(const std::size_t n)
  {
    return static_cast<T *>(
        ::operator new(n * sizeof(T), std::align_val_t(64)));
  }
  /**
   * With the alignment it was allocated with, as the standard demands of the
   * pair.
   */
  void deallocate(T *p, std::size_t)
  {
    ::operator delete(p, std::align_val_t(64));
  }
  /** What one has allocated any other may release. */
  template <typename U>
  bool operator==(const AlignedAllocator<U> &) const
  {
    return true;
  }
  template <typename U>
  bool operator!=(const AlignedAllocator<U> &) const
  {
    return false;
  }
};

/**
 * std::vector whose first entry lies at a multiple of 64 bytes.
 * Rows of a structure of arrays that each are one of these do not share a line
 * of the cache, and load_pack() may read from every index that is a multiple of
 * four.
 */
template <typename T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

/** In place of a step dt [s]: nothing moves, only forces are asked for, as at
    the start and after a kernel update. */
constexpr double no_step = 0.;
/** Whether @p dt is a step in which something moves. */
constexpr bool is_step(const double dt)
{
  return dt > no_step;
}
} // namespace sabot

#endif
