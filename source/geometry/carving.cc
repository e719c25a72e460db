// Zones of particles: what they contain, and the cut through the mesh.
#include "sabot/geometry/carving.h"
#include "sabot/geometry/cell_shape.h"

#include "sabot/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace sabot
{
namespace
{
using Face = std::array<GlobalIndex, 4>;

Face sorted(Face face)
{
  std::sort(face.begin(), face.end());
  return face;
}

/** The cells of @p mesh with is_in[cell] == @p wanted. */
HexMesh part_of(const HexMesh &mesh, const std::vector<char> &is_in,
                const char wanted, const unsigned int interface_id)
{
  constexpr GlobalIndex unused = std::numeric_limits<GlobalIndex>::max();
  std::vector<GlobalIndex> number(mesh.nodes.size(), unused);
  std::map<Face, unsigned int> outside; // boundary id
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
    outside[sorted(mesh.boundary_faces[f])] = mesh.boundary_id[f];
  std::map<Face, int> uses; // by cells of this part
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (is_in[c] == wanted)
    {
      for (const GlobalIndex a : mesh.cells[c])
        number[a] = 0;
      for (const auto &corners : face_corners)
      {
        Face face;
        for (int a = 0; a < 4; ++a)
          face[a] = mesh.cells[c][corners[a]];
        ++uses[sorted(face)];
      }
    }
  HexMesh part;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] != unused)
    {
      number[i] = part.nodes.size();
      part.nodes.push_back(mesh.nodes[i]);
    }
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    if (is_in[c] != wanted)
      continue;
    std::array<GlobalIndex, 8> cell;
    for (int a = 0; a < 8; ++a)
      cell[a] = number[mesh.cells[c][a]];
    part.cells.push_back(cell);
    part.volume.push_back(mesh.volume[c]);
    for (const auto &corners : face_corners)
    {
      Face face, renumbered;
      for (int a = 0; a < 4; ++a)
      {
        face[a] = mesh.cells[c][corners[a]];
        renumbered[a] = cell[corners[a]];
      }
      if (uses[sorted(face)] == 2)
        continue;
      const auto old = outside.find(sorted(face));
      part.boundary_faces.push_back(renumbered);
      part.boundary_id.push_back(old == outside.end() ? interface_id
                                                      : old->second);
    }
  }
  return part;
}
} // namespace

bool ZoneShape::contains(const std::array<double, 3> &point) const
{
  double square = 0.;
  for (int d = 0; d < 3; ++d)
  {
    const double x = (point[d] - center[d]) / (0.5 * size[d]);
    if (axis && d != *axis)
      square += x * x;
    else if (!(std::abs(x) < 1.))
      return false;
  }
  return square < 1.;
}

bool ZoneShape::is_coaxial(const unsigned int line_axis,
                           const std::array<double, 3> &point) const
{
  bool same = axis == int(line_axis);
  for (unsigned int d = 0; d < 3; ++d)
    same = same &&
           (d == line_axis || std::abs(center[d] - point[d]) < 1e-6 * size[d]);
  return same;
}

CarvedMesh carve(const HexMesh &mesh, const ZoneShape &shape,
                 const unsigned int n_named, const std::string &path)
{
  std::vector<char> is_in(mesh.cells.size());
  std::size_t n_in = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    std::array<double, 3> center{{0., 0., 0.}};
    for (const GlobalIndex a : mesh.cells[c])
      for (int d = 0; d < 3; ++d)
        center[d] += 0.125 * mesh.nodes[a][d];
    is_in[c] = shape.contains(center);
    n_in += is_in[c];
  }
  if (n_in == 0)
    throw InputError(path, "no cell of the body that the zone is carved from "
                           "has its center in the zone; check its size and "
                           "center");
  if (n_in == mesh.cells.size())
    throw InputError(path, "the zone leaves nothing of the body that it is "
                           "carved from; make it smaller");
  unsigned int interface_id = n_named;
  for (const unsigned int id : mesh.boundary_id)
    interface_id = std::max(interface_id, id + 1);
  return {part_of(mesh, is_in, 0, interface_id),
          part_of(mesh, is_in, 1, interface_id)};
}
} // namespace sabot
