// Rigid bodies as a choice of scenes: entries, checks, construction.
#include "sabot/bodies/discretization.h"
#include "sabot/bodies/rigid/rigid_body.h"

namespace sabot
{
namespace
{
class Rigid : public Discretization
{
public:
  void declare(Parameters &prm, const BodyShape *) const override
  {
    prm.declare_knob("Cell size", "1 mm",
                     quantity(Dimension::length, 1e-9, 1e2),
                     "Edge of the cells, whose outer faces are the surface.");
    RigidOptions::declare_parameters(prm);
  }

  std::unique_ptr<Body> build(BodyRequest &request) const override
  {
    const double size = get_quantity(request.prm, "Cell size");
    RigidOptions options = RigidOptions::parse(request.prm);
    options.initial_velocity = request.initial_velocity;
    options.cell_size = size;
    NamedMesh made = request.mesh(size);
    auto body = std::make_unique<RigidBody>(
        request.name, request.id, std::move(made.mesh),
        std::move(request.material), options);
    body->find_faces = face_finder(made);
    return body;
  }
};

const Registry<Discretization>::Add
    registered({"rigid", "hexahedra that do not deform.", nullptr,
                []() { return std::make_unique<Rigid>(); }});
} // namespace
} // namespace sabot
