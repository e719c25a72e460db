// The shape "sphere": a ball of six blocks of shells around a cube.
#include "sabot/geometry/round_bodies.h"
#include "sabot/geometry/sector.h"
#include "sabot/geometry/shape.h"

namespace sabot
{
namespace
{
class Sphere : public BodyShape
{
public:
  static void declare(Parameters &prm)
  {
    prm.declare_entry("Radius", "1 mm", quantity(Dimension::length, 1e-9, 1e3),
                      "Radius of the sphere.");
    Sector::declare(prm, "sphere",
                    "half keeps the positive side of x, quarter that of y, "
                    "too. The cut planes are called -x and -y.");
  }

  std::string face_names() const override
  {
    return "surface and the cut planes of a sector";
  }

  NamedMesh mesh(const ShapeRequest &request) const override
  {
    const Sector sector = Sector::parse(request.prm);
    std::vector<std::string> faces = {"surface"};
    sector.name_cuts(0, faces);
    return {make_sphere(get_quantity(request.prm, "Radius"),
                        get_vector(request.prm, "Center"), request.cell_size,
                        sector.n_cuts),
            std::move(faces)};
  }
};

const Registry<BodyShape>::Add sphere({"sphere", "a ball.", Sphere::declare,
                                       []
                                       { return std::make_unique<Sphere>(); }});
} // namespace
} // namespace sabot
