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
    ledger.internal.add(points.internal_energy[i]);
    ledger.stabilization.add(bond_work[i]);
    if (second_gradient)
      ledger.stabilization.add(second_gradient->work[i]);
    ledger.plastic_work.add(points.plastic_work[i]);
    ledger.failure.add(failure_loss[i]);
  }
}

BodyMeasures SpgBody::measure() const
{
  const double *const eps = points.state("effective plastic strain");
  const double *const temperature = points.state("temperature");
  ExactSum internal, stabilization, plastic, failure, bonds_failed, bonds_all,
      n_weak, n_isolated, fallbacks;
  fallbacks.add(n_fallback);
  double top[2] = {0., 0.};
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    internal.add(points.internal_energy[i]);
    stabilization.add(bond_work[i] +
                      (second_gradient ? second_gradient->work[i] : 0.));
    plastic.add(points.plastic_work[i]);
    failure.add(failure_loss[i]);
    bonds_failed.add(n_failed[i]);
    bonds_all.add(bonds.n_bonds(i) + n_failed[i]);
    n_weak.add(weak[i]);
    n_isolated.add(bonds.n_bonds(i) == 0);
    top[0] = std::max(top[0], eps ? eps[i] : 0.);
    top[1] = std::max(top[1], temperature ? temperature[i] : 0.);
  }
  ExactSum::reduce({&internal, &stabilization, &plastic, &failure,
                    &bonds_failed, &bonds_all, &n_weak, &n_isolated,
                    &fallbacks},
                   communicator);
  MPI_Allreduce(MPI_IN_PLACE, top, 2, MPI_DOUBLE, MPI_MAX, communicator);
  BodyMeasures measures = measure_nodes(nodal_state, communicator);
  measures.internal_energy = internal.value();
  measures.own.push_back({"stabilisation energy", "J", stabilization.value()});
  measures.own.push_back({"plastic work", "J", plastic.value()});
  if (options.can_fail())
    measures.own.push_back({"failure energy", "J", failure.value()});
  measures.own.push_back({"plastic strain max", "1", top[0]});
  const double n = bonds_all.value();
  measures.bonds_broken_fraction = n > 0. ? bonds_failed.value() / n : 0.;
  measures.own.push_back(
      {"bonds broken fraction", "1", measures.bonds_broken_fraction});
  measures.own.push_back({"bonds broken", "1", 0.5 * bonds_failed.value()});
  measures.own.push_back({"weak particles", "1", n_weak.value()});
  measures.own.push_back({"isolated particles", "1", n_isolated.value()});
  if (options.approximation != SpgOptions::Approximation::least_squares)
    measures.own.push_back({"approximation fallbacks", "1", fallbacks.value()});
  if (points.has_state("temperature"))
    measures.own.push_back({"temperature max", "K", top[1]});
  return measures;
}

std::vector<MaterialSite> SpgBody::material_sites() const
{
  const double *const eps = points.state("effective plastic strain");
  std::vector<MaterialSite> sites(nodal_state.n_owned);
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    const Vec X = nodal_state.reference_position[i];
    const double n = bonds.n_bonds(i) + n_failed[i];
    sites[i] = {
        {{X[0], X[1], X[2]}}, eps ? eps[i] : 0., n > 0. ? n_failed[i] / n : 0.};
  }
  return sites;
}

std::size_t SpgBody::n_bonds() const
{
  std::size_t n = 0;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    n += bonds.n_bonds(i);
  return n;
}

namespace
{
const DescribeField described[] = {
    DescribeField({"failed-bond fraction", "1", 1, "particles",
                   "Failed bonds of the particle over all it has had."}),
    DescribeField({"fragment", "1", 1, "particles whose bonds may fail",
                   "Lowest number of a particle in the piece that bonds still "
                   "hold together."})};
} // namespace

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
  add_field(fields, "displacement", n,
            [&](const std::size_t i, const unsigned int c) {
              return nodal_state.position[i][c] -
                     nodal_state.reference_position[i][c];
            });
  add_field(fields, "velocity", n,
            [&](const std::size_t i, const unsigned int c)
            { return nodal_state.velocity[i][c]; });
  points.add_fields(fields, items);
  add_field(fields, "failed-bond fraction", n,
            [&](const std::size_t i, const unsigned int)
            {
              const double all = bonds.n_bonds(i) + n_failed[i];
              return all > 0. ? n_failed[i] / all : 0.;
            });
  if (options.can_fail())
  {
    const std::vector<GlobalIndex> labels = fragment_labels();
    add_field(fields, "fragment", n,
              [&](const std::size_t i, const unsigned int)
              { return double(labels[i]); });
  }
  add_field(fields, "body", n,
            [&](std::size_t, unsigned int) { return double(id); });
  add_field(fields, "rank", n,
            [&](std::size_t, unsigned int) { return double(rank); });
  return mesh;
}

