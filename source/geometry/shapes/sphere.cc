// The shape "sphere": a ball of six blocks of shells around a cube.
#include "sabot/geometry/round_bodies.h"
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
    prm.declare_knob("Sector", "full", one_of("full|half|quarter"),
                     "Part of the sphere that is modeled: half keeps the "
                     "positive side of x, quarter that of y, too. The cut "
                     "planes are called -x and -y.");
  }

  std::string face_names() const override
  {
    return "surface and the cut planes of a sector";
  }

  NamedMesh mesh(const ShapeRequest &request) const override
  {
    const std::string sector = request.prm.get("Sector");
    const unsigned int n_cuts = sector == "full" ? 0 : sector == "half" ? 1 : 2;
    std::vector<std::string> faces = {"surface"};
    for (unsigned int cut = 0; cut < n_cuts; ++cut)
      faces.push_back(box_faces[2 * cut]);
    return {make_sphere(get_quantity(request.prm, "Radius"),
                        get_vector(request.prm, "Center"), request.cell_size,
                        n_cuts),
            std::move(faces)};
  }
};

const Registry<BodyShape>::Add sphere({"sphere", "a ball.", Sphere::declare,
                                       []
                                       { return std::make_unique<Sphere>(); }});
} // namespace
} // namespace sabot
