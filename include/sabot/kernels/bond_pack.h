#ifndef sabot_kernels_bond_pack_h
#define sabot_kernels_bond_pack_h

#include "sabot/kernels/pack.h"

#include <cstdint>

/**
 * Four bonds of one particle at once: what loops over bonds load, store and sum
 * up, one bond in each lane of a Pack. Rows of bonds are padded to whole packs
 * (BondList), and a bond's lane follows from its place in the row, so that sums
 * have the same bits for every number of ranks.
 */
namespace sabot
{
/** A vector of a bond as it is stored, in single precision: 12 bytes, so that
    four of them are three quarters of a cache line. */
struct BondVec
{
  float x, y, z;
};

/**
 * Widened, fourth lane zero; exact.
 * Of a single bond anywhere in the list, as of the other end of one.
 */
inline Vec load(const BondVec &a)
{
#ifdef __AVX__
  return _mm256_cvtps_pd(_mm_maskload_ps(&a.x, _mm_set_epi32(0, -1, -1, -1)));
#else
  return vec(a.x, a.y, a.z);
#endif
}

/** Rounded to the nearest float; see store(Vec) on what must not be stored like
    this. */
inline BondVec store_bond(const Vec a)
{
  return {static_cast<float>(a[0]), static_cast<float>(a[1]),
          static_cast<float>(a[2])};
}

/** The components of the four bonds from @p p on, which is aligned to 16 bytes;
    widened. out[d]: component d. */
inline void load_bonds(const BondVec *const p, Pack out[3])
{
  const StoredVec *const quarter = reinterpret_cast<const StoredVec *>(p);
  const StoredVec a = quarter[0], b = quarter[1], c = quarter[2];
  const StoredVec x_bc = __builtin_shufflevector(b, c, 2, 5, 2, 5),
                  y_ab = __builtin_shufflevector(a, b, 1, 4, 7, 7),
                  z_ab = __builtin_shufflevector(a, b, 2, 5, 2, 5);
  out[0] = load(StoredVec(__builtin_shufflevector(a, x_bc, 0, 3, 4, 5)));
  out[1] = load(StoredVec(__builtin_shufflevector(y_ab, c, 0, 1, 2, 6)));
  out[2] = load(StoredVec(__builtin_shufflevector(z_ab, c, 0, 1, 4, 7)));
}

/** Back, rounded to the nearest floats; @p in becomes what has been stored. */
inline void store_bonds(BondVec *const p, Pack in[3])
{
  const StoredVec x = store(in[0]), y = store(in[1]), z = store(in[2]);
  in[0] = load(x);
  in[1] = load(y);
  in[2] = load(z);
  const StoredVec xy_01 = __builtin_shufflevector(x, y, 0, 4, 1, 5),
                  xy_23 = __builtin_shufflevector(x, y, 2, 6, 3, 7),
                  yz_1 = __builtin_shufflevector(xy_01, z, 3, 5, 3, 5);
  StoredVec *const quarter = reinterpret_cast<StoredVec *>(p);
  quarter[0] = __builtin_shufflevector(xy_01, z, 0, 1, 4, 2);
  quarter[1] = __builtin_shufflevector(yz_1, xy_23, 0, 1, 4, 5);
  quarter[2] = __builtin_shufflevector(xy_23, z, 6, 2, 3, 7);
}

/** Four floats at @p p, aligned to 16 bytes; widened. */
inline Pack load_floats(const float *const p)
{
  return load(*reinterpret_cast<const StoredVec *>(p));
}

/** Rows to columns: out lane k of a[l] is lane l of a[k]. */
inline void transpose_lanes(Pack a[4])
{
  const Pack even_01 = __builtin_shufflevector(a[0], a[1], 0, 4, 2, 6),
             odd_01 = __builtin_shufflevector(a[0], a[1], 1, 5, 3, 7),
             even_23 = __builtin_shufflevector(a[2], a[3], 0, 4, 2, 6),
             odd_23 = __builtin_shufflevector(a[2], a[3], 1, 5, 3, 7);
  a[0] = __builtin_shufflevector(even_01, even_23, 0, 1, 4, 5);
  a[1] = __builtin_shufflevector(odd_01, odd_23, 0, 1, 4, 5);
  a[2] = __builtin_shufflevector(even_01, even_23, 2, 3, 6, 7);
  a[3] = __builtin_shufflevector(odd_01, odd_23, 2, 3, 6, 7);
}

/** The sums of the lanes of a, b, c and d, in this order; (0 + 1) + (2 + 3)
    each. */
inline Pack sum_lanes(const Pack a, const Pack b, const Pack c, const Pack d)
{
  const Pack ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) +
                  __builtin_shufflevector(a, b, 1, 5, 3, 7),
             cd = __builtin_shufflevector(c, d, 0, 4, 2, 6) +
                  __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) +
         __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

/** @p a in all lanes. */
inline Pack in_all(const double a)
{
  return Pack{a, a, a, a};
}
} // namespace sabot

#endif
