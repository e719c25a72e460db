#include "sabot/base/error.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/quantity.h"
#include "sabot/bodies/fem/fem_body.h"
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/bodies/spg/spg_body.h"
#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/mesh_import.h"
#include "sabot/geometry/partition.h"
#include "sabot/geometry/round_bodies.h"
#include "sabot/simulation/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace sabot
{
namespace
{
std::array<double, 3> get_vector(const dealii::ParameterHandler &prm,
                                 const std::string &entry)
{
  const std::vector<double> v = get_quantities(prm, entry);
  return {{v[0], v[1], v[2]}};
}

/** Enters Section/name of a ParameterHandler while it lives. */
class Entered
{
public:
  Entered(dealii::ParameterHandler &prm, const std::string &section,
          const std::string &name)
      : prm(prm)
  {
    prm.enter_subsection(section);
    prm.enter_subsection(name);
  }
  ~Entered()
  {
    prm.leave_subsection();
    prm.leave_subsection();
  }

private:
  dealii::ParameterHandler &prm;
};

[[noreturn]] void unknown_name(const std::string &path, const std::string &what,
                               const std::string &name,
                               const std::vector<std::string> &allowed)
{
  if (name.empty())
    throw InputError(path, "needs the name of a " + what);
  std::string message = "no " + what + " is called \"" + name + "\"";
  if (!allowed.empty())
    message += "; did you mean \"" + nearest_name(name, allowed) + "\"?";
  throw InputError(path, message);
}

const std::vector<std::string> box_faces = {"-x", "+x", "-y", "+y", "-z", "+z"};

/** Numbers of the named faces (or axes) among the allowed ones. */
std::vector<unsigned int> face_ids(const std::string &path,
                                   const std::string &text,
                                   const std::vector<std::string> &allowed)
{
  std::vector<unsigned int> ids;
  for (const std::string &face : split_names(text))
  {
    const auto found = std::find(allowed.begin(), allowed.end(), face);
    if (found == allowed.end())
    {
      std::string all;
      for (const std::string &a : allowed)
        all += (all.empty() ? "" : ", ") + a;
      throw InputError(path, "\"" + face + "\" is not a face; allowed: " + all);
    }
    ids.push_back(found - allowed.begin());
  }
  return ids;
}
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

Scene::Scene(const ParameterFile &file, MPI_Comm communicator)
    : file(file), communicator(communicator)
{
  declare(prm, &file);
  file.parse_into(prm);
  read_settings();
  build_materials();
  build_bodies();
  check_overlaps();
  build_couplings();
  build_outputs();
  build_quantities();
}

void Scene::read_settings()
{
  settings.title = prm.get("Title");
  settings.end_time = get_quantity(prm, "End time");
  settings.step_factor = get_quantity(prm, "Step factor");
  settings.largest_step = get_quantity(prm, "Largest step");
  settings.energy_limit = get_quantity(prm, "Energy residual limit");
  settings.checkpoint_interval = get_quantity(prm, "Checkpoint interval");
  settings.checkpoint_steps = prm.get_integer("Checkpoint interval in steps");
  settings.checkpoint_wall_time =
      get_quantity(prm, "Checkpoint interval of wall time");
  if (split_names(prm.get("List of bodies")).empty())
    throw InputError("List of bodies",
                     "the scene has no bodies; list their names");
}

void Scene::build_materials()
{
  for (const std::string &name : file.subsections("Materials"))
  {
    const Entered entered(prm, "Materials", name);
    material_by_name[name] = Material::make(prm, "Materials/" + name);
    for (const std::string &warning : material_by_name[name]->warnings)
      warnings.push_back(warning);
  }
}

/** A box cut out of a FEM body for particles. */
struct Scene::Carving
{
  std::string body, zone;
  std::array<double, 3> centre, size;
};

void Scene::build_bodies()
{
  const std::vector<std::string> names = split_names(prm.get("List of bodies"));
  std::vector<Carving> carvings;
  for (const std::string &name : names)
  {
    const Entered entered(prm, "Bodies", name);
    if (prm.get("Discretization") != "SPG" || prm.get("Carve from").empty())
      continue;
    const std::string from = prm.get("Carve from");
    if (std::find(names.begin(), names.end(), from) == names.end() ||
        from == name)
      unknown_name("Bodies/" + name + "/Carve from", "body", from, names);
    for (const Carving &other : carvings)
      if (other.body == from)
        throw InputError("Bodies/" + name + "/Carve from",
                         "body \"" + from + "\" already has the zone \"" +
                             other.zone + "\"; one zone per body");
    carvings.push_back(
        {from, name, get_vector(prm, "Centre"), get_vector(prm, "Size")});
  }

  for (const std::string &name : names)
  {
    const std::string path = "Bodies/" + name;
    const Entered entered(prm, "Bodies", name);
    std::vector<std::string> known;
    for (const auto &entry : material_by_name)
      known.push_back(entry.first);
    const auto material = material_by_name.find(prm.get("Material"));
    if (material == material_by_name.end())
      unknown_name(path + "/Material", "material", prm.get("Material"), known);
    const auto centre = get_vector(prm, "Centre");

    if (prm.get("Discretization") == "SPG")
    {
      SpgOptions options = SpgOptions::parse(prm, path);
      for (const unsigned int face : face_ids(
               path + "/Symmetry faces", prm.get("Symmetry faces"), box_faces))
        options.symmetry_faces |= 1 << face;
      is_free = is_free && options.symmetry_faces == 0;
      options.initial_velocity = get_vector(prm, "Initial velocity");
      bodies.push_back(std::make_unique<SpgBody>(
          name, bodies.size(),
          make_box_cloud(centre, get_vector(prm, "Size"),
                         get_quantity(prm, "Nodal spacing")),
          material->second, options));
      continue;
    }

    const bool is_rigid = prm.get("Discretization") == "rigid";
    const double cell_size = get_quantity(prm, "Cell size");
    const auto carving =
        std::find_if(carvings.begin(), carvings.end(),
                     [&](const Carving &c) { return c.body == name; });
    HexMesh mesh;
    std::vector<std::string> faces = box_faces;
    if (carving != carvings.end() && (prm.get("Geometry") != "box" || is_rigid))
      throw InputError("Bodies/" + carving->zone + "/Carve from",
                       "a zone can only be carved from a FEM box");
    if (prm.get("Geometry") == "cylinder")
    {
      const unsigned int axis = prm.get("Axis")[0] - 'x';
      const std::string sector = prm.get("Sector");
      const unsigned int n_cuts = sector == "full"   ? 0
                                  : sector == "half" ? 1
                                                     : 2;
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
      mesh =
          read_mesh(resolved, get_quantity(prm, "Mesh unit"), centre,
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
      if (!is_rigid)
      {
        box.coarsest_cell_size = get_quantity(prm, "Coarsest cell size");
        box.growth_ratio = get_quantity(prm, "Growth ratio");
      }
      if (carving != carvings.end())
      {
        box.has_zone = true;
        box.zone_centre = carving->centre;
        box.zone_size = carving->size;
        box.zone_path = "Bodies/" + carving->zone;
      }
      const auto refined = is_rigid ? std::array<double, 3>{}
                                    : get_vector(prm, "Refined zone size");
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
    notes.push_back("mesh of " + name + ": " + quality.text());
    if (quality.scaled_jacobian <= 0.)
      throw InputError(path + "/Geometry",
                       "the mesh has a cell that is inside out or flat: " +
                           quality.text());
    if (is_rigid)
    {
      RigidOptions options = RigidOptions::parse(prm);
      options.initial_velocity = get_vector(prm, "Initial velocity");
      is_free = is_free && !options.is_prescribed;
      bodies.push_back(std::make_unique<RigidBody>(
          name, bodies.size(), std::move(mesh), material->second, options));
      continue;
    }
    FemOptions options = FemOptions::parse(prm);
    options.initial_velocity = get_vector(prm, "Initial velocity");
    const auto ids = [&](const char *const entry)
    { return face_ids(path + "/" + entry, prm.get(entry), faces); };
    options.clamped_boundary_ids = ids("Clamped faces");
    options.symmetry_boundary_ids = ids("Symmetry faces");
    options.driven_boundary_ids = ids("Driven faces");
    options.driven_velocity = get_vector(prm, "Prescribed velocity");
    options.driven_components = {{false, false, false}};
    for (const unsigned int axis :
         face_ids(path + "/Prescribed components",
                  prm.get("Prescribed components"), {"x", "y", "z"}))
      options.driven_components[axis] = true;
    is_free = is_free && options.clamped_boundary_ids.empty() &&
              options.symmetry_boundary_ids.empty() &&
              options.driven_boundary_ids.empty();
    bodies.push_back(std::make_unique<FemBody>(
        name, bodies.size(), std::move(mesh), material->second, options));
  }
}

int Scene::body_index(const std::string &path,
                      const std::string &body_name) const
{
  std::vector<std::string> names;
  for (const auto &body : bodies)
  {
    if (body->name == body_name)
      return body->id;
    names.push_back(body->name);
  }
  unknown_name(path, "body", body_name, names);
}

std::vector<Body *> Scene::body_pointers() const
{
  std::vector<Body *> pointers;
  for (const auto &body : bodies)
    pointers.push_back(body.get());
  return pointers;
}
} // namespace sabot
