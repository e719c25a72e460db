// Faces by the names of a mesh, and by the planes they lie in.
#include "sabot/geometry/named_mesh.h"

#include "sabot/base/error.h"
#include "sabot/base/parameters.h"
#include "sabot/base/text.h"
#include "sabot/geometry/boundary_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sabot
{
namespace
{
struct Plane
{
  int axis;
  double height; // [m]
};

/** "x = 1 mm"; nothing for other names. */
std::optional<Plane> plane_of(const std::string &path, const std::string &word)
{
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos)
    return std::nullopt;
  const std::string axis = trim(word.substr(0, equals)),
                    height = trim(word.substr(equals + 1));
  if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z' ||
      !quantity(Dimension::length).match(height))
    throw InputError(path, "\"" + word +
                               "\" is no plane; one is written as \"x = 1.5 "
                               "mm\", with x, y or z and a length");
  return Plane{axis[0] - 'x', *read_quantity(height)};
}

/** A millionth of the mesh's size [m]. */
double tolerance_of(const HexMesh &mesh)
{
  double square = 0.;
  for (int d = 0; d < 3; ++d)
  {
    double low = mesh.nodes[0][d], high = low;
    for (const auto &x : mesh.nodes)
    {
      low = std::min(low, x[d]);
      high = std::max(high, x[d]);
    }
    square += (high - low) * (high - low);
  }
  return 1e-6 * std::sqrt(square);
}

bool lies_in(const HexMesh &mesh, const std::size_t face, const Plane &plane,
             const double tolerance)
{
  bool inside = true;
  for (const GlobalIndex a : mesh.boundary_faces[face])
    inside = inside &&
             std::abs(mesh.nodes[a][plane.axis] - plane.height) <= tolerance;
  return inside;
}

/** Ids of the faces called @p word, ascending; @p is_known: whether there is
    such a name at all. */
