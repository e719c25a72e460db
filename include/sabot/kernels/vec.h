#ifndef sabot_kernels_vec_h
#define sabot_kernels_vec_h

#ifdef __AVX__
#include <immintrin.h>
#endif

#include <array>
#include <cmath>

/**
 * Small vectors and matrices for the hot loops.
 *
 * A nodal vector is stored as four doubles (x, y, z, 0) in one 32-byte GCC
 * vector: one aligned load per gathered node, never across a cache line, and
 * the same source compiles to one AVX register or two SSE registers. The
 * compiler gives such a type +, -, *, / component by component, also with a
 * double, and v[d] for a component.
 *
 * The fourth lane is zero in everything that is stored, and every function here
 * keeps it so but broadcast() and division by a vector. Nothing checks units or
 * frames: a Vec is a position [m] or a force [N] as its name says.
 */
namespace sabot
{
typedef double Vec __attribute__((vector_size(32)));

/**
 * (x, y, z) with the fourth lane zero.
 * The only way in which stored vectors should be made, as whatever sums over
 * all four lanes relies on the zero.
 */
inline Vec vec(const double x, const double y, const double z)
{
  return Vec{x, y, z, 0.};
}

/**
 * @p a in all four lanes, as a divisor: v / broadcast(m).
 * A vector with a zero in its fourth lane would give 0/0 there and, where
 * floating point exceptions are watched, a false alarm.
 */
inline Vec broadcast(const double a)
{
  return Vec{a, a, a, a};
}

/** Single-precision storage of a Vec, 16 bytes: half of the memory that a loop
    over bonds has to read, for numbers known to seven digits anyway. */
typedef float StoredVec __attribute__((vector_size(16)));

/**
 * Widened; exact.
 * Every float is a double, and the fourth lane stays zero.
 */
inline Vec load(const StoredVec a)
{
#ifdef __AVX__ // GCC 12 converts the halves one by one otherwise
  return _mm256_cvtps_pd(a);
#else
  return __builtin_convertvector(a, Vec);
#endif
}

/**
 * Rounded to the nearest float, component by component.
 * Relative error up to 2^-24, about 6e-8; beyond 3.4e38 the result is infinite.
 * What is summed up over steps must not be stored like this.
 */
inline StoredVec store(const Vec a)
{
#ifdef __AVX__
  return _mm256_cvtpd_ps(a);
#else
  return __builtin_convertvector(a, StoredVec);
#endif
}

/**
 * a . b of the first three components, summed from x to z.
 * The fourth lane takes no part, whatever stands in it. The fixed order makes
 * sums the same on every machine with the same rounding.
 */
inline double dot(const Vec a, const Vec b)
{
  const Vec c = a * b;
  return c[0] + c[1] + c[2];
}

/** |a|^2. */
inline double norm_square(const Vec a)
{
  return dot(a, a);
}

/**
 * |a|.
 * Without protection from overflow: components beyond 1e154 have an infinite
 * norm, below 1e-162 it is zero. Lengths [m] and speeds [m/s] are far from
 * both.
 */
inline double norm(const Vec a)
{
  return std::sqrt(dot(a, a));
}

/**
 * a x b, right-handed.
 * Of two edges of a triangle twice its area times its normal, by the right-hand
 * rule; zero in the fourth lane.
 */
inline Vec cross(const Vec a, const Vec b)
{
  return Vec{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
             a[0] * b[1] - a[1] * b[0], 0.};
}

/**
 * 3x3 matrix, three rows; the fourth lane of every row is zero. Not initialized
 * by itself: start sums with zero(). Not every matrix is a tensor: of a
 * deformation gradient the first index is of the present frame, the second one
 * of the reference.
 */
struct Mat
{
  Vec row[3];

  /** For sums; add_outer() then adds dyads to it. */
  static Mat zero() { return {{Vec{}, Vec{}, Vec{}}}; }
  /** The deformation gradient of an undeformed body. */
  static Mat identity() { return {{vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1)}}; }
  // a(i, j): row i, column j, both from 0
  /**
   * Entries by index are for set-up and decompositions; loops take whole rows.
   */
  double operator()(const int i, const int j) const { return row[i][j]; }
  void set(const int i, const int j, const double a) { row[i][j] = a; }
};

