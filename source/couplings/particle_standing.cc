// Where a node stands against the surface or the volume of particles.
#include "sabot/couplings/particle_standing.h"

#include "sabot/couplings/mirror_images.h"
#include "sabot/couplings/particle_search.h"
#include "sabot/kernels/kernel_function.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Mean of the sum of cubic splines of radius 1.5 spacings over a plane of
    particles: 2 pi 1.5^2 integral of phi r dr. */
constexpr double full_sum = 0.8247;
/** Part of it below which a surface has ended, and from which it is whole:
    least values half a spacing beyond a straight rim and inside of it. */
constexpr double least_sum = 0.5, whole_sum = 0.875;
/** Least slope, times R, of the filled part across the face of a lattice whose
    outermost particles have half a volume and splines of R = 1.75 spacings:
    24 phi(1/R) / R^2 at the face, 9 % more half a spacing beneath. (A face of
    whole particles has twice as much, matter without grain 1.4.) */
constexpr double plane_slope = 0.82;
/** Parts of it below which a node is too deep for a nearest side (a lattice has
    0.13 of it deep inside), and from which it is surely not. */
constexpr double deep_slope = 0.2, shallow_slope = 0.5;

/** 0 for directions at right angles or worse, 1 within 60 degrees. */
double alignment(const double cosine)
{
  return std::clamp(2. * cosine, 0., 1.);
}

/** Make the weights sum to 1 and, as far as it can, to the node's place, so
    that forces have the right moment: along the plane with normal @p n, or in
    all directions where n is zero. */
void balance_weights(std::vector<NearParticle> &near, const Vec n)
{
  // w (1 + c . d) has no first moment where the node stands between
  // particles; beyond the last it gets as near as w >= 0 allows. Where all are
  // in one direction, or there is one only, c . d is -1 for all of them but for
  // round-off: then something has to be left of the weights.
  constexpr double largest_loss = 0.999;
  const auto arm = [&](const NearParticle &p)
  { return p.offset - dot(p.offset, n) * n; };
  Vec first = {};
  Mat second = Mat::zero();
  for (const NearParticle &p : near)
    if (p.weight > 0.)
    {
      const Vec d = arm(p), wd = p.weight * d;
      first += wd;
      add_outer(second, wd, d);
    }
  const double size = trace(second);
  Vec slope = {};
  if (size > 0.)
  {
    add_outer(second, size * n, n);
    slope = -1. * (inverse(second + 1e-6 * size * Mat::identity()) * first);
  }
  double least = 0.;
  for (const NearParticle &p : near)
    if (p.weight > 0.)
      least = std::min(least, dot(slope, arm(p)));
  if (least < -largest_loss)
    slope *= -largest_loss / least;
  double sum = 0.;
  for (NearParticle &p : near)
  {
    if (p.weight > 0.)
      p.weight *= std::max(0., 1. + dot(slope, arm(p)));
    sum += p.weight;
  }
  for (NearParticle &p : near)
    p.weight /= sum;
}
} // namespace

Standing stand_on_surface(const StandingNode &node,
                          std::vector<NearParticle> &near,
                          const AlignedVector<SurfacePoint> &points)
{
  // A node that comes from outside is caught before half a spacing; the other
  // side of a thin part is a spacing deep at least.
  const double deepest = node.is_inside ? ParticleSearch::reach : 0.5;
  const bool has_normal = norm_square(node.own.normal) > 0.;
  Standing standing;
  double sum = 0., gap = 0.;
  Vec normal = {};
  for (NearParticle &p : near)
  {
    p.weight = 0.;
    const SurfacePoint &point = points[p.slot];
    Vec n = flipped(point.normal, p.turned);
    double facing = norm_square(n) > 0. ? 1. : 0.;
    if (has_normal)
    {
      facing *= alignment(-dot(node.own.normal, n));
      n = point.flatness * n - node.own.flatness * node.own.normal;
    }
    if (facing <= 0.)
      continue;
    n *= 1. / norm(n);
    if (node.is_inside)
      facing *= alignment(dot(n, node.side));
    const double along = dot(p.offset, n);
    if (along < -deepest * point.spacing)
      continue;
    const double lateral =
        std::sqrt(std::max(0., norm_square(p.offset) - along * along));
    p.weight = facing *
               cubic_spline(lateral / (ParticleSearch::reach * point.spacing));
    sum += p.weight;
    normal += p.weight * n;
  }
  const double part = sum / full_sum;
  if (part <= least_sum || norm_square(normal) == 0.)
    return standing;
  standing.normal = (1. / norm(normal)) * normal;
  balance_weights(near, standing.normal);
  for (const NearParticle &p : near)
    if (p.weight > 0.)
    {
      Vec n = flipped(points[p.slot].normal, p.turned);
      if (has_normal)
        n = points[p.slot].flatness * n - node.own.flatness * node.own.normal;
      gap += p.weight * dot(p.offset, (1. / norm(n)) * n);
    }
  standing.gap = gap;
  standing.fade = std::min(1., (part - least_sum) / (whole_sum - least_sum));
  return standing;
}

Standing stand_in_volume(std::vector<NearParticle> &near,
                         const AlignedVector<VolumePoint> &points)
{
  Standing standing;
  double filled = 0.;
  Vec slope = {};
  for (NearParticle &p : near)
  {
    p.weight = 0.;
    const VolumePoint &point = points[p.slot];
    const Vec xi =
        point.to_unit * flipped(p.offset, p.turned); // as the particle sees it
    const double r = norm(xi);
    if (!(r < 1.))
      continue;
    p.weight = point.content * cubic_spline(r);
    filled += p.weight;
    if (r > 0.)
      slope += flipped(point.content * cubic_spline_slope(r) / r *
                           (transpose(point.to_unit) * xi),
                       p.turned);
  }
  if (filled <= 0.5)
    return standing;
  const double steepness = norm(slope);
  if (!(steepness > 0.))
  {
    standing.is_deep = true;
    return standing;
  }
  const Vec normal = (-1. / steepness) * slope;
  double on_plane = 0.;
  for (const NearParticle &p : near)
    if (p.weight > 0.)
    {
      // How far its ellipsoid reaches along the normal.
      const Mat axes = transpose(inverse(points[p.slot].to_unit));
      on_plane += p.weight / norm(axes * flipped(normal, p.turned));
    }
  on_plane *= plane_slope / filled;
  standing.fade = std::clamp((steepness / on_plane - deep_slope) /
                                 (shallow_slope - deep_slope),
                             0., 1.);
  if (standing.fade <= 0.)
  {
    standing.is_deep = true;
    return standing;
  }
  standing.normal = normal;
  // Deeper inside the part changes less than across the face.
  standing.gap = (0.5 - filled) / std::max(steepness, on_plane);
  balance_weights(near, Vec{});
  return standing;
}
} // namespace sabot
