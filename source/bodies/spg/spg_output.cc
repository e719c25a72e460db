#include "sabot/bodies/spg/spg_body.h"

#include "sabot/bodies/body_report.h"

#include <algorithm>

namespace sabot
{
void SpgBody::add_energies(EnergyLedger &ledger) const
{
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    ledger.kinetic.add(0.5 * nodal_state.inertia[i] *
                       norm_square(nodal_state.velocity[i]));
    ledger.internal.add(internal_energy[i]);
    ledger.stabilization.add(bond_work[i]);
    ledger.plastic_work.add(plastic_work[i]);
  }
}

Measures SpgBody::measure() const
{
  const double *const eps = state_array("effective plastic strain");
  const double *const temperature = state_array("temperature");
  ExactSum internal, stabilization, bonds_now, bonds_initial, n_weak,
      n_isolated;
  double top[2] = {0., 0.};
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    internal.add(internal_energy[i]);
    stabilization.add(bond_work[i]);
    bonds_now.add(bonds.n_bonds(i));
    bonds_initial.add(bonds.n_initial(i));
    n_weak.add(weak[i]);
    n_isolated.add(bonds.n_bonds(i) == 0);
    top[0] = std::max(top[0], eps ? eps[i] : 0.);
    top[1] = std::max(top[1], temperature ? temperature[i] : 0.);
  }
  ExactSum::reduce({&internal, &stabilization, &bonds_now, &bonds_initial,
                    &n_weak, &n_isolated},
                   communicator);
  MPI_Allreduce(MPI_IN_PLACE, top, 2, MPI_DOUBLE, MPI_MAX, communicator);
  Measures measures = measure_nodes(nodal_state, communicator);
  measures.push_back({"internal energy", "J", internal.value()});
  measures.push_back({"stabilisation energy", "J", stabilization.value()});
  measures.push_back({"plastic strain max", "1", top[0]});
  const double n = bonds_initial.value();
  measures.push_back(
      {"bonds broken fraction", "1", n > 0. ? 1. - bonds_now.value() / n : 0.});
  measures.push_back({"weak particles", "1", n_weak.value()});
  measures.push_back({"isolated particles", "1", n_isolated.value()});
  if (temperature)
    measures.push_back({"temperature max", "K", top[1]});
  return measures;
}

OutputMesh SpgBody::output_mesh() const
{
  const std::size_t n = nodal_state.n_owned;
  int rank;
  MPI_Comm_rank(communicator, &rank);
  OutputMesh mesh;
  mesh.nodes_per_cell = 1;
  std::vector<std::size_t> items(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    items[i] = i;
    for (int d = 0; d < 3; ++d)
      mesh.points.push_back(nodal_state.position[i][d]);
    mesh.connectivity.push_back(i);
  }
  std::vector<OutputField> &fields = mesh.point_fields;
  add_field(fields, "displacement", "m", n, 3,
            [&](const std::size_t i, const unsigned int c) {
              return nodal_state.position[i][c] -
                     nodal_state.reference_position[i][c];
            });
  add_field(fields, "velocity", "m/s", n, 3,
            [&](const std::size_t i, const unsigned int c)
            { return nodal_state.velocity[i][c]; });
  add_material_fields(fields, items, n, stress_data, state_data,
                      state_variables);
  add_field(fields, "failed-bond fraction", "1", n, 1,
            [&](const std::size_t i, const unsigned int)
            {
              const double initial = bonds.n_initial(i);
              return initial > 0. ? 1. - bonds.n_bonds(i) / initial : 0.;
            });
  add_field(fields, "body", "1", n, 1,
            [&](std::size_t, unsigned int) { return double(id); });
  add_field(fields, "rank", "1", n, 1,
            [&](std::size_t, unsigned int) { return double(rank); });
  return mesh;
}

void SpgBody::visit_state(StateVisitor &visitor)
{
  const auto visit = [&](const std::string &array, auto &data)
  { visitor.visit(array, data.data(), data.size(), sizeof(data[0])); };
  visit("position", nodal_state.position);
  visit("velocity", nodal_state.velocity);
  visit("force", nodal_state.force);
  visit("inertia", nodal_state.inertia);
  visit("kernel position", kernel_position);
  visit("kernel", kernel);
  visit("kernel volume", kernel_volume);
  visit("gradient", gradient);
  visit("total gradient", total_gradient);
  visit("moment inverse", moment_inverse);
  visit("bond stiffness", bond_stiffness);
  visit("weak", weak);
  visit("has failed bond", has_failed_bond);
  visit("stress", stress_data);
  visit("state", state_data);
  visit("viscous pressure", viscous_pressure);
  visit("internal energy", internal_energy);
  visit("bond work", bond_work);
  visit("force on residual", force_on_residual);
  // Ghosts' bond forces come anew every step.
  visitor.visit("bond force", bonds.force.data(), bonds.capacity(),
                sizeof(bonds.force[0]));
  visit("plastic work", plastic_work);
  visit("update stable step", update_stable_step);
  visit("bond count", bonds.count);
  visit("bond neighbour", bonds.neighbor);
  visit("bond weight", bonds.weight);
  visit("bond rest", bonds.rest);
  visitor.visit("stable step", &current_stable_step, 1, sizeof(double));
  visitor.visit("largest change", &largest_change, 1, sizeof(double));
  visitor.visit("stable step item", &stable_step_item, 1, sizeof(GlobalIndex));
  visitor.visit("removed bonds", &n_removed_bonds, 1, sizeof(n_removed_bonds));
  if (visitor.is_restoring())
    bonds.reconnect();
}
} // namespace sabot
