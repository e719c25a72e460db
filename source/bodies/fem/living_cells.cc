// Which cells of a body are left, and what can be touched of them.
#include "sabot/bodies/fem/living_cells.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** Corners of the faces of a cell in VTK order, outward normal by the
    right-hand rule: -x, +x, -y, +y, -z, +z. */
constexpr int face_corner[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                   {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
} // namespace

LivingCells::LivingCells(NodalState &nodal_state, Hexahedra &cells,
                         FemBoundary &boundary, std::vector<char> &owned_cell,
                         const GlobalIndex n_boundary_faces)
    : nodal_state(nodal_state), cells(cells), boundary(boundary),
      owned_cell(owned_cell), n_boundary_faces(n_boundary_faces)
{
  const std::size_t n = cells.size();
  nodes = cells.connectivity;
  id = cells.cell_id;
  alive.assign(n, 1);
  has_opened.assign(n, 0);
  cells_of_node.assign(nodal_state.size(), 0);
  bare_node.assign(nodal_state.n_owned, 0);
  for (std::size_t e = 0; e < n; ++e)
  {
    initial.push_back(e);
    for (const std::uint32_t a : nodes[e])
      ++cells_of_node[a];
  }
  find_neighbors();
}

void LivingCells::find_neighbors()
{
  // Who is across each face: equal corners, sorted.
  struct Face
  {
    std::array<std::size_t, 4> corner;
    std::int32_t cell;
    int number;
    bool operator<(const Face &o) const { return corner < o.corner; }
  };
  const std::size_t n = nodes.size();
  std::vector<Face> faces;
  for (std::size_t e = 0; e < n; ++e)
    for (int f = 0; f < 6; ++f)
    {
      Face face{{}, std::int32_t(e), f};
      for (int a = 0; a < 4; ++a)
        face.corner[a] = nodes[e][face_corner[f][a]];
      std::sort(face.corner.begin(), face.corner.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end());
  across.assign(n, {{-1, -1, -1, -1, -1, -1}});
  for (std::size_t i = 1; i < faces.size(); ++i)
    if (faces[i].corner == faces[i - 1].corner)
    {
      across[faces[i].cell][faces[i].number] = faces[i - 1].cell;
      across[faces[i - 1].cell][faces[i - 1].number] = faces[i].cell;
    }
  for (const auto &corners : boundary.faces)
  {
    Face face{corners, 0, 0};
    std::sort(face.corner.begin(), face.corner.end());
    const auto found = std::lower_bound(faces.begin(), faces.end(), face);
    face_cell.push_back(found->cell);
  }
}

bool LivingCells::has(const GlobalIndex cell) const
{
  const auto found = std::lower_bound(id.begin(), id.end(), cell);
  return found != id.end() && *found == cell && alive[found - id.begin()];
}

std::vector<std::uint32_t> LivingCells::cells_of_faces() const
{
  std::vector<std::uint32_t> found;
  for (const std::int32_t cell : face_cell)
    found.push_back(
        std::lower_bound(initial.begin(), initial.end(), std::uint32_t(cell)) -
        initial.begin());
  return found;
}

void LivingCells::take_out(const std::vector<std::size_t> &leaving,
                           const bool opens)
{
  std::vector<std::uint32_t> gone;
  for (const std::size_t e : leaving)
  {
    Vec force[8];
    cells.cell_forces(nodal_state, e, force);
    for (int a = 0; a < 8; ++a)
      nodal_state.force[cells.connectivity[e][a]] -= force[a];
    gone.push_back(initial[e]);
    alive[initial[e]] = 0;
    has_opened[initial[e]] = opens;
  }
  update_boundary(gone, opens);
  compact();
}

void LivingCells::update_boundary(const std::vector<std::uint32_t> &gone,
                                  const bool opens)
{
  for (const std::uint32_t cell : gone)
    for (const std::uint32_t a : nodes[cell])
      if (--cells_of_node[a] == 0 && a < nodal_state.n_owned)
        bare_node[a] = 1;
  // Faces of cells that go, then those of the living behind them.
  std::size_t kept = 0;
  for (std::size_t f = 0; f < boundary.faces.size(); ++f)
    if (alive[face_cell[f]])
    {
      boundary.faces[kept] = boundary.faces[f];
      boundary.face_id[kept] = boundary.face_id[f];
      face_cell[kept++] = face_cell[f];
    }
  boundary.faces.resize(kept);
  boundary.face_id.resize(kept);
  face_cell.resize(kept);
  if (!opens)
    return;
  struct Face
  {
    GlobalIndex id;
    std::array<std::size_t, 4> corners;
    std::int32_t cell;
  };
  std::vector<Face> opened;
  for (const std::uint32_t cell : gone)
    for (const std::int32_t other : across[cell])
    {
      if (other < 0 || !alive[other])
        continue;
      const auto &back = across[other];
      const int f = std::find(back.begin(), back.end(), std::int32_t(cell)) -
                    back.begin();
      std::array<std::size_t, 4> face;
      for (int a = 0; a < 4; ++a)
        face[a] = nodes[other][face_corner[f][a]];
      opened.push_back({n_boundary_faces + 6 * id[other] + f, face, other});
    }
  // In one order, however and whenever cells went.
  const auto before = [](const Face &a, const Face &b) { return a.id < b.id; };
  std::sort(opened.begin(), opened.end(), before);
  const std::ptrdiff_t n_new = opened.size();
  for (std::size_t f = 0; f < kept; ++f)
    opened.push_back({boundary.face_id[f], boundary.faces[f], face_cell[f]});
  std::inplace_merge(opened.begin(), opened.begin() + n_new, opened.end(),
                     before);
  boundary.faces.clear();
  boundary.face_id.clear();
  face_cell.clear();
  for (const Face &face : opened)
  {
    boundary.faces.push_back(face.corners);
    boundary.face_id.push_back(face.id);
    face_cell.push_back(face.cell);
  }
}

void LivingCells::compact()
{
  std::vector<std::size_t> kept;
  for (std::size_t e = 0; e < cells.size(); ++e)
    if (alive[initial[e]])
    {
      owned_cell[kept.size()] = owned_cell[e];
      initial[kept.size()] = initial[e];
      kept.push_back(e);
    }
  owned_cell.resize(kept.size());
  initial.resize(kept.size());
  cells.keep(kept);
}

StateItems LivingCells::items(const std::string &body) const
{
  return {"body " + body + "/cells of the start", id.data(), id.size(),
          id.size()};
}

void LivingCells::visit_state(StateVisitor &visitor, const std::string &body)
{
  // A reader must know which cells are left before it fills their arrays.
  const StateItems cells_of_start = items(body);
  visitor.visit_keys(cells_of_start);
  visitor.visit_items("alive cells", alive, cells_of_start);
  visitor.visit_items("opened cells", has_opened, cells_of_start);
  if (!visitor.is_restoring())
    return;
  for (const bool opens : {false, true})
  {
    std::vector<std::uint32_t> gone;
    for (const std::uint32_t cell : initial)
      if (!alive[cell] && bool(has_opened[cell]) == opens)
        gone.push_back(cell);
    update_boundary(gone, opens);
  }
  compact();
}
} // namespace sabot