void SpgBody::visit_bonds(StateVisitor &visitor)
{
  const std::size_t n = nodal_state.n_owned;
  if (options.neighbor_policy != SpgOptions::NeighborPolicy::lagrangian)
  {
    // The list itself is state.
    std::vector<std::uint32_t> lengths(n), n_pairs(n, 0);
    std::vector<GlobalIndex> neighbors, pairs;
    for (std::size_t i = 0; i < n; ++i)
    {
      lengths[i] = bonds.n_bonds(i);
      for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
        neighbors.push_back(nodal_state.global_id[bonds.neighbor[b]]);
      if (!failed_pairs.empty())
      {
        n_pairs[i] = failed_pairs[i].size();
        pairs.insert(pairs.end(), failed_pairs[i].begin(),
                     failed_pairs[i].end());
      }
    }
    visitor.visit_array("row lengths", lengths);
    visitor.visit_resized("row neighbours", neighbors);
    visitor.visit_array("failed pair counts", n_pairs);
    visitor.visit_resized("failed pairs", pairs);
    if (visitor.is_restoring())
    {
      BondList::Rows rows(n);
      auto j = neighbors.begin();
      auto pair = pairs.begin();
      for (std::size_t i = 0; i < n; ++i)
      {
        rows[i].assign(j, j + lengths[i]);
        j += lengths[i];
        if (!failed_pairs.empty())
          failed_pairs[i].assign(pair, pair + n_pairs[i]);
        pair += n_pairs[i];
      }
      renumber(rows);
    }
  }
  visitor.visit_array("bond count", bonds.count);
  visitor.visit_array("bond neighbour", bonds.neighbor);
  visitor.visit_array("bond weight", bonds.weight);
  visitor.visit_array("bond residual weight", bonds.residual_weight);
  if (visitor.is_restoring())
    bonds.reconnect();
  // Ghosts' bonds come anew.
  const auto visit = [&](const std::string &array, auto &data)
  {
    if (data.empty())
      return;
    data.resize(bonds.n_with_ghosts());
    visitor.visit(array, data.data(), bonds.capacity(), sizeof(data[0]));
    if (visitor.is_restoring())
      bonds.update_ghosts(data.data());
  };
  visit("bond residual", bonds.residual);
  visit("shape gradient", shape_gradient);
  if (second_gradient)
    visit("second gradient of bonds", second_gradient->bond_gradient);
}

void SpgBody::visit_state(StateVisitor &visitor)
{
  visit_bonds(visitor);
  const auto visit = [&](const std::string &array, auto &data)
  { visitor.visit_array(array, data); };
  visit("position", nodal_state.position);
  visit("velocity", nodal_state.velocity);
  visit("force", nodal_state.force);
  visit("inertia", nodal_state.inertia);
  visit("previous position", previous_position);
  visit("kernel position", kernel_position);
  visit("kernel", kernel);
  visit("kernel volume", kernel_volume);
  visit("gradient", gradient);
  visit("total gradient", total_gradient);
  visit("moment inverse", moment_inverse);
  visit("bond stiffness", bond_stiffness);
  visit("residual factor", residual_factor);
  visit("weak", weak);
  visit("failed bonds", n_failed);
  points.visit_state(visitor);
  visit("stiffening", stiffening);
  visit("bond work", bond_work);
  visit("failure loss", failure_loss);
  visit("update stable step", update_stable_step);
  if (second_gradient)
    second_gradient->visit_state(visit);
  visitor.visit_value("stable step", current_stable_step);
  visitor.visit_value("stable step item", stable_step_item);
  visitor.visit_value("step calibration", step_calibration);
  visitor.visit_value("initial calibration", initial_calibration);
  visitor.visit_value("last calibration", last_calibration);
  visitor.visit_value("calibrated bound", calibrated_bound);
  if (heat)
    visitor.visit_value("last conduction", last_conduction);
  visitor.visit_value("kernel updates", n_updates);
  visitor.visit_value("fallbacks", n_fallback);
  visitor.visit_value("largest change", largest_change);
}
} // namespace sabot
