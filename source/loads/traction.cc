// Load: a force per area of the start, of fixed direction.
#include "sabot/loads/surface_load.h"

namespace sabot
{
namespace
{
/** f_a = t integral of N_a dA over the faces of the start. */
class Traction : public SurfaceLoad
{
public:
  explicit Traction(const LoadRequest &request) : SurfaceLoad(request)
  {
    const auto t = get_vector(request.prm, "Traction");
    traction = vec(t[0], t[1], t[2]);
  }
  std::string type() const override { return "traction"; }

protected:
  void faces_changed() override
  {
    area.assign(force().size(), 0.);
    const AlignedVector<Vec> &X = body.nodes().reference_position;
    for (const LoadedFace &face : faces)
    {
      const auto areas = nodal_areas({{X[face.node[0]], X[face.node[1]],
                                       X[face.node[2]], X[face.node[3]]}});
      for (int a = 0; a < 4; ++a)
        if (face.slot[a] != elsewhere)
          area[face.slot[a]] += norm(areas[a]);
    }
    for (const LoadedShare &s : shares)
      area[s.slot] += norm(s.share.area);
  }
  void compute(const double factor) override
  {
    const Vec t = factor * traction;
    for (std::size_t k = 0; k < area.size(); ++k)
      force()[k] = area[k] * t;
  }

private:
  Vec traction;             // [Pa]
  std::vector<double> area; // of the start, by node [m^2]
};

void declare(Parameters &prm)
{
  prm.declare_entry("Traction", "0 Pa, 0 Pa, 0 Pa",
                    quantities(Dimension::pressure, 3, 3, -1e14, 1e14),
                    "Force per area of the start, a vector in the fixed "
                    "frame.");
  SurfaceLoad::declare(prm);
}

const Registry<Load>::Add registered(
    {"traction",
     "on faces of a body, the same force however they move (dead load).",
     declare, [](const LoadRequest &request) {
       return std::make_unique<Traction>(request);
     }});
} // namespace
} // namespace sabot
