#ifndef sabot_kernels_pack_h
#define sabot_kernels_pack_h

#include "sabot/kernels/vec.h"

#include <cstddef>
#include <cstdint>
#ifdef __AVX__
#include <immintrin.h>
#endif

/**
 * Four cells at once: a Pack holds one number of each, in the lanes of one
 * AVX register. Every lane sees the same operations wherever its cell stands,
 * so results do not depend on how cells are grouped, and so not on the number
 * of ranks.
 *
 * Branches become comparisons and selects: a comparison of packs gives a pack
 * of long integers, -1 where true, and c ? a : b takes lane by lane. A lane
 * without a cell repeats one that exists, so that nothing is ever infinite.
 */
namespace sabot
{
/**
 * A GCC vector: +, -, *, / and comparisons act lane by lane, a double on either
 * side of an operator stands for four. Objects must lie at multiples of 32
 * bytes, which AlignedVector and automatic variables do. Without AVX the
 * compiler splits it into two SSE registers; the operations and their order
 * stay the same.
 */
typedef double Pack __attribute__((vector_size(32)));
constexpr std::size_t n_lanes = 4;

/**
 * Four 3x3 matrices: m[i][j] holds the entry (i, j) of each.
 * The entries of one matrix are 32 bytes apart: loops over i and j are over
 * whole registers. Frames are those of Mat: of a deformation gradient i is of
 * the present configuration, j of the reference. Not initialized.
 */
struct PackMat
{
  Pack m[3][3];
};

/**
 * The greater of a and b in each lane; b where either is not a number.
 * A comparison with something that is not a number is false, hence the second
 * operand, as maxpd has it.
 */
inline Pack pack_max(const Pack a, const Pack b)
{
  return a > b ? a : b;
}

/** The lesser of a and b in each lane; b where either is not a number. */
inline Pack pack_min(const Pack a, const Pack b)
{
  return a < b ? a : b;
}

/** Whether a comparison of packs holds in every lane. */
template <typename Comparison>
inline bool in_all_lanes(const Comparison holds)
{
#ifdef __AVX__
  return _mm256_movemask_pd(reinterpret_cast<Pack>(holds)) == 15;
#else
  return (holds[0] & holds[1] & holds[2] & holds[3]) != 0;
#endif
}

/**
 * Square root of each lane, correctly rounded.
 * IEEE 754 demands this of the instruction and of std::sqrt alike, so that both
 * branches give the same bits. Negative lanes become not-a-number, without a
 * trap.
 */
inline Pack pack_sqrt(const Pack a)
{
#ifdef __AVX__
  return _mm256_sqrt_pd(a);
#else
  return Pack{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]),
              std::sqrt(a[3])};
#endif
}

/** Four numbers of seven digits, for what is kept in half the room. */
typedef float HalfPack __attribute__((vector_size(16)));
inline HalfPack to_float(const Pack a)
{
  return __builtin_convertvector(a, HalfPack);
}
inline Pack to_double(const HalfPack a)
{
  return __builtin_convertvector(a, Pack);
}
/** Square root of each, correctly rounded, as pack_sqrt(). */
inline HalfPack half_sqrt(const HalfPack a)
{
#ifdef __AVX__
  return _mm_sqrt_ps(a);
#else
  return HalfPack{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]),
                  std::sqrt(a[3])};
#endif
}

/**
 * Cube root of 1e-36 < a < 1e36, to 3 ulp, and 0 of 0: y = a r^2 with r =
 * a^(-1/3) by r <- r (1 + e/3 + 2 e^2/9 + 14 e^3/81 + 35 e^4/243), e = 1 - a
 * r^3, the binomial series of (1 - e)^(-1/3). The first guess divides the
 * exponent of a float by three, to 4 %; two steps of fifth order follow, and
 * no division. For any width: @p Numbers, as many floats, as many integers.
 */
template <typename Numbers, typename Floats, typename Bits>
inline Numbers cube_root_of(const Numbers a)
{
  const Bits third = __builtin_convertvector(
      (1.f / 3.f) *
          __builtin_convertvector(
              reinterpret_cast<Bits>(__builtin_convertvector(a, Floats)),
              Floats),
      Bits);
  Numbers r = __builtin_convertvector(
      reinterpret_cast<Floats>(0x54a2fa8c - third), Numbers);
  for (int i = 0; i < 2; ++i)
  {
    const Numbers e = 1. - a * r * (r * r);
    r += r * e *
         ((1. / 3. + 2. / 9. * e) + e * e * (14. / 81. + 35. / 243. * e));
  }
  const Numbers y = a * (r * r);
  // r is good to some ulp: one of Newton's steps on y.
  return y - (1. / 3.) * (r * r) * (y * (y * y) - a);
}
inline Pack pack_cbrt(const Pack a)
{
  typedef std::int32_t Bits __attribute__((vector_size(16)));
  return cube_root_of<Pack, HalfPack, Bits>(a);
}

