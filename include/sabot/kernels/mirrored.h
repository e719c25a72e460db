#ifndef sabot_kernels_mirrored_h
#define sabot_kernels_mirrored_h

#include "sabot/kernels/bond_pack.h"
#include "sabot/kernels/vec.h"

#include <type_traits>

/**
 * Values as their mirror images have them, in planes across axes: @p axes has a
 * bit for each axis along which vectors are turned around, so that two planes
 * across one axis cancel. With R the reflection a vector v becomes R v, a
 * tensor T becomes R T R, a scalar stays. Fourth lanes are scalars. Each is its
 * own inverse, and exact: only signs change.
 */
namespace sabot
{
/** 1 or -1 for each component, 1 in the fourth lane. */
inline Vec mirror_signs(const unsigned int axes)
{
  return Vec{axes & 1 ? -1. : 1., axes & 2 ? -1. : 1., axes & 4 ? -1. : 1., 1.};
}

template <typename T>
inline std::enable_if_t<std::is_arithmetic_v<T>> mirror(T &, unsigned int)
{
}

inline void mirror(Vec &v, const unsigned int axes)
{
  v *= mirror_signs(axes);
}

inline void mirror(BondVec &v, const unsigned int axes)
{
  v = store_bond(load(v) * mirror_signs(axes));
}

/** By rows or by columns. */
inline void mirror(Mat &t, const unsigned int axes)
{
  const Vec signs = mirror_signs(axes);
  for (int d = 0; d < 3; ++d)
  {
    const double lane = t.row[d][3];
    t.row[d] *= signs[d] * signs;
    t.row[d][3] = lane;
  }
}

/** Mean of a tensor and its images in planes across @p axes: nothing links
    directions along and across them. */
inline void take_mean_of_images(Mat &t, const unsigned int axes)
{
  for (int d = 0; d < 3; ++d)
    for (int e = 0; e < 3; ++e)
      if (d != e && ((axes >> d | axes >> e) & 1))
        t.row[d][e] = 0.;
}

/** The same of xx, yy, zz, xy, yz, xz. */
inline void take_mean_of_images(double *const symmetric,
                                const unsigned int axes)
{
  constexpr unsigned int linked[3] = {1 | 2, 2 | 4, 1 | 4};
  for (int c = 0; c < 3; ++c)
    if (axes & linked[c])
      symmetric[3 + c] = 0.;
}
} // namespace sabot

#endif
