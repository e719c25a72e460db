#include "sabot/bodies/body_report.h"
#include "sabot/bodies/fem/fem_body.h"

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

void FemBody::set_up_erosion()
{
  erosion = std::make_unique<Erosion>();
  Erosion &er = *erosion;
  const std::size_t n = cells->size();
  er.nodes = cells->connectivity;
  er.id = cells->cell_id;
  er.alive.assign(n, 1);
  er.cells_of_node.assign(nodal_state.size(), 0);
  er.free_node.assign(nodal_state.n_owned, 0);
  er.n_boundary_faces = mesh.boundary_faces.size();
  for (std::size_t e = 0; e < n; ++e)
  {
    er.initial.push_back(e);
    for (const std::uint32_t a : er.nodes[e])
      ++er.cells_of_node[a];
  }

  // Who is across each face: equal corners, sorted.
  struct Face
  {
    std::array<std::size_t, 4> corner;
    std::int32_t cell;
    int number;
    bool operator<(const Face &o) const { return corner < o.corner; }
  };
  std::vector<Face> faces;
  for (std::size_t e = 0; e < n; ++e)
    for (int f = 0; f < 6; ++f)
    {
      Face face{{}, std::int32_t(e), f};
      for (int a = 0; a < 4; ++a)
        face.corner[a] = er.nodes[e][face_corner[f][a]];
      std::sort(face.corner.begin(), face.corner.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end());
  er.across.assign(n, {{-1, -1, -1, -1, -1, -1}});
  for (std::size_t i = 1; i < faces.size(); ++i)
    if (faces[i].corner == faces[i - 1].corner)
    {
      er.across[faces[i].cell][faces[i].number] = faces[i - 1].cell;
      er.across[faces[i - 1].cell][faces[i - 1].number] = faces[i].cell;
    }
  for (const auto &boundary : boundary_faces)
  {
    Face face{boundary, 0, 0};
    std::sort(face.corner.begin(), face.corner.end());
    const auto found = std::lower_bound(faces.begin(), faces.end(), face);
    er.face_cell.push_back(found->cell);
  }
}

const std::vector<char> *FemBody::free_nodes() const
{
  return erosion ? &erosion->free_node : nullptr;
}

std::vector<std::size_t> FemBody::cells_to_erode() const
{
  std::vector<std::size_t> found = cells->inverting;
  const auto add_above = [&](const char *const variable, const double limit)
  {
    if (limit >= FemOptions::never)
      return;
    const std::vector<double> values = cells->cell_state(variable);
    for (std::size_t e = 0; e < values.size(); ++e)
      if (values[e] >= limit)
        found.push_back(e);
  };
  add_above("effective plastic strain", options.erosion_plastic_strain);
  add_above("damage", options.erosion_damage);
  for (std::size_t e = 0; e < cells->cell_step.size(); ++e)
    if (cells->cell_step[e] < options.erosion_step)
      found.push_back(e);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool FemBody::erode_cells()
{
  const std::vector<std::size_t> found = cells_to_erode();
  cells->inverting.clear();
  // All ranks must search their contacts anew.
  int any = !found.empty();
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
  if (any == 0)
    return false;
  ++surface_version;
  erode(found);
  return true;
}

void FemBody::erode(const std::vector<std::size_t> &found)
{
  Erosion &er = *erosion;
  std::vector<std::uint32_t> dead;
  for (const std::size_t e : found)
  {
    // The half step that starts now must not feel the cell any more.
    Vec force[8];
    cells->cell_forces(nodal_state, e, force);
    for (int a = 0; a < 8; ++a)
      nodal_state.force[cells->connectivity[e][a]] -= force[a];
    dead.push_back(er.initial[e]);
    er.alive[er.initial[e]] = 0;
    if (!owned_cell[e])
      continue;
    er.mass.add(material->density() * cells->volume[e]);
    er.energy.add(cells->internal_energy(e));
    er.energy.add(cells->hourglass_energy[e]);
    er.plastic_work.add(cells->plastic_work(e));
    er.n_cells.add(1.);
  }
  update_boundary(dead);
  compact();
}

void FemBody::update_boundary(const std::vector<std::uint32_t> &dead)
{
  Erosion &er = *erosion;
  for (const std::uint32_t cell : dead)
    for (const std::uint32_t a : er.nodes[cell])
      if (--er.cells_of_node[a] == 0 && a < nodal_state.n_owned)
        er.free_node[a] = 1;
  // Faces of dead cells go, faces of the living behind them come.
  std::size_t kept = 0;
  for (std::size_t f = 0; f < boundary_faces.size(); ++f)
    if (er.alive[er.face_cell[f]])
    {
      boundary_faces[kept] = boundary_faces[f];
      boundary_face_id[kept] = boundary_face_id[f];
      er.face_cell[kept++] = er.face_cell[f];
    }
  boundary_faces.resize(kept);
  boundary_face_id.resize(kept);
  er.face_cell.resize(kept);
  for (const std::uint32_t cell : dead)
    for (const std::int32_t other : er.across[cell])
    {
      if (other < 0 || !er.alive[other])
        continue;
      const auto &back = er.across[other];
      const int f = std::find(back.begin(), back.end(), std::int32_t(cell)) -
                    back.begin();
      std::array<std::size_t, 4> face;
      for (int a = 0; a < 4; ++a)
        face[a] = er.nodes[other][face_corner[f][a]];
      boundary_faces.push_back(face);
      boundary_face_id.push_back(er.n_boundary_faces + 6 * er.id[other] + f);
      er.face_cell.push_back(other);
    }
}

void FemBody::compact()
{
  Erosion &er = *erosion;
  std::vector<std::size_t> kept;
  for (std::size_t e = 0; e < cells->size(); ++e)
    if (er.alive[er.initial[e]])
    {
      owned_cell[kept.size()] = owned_cell[e];
      er.initial[kept.size()] = er.initial[e];
      kept.push_back(e);
    }
  owned_cell.resize(kept.size());
  er.initial.resize(kept.size());
  cells->keep(kept);
}

void FemBody::visit_erosion(StateVisitor &visitor)
{
  Erosion &er = *erosion;
  // A reader must know which cells are left before it fills their arrays.
  visitor.visit_array("alive cells", er.alive);
  if (visitor.is_restoring())
  {
    std::vector<std::uint32_t> dead;
    for (const std::uint32_t cell : er.initial)
      if (!er.alive[cell])
        dead.push_back(cell);
    update_boundary(dead);
    compact();
  }
  // In the order in which cells died.
  visitor.visit_resized("boundary faces", boundary_faces);
  visitor.visit_resized("boundary face ids", boundary_face_id);
  visitor.visit_resized("cells of boundary faces", er.face_cell);
  visitor.visit_value("eroded mass", er.mass);
  visitor.visit_value("eroded energy", er.energy);
  visitor.visit_value("eroded plastic work", er.plastic_work);
  visitor.visit_value("eroded cells", er.n_cells);
  visitor.visit_value("surface version", surface_version);
}

void FemBody::add_erosion_measures(BodyMeasures &measures) const
{
  ExactSum mass = erosion->mass, n_cells = erosion->n_cells, free_mass, kinetic,
           momentum[3];
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    if (erosion->free_node[i])
    {
      const double m = nodal_state.lumped_mass[i];
      const Vec v = nodal_state.velocity[i];
      free_mass.add(m);
      kinetic.add(0.5 * m * norm_square(v));
      for (int d = 0; d < 3; ++d)
        momentum[d].add(m * v[d]);
    }
  ExactSum::reduce({&mass, &n_cells, &free_mass, &kinetic, &momentum[0],
                    &momentum[1], &momentum[2]},
                   communicator);
  measures.eroded_mass = mass.value();
  for (int d = 0; d < 3; ++d)
    measures.eroded_momentum[d] = momentum[d].value();
  measures.own.push_back({"eroded mass", "kg", mass.value()});
  measures.own.push_back({"eroded cells", "1", n_cells.value()});
  measures.own.push_back({"free node mass", "kg", free_mass.value()});
  measures.own.push_back({"free node kinetic energy", "J", kinetic.value()});
  for (int d = 0; d < 3; ++d)
    measures.own.push_back({std::string("eroded momentum ") + "xyz"[d],
                            "kg m/s", momentum[d].value()});
}
} // namespace sabot
