// Bodies of a scene from their shapes, zones and discretizations.
#include "sabot/simulation/body_assembly.h"

#include "sabot/base/choice.h"
#include "sabot/base/error_report.h"
#include "sabot/base/text.h"
#include "sabot/bodies/conversion.h"
#include "sabot/geometry/item_count.h"
#include "sabot/geometry/mesh_import.h"
#include "sabot/geometry/mesh_layers.h"

#include <algorithm>
#include <iterator>

namespace sabot
{
BodyAssembly::BodyAssembly(Parameters &prm, const ParameterFile &file,
                           const Materials &materials)
    : prm(prm), file(file), materials(materials)
{
}

std::unique_ptr<Discretization>
BodyAssembly::discretization_of(const std::string &body) const
{
  const std::string path = "Bodies/" + body + "/Discretization";
  return Registry<Discretization>::get(path, file.value(path, "FEM")).make();
}

std::unique_ptr<BodyShape> BodyAssembly::shape_of(const std::string &body) const
{
  const std::string path = "Bodies/" + body + "/Geometry";
  return make_shape(path, file.value(path, "box"));
}

void BodyAssembly::build(const std::vector<std::string> &names)
{
  find_carvings(names);
  find_postures(names);
  within_memory("meshes with zones", [&]() { carve_meshes(); });
  for (const std::string &name : names)
    within_memory("\"Bodies/" + name + "\"",
                  [&]() { bodies.push_back(make_body(name, bodies.size())); });
  for (const Carving &carving : carvings)
    if (carving.finds_itself)
      growing.push_back(record_growing(carving));
    else
      zones.push_back(record(carving));
}

void BodyAssembly::find_postures(const std::vector<std::string> &names)
{
  for (const std::string &name : names)
  {
    const EnteredSubsection entered(prm, "Bodies", name);
    Posture &posture = postures[name];
    posture.turn = Turn::parse(prm, "Bodies/" + name);
    posture.axis = posture.turn.direction(shape_of(name)->axis(prm));
  }
  for (const Carving &carving : carvings)
  {
    if (!postures[carving.zone].turn.is_none())
      throw InputError("Bodies/" + carving.zone + "/Rotation angle",
                       "a zone turns with the body \"" + carving.body +
                           "\" that it is carved from; turn that one and place "
                           "the zone in it as it is before");
    postures[carving.zone] = postures[carving.body];
  }
}

void BodyAssembly::find_carvings(const std::vector<std::string> &names)
{
  for (const std::string &name : names)
  {
    const EnteredSubsection entered(prm, "Bodies", name);
    const std::string from = discretization_of(name)->carved_from(prm),
                      path = "Bodies/" + name + "/Carve from";
    if (from.empty())
    {
      // A zone that finds itself says what it lacks.
      discretization_of(name)->conversion(prm, "Bodies/" + name);
      continue;
    }
    if (from == name)
      throw InputError(path, "a body cannot be carved from itself; name the "
                             "FEM body of which \"" +
                                 name + "\" is a part");
    if (std::find(names.begin(), names.end(), from) == names.end())
    {
      std::vector<std::string> others;
      std::remove_copy(names.begin(), names.end(), std::back_inserter(others),
                       name);
      const std::vector<std::string> described = file.subsections("Bodies");
      if (std::find(described.begin(), described.end(), from) !=
          described.end())
        throw InputError(path, "body \"" + from +
                                   "\" is described but does not stand in "
                                   "\"List of bodies\"; add it there");
      throw_unknown_name(path, "body", from, others);
    }
    for (const Carving &other : carvings)
      if (other.body == from)
        throw InputError(path, "body \"" + from + "\" already has the zone \"" +
                                   other.zone + "\"; one zone per body");
    if (!discretization_of(from)->may_be_carved())
      throw InputError(path, "body \"" + from +
                                 "\" is not of finite elements; a zone can "
                                 "only be carved from a FEM body");
    carvings.push_back(read_carving(name, from));
  }
}

Carving BodyAssembly::read_carving(const std::string &name,
                                   const std::string &from) const
{
  const std::string path = "Bodies/" + name;
  const auto shape = shape_of(name);
  const std::optional<ZoneShape> zone = shape->zone(prm, path);
  if (!zone)
    throw InputError(path + "/Geometry",
                     "is " + prm.get("Geometry") +
                         "; a zone that is carved from a body is a box or a "
                         "cylinder");
  Carving carving;
  carving.body = from;
  carving.zone = name;
  carving.shape = *zone;
  carving.finds_itself =
      discretization_of(name)->conversion(prm, path).has_value();
  carving.has_start = !carving.finds_itself || has_start_zone(name);
  carving.follows_mesh = carving.finds_itself || !shape->has_lattice() ||
                         !shape_of(from)->has_lattice();
  return carving;
}

bool BodyAssembly::has_start_zone(const std::string &name) const
{
  const std::string path = "Bodies/" + name;
  if (prm.get("Start zone") == "by entries")
  {
    const bool is_given =
        file.is_set(path + "/Size") || file.is_set(path + "/Radius");
    // The expanded parameters set all entries.
    prm.set("Start zone", is_given ? "yes" : "no");
  }
  return prm.get("Start zone") == "yes";
}

void BodyAssembly::carve_meshes()
{
  for (const Carving &c : carvings)
  {
    if (!c.follows_mesh)
      continue;
    double size = 0.;
    {
      const EnteredSubsection entered(prm, "Bodies", c.body);
      size = discretization_of(c.body)->cell_size(prm);
      const NamedMesh whole =
          make_mesh("Bodies/" + c.body, size, c.has_start ? &c : nullptr);
      if (c.finds_itself)
      {
        cells[c.body] = cells[c.zone] = whole;
        if (!shape_of(c.body)->follows_cell_size())
          size = make_mesh_cloud(whole.mesh).spacing[0];
      }
      else
      {
        CarvedMesh parts = carve(whole.mesh, c.shape, whole.faces.size(),
                                 "Bodies/" + c.zone + "/Center");
        for (const std::string &name : {c.body, c.zone})
        {
          cells[name].faces = whole.faces;
          cells[name].groups = whole.groups;
          cells[name].unusable = whole.unusable;
        }
        cells[c.body].mesh = std::move(parts.rest);
        cells[c.zone].mesh = std::move(parts.zone);
        if (!shape_of(c.body)->follows_cell_size())
          size = make_mesh_cloud(cells[c.zone].mesh).spacing[0];
      }
    }
    if (c.finds_itself)
      take_from_host(c);
    const EnteredSubsection entered(prm, "Bodies", c.zone);
    discretization_of(c.zone)->follow_spacing(prm, file, "Bodies/" + c.zone,
                                              size);
    cell_size[c.zone] = size;
  }
}

template <typename Make>
auto BodyAssembly::counted(const std::string &path, const Make &make) const
{
  try
  {
    return make();
  }
  catch (const TooManyItems &e)
  {
    throw InputError(path + (prm.is_declared("Nodal spacing") ? "/Nodal spacing"
                                                              : "/Cell size"),
                     e.what());
  }
}

NamedMesh BodyAssembly::make_mesh(const std::string &path, const double size,
                                  const Carving *carving)
{
  const std::string name = path.substr(path.find('/') + 1);
  ShapeRequest request{prm, file, path};
  request.cell_size = size;
  request.is_graded = discretization_of(name)->may_be_carved();
  request.carving = carving;
  NamedMesh made = counted(path,
                           [&]()
                           {
                             NamedMesh mesh = shape_of(name)->mesh(request);
                             if (prm.is_declared("Nodal spacing"))
                               check_memory_for(mesh.mesh.nodes.size(),
                                                Item::particle, "its nodes");
                             return mesh;
                           });
  const MeshQuality quality = measure_quality(made.mesh);
  for (const std::string &note : made.notes)
    notes.push_back("mesh of " + name + ": " + note);
  notes.push_back("mesh of " + name + ": " + quality.text());
  for (const std::string &warning : made.warnings)
    warnings.push_back("mesh of \"" + name + "\": " + warning);
  const ThinLayer layer = find_thin_layer(made.mesh);
  if (layer.n_cells > 0)
    warnings.push_back("mesh of \"" + name + "\": " + layer.text());
  if (quality.is_inverted)
    throw InputError(path + "/Geometry",
                     "the mesh has a cell that is inside out or flat: " +
                         quality.text());
  return made;
}

void BodyAssembly::name_planes_of(const std::string &path,
                                  NamedMesh &made) const
{
  std::vector<std::string> entries;
  for (const std::string entry :
       {"Symmetry faces", "Clamped faces", "Driven faces"})
    entries.push_back(path + "/" + entry);
  for (const std::string &load : file.subsections("Loads"))
    if ("Bodies/" + trim(file.value("Loads/" + load + "/Body", "")) == path)
      entries.push_back("Loads/" + load + "/Faces");
  for (const std::string &entry : entries)
    name_planes(made, entry, file.value(entry, ""), entry == entries[0]);
}

std::unique_ptr<Body> BodyAssembly::make_body(const std::string &name,
                                              const int id)
{
  const std::string path = "Bodies/" + name;
  const EnteredSubsection entered(prm, "Bodies", name);
  const auto material = materials.find(prm.get("Material"));
  if (material == materials.end())
  {
    std::vector<std::string> known;
    for (const auto &entry : materials)
      known.push_back(entry.first);
    throw_unknown_name(path + "/Material", "material", prm.get("Material"),
                       known);
  }
  const auto carving =
      std::find_if(carvings.begin(), carvings.end(),
                   [&](const Carving &c) { return c.body == name; });
  const auto shape = shape_of(name);
  const Posture &posture = postures.at(name);
  const auto mesh = [&](const double size)
  {
    NamedMesh made =
        make_mesh(path, size, carving == carvings.end() ? nullptr : &*carving);
    posture.turn.apply(made.mesh);
    name_planes_of(path, made);
    return made;
  };
  std::array<double, 3> velocity = get_vector(prm, "Initial velocity");
  const double speed = get_quantity(prm, "Initial speed");
  for (int d = 0; d < 3; ++d)
    velocity[d] += speed * posture.axis[d];
  BodyRequest request{prm,
                      file,
                      path,
                      name,
                      id,
                      material->second,
                      *shape,
                      posture.turn,
                      velocity,
                      mesh,
                      [&](NamedMesh &faces) { name_planes_of(path, faces); },
                      std::nullopt};
  const auto made = cells.find(name);
  if (made != cells.end())
  {
    posture.turn.apply(made->second.mesh);
    // A zone that finds itself has the faces that its host's entries list.
    const auto own = std::find_if(carvings.begin(), carvings.end(),
                                  [&](const Carving &c)
                                  { return c.zone == name && c.finds_itself; });
    name_planes_of(own == carvings.end() ? path : "Bodies/" + own->body,
                   made->second);
    request.cells = std::move(made->second);
  }
  return counted(path,
                 [&]() { return discretization_of(name)->build(request); });
}

int BodyAssembly::number_of(const std::string &name) const
{
  int b = 0;
  while (bodies[b]->name != name)
    ++b;
  return b;
}

CarvedZone BodyAssembly::record(const Carving &carving) const
{
  CarvedZone zone;
  zone.zone = number_of(carving.zone);
  zone.host = number_of(carving.body);
  zone.shape = carving.shape;
  zone.turn = postures.at(carving.body).turn;
  constexpr double far = std::numeric_limits<double>::max();
  zone.host_low.fill(far);
  zone.host_high.fill(-far);
  for (const int b : {zone.zone, zone.host})
    for (const auto &place : bodies[b]->partition_points())
    {
      const auto x = zone.turn.origin(place);
      for (int d = 0; d < 3; ++d)
      {
        zone.host_low[d] = std::min(zone.host_low[d], x[d]);
        zone.host_high[d] = std::max(zone.host_high[d], x[d]);
      }
    }
  const auto size = cell_size.find(carving.zone);
  if (size != cell_size.end())
    zone.spacing.fill(size->second);
  else
    zone.spacing = bodies[zone.zone]->facts().spacing;
  return zone;
}
} // namespace sabot
