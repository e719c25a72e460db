// Faces of a body of hexahedra: prescribed velocities, symmetry planes, and
// what couplings may touch.
#include "sabot/bodies/fem/fem_boundary.h"

#include "sabot/base/error.h"
#include "sabot/geometry/boundary_planes.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
bool contains(const std::vector<unsigned int> &ids, const unsigned int id)
{
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

std::array<Vec, 4> corners(const HexMesh &mesh, const std::size_t face)
{
  std::array<Vec, 4> x;
  for (int a = 0; a < 4; ++a)
  {
    const auto &p = mesh.nodes[mesh.boundary_faces[face][a]];
    x[a] = vec(p[0], p[1], p[2]);
  }
  return x;
}

Vec area_vector(const std::array<Vec, 4> &x)
{
  return 0.5 * cross(x[2] - x[0], x[3] - x[1]);
}
} // namespace

FemBoundary::FemBoundary(const std::string &body_name, const HexMesh &mesh,
                         const FemOptions &options)
    : options(options)
{
  for (const unsigned int id : options.symmetry_boundary_ids)
  {
    const std::optional<int> axis = plane_axis(mesh, id);
    if (!axis)
      throw InputError("Bodies/" + body_name + "/Symmetry faces",
                       "these faces do not lie in one plane across the x, y or "
                       "z axis; a symmetry plane must");
    symmetry_axes[id] = *axis;
    for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
      if (mesh.boundary_id[f] == id)
      {
        symmetry_planes.push_back(
            {*axis, mesh.nodes[mesh.boundary_faces[f][0]][*axis]});
        break;
      }
  }
  refuse_contradictions(body_name, mesh, options, symmetry_axes);
}

void FemBoundary::set_up(
    const HexMesh &mesh,
    const std::unordered_map<GlobalIndex, std::uint32_t> &local,
    const std::size_t n_owned, VelocityConstraints &constraints)
{
  std::map<std::size_t, int> planes; // bit per axis
  std::vector<std::size_t> driven, clamped;
  double total_area = 0.; // without planes of symmetry, as the whole has it
  std::size_t n_open = 0;
  const auto is_here = [&](const std::array<GlobalIndex, 4> &face)
  {
    return std::all_of(face.begin(), face.end(),
                       [&](const GlobalIndex a)
                       { return local.find(a) != local.end(); });
  };
  const std::size_t n_here = std::count_if(mesh.boundary_faces.begin(),
                                           mesh.boundary_faces.end(), is_here);
  faces.reserve(n_here);
  face_id.reserve(n_here);
  id_of_face.reserve(n_here);
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    const unsigned int id = mesh.boundary_id[f];
    const bool on_plane = contains(options.symmetry_boundary_ids, id);
    if (!on_plane)
    {
      total_area += norm(area_vector(corners(mesh, f)));
      ++n_open;
    }
    std::array<std::size_t, 4> face;
    bool here = true;
    for (int a = 0; a < 4; ++a)
    {
      const auto found = local.find(mesh.boundary_faces[f][a]);
      here = here && found != local.end();
      if (found == local.end())
        continue;
      face[a] = found->second;
      if (found->second >= n_owned)
        continue;
      if (on_plane)
        planes[found->second] |= 1 << symmetry_axes.at(id);
      if (contains(options.driven_boundary_ids, id))
        driven.push_back(found->second);
      if (contains(options.clamped_boundary_ids, id))
        clamped.push_back(found->second);
    }
    if (here && !on_plane)
    {
      faces.push_back(face);
      face_id.push_back(f);
      id_of_face.emplace_back(f, id);
    }
  }
  typical_spacing = std::sqrt(total_area / std::max<std::size_t>(1, n_open));
  hold_on_planes(planes, constraints);
  for (const std::size_t node : driven)
    for (int d = 0; d < 3; ++d)
      if (options.driven_components[d])
        constraints.prescribe(node, d, options.driven_velocity[d],
                              VelocityConstraints::Holder::drive);
  for (const std::size_t node : clamped)
    for (int d = 0; d < 3; ++d)
      constraints.prescribe(node, d, 0., VelocityConstraints::Holder::clamp);
  constraints.finish();
}

