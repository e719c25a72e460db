// What a FEM body reports of itself: measures, fields, bytes of its arrays.
#include "sabot/bodies/body_report.h"
#include "sabot/bodies/fem/fem_body.h"
#include "sabot/bodies/memory_lists.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** Largest cell mean of a state variable over the cells that count, at least 0;
    0 where the law does not have it. One cell after the other: rows of
    histories take no memory per cell. */
double largest_state(const Hexahedra &cells, const std::vector<char> &counts,
                     const std::string &variable)
{
  std::size_t row = 0;
  for (const StateVariable &v : cells.states())
  {
    if (v.name == variable)
      return cells.largest_mean(row, counts);
    row += v.is_tensor ? n_symmetric : 1;
  }
  return 0.;
}
} // namespace

BodyMeasures FemBody::measure() const
{
  ExactSum internal, hourglass;
  double top[2] = {
      largest_state(*cells, owned_cell, "effective plastic strain"),
      largest_state(*cells, owned_cell, "temperature")};
  {
    ExactTerms of_cells(internal), of_control(hourglass);
    for (std::size_t e = 0; e < cells->size(); ++e)
      if (owned_cell[e])
      {
        of_cells.add(cells->internal_energy(e));
        of_control.add(cells->hourglass_energy[e]);
      }
  }
  ExactSum::reduce({&internal, &hourglass}, communicator);
  MPI_Allreduce(MPI_IN_PLACE, top, 2, MPI_DOUBLE, MPI_MAX, communicator);
  BodyMeasures measures =
      measure_nodes(nodal_state, communicator, free_nodes());
  measures.internal_energy = internal.value();
  if (!cells->hourglass_control().empty())
    measures.control = "hourglass";
  measures.control_energy = hourglass.value();
  measures.own.push_back({"hourglass energy", "J", hourglass.value()});
  measures.own.push_back({"plastic strain max", "1", top[0]});
  // Not from the array, which a rank without cells does not have.
  if (has_state("temperature"))
    measures.own.push_back({"temperature max", "K", top[1]});
  if (erosion)
    erosion->add_measures(measures);
  add_scaling(measures);
  return measures;
}

std::vector<MaterialSite> FemBody::material_sites() const
{
  const std::vector<double> eps = cells->cell_state("effective plastic strain");
  std::vector<MaterialSite> sites;
  for (std::size_t e = 0; e < cells->size(); ++e)
    if (owned_cell[e])
    {
      MaterialSite site{};
      for (const std::uint32_t node : cells->connectivity[e])
        for (int d = 0; d < 3; ++d)
          site.reference_position[d] +=
              nodal_state.reference_position[node][d] / 8.;
      site.plastic_strain = eps.empty() ? 0. : eps[e];
      sites.push_back(site);
    }
  return sites;
}

void FemBody::fill_output(OutputMesh &out) const
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const std::size_t n_nodes = nodal_state.size();
  for (std::size_t i = 0; i < n_nodes; ++i)
    for (int d = 0; d < 3; ++d)
      out.points.push_back(nodal_state.position[i][d]);
  std::vector<std::size_t> owned;
  for (std::size_t e = 0; e < cells->size(); ++e)
    if (owned_cell[e])
    {
      owned.push_back(e);
      const auto &nodes = cells->connectivity[e];
      out.connectivity.insert(out.connectivity.end(), nodes.begin(),
                              nodes.end());
    }
  add_field(out.point_fields, "displacement", n_nodes,
            [&](const std::size_t i, const unsigned int c) {
              return nodal_state.position[i][c] -
                     nodal_state.reference_position[i][c];
            });
  if (out.point_fields.wants("velocity"))
  {
    // Forces know those of other ranks before the last kick.
    AlignedVector<Vec> velocity = nodal_state.velocity;
    node_exchange.update(velocity.data());
    add_field(out.point_fields, "velocity", n_nodes,
              [&](const std::size_t i, const unsigned int c)
              { return velocity[i][c]; });
  }
  add_material_fields(out.cell_fields, owned, cells->size(),
                      cells->cell_stress().data(), cells->cell_states().data(),
                      cells->states());
  add_field(out.cell_fields, "body", owned.size(),
            [&](std::size_t, unsigned int) { return double(id); });
  add_field(out.cell_fields, "rank", owned.size(),
            [&](std::size_t, unsigned int) { return double(rank); });
}

void Hexahedra::list_memory(MemoryTable &table) const
{
  table.add("corners of cells", connectivity);
  table.add("cell numbers", cell_id);
  table.add("volumes of the start", volume);
  table.add("hourglass energy", hourglass_energy);
  table.add("steps of cells", cell_step);
  table.add("added shares", added_share);
  sabot::list_memory(points, table);
}

void FemBody::list_memory(MemoryTable &table) const
{
  sabot::list_memory(nodal_state, table);
  cells->list_memory(table);
  table.add("owned cells", owned_cell);
  table.add("faces", boundary.faces);
  table.add("face numbers", boundary.face_id);
  table.add("cells of faces", known_cell_of_faces);
}
} // namespace sabot