std::vector<unsigned int> ids_of(const NamedMesh &made, const std::string &word,
                                 const bool any_case, bool &is_known)
{
  const auto equal = [&](const std::string &name)
  { return any_case ? lower_case(name) == lower_case(word) : name == word; };
  std::vector<unsigned int> ids;
  is_known = false;
  for (unsigned int id = 0; id < made.faces.size(); ++id)
    if (equal(made.faces[id]))
    {
      ids.push_back(id);
      is_known = true;
    }
  for (const NamedMesh::Group &group : made.groups)
    if (equal(group.name) || (!group.also.empty() && equal(group.also)))
    {
      ids.insert(ids.end(), group.ids.begin(), group.ids.end());
      is_known = true;
    }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

/** The names to choose from. */
std::string allowed(const NamedMesh &made)
{
  std::vector<std::string> names;
  const auto add = [&](const std::string &name)
  {
    if (!name.empty() &&
        std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  };
  for (const NamedMesh::Group &group : made.groups)
    if (!group.ids.empty())
      add(group.name + (group.also.empty() ? "" : " (" + group.also + ")"));
  if (made.groups.empty())
    for (const std::string &face : made.faces)
      add(face);
  constexpr std::size_t most = 30;
  const bool is_long = names.size() > most;
  if (is_long)
    names.resize(most);
  return join(names, ", ") + (is_long ? ", ..." : "");
}

/** Gives the faces for which @p is_meant another id than their fellows. */
template <typename Meant>
void split_ids(NamedMesh &made, const Meant &is_meant)
{
  HexMesh &mesh = made.mesh;
  unsigned int n = made.faces.size();
  for (const unsigned int id : mesh.boundary_id)
    n = std::max(n, id + 1);
  std::vector<char> some(n, 0), others(n, 0);
  for (std::size_t f = 0; f < mesh.boundary_id.size(); ++f)
    (is_meant(f) ? some : others)[mesh.boundary_id[f]] = 1;
  std::vector<unsigned int> part(n);
  made.faces.resize(n);
  for (unsigned int id = 0; id < n; ++id)
  {
    part[id] = id;
    if (!some[id] || !others[id])
      continue;
    part[id] = made.faces.size();
    made.faces.push_back(std::string(made.faces[id]));
    for (NamedMesh::Group &group : made.groups)
      if (std::find(group.ids.begin(), group.ids.end(), id) != group.ids.end())
        group.ids.push_back(part[id]);
  }
  for (std::size_t f = 0; f < mesh.boundary_id.size(); ++f)
    if (is_meant(f))
      mesh.boundary_id[f] = part[mesh.boundary_id[f]];
}

/** Makes a group of the boundary faces in a plane. */
void name_plane(NamedMesh &made, const std::string &path,
                const std::string &word, const Plane &plane)
{
  HexMesh &mesh = made.mesh;
  const double tolerance = tolerance_of(mesh);
  std::vector<char> is_in;
  double nearest = HUGE_VAL;
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    is_in.push_back(lies_in(mesh, f, plane, tolerance));
    const Plane own{plane.axis,
                    mesh.nodes[mesh.boundary_faces[f][0]][plane.axis]};
    if (lies_in(mesh, f, own, tolerance) &&
        std::abs(own.height - plane.height) < std::abs(nearest - plane.height))
      nearest = own.height;
  }
  if (std::find(is_in.begin(), is_in.end(), 1) == is_in.end())
    throw InputError(
        path, "no face of the mesh lies in the plane \"" + word + "\"" +
                  (std::isfinite(nearest)
                       ? formatted("; the nearest that some do is at %.9g mm",
                                   1e3 * nearest)
                       : std::string("; none does across this axis")));
  split_ids(made, [&](const std::size_t f) { return is_in[f]; });
  NamedMesh::Group group{word, "", {}};
  for (std::size_t f = 0; f < is_in.size(); ++f)
    if (is_in[f])
      group.ids.push_back(mesh.boundary_id[f]);
  std::sort(group.ids.begin(), group.ids.end());
  group.ids.erase(std::unique(group.ids.begin(), group.ids.end()),
                  group.ids.end());
  made.groups.push_back(std::move(group));
}

/** Splits the faces of an id into the planes across the axes in which they
    lie; leaves others as they are. */
void split_planes(NamedMesh &made, const unsigned int id)
{
  const HexMesh &mesh = made.mesh;
  const double tolerance = tolerance_of(mesh);
  while (!plane_axis(mesh, id))
  {
    std::size_t f = 0;
    while (f < mesh.boundary_id.size() && mesh.boundary_id[f] != id)
      ++f;
    if (f == mesh.boundary_id.size())
      return;
    std::optional<Plane> plane;
    for (int axis = 0; axis < 3 && !plane; ++axis)
    {
      const Plane own{axis, mesh.nodes[mesh.boundary_faces[f][0]][axis]};
      if (lies_in(mesh, f, own, tolerance))
        plane = own;
    }
    const std::vector<unsigned int> before = mesh.boundary_id;
    if (plane)
      split_ids(made,
                [&](const std::size_t g) {
                  return before[g] == id && lies_in(mesh, g, *plane, tolerance);
                });
    if (mesh.boundary_id == before)
      return;
  }
}
} // namespace

void name_planes(NamedMesh &made, const std::string &path,
                 const std::string &text, const bool is_symmetry)
{
  for (const std::string &word : split_names(text))
  {
    bool is_known = false;
    std::vector<unsigned int> ids = ids_of(made, word, false, is_known);
    const auto plane = is_known ? std::nullopt : plane_of(path, word);
    if (plane)
      name_plane(made, path, word, *plane);
    if (is_symmetry)
      for (const unsigned int id : ids)
        split_planes(made, id);
  }
}

std::vector<unsigned int> find_face_ids(const std::string &path,
                                        const std::string &text,
                                        const NamedMesh &made)
{
  std::vector<unsigned int> ids;
  for (const std::string &word : split_names(text))
  {
    bool is_known = false;
    std::vector<unsigned int> found = ids_of(made, word, false, is_known);
    if (!is_known)
      found = ids_of(made, word, true, is_known);
    for (const NamedMesh::Unusable &name : made.unusable)
      if (!is_known && lower_case(name.name) == lower_case(word))
        throw InputError(path, "\"" + word +
                                   "\" names no faces here: " + name.reason);
    if (!is_known)
      throw InputError(path, "\"" + word +
                                 "\" is not a face; allowed: " + allowed(made) +
                                 ", or a plane, as \"x = 0 mm\"");
    if (found.empty())
      throw InputError(path, "\"" + word +
                                 "\" has no face of the boundary; allowed: " +
                                 allowed(made));
    ids.insert(ids.end(), found.begin(), found.end());
  }
  return ids;
}
} // namespace sabot