// Sums, and products with a scalar, entry by entry.
inline Mat operator+(const Mat &a, const Mat &b)
{
  return {{a.row[0] + b.row[0], a.row[1] + b.row[1], a.row[2] + b.row[2]}};
}

inline Mat operator-(const Mat &a, const Mat &b)
{
  return {{a.row[0] - b.row[0], a.row[1] - b.row[1], a.row[2] - b.row[2]}};
}

inline Mat operator*(const double s, const Mat &a)
{
  return {{s * a.row[0], s * a.row[1], s * a.row[2]}};
}

/**
 * a += b (x) c, that is a_ij += b_i c_j.
 * Summed over neighbors with weights in b or c this makes moment matrices M =
 * sum w d (x) d and velocity gradients L = sum v (x) grad N, of which the first
 * index is the component and the second the direction.
 */
inline void add_outer(Mat &a, const Vec b, const Vec c)
{
  a.row[0] += b[0] * c;
  a.row[1] += b[1] * c;
  a.row[2] += b[2] * c;
}

/** a b; sums across lanes, see multiply_columns(). */
inline Vec operator*(const Mat &a, const Vec b)
{
  return vec(dot(a.row[0], b), dot(a.row[1], b), dot(a.row[2], b));
}

/**
 * c_ik = a_ij b_jk, by combinations of the rows of b.
 * Rows need no transposition: row i of the product is the sum of a_ik times row
 * k of b, three multiplications of whole registers.
 */
inline Mat operator*(const Mat &a, const Mat &b)
{
  Mat c;
  for (int i = 0; i < 3; ++i)
    c.row[i] = a.row[i][0] * b.row[0] + a.row[i][1] * b.row[1] +
               a.row[i][2] * b.row[2];
  return c;
}

/** a b without sums across lanes, for @p a given by its columns in row[], that
    is for transpose(a): the cheaper product, where many vectors meet one
    matrix. */
inline Vec multiply_columns(const Mat &columns, const Vec b)
{
  return b[0] * columns.row[0] + b[1] * columns.row[1] + b[2] * columns.row[2];
}

/**
 * Of a rotation its inverse; of a deformation gradient, over J, what takes
 * present areas n da back to the reference (Nanson).
 */
inline Mat transpose(const Mat &a)
{
  return {{vec(a(0, 0), a(1, 0), a(2, 0)), vec(a(0, 1), a(1, 1), a(2, 1)),
           vec(a(0, 2), a(1, 2), a(2, 2))}};
}

/**
 * a_ii.
 * Of a velocity gradient div v, the rate of ln J [1/s]; of a stress minus three
 * times the pressure.
 */
inline double trace(const Mat &a)
{
  return a(0, 0) + a(1, 1) + a(2, 2);
}

/**
 * Of rows r0 . (r1 x r2).
 * Of a deformation gradient J = rho_0/rho; positive where a cell has not been
 * turned inside out.
 */
inline double determinant(const Mat &a)
{
  return dot(a.row[0], cross(a.row[1], a.row[2]));
}

/**
 * Inverse by cofactors. The determinant is returned through @p det and not
 * checked: where it is zero the entries are infinite or not a number, and the
 * caller has to look.
 * Columns of the inverse are the cross products of the rows over the
 * determinant:
 *   a^-1 = (r1 x r2, r2 x r0, r0 x r1)/det a.
 * The error grows with the condition of a, fit for well-shaped cells and
 * supports; nearly singular moment matrices are for damped_inverse().
 */
inline Mat inverse(const Mat &a, double &det)
{
  const Vec c0 = cross(a.row[1], a.row[2]), c1 = cross(a.row[2], a.row[0]),
            c2 = cross(a.row[0], a.row[1]);
  det = dot(a.row[0], c0);
  const double r = 1. / det;
  return transpose(Mat{{r * c0, r * c1, r * c2}});
}

/** The same where the determinant is known not to be zero. */
inline Mat inverse(const Mat &a)
{
  double det;
  return inverse(a, det);
}
} // namespace sabot

#endif
