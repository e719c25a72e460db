// Particles as a choice of scenes: entries, checks, construction.
#include "sabot/base/text.h"
#include "sabot/bodies/discretization.h"
#include "sabot/bodies/spg/spg_body.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sabot
{
namespace
{
/** The faces of the box that a lattice fills, as one cell has them: names by
    box_faces, places for planes. */
NamedMesh faces_of_box(const ParticleCloud &cloud)
{
  std::array<double, 3> low = cloud.position[0], high = low;
  for (const auto &x : cloud.position)
    for (int d = 0; d < 3; ++d)
    {
      low[d] = std::min(low[d], x[d]);
      high[d] = std::max(high[d], x[d]);
    }
  NamedMesh box;
  for (int corner = 0; corner < 8; ++corner)
    box.mesh.nodes.push_back(
        {{corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
          corner & 4 ? high[2] : low[2]}});
  for (unsigned int id = 0; id < box_faces.size(); ++id)
  {
    const GlobalIndex axis = 1 << id / 2, b = axis == 1 ? 2 : 1,
                      c = axis == 4 ? 2 : 4, first = id % 2 * axis;
    box.mesh.boundary_faces.push_back(
        {{first, first + b, first + b + c, first + c}});
    box.mesh.boundary_id.push_back(id);
    box.faces.push_back(box_faces[id]);
  }
  return box;
}

/** Bits as in ParticleCloud::on_face of the faces that an entry lists. */
std::uint32_t face_bits(const BodyRequest &request, const std::string &entry,
                        const NamedMesh &faces)
{
  const std::string path = request.path + "/" + entry;
  std::uint32_t bits = 0;
  for (const unsigned int face :
       find_face_ids(path, request.prm.get(entry), faces))
  {
    if (face >= ParticleCloud::n_faces)
      throw InputError(path, "names the boundary id " + std::to_string(face) +
                                 "; faces of particles need ids below " +
                                 std::to_string(ParticleCloud::n_faces));
    bits |= 1u << face;
  }
  return bits;
}

/** Refuses particles that a search by cubes of the spacing could not hold. */
void check_spread(const ParticleCloud &cloud, const std::string &path)
{
  double n_cubes = 1.;
  for (int d = 0; d < 3; ++d)
  {
    double low = cloud.position[0][d], high = low;
    for (const auto &x : cloud.position)
    {
      low = std::min(low, x[d]);
      high = std::max(high, x[d]);
    }
    n_cubes *= 1. + (high - low) / cloud.spacing[d];
  }
  constexpr double most = 1e9;
  if (!(n_cubes < most))
    throw InputError(path + "/Geometry",
                     "the box around its particles has room for " +
                         formatted("%.3g", n_cubes) +
                         " of them, more than can be searched; make a body of "
                         "each piece, or look for a misplaced node");
}

constexpr const char *standard_criteria =
    "plastic strain, stable step, shape, failed neighbors";

/** " name: when; name: when". */
std::string described_criteria()
{
  std::string text;
  for (const auto &entry : Registry<ConversionCriterion>::entries())
    text += (text.empty() ? " " : "; ") + entry.name + ": " + entry.description;
  return text;
}

class Particles : public Discretization
{
public:
  void declare(Parameters &prm, const BodyShape *const shape) const override
  {
    const std::string faces = face_names(shape);
    prm.declare_knob("Symmetry faces", "", name_list(),
                     "Plane faces on which the model is cut: no velocity "
                     "across them, no contact with them. Among " +
                         faces + ".");
    prm.declare_knob("Nodal spacing", "1 mm",
                     quantities(Dimension::length, 1, 3, 1e-9, 1e2),
                     "Distance of neighboring particles; of a box the "
                     "nearest value that divides each edge, one for all or "
                     "three, one per axis. In other shapes particles are the "
                     "nodes of hexahedra with cells of this size.");
    prm.declare_entry("Carve from", "", any_text(),
                      "A FEM body whose cells inside this box or cylinder give "
                      "way to the particles. A box in a box has a lattice of "
                      "its own, around which the body is meshed; else the "
                      "nodes of the cells become the particles. Add a tie to "
                      "join the two.");
    prm.declare_knob("Zone", "fixed", one_of("fixed|self-finding"),
                     "With Carve from. fixed: the particles take the place of "
                     "the cells from the start. self-finding: cells turn into "
                     "particles at their nodes while the run goes on, by "
                     "\"Converts by\"; box or cylinder, where given by Size or "
                     "Radius, are of particles from the start. No tie is "
                     "needed.");
    prm.declare_entry("Start zone", "by entries", one_of("by entries|yes|no"),
                      "Whether the box or cylinder of a self-finding zone is "
                      "of particles from the start. by entries: where Size or "
                      "Radius is set.");
    prm.declare_knob(
        "Coarse cells", "by spacing", one_of("by spacing|split|whole"),
        "Cells of the host of a self-finding zone that are coarser "
        "than \"Nodal spacing\". split: each turns into a lattice "
        "of particles, of whole numbers of parts along each row of "
        "edges, nearest to that spacing. whole: into particles at "
        "its nodes, as far apart as these. by spacing: split where "
        "\"Nodal spacing\" is less than \"Cell size\" of the host, "
        "else whole.");
    prm.declare_knob("Converts by", standard_criteria, name_list(),
                     "What turns a cell into particles, any of these:" +
                         described_criteria());
    prm.declare_knob("Conversion interval", "10", integer(1),
                     "Steps between looks at the cells of the host of a "
                     "self-finding zone.");
    Registry<ConversionCriterion>::declare_entries(prm, "");
    prm.declare_entry("Clamped faces", "", name_list(),
                      "Faces held fixed, among " + faces +
                          "; in a zone with the cells of another body among "
                          "that body's, as for symmetry faces.");
    SpgOptions::declare_parameters(prm);
  }

  std::unique_ptr<Body> build(BodyRequest &request) const override
  {
    std::vector<double> spacing = get_quantities(request.prm, "Nodal spacing");
    const bool has_lattice = !request.cells && request.shape.has_lattice();
    if (spacing.size() == 2 || (spacing.size() == 3 && !has_lattice))
      throw InputError(request.path + "/Nodal spacing",
                       "has " + std::to_string(spacing.size()) +
                           " values; give one, or three for a box with a "
                           "lattice of its own");
    NamedMesh faces;
    ParticleCloud cloud;
    std::shared_ptr<const SplitMesh> lattices;
    if (has_lattice)
    {
      spacing.resize(3, spacing[0]);
      cloud = request.shape.lattice(request.prm,
                                    {{spacing[0], spacing[1], spacing[2]}});
      faces = faces_of_box(cloud);
      request.turn.apply(cloud);
      request.turn.apply(faces.mesh);
      request.name_planes(faces);
    }
    else
    {
      const NamedMesh mesh =
          request.cells ? std::move(*request.cells) : request.mesh(spacing[0]);
      faces.faces = mesh.faces;
      faces.groups = mesh.groups;
      cloud = make_mesh_cloud(mesh.mesh);
      lattices = split(request, mesh.mesh, spacing[0]);
      if (!request.cells && !request.shape.follows_cell_size())
        follow_spacing(request.prm, request.file, request.path,
                       cloud.spacing[0]);
    }
    check_spread(cloud, request.path);
    SpgOptions options = SpgOptions::parse(request.prm, request.path);
    options.initial_velocity = request.initial_velocity;
    options.symmetry_faces = face_bits(request, "Symmetry faces", faces);
    options.clamped_faces = face_bits(request, "Clamped faces", faces);
    options.grows = request.prm.get("Zone") != "fixed";
    if (options.grows && options.stores_gradients())
      throw InputError(request.path + "/Approximation",
                       "is " + request.prm.get("Approximation") +
                           ", whose masses are row sums of the cloud of the "
                           "start; a self-finding zone needs least squares");
    if (options.grows)
      cloud.spacing.fill(get_quantities(request.prm, "Nodal spacing")[0]);
    auto body = std::make_unique<SpgBody>(
        request.name, request.id, std::move(cloud), std::move(request.material),
        options, std::move(lattices));
    body->find_faces = face_finder(faces);
    return body;
  }

  std::optional<ConversionRequest>
  conversion(const Parameters &prm, const std::string &path) const override
  {
    if (prm.get("Zone") == "fixed")
      return std::nullopt;
    if (prm.get("Carve from").empty())
      throw InputError(
          path + "/Zone",
          "is self-finding, which needs a host: set \"Carve from\" "
          "to a body of finite elements");
    ConversionRequest request;
    request.interval = prm.get_integer("Conversion interval");
    for (const std::string &name : split_names(prm.get("Converts by")))
      request.criteria.push_back(
          Registry<ConversionCriterion>::get(path + "/Converts by", name)
              .make(prm, path));
    return request;
  }

  /** Whether cells of the host are split. */
  static bool splits(const Parameters &prm)
  {
    return prm.get("Zone") != "fixed" && prm.get("Coarse cells") == "split";
  }

  /** The lattices of the host's cells; null where none is split. */
  static std::shared_ptr<const SplitMesh>
  split(const BodyRequest &request, const HexMesh &mesh, const double spacing)
  {
    if (!splits(request.prm))
      return nullptr;
    auto lattices = std::make_shared<const SplitMesh>(mesh, spacing);
    return lattices->parts().second > 1 ? lattices : nullptr;
  }

  std::string carved_from(const Parameters &prm) const override
  {
    return prm.get("Carve from");
  }

  void follow_spacing(Parameters &prm, const ParameterFile &file,
                      const std::string &path,
                      const double spacing) const override
  {
    // Rough, as the cells of a file have no one size.
    constexpr double tolerance = 0.1;
    const std::string entry = path + "/Nodal spacing";
    const double asked = get_quantities(prm, "Nodal spacing")[0];
    const bool is_finer =
        file.is_set(entry) && asked < (1. - tolerance) * spacing;
    if (prm.get("Zone") != "fixed" && prm.get("Coarse cells") == "by spacing")
      prm.set("Coarse cells", is_finer ? "split" : "whole"); // for the same
    if (is_finer && splits(prm))
      return;
    char value[40];
    std::snprintf(value, sizeof(value), "%.10g mm", 1e3 * spacing);
    if (file.is_set(entry) && std::abs(asked / spacing - 1.) > tolerance)
      throw InputError(entry, "is " + prm.get("Nodal spacing") +
                                  ", but the particles are the nodes of cells "
                                  "of " +
                                  value + "; set that or remove the entry" +
                                  (is_finer && prm.get("Zone") != "fixed"
                                       ? ", or let cells be split: \"Coarse "
                                         "cells = split\""
                                       : ""));
    prm.set("Nodal spacing", value); // for the expanded parameters
  }
};

const Registry<Discretization>::Add
    registered({"SPG", "smoothed-particle-Galerkin particles.", nullptr,
                []() { return std::make_unique<Particles>(); }});
} // namespace
} // namespace sabot