/**
 * Four doubles at @p p, which is aligned to 32 bytes.
 * At other addresses the aligned load would fault.
 */
inline Pack load_pack(const double *const p)
{
  return *reinterpret_cast<const Pack *>(p);
}

/** And back; same alignment. */
inline void store_pack(double *const p, const Pack a)
{
  *reinterpret_cast<Pack *>(p) = a;
}

/**
 * The x, y and z of four nodal vectors, one @p node of each cell: out[d] holds
 * component d of the four. Three shuffles of four loads.
 * The fourth lane of the vectors is not read into the result. Indices count
 * vectors from the start of @p nodal and are not checked; two lanes may have
 * the same one.
 */
inline void gather(const Vec *const nodal, const std::uint32_t node[n_lanes],
                   Pack out[3])
{
  const Vec a = nodal[node[0]], b = nodal[node[1]], c = nodal[node[2]],
            d = nodal[node[3]];
  const Vec xz_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6),
            xz_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6),
            y_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7),
            y_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  out[0] = __builtin_shufflevector(xz_ab, xz_cd, 0, 1, 4, 5);
  out[1] = __builtin_shufflevector(y_ab, y_cd, 0, 1, 4, 5);
  out[2] = __builtin_shufflevector(xz_ab, xz_cd, 2, 3, 6, 7);
}

/**
 * Back from components: one nodal vector per lane, fourth components zero.
 * The inverse of gather(): out[k] = (x[k], y[k], z[k], 0) for the lane k. Sums
 * over cells that share a node are left to the caller.
 */
inline void unpack(const Pack x, const Pack y, const Pack z, Vec out[n_lanes])
{
  const Pack zero = {};
  const Pack xy_even = __builtin_shufflevector(x, y, 0, 4, 2, 6),
             xy_odd = __builtin_shufflevector(x, y, 1, 5, 3, 7),
             z_even = __builtin_shufflevector(z, zero, 0, 4, 2, 6),
             z_odd = __builtin_shufflevector(z, zero, 1, 5, 3, 7);
  out[0] = __builtin_shufflevector(xy_even, z_even, 0, 1, 4, 5);
  out[1] = __builtin_shufflevector(xy_odd, z_odd, 0, 1, 4, 5);
  out[2] = __builtin_shufflevector(xy_even, z_even, 2, 3, 6, 7);
  out[3] = __builtin_shufflevector(xy_odd, z_odd, 2, 3, 6, 7);
}

/**
 * det a of each lane, expanded by the first row.
 * Of a deformation gradient J, the present volume over that of the reference.
 * The same expansion as that of determinant(Mat), to which it is equal to
 * round-off.
 */
inline Pack determinant(const PackMat &a)
{
  return a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) +
         a.m[0][1] * (a.m[1][2] * a.m[2][0] - a.m[1][0] * a.m[2][2]) +
         a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
}

/**
 * det a times the inverse of a, the transposed cofactors: no division, and
 * right where a is singular.
 *   adj(a)_ij = a_ps a_qt - a_pt a_qs,
 * with (p, q) the indices that follow j and (s, t) those that follow i, in
 * cyclic order, by which the sign comes by itself. a adj(a) = det(a) 1; of a
 * deformation gradient adj(F)^T = J F^-T takes areas of the reference to the
 * present (Nanson).
 */
inline PackMat adjugate(const PackMat &a)
{
  PackMat r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const int p = (j + 1) % 3, q = (j + 2) % 3, s = (i + 1) % 3,
                t = (i + 2) % 3;
      r.m[i][j] = a.m[p][s] * a.m[q][t] - a.m[p][t] * a.m[q][s];
    }
  return r;
}

/**
 * The matrix of one lane.
 * For what has no form without branches, as polar decompositions; @p lane is
 * below n_lanes and not checked.
 */
inline Mat lane_of(const PackMat &a, const std::size_t lane)
{
  Mat r;
  for (int i = 0; i < 3; ++i)
    r.row[i] = vec(a.m[i][0][lane], a.m[i][1][lane], a.m[i][2][lane]);
  return r;
}

/**
 * c_ij = a_ik b_kj of each lane.
 * Three products each, summed from k = 0 to 2 in every lane.
 */
inline PackMat multiply(const PackMat &a, const PackMat &b)
{
  PackMat c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c.m[i][j] =
          a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
  return c;
}
} // namespace sabot

#endif
