#ifndef sabot_kernels_pack_math_h
#define sabot_kernels_pack_math_h

#include "sabot/kernels/pack.h"

#include <cmath>
#include <cstring>

/**
 * Logarithm, exponential and powers of whole packs, for the loops over material
 * points. They are compiled in: what a lane computes does not depend on its
 * neighbors, nor on whether a pack has four lanes or eight, nor on the
 * machine's C library, as operations and their order are the same. Only without
 * fused multiplication (the instruction set "baseline") are bits others.
 *
 * All functions take double as well, for which they are those of the standard
 * library: formulas written as templates over the type of a number serve both.
 */
namespace sabot
{
/** As many numbers as a register holds: eight with AVX-512, else four. */
#ifdef __AVX512F__
typedef double WidePack __attribute__((vector_size(64)));
#else
typedef Pack WidePack;
#endif
constexpr std::size_t n_wide = sizeof(WidePack) / sizeof(double);

/** What a comparison of wide packs gives: -1 where true, 0 elsewhere. */
typedef std::int64_t WideMask __attribute__((vector_size(sizeof(WidePack))));

typedef std::uint64_t WideBits __attribute__((vector_size(sizeof(WidePack))));

/** ln 2 = high + low, the high part with zeros at its end. */
constexpr double ln2_high = 6.93147180369123816490e-01,
                 ln2_low = 1.90821492927058770002e-10;

/** @p x in all lanes, for @p Number double or WidePack. */
template <typename Number>
inline Number splat(const double x)
{
  return x + Number{};
}

inline double pack_max(const double a, const double b)
{
  return a > b ? a : b;
}
inline double pack_min(const double a, const double b)
{
  return a < b ? a : b;
}
inline double pack_sqrt(const double a)
{
  return std::sqrt(a);
}
inline double pack_cbrt(const double a)
{
  return std::cbrt(a);
}
inline double pack_log(const double a)
{
  return std::log(a);
}
inline double pack_exp(const double a)
{
  return std::exp(a);
}
inline double pack_power(const double a, const double b)
{
  return std::pow(a, b);
}
inline bool any_of(const bool a)
{
  return a;
}

#ifdef __AVX512F__
/** As those of Pack. */
inline WidePack pack_max(const WidePack a, const WidePack b)
{
  return a > b ? a : b;
}
inline WidePack pack_min(const WidePack a, const WidePack b)
{
  return a < b ? a : b;
}
inline WidePack pack_sqrt(const WidePack a)
{
  return _mm512_sqrt_pd(a);
}
inline WidePack pack_cbrt(const WidePack a)
{
  typedef std::int32_t Bits __attribute__((vector_size(32)));
  typedef float Floats __attribute__((vector_size(32)));
  return cube_root_of<WidePack, Floats, Bits>(a);
}
#endif

/** Whether a comparison is true in any lane. */
inline bool any_of(const WideMask a)
{
#ifdef __AVX512DQ__
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(a)) != 0;
#elif defined(__AVX__)
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(a)) != 0;
#else
  return (a[0] | a[1] | a[2] | a[3]) != 0;
#endif
}

/**
 * Natural logarithm of a normal number above 0, to 0.75 ulp: with a = 2^k (1 +
 * f), 1 + f within a factor sqrt(2) of 1, the series in s = f/(2 + f) of
 * FreeBSD's msun (e_log.c, Sun Microsystems 1993), Lg1 to Lg7.
 * Not-a-number elsewhere, at 0 as well.
 */
inline WidePack pack_log(const WidePack a)
{
  constexpr std::int64_t root = 0x3fe6a09e667f3bcd; // bits of sqrt(1/2)
  const WideMask t =
      reinterpret_cast<WideMask>(a) + (0x3ff0000000000000 - root);
  // k as the last digits of 2^52 + 1023 + k.
  const WidePack k =
      reinterpret_cast<WidePack>((reinterpret_cast<WideBits>(t) >> 52) |
                                 0x4330000000000000) -
      (4503599627370496. + 1023.);
  const WidePack f =
      reinterpret_cast<WidePack>((t & 0x000fffffffffffff) + root) - 1.;
  const WidePack s = f / (2. + f), z = s * s, w = z * z;
  const WidePack even =
      w * (3.999999999940941908e-01 +
           w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const WidePack odd =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 +
                w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const WidePack half_square = 0.5 * f * f;
  const WidePack log =
      k * ln2_high -
      ((half_square - (s * (half_square + (even + odd)) + k * ln2_low)) - f);
  return a > 0. ? log : splat<WidePack>(std::nan(""));
}

/**
 * Exponential, to 1.05 ulp: a = n ln 2 + r, |r| <= ln(2)/2, the Taylor series
 * of r up to r^13/13!, and n added to the exponent of the result. Arguments are
 * cut to [-708, 709], so that nothing overflows.
 */
inline WidePack pack_exp(const WidePack a)
{
  constexpr double shift = 6755399441055744.; // 1.5 2^52: n in the last digits
  const WidePack x =
      pack_min(pack_max(a, splat<WidePack>(-708.)), splat<WidePack>(709.));
  const WidePack n = x * 1.4426950408889634074 + shift, whole = n - shift;
  const WidePack r = (x - whole * ln2_high) - whole * ln2_low, r2 = r * r,
                 r4 = r2 * r2;
  const WidePack c2 = 1. / 2 + r * (1. / 6), c4 = 1. / 24 + r * (1. / 120),
                 c6 = 1. / 720 + r * (1. / 5040),
                 c8 = 1. / 40320 + r * (1. / 362880),
                 c10 = 1. / 3628800 + r * (1. / 39916800),
                 c12 = 1. / 479001600 + r * (1. / 6227020800.);
  const WidePack series =
      (c2 + r2 * c4) + r4 * ((c6 + r2 * c8) + r4 * (c10 + r2 * c12));
  const WidePack y = 1. + (r + r2 * series);
  return reinterpret_cast<WidePack>(reinterpret_cast<WideMask>(y) +
                                    (reinterpret_cast<WideMask>(n) << 52));
}

/** a^b = exp(b ln a), a > 0: the rounding of the exponent makes an error of
    (2 + |b ln a|) ulp, 8 ulp over 13 orders of magnitude at b = 0.34. */
inline WidePack pack_power(const WidePack a, const double b)
{
  return pack_exp(b * pack_log(a));
}

/** n_wide numbers from @p p on, at any address. */
inline WidePack load_wide(const double *const p)
{
  WidePack a;
  std::memcpy(&a, p, sizeof(a));
  return a;
}

/** And back. */
inline void store_wide(double *const p, const WidePack a)
{
  std::memcpy(p, &a, sizeof(a));
}

/** Components of the symmetric tensors @p t of the points from @p k on, and
    back. */
inline void load_wide(const double *const t[6], const std::size_t k,
                      WidePack out[6])
{
  for (int c = 0; c < 6; ++c)
    out[c] = load_wide(&t[c][k]);
}
inline void store_wide(double *const t[6], const std::size_t k,
                       const WidePack a[6])
{
  for (int c = 0; c < 6; ++c)
    store_wide(&t[c][k], a[c]);
}

/** a : a of symmetric tensors. */
inline WidePack square_of(const WidePack a[6])
{
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2] +
         2. * (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]);
}
/** a <- dev a. @return tr a / 3. */
inline WidePack make_deviator(WidePack a[6])
{
  const WidePack mean = (a[0] + a[1] + a[2]) / 3.;
  for (int c = 0; c < 3; ++c)
    a[c] -= mean;
  return mean;
}
} // namespace sabot

#endif
