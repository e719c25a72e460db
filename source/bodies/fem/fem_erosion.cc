// Erosion of hexahedra: criteria, removal, what is kept of the dead.
#include "sabot/bodies/fem/fem_erosion.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
FemErosion::FemErosion(const FemOptions &options, const Material &material,
                       NodalState &nodal_state, Hexahedra &cells,
                       LivingCells &living, std::vector<char> &owned_cell,
                       MPI_Comm communicator)
    : options(options), material(material), nodal_state(nodal_state),
      cells(cells), living(living), owned_cell(owned_cell),
      communicator(communicator)
{
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
  for (const std::size_t e : condemned)
  {
    if (!owned_cell[e])
      continue;
    mass.add(material.density() * cells.volume[e]);
    energy.add(cells.internal_energy(e));
    energy.add(cells.hourglass_energy[e]);
    plastic_work.add(cells.plastic_work(e));
    n_cells.add(1.);
  }
  living.take_out(condemned, true);
}

void FemErosion::visit_state(StateVisitor &visitor)
{
  visitor.visit_sum("eroded mass", mass);
  visitor.visit_sum("eroded energy", energy);
  visitor.visit_sum("eroded plastic work", plastic_work);
  visitor.visit_sum("eroded cells", n_cells);
}

void FemErosion::add_energies(EnergyLedger &ledger) const
{
  ledger.eroded.add(energy);
  ledger.plastic_work.add(plastic_work);
}

void FemErosion::add_measures(BodyMeasures &measures) const
{
  ExactSum gone = mass, n_gone = n_cells, free_mass, kinetic, momentum[3];
  const std::vector<char> &is_bare = living.bare_nodes();
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    if (is_bare[i])
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
