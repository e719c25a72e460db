#ifndef sabot_verification_driven_h
#define sabot_verification_driven_h

#include "sabot/verification/world.h"

#include <functional>

namespace sabot
{
/** Hexahedra whose velocities a problem prescribes, some or all. */
class DrivenFemBody : public FemBody
{
public:
  using Drive = std::function<void(NodalState &, const double time)>;
  DrivenFemBody(const std::string &name, const int id, HexMesh mesh,
                std::shared_ptr<const Material> material,
                const FemOptions &options, const Drive &drive)
      : FemBody(name, id, std::move(mesh), material, options), drive(drive)
  {
  }
  void impose_velocities(const double time) override
  {
    FemBody::impose_velocities(time);
    drive(nodes(), time);
  }

private:
  const Drive drive;
};

/** No motion across x: uniaxial strain. */
inline void hold_lateral(NodalState &nodes, const double)
{
  for (Vec &v : nodes.velocity)
    v = vec(v[0], 0., 0.);
}

/** A bar of @p n cells of edge @p h along x, one cell across, from @p start. */
inline HexMesh make_bar(const double start, const int n, const double h)
{
  BoxSpecification box;
  box.size = {{n * h, h, h}};
  box.centre = {{start + 0.5 * n * h, 0., 0.}};
  box.cell_size = h;
  return make_graded_box(box);
}

/** Mean of the velocities along x over nodes whose reference position along x
    is within @p tolerance of @p x. */
inline double velocity_at(const Body &body, const double x,
                          const double tolerance)
{
  double sum = 0.;
  int n = 0;
  const NodalState &nodes = body.nodes();
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    if (std::abs(nodes.reference_position[i][0] - x) < tolerance)
    {
      sum += nodes.velocity[i][0];
      ++n;
    }
  return sum / n;
}

/** Time at which @p value last crossed @p level, by linear interpolation
    between calls; NaN before it does. */
struct Crossing
{
  double level, time = std::nan("");
  double old_value = 0., old_time = 0.;
  void sample(const double now, const double value)
  {
    if (std::isnan(time) && (old_value - level) * (value - level) < 0.)
      time = old_time +
             (level - old_value) / (value - old_value) * (now - old_time);
    old_value = value;
    old_time = now;
  }
};
} // namespace sabot

#endif
