#include "sabot/simulation/scene_tools.h"

#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/mesh_import.h"
#include "sabot/geometry/round_bodies.h"

#include <filesystem>

namespace sabot
{
namespace
{
/** A file that an entry names, looked up in the folder of the parameter file
    that sets it (of the scene, for an override). */
std::string beside(const ParameterFile &file, const std::string &path,
                   const std::string &name)
{
  if (name.empty())
    throw InputError(path, "needs the name of a mesh file");
  if (name[0] == '/')
    return name;
  const std::string origin = file.origin(path);
  const std::string from =
      origin.compare(0, 5, "--set") == 0 ? file.file_name : origin;
  const std::size_t slash = from.find_last_of('/');
  const std::string relative =
      slash == std::string::npos ? name : from.substr(0, slash + 1) + name;
  return std::filesystem::absolute(relative).string();
}
} // namespace

Scene::BodyMesh Scene::make_mesh(const std::string &path,
                                 const double cell_size, const Carving *carving)
{
  const auto centre = get_vector(prm, "Centre");
  HexMesh mesh;
  std::vector<std::string> faces = box_faces;
  if (prm.get("Geometry") == "cylinder")
  {
    const unsigned int axis = prm.get("Axis")[0] - 'x';
    const std::string sector = prm.get("Sector");
    const unsigned int n_cuts = sector == "full" ? 0 : sector == "half" ? 1 : 2;
    faces = {"lower", "upper", "side"};
    for (unsigned int cut = 0; cut < n_cuts; ++cut)
      faces.push_back(box_faces[2 * ((axis + 1 + cut) % 3)]);
    CylinderGrading grading;
    grading.core_radius = get_quantity(prm, "Core radius");
    grading.growth_ratio = get_quantity(prm, "Growth ratio");
    grading.coarsest_cell_size = get_quantity(prm, "Coarsest cell size");
    const double radius = get_quantity(prm, "Radius");
    if (grading.core_radius > 0.9 * radius)
      throw InputError(path + "/Core radius",
                       "leaves no room for rings; at most 0.9 of the radius");
    if (carving != nullptr && carving->is_coaxial(axis, centre) &&
        0.5 * carving->shape.size[(axis + 1) % 3] < 0.999 * radius)
    {
      if (grading.core_radius > 0.)
        throw InputError(path + "/Core radius",
                         "has no effect: the zone \"" + carving->zone +
                             "\" that is carved from this body is the middle "
                             "part with cells of the cell size; remove it");
      grading.zone_radius = 0.5 * carving->shape.size[(axis + 1) % 3];
    }
    mesh = make_cylinder(radius, get_quantity(prm, "Length"), axis, centre,
                         cell_size, n_cuts, grading);
  }
  else if (prm.get("Geometry") == "sphere")
  {
    faces = {"surface"};
    mesh = make_sphere(get_quantity(prm, "Radius"), centre, cell_size);
  }
  else if (prm.get("Geometry") == "projectile")
  {
    faces = {"end", "side"};
    ProjectileSpecification projectile;
    projectile.radius = get_quantity(prm, "Radius");
    projectile.shaft_length = get_quantity(prm, "Length");
    projectile.nose_length = get_quantity(prm, "Nose length");
    const std::string nose = prm.get("Nose"), axis = prm.get("Axis");
    projectile.nose = nose == "ogive"     ? Nose::ogive
                      : nose == "conical" ? Nose::conical
                                          : Nose::spherical;
    if (projectile.nose == Nose::ogive &&
        projectile.nose_length < projectile.radius)
      throw InputError(path + "/Nose length",
                       "a tangent ogive is at least as long as its radius; "
                       "use a spherical nose or a longer one");
    projectile.axis = axis.back() - 'x';
    projectile.towards_positive = axis[0] != '-';
    projectile.centre = centre;
    projectile.cell_size = cell_size;
    mesh = make_projectile(projectile);
  }
  else if (prm.get("Geometry") == "file")
  {
    const std::string resolved =
        beside(file, path + "/Mesh file", prm.get("Mesh file"));
    prm.set("Mesh file", resolved); // for the expanded parameters
    mesh = read_mesh(resolved, get_quantity(prm, "Mesh unit"), centre,
                     prm.get_integer("Mesh material id"), path + "/Mesh file");
    faces.clear();
    for (const unsigned int id : mesh.boundary_id)
      while (faces.size() <= id)
        faces.push_back(std::to_string(faces.size()));
  }
  else
  {
    BoxSpecification box;
    box.centre = centre;
    box.size = get_vector(prm, "Size");
    box.cell_size = cell_size;
    if (prm.get("Discretization") == "FEM")
    {
      box.coarsest_cell_size = get_quantity(prm, "Coarsest cell size");
      box.growth_ratio = get_quantity(prm, "Growth ratio");
    }
    if (carving != nullptr && !carving->follows_mesh)
    {
      box.has_zone = true;
      box.zone_centre = carving->shape.centre;
      box.zone_size = carving->shape.size;
      box.zone_path = "Bodies/" + carving->zone;
    }
    const auto refined = prm.get("Discretization") == "FEM"
                             ? get_vector(prm, "Refined zone size")
                             : std::array<double, 3>{};
    if (refined[0] > 0. && refined[1] > 0. && refined[2] > 0.)
    {
      if (box.has_zone)
        throw InputError(path + "/Refined zone size",
                         "a body has one zone, and \"" + carving->zone +
                             "\" is carved from this one already");
      box.has_zone = true;
      box.zone_is_cut = false;
      box.zone_centre = get_vector(prm, "Refined zone centre");
      box.zone_size = refined;
      box.zone_path = path;
    }
    mesh = make_graded_box(box);
  }
  const MeshQuality quality = measure_quality(mesh);
  notes.push_back("mesh of " + path.substr(path.find('/') + 1) + ": " +
                  quality.text());
  if (quality.scaled_jacobian <= 0.)
    throw InputError(path + "/Geometry",
                     "the mesh has a cell that is inside out or flat: " +
                         quality.text());
  return {std::move(mesh), std::move(faces)};
}
} // namespace sabot
