#ifndef sabot_base_types_h
#define sabot_base_types_h

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

namespace sabot
{
/** Number of a node or cell in its body, the same on every rank. */
using GlobalIndex = std::int64_t;

/** Allocator for arrays of Vec and for loops that the compiler vectorises. */
template <typename T>
struct AlignedAllocator
{
  using value_type = T;
  AlignedAllocator() = default;
  template <typename U>
  AlignedAllocator(const AlignedAllocator<U> &)
  {
  }
  T *allocate(const std::size_t n)
  {
    return static_cast<T *>(
        ::operator new(n * sizeof(T), std::align_val_t(64)));
  }
  void deallocate(T *p, std::size_t)
  {
    ::operator delete(p, std::align_val_t(64));
  }
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

template <typename T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;
} // namespace sabot

#endif
