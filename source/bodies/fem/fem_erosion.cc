// Erosion of hexahedra: criteria, removal, the new boundary, what is kept of
// the dead.
#include "sabot/bodies/fem/fem_erosion.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Corners of the faces of a cell in VTK order, outward normal by the
    right-hand rule: -x, +x, -y, +y, -z, +z. */
constexpr int face_corner[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                   {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
} // namespace

FemErosion::FemErosion(const FemOptions &options, const Material &material,
                       NodalState &nodal_state, Hexahedra &cells,
                       FemBoundary &boundary, std::vector<char> &owned_cell,
                       const GlobalIndex n_boundary_faces,
                       MPI_Comm communicator)
    : options(options), material(material), nodal_state(nodal_state),
      cells(cells), boundary(boundary), owned_cell(owned_cell),
      n_boundary_faces(n_boundary_faces), communicator(communicator)
{
  const std::size_t n = cells.size();
  nodes = cells.connectivity;
  id = cells.cell_id;
  alive.assign(n, 1);
  cells_of_node.assign(nodal_state.size(), 0);
  free_node.assign(nodal_state.n_owned, 0);
  for (std::size_t e = 0; e < n; ++e)
  {
    initial.push_back(e);
    for (const std::uint32_t a : nodes[e])
      ++cells_of_node[a];
  }
  find_neighbors();
}

void FemErosion::find_neighbors()
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

std::vector<std::uint32_t> FemErosion::cells_of_faces() const
{
  std::vector<std::uint32_t> found;
  for (const std::int32_t cell : face_cell)
    found.push_back(
        std::lower_bound(initial.begin(), initial.end(), std::uint32_t(cell)) -
        initial.begin());
  return found;
}

std::vector<std::size_t> FemErosion::find_condemned() const
{
  std::vector<std::size_t> found = cells.inverting;
  for (const ErosionLimit &limit : options.erosion_limits())
  {
    const std::vector<double> values = cells.cell_state(limit.variable);
    for (std::size_t e = 0; e < values.size(); ++e)
      if (values[e] >= limit.value)
        found.push_back(e);
  }
  for (std::size_t e = 0; e < cells.cell_step.size(); ++e)
    if (cells.cell_step[e] < options.erosion_step)
      found.push_back(e);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool FemErosion::erode()
{
  const std::vector<std::size_t> condemned = find_condemned();
  cells.inverting.clear();
  // All ranks must search their contacts anew.
  int any = !condemned.empty();
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
  if (any == 0)
    return false;
  remove(condemned);
  return true;
}

void FemErosion::remove(const std::vector<std::size_t> &condemned)
{
  std::vector<std::uint32_t> dead;
  for (const std::size_t e : condemned)
  {
    // The half step that starts now must not feel the cell any more.
    Vec force[8];
    cells.cell_forces(nodal_state, e, force);
    for (int a = 0; a < 8; ++a)
      nodal_state.force[cells.connectivity[e][a]] -= force[a];
    dead.push_back(initial[e]);
    alive[initial[e]] = 0;
    if (!owned_cell[e])
      continue;
    mass.add(material.density() * cells.volume[e]);
    energy.add(cells.internal_energy(e));
    energy.add(cells.hourglass_energy[e]);
    plastic_work.add(cells.plastic_work(e));
    n_cells.add(1.);
  }
  update_boundary(dead);
  compact();
}

void FemErosion::update_boundary(const std::vector<std::uint32_t> &dead)
{
  for (const std::uint32_t cell : dead)
    for (const std::uint32_t a : nodes[cell])
      if (--cells_of_node[a] == 0 && a < nodal_state.n_owned)
        free_node[a] = 1;
  // Faces of dead cells go, faces of the living behind them come.
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
  for (const std::uint32_t cell : dead)
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
      boundary.faces.push_back(face);
      boundary.face_id.push_back(n_boundary_faces + 6 * id[other] + f);
      face_cell.push_back(other);
    }
}

void FemErosion::compact()
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

void FemErosion::visit_state(StateVisitor &visitor)
{
  // A reader must know which cells are left before it fills their arrays.
  visitor.visit_array("alive cells", alive);
  if (visitor.is_restoring())
  {
    std::vector<std::uint32_t> dead;
    for (const std::uint32_t cell : initial)
      if (!alive[cell])
        dead.push_back(cell);
    update_boundary(dead);
    compact();
  }
  // In the order in which cells died.
  visitor.visit_resized("boundary faces", boundary.faces);
  visitor.visit_resized("boundary face ids", boundary.face_id);
  visitor.visit_resized("cells of boundary faces", face_cell);
  visitor.visit_value("eroded mass", mass);
  visitor.visit_value("eroded energy", energy);
  visitor.visit_value("eroded plastic work", plastic_work);
  visitor.visit_value("eroded cells", n_cells);
}

void FemErosion::add_energies(EnergyLedger &ledger) const
{
  ledger.eroded.add(energy);
  ledger.plastic_work.add(plastic_work);
}

void FemErosion::add_measures(BodyMeasures &measures) const
{
  ExactSum gone = mass, n_gone = n_cells, free_mass, kinetic, momentum[3];
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    if (free_node[i])
    {
      const double m = nodal_state.lumped_mass[i];
      const Vec v = nodal_state.velocity[i];
      free_mass.add(m);
      kinetic.add(0.5 * m * norm_square(v));
      for (int d = 0; d < 3; ++d)
        momentum[d].add(m * v[d]);
    }
  ExactSum::reduce({&gone, &n_gone, &free_mass, &kinetic, &momentum[0],
                    &momentum[1], &momentum[2]},
                   communicator);
  measures.eroded_mass = gone.value();
  for (int d = 0; d < 3; ++d)
    measures.eroded_momentum[d] = momentum[d].value();
  measures.own.push_back({"eroded mass", "kg", gone.value()});
  measures.own.push_back({"eroded cells", "1", n_gone.value()});
  measures.own.push_back({"free node mass", "kg", free_mass.value()});
  measures.own.push_back({"free node kinetic energy", "J", kinetic.value()});
  for (int d = 0; d < 3; ++d)
    measures.own.push_back({std::string("eroded momentum ") + "xyz"[d],
                            "kg m/s", momentum[d].value()});
}
} // namespace sabot
