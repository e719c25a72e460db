// The mesh of a body by its shape, and what it is like.
#include "sabot/simulation/scene_tools.h"

#include "sabot/geometry/mesh_import.h"

namespace sabot
{
NamedMesh Scene::make_mesh(const std::string &path, const double cell_size,
                           const Carving *carving)
{
  ShapeRequest request{prm, file, path};
  request.cell_size = cell_size;
  request.is_graded = prm.get("Discretization") == "FEM";
  request.carving = carving;
  NamedMesh made =
      make_shape(path + "/Geometry", prm.get("Geometry"))->mesh(request);
  const MeshQuality quality = measure_quality(made.mesh);
  notes.push_back("mesh of " + path.substr(path.find('/') + 1) + ": " +
                  quality.text());
  if (quality.scaled_jacobian <= 0.)
    throw InputError(path + "/Geometry",
                     "the mesh has a cell that is inside out or flat: " +
                         quality.text());
  return made;
}
} // namespace sabot
