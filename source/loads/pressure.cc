// Load: a pressure that follows the faces.
#include "sabot/loads/surface_load.h"

namespace sabot
{
namespace
{
/** f_a = -p integral of N_a n dA over the faces as they are now; of particles
    -p det F F^-T A_a. */
class Pressure : public SurfaceLoad
{
public:
  explicit Pressure(const LoadRequest &request)
      : SurfaceLoad(request), pressure(get_quantity(request.prm, "Pressure"))
  {
  }
  std::string type() const override { return "pressure"; }

protected:
  void compute(const double factor) override
  {
    const double p = factor * pressure;
    const AlignedVector<Vec> &x = body.nodes().position;
    for (const LoadedFace &face : faces)
    {
      const auto areas = nodal_areas({{x[face.node[0]], x[face.node[1]],
                                       x[face.node[2]], x[face.node[3]]}});
      for (int a = 0; a < 4; ++a)
        if (face.slot[a] != elsewhere)
          force()[face.slot[a]] -= p * areas[a];
    }
    for (const LoadedShare &s : shares)
      force()[s.slot] -=
          p * body.particles()->present_area(s.share.node, s.share.area);
  }

private:
  const double pressure; // [Pa]
};

void declare(Parameters &prm)
{
  prm.declare_entry("Pressure", "0 Pa",
                    quantity(Dimension::pressure, -1e14, 1e14),
                    "Force per present area against the outward normal: "
                    "positive ones push.");
  SurfaceLoad::declare(prm);
}

const Registry<Load>::Add registered(
    {"pressure",
     "on faces of a body, across them as they are now (follower load).",
     declare, [](const LoadRequest &request) {
       return std::make_unique<Pressure>(request);
     }});
} // namespace
} // namespace sabot
