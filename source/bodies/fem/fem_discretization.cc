// Finite elements as a choice of scenes: entries, checks, construction.
#include "sabot/bodies/discretization.h"
#include "sabot/bodies/fem/fem_body.h"
#include "sabot/geometry/face_names.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Edge of a cube of the mean volume of the cells: of a mesh from a file nobody
    has told it [m]. */
double typical_cell_size(const HexMesh &mesh)
{
  double volume = 0.;
  for (const double v : mesh.volume)
    volume += v;
  return std::cbrt(volume / mesh.cells.size());
}

class FiniteElements : public Discretization
{
public:
  void declare(Parameters &prm, const BodyShape *const shape) const override
  {
    const std::string faces = face_names(shape);
    prm.declare_knob("Symmetry faces", "", name_list(),
                     "Plane faces on which the model is cut: no velocity "
                     "across them, no contact with them. Among " +
                         faces + ".");
    prm.declare_knob("Cell size", "1 mm",
                     quantity(Dimension::length, 1e-9, 1e2),
                     "Edge of the cells; next to a carved zone, where the "
                     "mesh is graded.");
    if (shape != nullptr)
      shape->declare_grading(prm);
    prm.declare_entry("Clamped faces", "", name_list(),
                      "Faces held fixed, among " + faces + ".");
    prm.declare_entry("Driven faces", "", name_list(),
                      "Faces whose nodes move with the prescribed velocity; "
                      "the work done on them counts as external.");
    prm.declare_entry("Prescribed velocity", "0 m/s, 0 m/s, 0 m/s",
                      quantities(Dimension::velocity, 3, 3, -1e5, 1e5),
                      "Constant velocity of the driven faces.");
    prm.declare_entry("Prescribed components", "x, y, z", name_list(),
                      "Components of the prescribed velocity that count; the "
                      "others are free.");
    FemOptions::declare_parameters(prm);
  }

  std::unique_ptr<Body> build(BodyRequest &request) const override
  {
    const Parameters &prm = request.prm;
    NamedMesh made = request.cells ? std::move(*request.cells)
                                   : request.mesh(cell_size(prm));
    FemOptions options = FemOptions::parse(prm, request.path);
    options.initial_velocity = request.initial_velocity;
    options.cell_size = request.shape.follows_cell_size()
                            ? cell_size(prm)
                            : typical_cell_size(made.mesh);
    const auto ids = [&](const char *const entry)
    { return find_face_ids(request.path + "/" + entry, prm.get(entry), made); };
    options.clamped_boundary_ids = ids("Clamped faces");
    options.symmetry_boundary_ids = ids("Symmetry faces");
    options.driven_boundary_ids = ids("Driven faces");
    options.driven_velocity = get_vector(prm, "Prescribed velocity");
    options.driven_components = {{false, false, false}};
    for (const unsigned int axis : word_ids(
             request.path + "/Prescribed components",
             prm.get("Prescribed components"), {"x", "y", "z"}, "component"))
      options.driven_components[axis] = true;
    auto body = std::make_unique<FemBody>(request.name, request.id,
                                          std::move(made.mesh),
                                          std::move(request.material), options);
    body->find_faces = face_finder(made);
    return body;
  }

  bool may_be_carved() const override { return true; }
  double cell_size(const Parameters &prm) const override
  {
    return get_quantity(prm, "Cell size");
  }
};

const Registry<Discretization>::Add
    registered({"FEM", "hexahedra, the finite elements.", nullptr,
                []() { return std::make_unique<FiniteElements>(); }});
} // namespace
} // namespace sabot
