// Which cells are expected to turn into particles, before a run.
#include "sabot/simulation/plan_conversion.h"

#include "sabot/base/text.h"
#include "sabot/bodies/conversion.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
constexpr int n_moments = 400; // of a course
const double largest_compression = 0.75;

double dot(const std::array<double, 3> &a, const std::array<double, 3> &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Middle of a body, of a part that is cut on the plane of the cut. */
std::array<double, 3> center_of(const PlannedBody &planned, const Body &body)
{
  std::array<double, 3> center;
  for (int d = 0; d < 3; ++d)
    center[d] = 0.5 * (planned.low[d] + planned.high[d]);
  for (const SymmetryPlane &plane : body.planes_of_symmetry())
    center[plane.axis] = plane.coordinate;
  return center;
}

/** Of @p body, seen from @p other [m/s]. */
std::array<double, 3> velocity_against(const PlannedBody &body,
                                       const PlannedBody &other)
{
  std::array<double, 3> v;
  for (int d = 0; d < 3; ++d)
    v[d] = body.facts.velocity[d] - other.facts.velocity[d];
  return v;
}

/** Taylor's e of rho U^2/Y = e^2/(1 - e). */
double compression(const double k)
{
  return 0.5 * (std::sqrt(k * k + 4. * k) - k);
}
} // namespace

ConversionForecast::ConversionForecast(const Scene &scene,
                                       const PhysicsPlan &physics,
                                       const GrowingZone &zone)
{
  const PlannedBody &host = physics.bodies[zone.host],
                    &own = physics.bodies[zone.zone];
  for (const auto &criterion : zone.request.criteria)
  {
    ConversionCriterion::Onset onset = criterion->onset();
    if (!onset.strain)
      onset.strain = own.facts.failure_strain;
    if (onset.strain && *onset.strain > 0.)
      onsets.push_back(onset);
  }
  if (!physics.impact.exists)
    basis = "no two bodies meet";
  else if (!host.yield_stress)
    basis = "its law never flows";
  else if (onsets.empty())
    basis = "no criterion tells how far metal has to flow";
  else
  {
    largest_strain = least_strain();
    const std::size_t striker = physics.impact.projectile;
    if (striker == std::size_t(zone.host) || striker == std::size_t(zone.zone))
      upset(scene, physics, host);
    else // layers are of cells, which are as fine as particles unless split
      enter(scene, physics, host,
            scene.bodies[zone.zone]->particle_sink()->lattices()
                ? host.facts.spacing[0]
                : own.facts.spacing[0]);
  }
}

double ConversionForecast::least_strain() const
{
  double least = *onsets[0].strain;
  for (const auto &onset : onsets)
    least = std::min(least, *onset.strain);
  return least;
}

double ConversionForecast::reach_at(const double depth, const double radius,
                                    const double spacing) const
{
  double reach = 0.;
  for (const auto &onset : onsets)
  {
    // Where eps(r) is the onset strain, which falls with r.
    const double needed = std::expm1(std::sqrt(3.) * *onset.strain);
    double low = 0., high = radius / std::sqrt(needed);
    for (int k = 0; k < 60; ++k)
    {
      const double r = 0.5 * (low + high),
                   c = depth / std::sqrt(4. * r * r + depth * depth);
      (r * r * needed < radius * radius * c ? low : high) = r;
    }
    constexpr double of_sheet = 1.75;
    if (thickness < 2. * radius)
      low = std::min(low, of_sheet * radius);
    reach = std::max(reach, low + onset.layers * spacing);
  }
  return reach;
}

void ConversionForecast::enter(const Scene &scene, const PhysicsPlan &physics,
                               const PlannedBody &host, const double spacing)
{
  const ImpactFacts &impact = physics.impact;
  const PlannedBody &p = physics.bodies[impact.projectile];
  const auto v = velocity_against(p, host);
  const double speed = std::sqrt(dot(v, v));
  const int axis = impact.axis;
  const auto center = center_of(p, *scene.bodies[impact.projectile]);
  const double across = speed > 0. ? v[axis] / speed : 0.;
  const double face = across < 0. ? host.high[axis] : host.low[axis];
  // From the middle of what flies to the struck face, along its flight.
  const double way = across != 0. ? (face - center[axis]) / across : -1.;
  bool meets = way >= 0.;
  for (int d = 0; d < 3 && meets; ++d)
  {
    direction[d] = v[d] / speed;
    entry[d] = center[d] + way * direction[d];
    const double slack = 1e-6 * (host.high[d] - host.low[d]);
    meets = d == axis ||
            (entry[d] > host.low[d] - slack && entry[d] < host.high[d] + slack);
  }
  if (!meets)
  {
    basis = "what flies does not come its way";
    return;
  }
  is_struck = true;
  thickness = (host.high[axis] - host.low[axis]) / std::abs(across);
  const double length = (p.high[axis] - p.low[axis]) / std::abs(across),
               a = impact.radius, Y = *host.yield_stress;
  double wide = a;
  if (p.yield_stress)
  {
    const double U = 0.5 * speed, e = compression(p.facts.material->density() *
                                                  U * U / *p.yield_stress);
    wide = a / std::sqrt(1. - std::min(e, largest_compression));
  }
  const Material &law = *host.facts.material;
  const double K = law.bulk_modulus(), G = law.shear_modulus(),
               E = 9. * K * G / (3. * K + G),
               R = 2. / 3. * Y * (1. + std::log(2. * E / (3. * Y))),
               per_area = p.facts.material->density() * length;
  const double start = std::max(0., way - 0.5 * length) / speed,
               dt = (scene.settings.end_time - start) / n_moments;
  double depth = 0., now = speed;
  for (int k = 0; k <= n_moments && dt > 0.; ++k)
  {
    course.push_back(
        {start + k * dt, depth, reach_at(depth, wide, spacing), now / speed});
    const double slower =
        depth < thickness ? (R + law.density() * now * now) / per_area : 0.;
    const double next = std::max(0., now - slower * dt);
    depth = std::min(thickness, depth + 0.5 * (now + next) * dt);
    now = next;
  }
  if (course.empty())
  {
    basis = "nothing meets it before the end";
    return;
  }
  basis =
      formatted("what strikes, of radius %.3g mm", 1e3 * a) +
      (wide > a ? formatted(" (%.3g mm when flattened)", 1e3 * wide) : "") +
      formatted(", goes %.3g mm deep", 1e3 * depth) +
      formatted(" against %.3g GPa and rho v^2", 1e-9 * R) +
      formatted("; a strain of %.3g", least_strain()) +
      formatted(" reaches %.3g mm from its path", 1e3 * course.back().reach);
}

