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
 * the same source compiles to one AVX register or two SSE registers.
 */
namespace sabot
{
typedef double Vec __attribute__((vector_size(32)));

inline Vec vec(const double x, const double y, const double z)
{
  return Vec{x, y, z, 0.};
}

inline Vec broadcast(const double a)
{
  return Vec{a, a, a, a};
}

/** Single-precision storage of a Vec, 16 bytes. */
typedef float StoredVec __attribute__((vector_size(16)));

inline Vec load(const StoredVec a)
{
#ifdef __AVX__ // GCC 12 converts the halves one by one otherwise
  return _mm256_cvtps_pd(a);
#else
  return __builtin_convertvector(a, Vec);
#endif
}

inline StoredVec store(const Vec a)
{
#ifdef __AVX__
  return _mm256_cvtpd_ps(a);
#else
  return __builtin_convertvector(a, StoredVec);
#endif
}

inline double dot(const Vec a, const Vec b)
{
  const Vec c = a * b;
  return c[0] + c[1] + c[2];
}

inline double norm_square(const Vec a)
{
  return dot(a, a);
}

inline double norm(const Vec a)
{
  return std::sqrt(dot(a, a));
}

inline Vec cross(const Vec a, const Vec b)
{
  return Vec{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
             a[0] * b[1] - a[1] * b[0], 0.};
}

/** 3x3 matrix, three rows; the fourth lane of every row is zero. */
struct Mat
{
  Vec row[3];

  static Mat zero() { return {{Vec{}, Vec{}, Vec{}}}; }
  static Mat identity() { return {{vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1)}}; }
  double operator()(const int i, const int j) const { return row[i][j]; }
  void set(const int i, const int j, const double a) { row[i][j] = a; }
};

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

/** a += b (outer product) c. */
inline void add_outer(Mat &a, const Vec b, const Vec c)
{
  a.row[0] += b[0] * c;
  a.row[1] += b[1] * c;
  a.row[2] += b[2] * c;
}

inline Vec operator*(const Mat &a, const Vec b)
{
  return vec(dot(a.row[0], b), dot(a.row[1], b), dot(a.row[2], b));
}

inline Mat operator*(const Mat &a, const Mat &b)
{
  Mat c;
  for (int i = 0; i < 3; ++i)
    c.row[i] = a.row[i][0] * b.row[0] + a.row[i][1] * b.row[1] +
               a.row[i][2] * b.row[2];
  return c;
}

/** a b without sums across lanes, for @p a given by its columns in row[]. */
inline Vec multiply_columns(const Mat &columns, const Vec b)
{
  return b[0] * columns.row[0] + b[1] * columns.row[1] + b[2] * columns.row[2];
}

inline Mat transpose(const Mat &a)
{
  return {{vec(a(0, 0), a(1, 0), a(2, 0)), vec(a(0, 1), a(1, 1), a(2, 1)),
           vec(a(0, 2), a(1, 2), a(2, 2))}};
}

inline double trace(const Mat &a)
{
  return a(0, 0) + a(1, 1) + a(2, 2);
}

inline double determinant(const Mat &a)
{
  return dot(a.row[0], cross(a.row[1], a.row[2]));
}

/** Inverse; the determinant is returned through @p det (not checked). */
inline Mat inverse(const Mat &a, double &det)
{
  const Vec c0 = cross(a.row[1], a.row[2]), c1 = cross(a.row[2], a.row[0]),
            c2 = cross(a.row[0], a.row[1]);
  det = dot(a.row[0], c0);
  const double r = 1. / det;
  return transpose(Mat{{r * c0, r * c1, r * c2}});
}

inline Mat inverse(const Mat &a)
{
  double det;
  return inverse(a, det);
}
} // namespace sabot

#endif
