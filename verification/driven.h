#ifndef verification_driven_h
#define verification_driven_h

#include "verification/world.h"

#include <functional>

namespace sabot
{
/** Hexahedra whose velocities a problem prescribes, some or all, and that
    touch others with their ends across x only: nodes on the rim of two equal
    cross-sections would otherwise be nearest to the sides. */
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
  ContactSurface contact_surface() const override
  {
    ContactSurface surface = FemBody::contact_surface();
    const auto &X = nodes().reference_position;
    std::size_t kept = 0;
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
    {
      const auto &face = surface.faces[f];
      const double x = X[face[0]][0], tolerance = 1e-6 * surface.spacing;
      if (std::abs(X[face[1]][0] - x) > tolerance ||
          std::abs(X[face[2]][0] - x) > tolerance)
        continue;
      surface.faces[kept] = face;
      surface.face_id[kept++] = surface.face_id[f];
    }
    surface.faces.resize(kept);
    surface.face_id.resize(kept);
    return surface;
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
  box.center = {{start + 0.5 * n * h, 0., 0.}};
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