void ConversionForecast::upset(const Scene &scene, const PhysicsPlan &physics,
                               const PlannedBody &host)
{
  const ImpactFacts &impact = physics.impact;
  const PlannedBody &other = physics.bodies[impact.target];
  const auto v = velocity_against(host, other);
  const double speed = std::sqrt(dot(v, v));
  const int axis = impact.axis;
  direction.fill(0.);
  direction[axis] = v[axis] < 0. ? -1. : 1.;
  entry.fill(0.);
  entry[axis] = v[axis] < 0. ? host.low[axis] : host.high[axis];
  const double length = host.high[axis] - host.low[axis],
               rho = host.facts.material->density(), Y = *host.yield_stress,
               gap = v[axis] < 0. ? host.low[axis] - other.high[axis]
                                  : other.low[axis] - host.high[axis],
               start = std::max(0., gap) / speed,
               dt = (scene.settings.end_time - start) / n_moments;
  double X = length, U = (other.facts.deforms ? 0.5 : 1.) * speed, turned = 0.;
  const double U_0 = U, least = least_strain();
  for (int k = 0; k <= n_moments && dt > 0.; ++k)
  {
    course.push_back({start + k * dt, turned, 0., X * U / (length * U_0)});
    // In parts, as the part that has not flowed gets short.
    constexpr int parts = 20;
    for (int s = 0; s < parts && U > 0. && X > 0.; ++s)
    {
      const double e = compression(rho * U * U / Y), h = dt / parts;
      X = std::max(1e-3 * length, X - h * U / e);
      if (-std::log1p(-e) >= least)
        turned = length - X;
      U = std::max(0., U - h * Y / (rho * X));
    }
  }
  if (turned == 0.)
    course.clear();
  basis =
      formatted("a bar of yield stress %.3g MPa that is stopped", 1e-6 * Y) +
      formatted(" from %.4g m/s flows by Taylor's theory", U_0) +
      formatted(" by %.3g or more", least) +
      formatted(" over %.3g mm of its foot", 1e3 * turned);
}

const ConversionForecast::Moment &
ConversionForecast::at(const double time) const
{
  auto next = std::upper_bound(course.begin(), course.end(), time,
                               [](const double t, const Moment &m)
                               { return t < m.time; });
  return next == course.begin() ? course.front() : *(next - 1);
}

bool ConversionForecast::has_turned(const std::array<double, 3> &place,
                                    const double time) const
{
  if (!exists() || time < course.front().time)
    return false;
  const Moment &now = at(time);
  std::array<double, 3> r;
  for (int d = 0; d < 3; ++d)
    r[d] = place[d] - entry[d];
  const double along = dot(r, direction);
  if (!is_struck) // the foot, measured from its end
    return now.depth > 0. && -along <= now.depth;
  const double s = std::clamp(along, 0., now.depth);
  double square = 0.;
  for (int d = 0; d < 3; ++d)
    square += std::pow(r[d] - s * direction[d], 2);
  return square <= now.reach * now.reach;
}

double ConversionForecast::speed_left(const double time) const
{
  return exists() ? at(time).speed : 1.;
}

double ConversionForecast::first_time() const
{
  return course.front().time;
}

double ConversionForecast::last_time() const
{
  std::size_t k = course.size() - 1;
  while (k > 0 && course[k - 1].depth == course.back().depth &&
         course[k - 1].reach == course.back().reach)
    --k;
  return course[k].time;
}

std::vector<ConversionForecast> foresee_conversions(const Scene &scene,
                                                    const PhysicsPlan &physics)
{
  std::vector<ConversionForecast> all;
  for (const GrowingZone &zone : scene.growing)
    all.emplace_back(scene, physics, zone);
  return all;
}
} // namespace sabot