void FemBoundary::hold_on_planes(const std::map<std::size_t, int> &planes,
                                 VelocityConstraints &constraints)
{
  for (const auto &[node, bits] : planes)
    for (int d = 0; d < 3; ++d)
      if (bits & 1 << d)
      {
        ++n_symmetry_planes[node];
        constraints.prescribe(node, d, 0.,
                              VelocityConstraints::Holder::symmetry);
      }
}

ContactSurface FemBoundary::surface(const std::size_t n_owned,
                                    const double bulk_modulus) const
{
  ContactSurface surface;
  surface.faces = faces;
  surface.face_id = face_id;
  for (const auto &face : faces)
    for (const std::size_t a : face)
      if (a < n_owned)
        surface.nodes.push_back(a);
  std::sort(surface.nodes.begin(), surface.nodes.end());
  surface.nodes.erase(std::unique(surface.nodes.begin(), surface.nodes.end()),
                      surface.nodes.end());
  if (!n_symmetry_planes.empty())
    for (const std::size_t a : surface.nodes)
    {
      const auto planes = n_symmetry_planes.find(a);
      surface.node_share.push_back(
          planes == n_symmetry_planes.end() ? 1. : 1. / (1 << planes->second));
    }
  surface.bulk_modulus = bulk_modulus;
  surface.spacing = typical_spacing;
  surface.symmetry_planes = symmetry_planes;
  return surface;
}

LoadedSurface
FemBoundary::loaded_surface(const std::vector<unsigned int> &ids) const
{
  std::vector<std::pair<GlobalIndex, std::size_t>> found; // number, local
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    const auto at = std::lower_bound(id_of_face.begin(), id_of_face.end(),
                                     std::make_pair(face_id[f], 0u));
    if (at != id_of_face.end() && at->first == face_id[f] &&
        contains(ids, at->second))
      found.emplace_back(face_id[f], f);
  }
  std::sort(found.begin(), found.end());
  LoadedSurface surface;
  for (const auto &[number, f] : found)
    surface.faces.push_back(faces[f]);
  return surface;
}

std::vector<std::uint32_t> FemBoundary::find_cells(const Hexahedra &cells) const
{
  std::map<std::size_t, std::vector<std::uint32_t>> cells_of;
  for (const auto &face : faces)
    cells_of[face[0]];
  for (std::size_t e = 0; e < cells.size(); ++e)
    for (const std::uint32_t a : cells.connectivity[e])
    {
      const auto at = cells_of.find(a);
      if (at != cells_of.end())
        at->second.push_back(e);
    }
  std::vector<std::uint32_t> found;
  for (const auto &face : faces)
  {
    found.push_back(no_cell);
    for (const std::uint32_t e : cells_of[face[0]])
    {
      const auto &nodes = cells.connectivity[e];
      if (std::all_of(face.begin(), face.end(),
                      [&](const std::size_t a) {
                        return std::find(nodes.begin(), nodes.end(), a) !=
                               nodes.end();
                      }))
        found.back() = e;
    }
  }
  return found;
}

std::vector<double> FemBoundary::flow_stress(
    const std::vector<std::size_t> &some_nodes, const std::size_t n_local_nodes,
    const Hexahedra &cells, const std::vector<std::uint32_t> &cell_of) const
{
  std::vector<std::int64_t> number(n_local_nodes, -1);
  for (std::size_t k = 0; k < some_nodes.size(); ++k)
    number[some_nodes[k]] = k;
  std::vector<std::size_t> around, needed;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (std::any_of(faces[f].begin(), faces[f].end(),
                    [&](const std::size_t a) { return number[a] >= 0; }))
    {
      around.push_back(f);
      needed.push_back(cell_of[f]);
    }
  const std::vector<double> of_faces = cells.flow_stress(needed);
  std::vector<double> mean(some_nodes.size(), 0.);
  std::vector<int> n_faces(some_nodes.size(), 0);
  for (std::size_t k = 0; k < around.size(); ++k)
    for (const std::size_t a : faces[around[k]])
      if (number[a] >= 0)
      {
        mean[number[a]] += of_faces[k];
        ++n_faces[number[a]];
      }
  for (std::size_t k = 0; k < mean.size(); ++k)
    mean[k] = n_faces[k] > 0 ? mean[k] / n_faces[k] : never_yields;
  return mean;
}
} // namespace sabot
