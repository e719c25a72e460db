#ifndef sabot_kernels_coarse_pack_h
#define sabot_kernels_coarse_pack_h

#include "sabot/kernels/pack.h"

#include <cstdint>

namespace sabot
{
/** Four numbers of two to three digits and the range of a float: its upper half
    (bfloat16), for what only books need. */
typedef std::uint16_t CoarsePack __attribute__((vector_size(8)));

/** Rounded to the nearest, ties to even, by 2^-9 at most; finite numbers below
    3e38 only. */
inline CoarsePack to_coarse(const Pack a)
{
  typedef std::uint32_t Bits __attribute__((vector_size(16)));
  Bits bits = reinterpret_cast<Bits>(to_float(a));
  bits += 0x7fffu + (bits >> 16 & 1u);
  return __builtin_convertvector(bits >> 16, CoarsePack);
}
inline Pack to_double(const CoarsePack a)
{
  typedef std::uint32_t Bits __attribute__((vector_size(16)));
  return to_double(
      reinterpret_cast<HalfPack>(__builtin_convertvector(a, Bits) << 16));
}
/** One of the four. */
inline double to_double(const std::uint16_t a)
{
  return to_double(CoarsePack{a, a, a, a})[0];
}
} // namespace sabot

#endif
