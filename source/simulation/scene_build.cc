#include "sabot/simulation/scene_tools.h"

#include "sabot/bodies/fem/fem_body.h"
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/bodies/spg/spg_body.h"
#include "sabot/geometry/particle_cloud.h"

#include <cstdio>
#include <map>

namespace sabot
{
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

std::vector<Carving> Scene::find_carvings(const std::vector<std::string> &names)
{
  std::vector<Carving> carvings;
  for (const std::string &name : names)
  {
    const std::string path = "Bodies/" + name;
    const Entered entered(prm, "Bodies", name);
    if (prm.get("Discretization") != "SPG" || prm.get("Carve from").empty())
      continue;
    const std::string from = prm.get("Carve from");
    if (std::find(names.begin(), names.end(), from) == names.end() ||
        from == name)
      unknown_name(path + "/Carve from", "body", from, names);
    for (const Carving &other : carvings)
      if (other.body == from)
        throw InputError(path + "/Carve from",
                         "body \"" + from + "\" already has the zone \"" +
                             other.zone + "\"; one zone per body");
    if (file.value("Bodies/" + from + "/Discretization", "FEM") != "FEM")
      throw InputError(path + "/Carve from",
                       "body \"" + from +
                           "\" is not of finite elements; a zone can only be "
                           "carved from a FEM body");
    Carving carving;
    carving.body = from;
    carving.zone = name;
    const auto shape = make_shape(path + "/Geometry", prm.get("Geometry"));
    const std::optional<ZoneShape> zone = shape->zone(prm, path);
    if (!zone)
      throw InputError(path + "/Geometry",
                       "is " + prm.get("Geometry") +
                           "; a zone that is carved from a body "
                           "is a box or a cylinder");
    carving.shape = *zone;
    const std::string host = "Bodies/" + from + "/Geometry";
    carving.follows_mesh =
        !shape->has_lattice() ||
        !make_shape(host, file.value(host, "box"))->has_lattice();
    carvings.push_back(carving);
  }
  return carvings;
}

void Scene::follow_spacing(const std::string &path, const double spacing)
{
  // Rough, as the cells of a file have no one size.
  constexpr double tolerance = 0.1;
  const std::string entry = path + "/Nodal spacing";
  char value[40];
  std::snprintf(value, sizeof(value), "%.10g mm", 1e3 * spacing);
  if (!file.value(entry, "").empty() &&
      std::abs(get_quantities(prm, "Nodal spacing")[0] / spacing - 1.) >
          tolerance)
    throw InputError(entry, "is " + prm.get("Nodal spacing") +
                                ", but the particles are the nodes of cells "
                                "of " +
                                value + "; set that or remove the entry");
  prm.set("Nodal spacing", std::string(value)); // for the expanded parameters
}

std::unique_ptr<Body>
Scene::make_particles(const std::string &name,
                      std::shared_ptr<const Material> material,
                      NamedMesh *const zone)
{
  const std::string path = "Bodies/" + name;
  const auto shape = make_shape(path + "/Geometry", prm.get("Geometry"));
  std::vector<double> spacing = get_quantities(prm, "Nodal spacing");
  if (spacing.size() == 2 ||
      (spacing.size() == 3 && (zone != nullptr || !shape->has_lattice())))
    throw InputError(path + "/Nodal spacing",
                     "has " + std::to_string(spacing.size()) +
                         " values; give one, or three for a box with a lattice "
                         "of its own");
  std::vector<std::string> faces(box_faces.begin(), box_faces.end());
  ParticleCloud cloud;
  if (zone != nullptr)
  {
    faces = zone->faces;
    cloud = make_mesh_cloud(zone->mesh);
  }
  else if (shape->has_lattice())
  {
    if (spacing.size() == 1)
      spacing = {spacing[0], spacing[0], spacing[0]};
    cloud = shape->lattice(prm, {{spacing[0], spacing[1], spacing[2]}});
  }
  else
  {
    NamedMesh mesh = make_mesh(path, spacing[0], nullptr);
    faces = mesh.faces;
    cloud = make_mesh_cloud(mesh.mesh);
    if (!shape->follows_cell_size())
      follow_spacing(path, cloud.spacing[0]);
  }
  SpgOptions options = SpgOptions::parse(prm, path);
  options.initial_velocity = get_vector(prm, "Initial velocity");
  const auto bits = [&](const char *const entry)
  {
    std::uint32_t result = 0;
    for (const unsigned int face :
         face_ids(path + "/" + entry, prm.get(entry), faces))
    {
      if (face >= ParticleCloud::n_faces)
        throw InputError(path + "/" + entry,
                         "names the boundary id " + std::to_string(face) +
                             "; faces of particles need ids below " +
                             std::to_string(ParticleCloud::n_faces));
      result |= 1u << face;
    }
    return result;
  };
  options.symmetry_faces = bits("Symmetry faces");
  options.clamped_faces = bits("Clamped faces");
  is_free =
      is_free && options.symmetry_faces == 0 && options.clamped_faces == 0;
  return std::make_unique<SpgBody>(name, bodies.size(), std::move(cloud),
                                   std::move(material), options);
}

void Scene::build_bodies()
{
  const std::vector<std::string> names = split_names(prm.get("List of bodies"));
  const std::vector<Carving> carvings = find_carvings(names);
  // Meshes of bodies whose cells give way to particles, by body and by zone.
  std::map<std::string, NamedMesh> rest, zone_meshes;
  for (const Carving &c : carvings)
  {
    if (!c.follows_mesh)
      continue;
    double cell_size = 0.;
    {
      const Entered entered(prm, "Bodies", c.body);
      cell_size = get_quantity(prm, "Cell size");
      NamedMesh whole = make_mesh("Bodies/" + c.body, cell_size, &c);
      CarvedMesh parts = carve(whole.mesh, c.shape, whole.faces.size(),
                               "Bodies/" + c.zone + "/Centre");
      rest[c.body] = {std::move(parts.rest), whole.faces};
      zone_meshes[c.zone] = {std::move(parts.zone), whole.faces};
      if (!make_shape("Bodies/" + c.body + "/Geometry", prm.get("Geometry"))
               ->follows_cell_size())
        cell_size = make_mesh_cloud(zone_meshes[c.zone].mesh).spacing[0];
    }
    const Entered entered(prm, "Bodies", c.zone);
    follow_spacing("Bodies/" + c.zone, cell_size);
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
    if (prm.get("Discretization") == "SPG")
    {
      const auto zone = zone_meshes.find(name);
      bodies.push_back(
          make_particles(name, material->second,
                         zone == zone_meshes.end() ? nullptr : &zone->second));
      continue;
    }

    const auto carving =
        std::find_if(carvings.begin(), carvings.end(),
                     [&](const Carving &c) { return c.body == name; });
    const auto carved = rest.find(name);
    NamedMesh made =
        carved != rest.end()
            ? std::move(carved->second)
            : make_mesh(path, get_quantity(prm, "Cell size"),
                        carving == carvings.end() ? nullptr : &*carving);
    HexMesh &mesh = made.mesh;
    const std::vector<std::string> &faces = made.faces;
    const bool is_rigid = prm.get("Discretization") == "rigid";
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
  for (const Carving &c : carvings)
    record_zone(c);
}

void Scene::record_zone(const Carving &carving)
{
  CarvedZone zone;
  zone.zone = body_index("Bodies", carving.zone);
  zone.host = body_index("Bodies", carving.body);
  zone.shape = carving.shape;
  zone.host_low.fill(1e300);
  zone.host_high.fill(-1e300);
  for (const int b : {zone.zone, zone.host})
    for (const auto &x : bodies[b]->partition_points())
      for (int d = 0; d < 3; ++d)
      {
        zone.host_low[d] = std::min(zone.host_low[d], x[d]);
        zone.host_high[d] = std::max(zone.host_high[d], x[d]);
      }
  const Entered entered(prm, "Bodies", carving.zone);
  const std::vector<double> spacing = get_quantities(prm, "Nodal spacing");
  for (int d = 0; d < 3; ++d)
  {
    zone.spacing[d] = spacing[spacing.size() == 3 ? d : 0];
    if (!carving.follows_mesh) // the nearest that divides the edge
      zone.spacing[d] =
          zone.shape.size[d] / n_intervals(zone.shape.size[d], zone.spacing[d]);
  }
  zones.push_back(zone);
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
