// Symmetries that planes of a body generate, and images of its particles.
#include "sabot/bodies/spg/mirror_planes.h"

#include "sabot/base/nodal_state.h"
#include "sabot/kernels/mirrored.h"

#include <algorithm>

namespace sabot
{
MirrorPlanes::MirrorPlanes(const std::vector<SymmetryPlane> &planes,
                           const std::vector<std::array<double, 3>> &points,
                           const double tolerance)
    : tolerance(tolerance)
{
  for (int d = 0; d < 3; ++d)
  {
    std::vector<double> across;
    for (const SymmetryPlane &plane : planes)
      if (plane.axis == d)
        across.push_back(plane.coordinate);
    if (across.empty() || points.empty())
      continue;
    const auto [low, high] = std::minmax_element(
        points.begin(), points.end(),
        [d](const auto &a, const auto &b) { return a[d] < b[d]; });
    const auto [first, last] =
        std::minmax_element(across.begin(), across.end());
    Axis axis{*last - *first > tolerance ? 2u : 1u, *first, *last, 1.};
    const bool above = (*low)[d] > axis.low - tolerance,
               below = (*high)[d] < axis.high + tolerance;
    if (axis.n_planes == 1)
      axis.side = above ? 1. : -1.;
    if (axis.n_planes == 2 ? above && below : above != below)
      axes[d] = axis;
  }
  n_symmetries = n_of(axes[0]) * n_of(axes[1]) * n_of(axes[2]);
}

unsigned int MirrorPlanes::across() const
{
  unsigned int bits = 0;
  for (int d = 0; d < 3; ++d)
    bits |= (axes[d].n_planes > 0) << d;
  return bits;
}

unsigned int MirrorPlanes::planes_at(const Vec X) const
{
  unsigned int on = 0;
  for (int d = 0; d < 3; ++d)
  {
    if (axes[d].n_planes > 0 && std::abs(X[d] - axes[d].low) < tolerance)
      on |= 1u << 2 * d;
    if (axes[d].n_planes > 1 && std::abs(X[d] - axes[d].high) < tolerance)
      on |= 2u << 2 * d;
  }
  return on;
}

std::vector<std::uint8_t> MirrorPlanes::planes_of(const NodalState &nodes) const
{
  std::vector<std::uint8_t> on(nodes.n_owned);
  for (std::size_t i = 0; i < on.size(); ++i)
    on[i] = planes_at(nodes.reference_position[i]);
  return on;
}

int MirrorPlanes::element(unsigned int symmetry, const int d) const
{
  for (int k = 0; k < d; ++k)
    symmetry /= n_of(axes[k]);
  return element_of(symmetry % n_of(axes[d]));
}

int MirrorPlanes::element_of(const int digit)
{
  // 0, -1, 1, -2, 2 and so on
  return digit % 2 == 1 ? -(digit + 1) / 2 : digit / 2;
}

unsigned int
MirrorPlanes::symmetry_with(const std::array<int, 3> &elements) const
{
  unsigned int symmetry = 0;
  for (int d = 2; d >= 0; --d)
  {
    const int c = elements[d];
    symmetry = symmetry * n_of(axes[d]) + (c < 0 ? -2 * c - 1 : 2 * c);
  }
  return symmetry;
}

unsigned int MirrorPlanes::canonical(const unsigned int symmetry,
                                     const unsigned int on) const
{
  std::array<int, 3> c;
  for (int d = 0; d < 3; ++d)
    c[d] = canonical_element(element(symmetry, d), on, d);
  return symmetry_with(c);
}

int MirrorPlanes::canonical_element(const int c, const unsigned int on,
                                    const int d)
{
  if (c % 2 == 0)
    return c;
  return on >> 2 * d & 1 ? c + 1 : on >> 2 * d & 2 ? c - 1 : c;
}

unsigned int MirrorPlanes::inverse(const unsigned int symmetry) const
{
  std::array<int, 3> c;
  for (int d = 0; d < 3; ++d)
  {
    c[d] = element(symmetry, d);
    if (c[d] % 2 == 0)
      c[d] = -c[d];
  }
  return symmetry_with(c);
}

unsigned int MirrorPlanes::turned_axes(const unsigned int symmetry) const
{
  unsigned int turned = 0;
  for (int d = 0; d < 3; ++d)
    turned |= (element(symmetry, d) % 2 != 0) << d;
  return turned;
}

Vec MirrorPlanes::offset(const unsigned int symmetry) const
{
  Vec added = {};
  for (int d = 0; d < 3; ++d)
    added[d] = offset_along(element(symmetry, d), d);
  return added;
}

double MirrorPlanes::offset_along(const int c, const int d) const
{
  const double width = axes[d].high - axes[d].low;
  return c % 2 == 0 ? c * width : 2. * axes[d].low + (c + 1) * width;
}

Vec MirrorPlanes::place(const unsigned int symmetry, const Vec x) const
{
  return x * mirror_signs(turned_axes(symmetry)) + offset(symmetry);
}

MirrorPlanes::Elements MirrorPlanes::elements_near(const Vec x,
                                                   const unsigned int on,
                                                   const double reach,
                                                   const int d) const
{
  const Axis &axis = axes[d];
  Elements near;
  for (unsigned int digit = 0; digit < n_of(axis); ++digit)
  {
    const int c = element_of(digit);
    const double there = (c % 2 == 0 ? x[d] : -x[d]) + offset_along(c, d);
    const bool is_near =
        c == 0 || (axis.n_planes == 1
                       ? axis.side * (there - axis.low) > -reach
                       : axis.low - reach < there && there < axis.high + reach);
    if (is_near && canonical_element(c, on, d) == c)
      near.c[near.n++] = c;
  }
  return near;
}
} // namespace sabot
