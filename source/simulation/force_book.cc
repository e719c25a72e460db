// Who pushes whom: resultants over time, and whether momentum closes with them.
#include "sabot/simulation/force_book.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace sabot
{
namespace
{
std::array<double, 3> momentum(const std::vector<BodyMeasures> &bodies)
{
  std::array<double, 3> sum{};
  for (const BodyMeasures &m : bodies)
    for (int d = 0; d < 3; ++d)
      sum[d] +=
          m.mass * m.velocity[d] + m.eroded_momentum[d] + m.added_momentum[d];
  return sum;
}
} // namespace

void ForceBook::start(const std::vector<BodyMeasures> &bodies)
{
  initial_momentum = momentum(bodies);
}

void ForceBook::look(const std::vector<BodyMeasures> &bodies)
{
  resultants = scene.resultants();
  std::set<int> across_planes;
  for (const auto &body : scene.bodies)
    for (const SymmetryPlane &plane : body->planes_of_symmetry())
      across_planes.insert(plane.axis);
  if (scene.is_free)
    return;

  double present_scale = 0., square = 0.;
  for (const BodyMeasures &m : bodies)
    present_scale += std::sqrt(2. * m.kinetic_energy * m.mass);
  scale = std::max(scale, present_scale);
  const std::array<double, 3> now = momentum(bodies);
  for (int d = 0; d < 3; ++d)
  {
    double missing = now[d] - initial_momentum[d];
    for (const Resultant &r : resultants)
      if (r.is_outside || across_planes.count(d) > 0)
        missing -= r.impulse[d];
    square += missing * missing;
  }
  if (scale > 0.)
    largest = std::max(largest, std::sqrt(square) / scale);
}

void ForceBook::append(History &history, const double time) const
{
  if (resultants.empty())
    return;
  Measures forces = {{"time", "s", time}}, impulses = forces;
  for (const Resultant &r : resultants)
    for (int d = 0; d < 3; ++d)
    {
      const std::string name = scene.column_of(r, "xyz"[d]);
      forces.push_back({name, "N", r.force[d]});
      impulses.push_back({name, "N s", r.impulse[d]});
    }
  history.append("forces", forces);
  history.append("impulses", impulses);
}

void ForceBook::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("momentum of the start", initial_momentum);
  visitor.visit_value("scale of momentum", scale);
  visitor.visit_value("largest residual of momentum", largest);
}
} // namespace sabot
