// What an SPG body shows: energies, measures, fields, checkpoint, and its
// particles as parts of a surface.
#include "sabot/base/output_fields.h"
#include "sabot/bodies/body_report.h"
#include "sabot/bodies/spg/spg_body.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace sabot
{
void SpgBody::add_energies(EnergyLedger &ledger) const
{
  const std::size_t n = nodal_state.n_owned;
  {
    ExactTerms kinetic(ledger.kinetic);
    for (std::size_t i = 0; i < n; ++i)
      kinetic.add(0.5 * nodal_state.inertia[i] *
                  norm_square(nodal_state.velocity[i]));
  }
  ledger.internal.add(points.internal_energy.data(), n);
  ledger.stabilization.add(stabilization->work().data(), n);
  ledger.plastic_work.add(points.plastic_work.data(), n);
  ledger.failure.add(failure.loss.data(), n);
  add_scaling(ledger);
  ledger.rubble_friction.add(failure.friction_work.data(),
                             failure.friction_work.size());
}

BodyMeasures SpgBody::measure() const
{
  const double *const eps = points.state("effective plastic strain");
  const double *const temperature = points.state("temperature");
  ExactSum internal, stabilized, of_failed, plastic, lost, bonds_failed,
      bonds_all, n_weak, n_isolated, fallbacks;
  fallbacks.add(approximation.n_fallbacks());
  double top[2] = {0., 0.};
  const std::size_t n = nodal_state.n_owned;
  const double *const stabilization_work = stabilization->work().data();
  internal.add(points.internal_energy.data(), n);
  stabilized.add(stabilization_work, n);
  if (options.can_fail())
  {
    ExactTerms terms(of_failed);
    for (std::size_t i = 0; i < n; ++i)
      if (failure.is_failed[i])
        terms.add(stabilization_work[i]);
  }
  plastic.add(points.plastic_work.data(), n);
  lost.add(failure.loss.data(), n);
  // Of numbers up to 2^53 any sum is exact.
  std::size_t failed = 0, all = 0, weak = 0, isolated = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    failed += failure.n_failed[i];
    all += failure.n_holding(bonds, i) + failure.n_failed[i];
    weak += approximation.lost_direction[i] != 0;
    isolated += bonds.n_bonds(i) == 0;
    top[0] = std::max(top[0], eps ? eps[i] : 0.);
    top[1] = std::max(top[1], temperature ? temperature[i] : 0.);
  }
  bonds_failed.add(failed);
  bonds_all.add(all);
  n_weak.add(weak);
  n_isolated.add(isolated);
  ExactSum::reduce({&internal, &stabilized, &of_failed, &plastic, &lost,
                    &bonds_failed, &bonds_all, &n_weak, &n_isolated,
                    &fallbacks},
                   communicator);
  MPI_Allreduce(MPI_IN_PLACE, top, 2, MPI_DOUBLE, MPI_MAX, communicator);
  BodyMeasures measures = measure_nodes(nodal_state, communicator);
  measures.internal_energy = internal.value();
  measures.control = "stabilization";
  measures.control_energy = stabilized.value();
  measures.control_in_failed = of_failed.value();
  measures.own.push_back({"stabilization energy", "J", stabilized.value()});
  measures.own.push_back({"plastic work", "J", plastic.value()});
  if (options.can_fail())
    measures.own.push_back({"failure energy", "J", lost.value()});
  measures.own.push_back({"plastic strain max", "1", top[0]});
  const double n_bonds = bonds_all.value();
  measures.bonds_broken_fraction =
      n_bonds > 0. ? bonds_failed.value() / n_bonds : 0.;
  measures.own.push_back(
      {"bonds broken fraction", "1", measures.bonds_broken_fraction});
  measures.own.push_back({"bonds broken", "1", 0.5 * bonds_failed.value()});
  measures.own.push_back({"weak particles", "1", n_weak.value()});
  measures.own.push_back({"isolated particles", "1", n_isolated.value()});
  if (options.stores_gradients())
    measures.own.push_back({"approximation fallbacks", "1", fallbacks.value()});
  if (points.has_state("temperature"))
    measures.own.push_back({"temperature max", "K", top[1]});
  add_scaling(measures);
  return measures;
}

BodyFacts SpgBody::facts() const
{
  BodyFacts facts;
  facts.material = &points.law();
  facts.is_particles = true;
  facts.is_clamped = options.clamped_faces != 0;
  facts.velocity = options.initial_velocity;
  const bool flies =
      options.initial_velocity != std::array<double, 3>{{0., 0., 0.}};
  facts.moves_by_itself = flies && facts.is_clamped;
  facts.spacing = kernel.axis_spacing();
  facts.may_fail = options.can_fail();
  facts.failure_strain =
      options.failure_criterion->critical_plastic_strain(points.law());
  if (!options.stores_gradients())
    facts.largest_shock = options.normalized_support < BodyFacts::wide_support
                              ? BodyFacts::narrow_shock
                              : BodyFacts::wide_shock;
  return facts;
}

bool SpgBody::is_held() const
{
  return options.symmetry_faces != 0 || options.clamped_faces != 0;
}

std::vector<MaterialSite> SpgBody::material_sites() const
{
  const double *const eps = points.state("effective plastic strain");
  std::vector<MaterialSite> sites(nodal_state.n_owned);
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    const Vec X = nodal_state.reference_position[i];
    sites[i] = {{{X[0], X[1], X[2]}},
                eps ? eps[i] : 0.,
                failure.failed_fraction(bonds, i)};
  }
  return sites;
}

namespace
{
const DescribeField described[] = {
    DescribeField({"failed-bond fraction", "1", 1, "particles",
                   "Failed bonds of the particle over all it has had."}),
    DescribeField({"diameter", "m", 1, "particles",
                   "Edge of the cube that has the particle's present volume: "
                   "spheres of this size touch."}),
    DescribeField({"fragment", "1", 1, "particles whose bonds may fail",
                   "Which piece of those that bonds still hold together, from "
                   "0, the heaviest, down; of equal ones that with the lowest "
                   "number of a particle comes first."})};

/** Of an owned particle [m^3]. */
double present_volume(const ParticleFields &fields, const std::size_t i)
{
  return determinant(fields.incremental_deformation_gradient[i]) *
         fields.kernel_reference_volume[i];
}

/** Of every label its place among the @p pieces, which are sorted by size. */
std::vector<double> size_ranks(const std::vector<GlobalIndex> &labels,
                               const std::vector<Fragment> &pieces)
{
  std::unordered_map<GlobalIndex, std::size_t> rank;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    rank[pieces[p].label] = p;
  std::vector<double> ranks;
  for (const GlobalIndex label : labels)
    ranks.push_back(rank.at(label));
  return ranks;
}
} // namespace

void SpgBody::fill_output(OutputMesh &mesh) const
{
  const std::size_t n = nodal_state.n_owned;
  int rank;
  MPI_Comm_rank(communicator, &rank);
  mesh.nodes_per_cell = 1;
  std::vector<std::size_t> items(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    items[i] = i;
    for (int d = 0; d < 3; ++d)
      mesh.points.push_back(nodal_state.position[i][d]);
    mesh.connectivity.push_back(i);
  }
  FieldList &at_points = mesh.point_fields, &out = mesh.cell_fields;
  add_field(at_points, "displacement", n,
            [&](const std::size_t i, const unsigned int c) {
              return nodal_state.position[i][c] -
                     nodal_state.reference_position[i][c];
            });
  add_field(at_points, "velocity", n,
            [&](const std::size_t i, const unsigned int c)
            { return nodal_state.velocity[i][c]; });
  add_field(at_points, "diameter", n,
            [&](const std::size_t i, const unsigned int)
            { return std::cbrt(present_volume(fields, i)); });
  points.add_fields(out, items);
  add_field(out, "failed-bond fraction", n,
            [&](const std::size_t i, const unsigned int)
            { return failure.failed_fraction(bonds, i); });
  if (options.can_fail() && out.wants("fragment"))
  {
    const std::vector<double> ranks =
        size_ranks(views.piece_labels(), views.connected_pieces());
    add_field(out, "fragment", n,
              [&](const std::size_t i, const unsigned int)
              { return ranks[i]; });
  }
  add_field(out, "body", n,
            [&](std::size_t, unsigned int) { return double(id); });
  add_field(out, "rank", n,
            [&](std::size_t, unsigned int) { return double(rank); });
}

ContactSurface SpgBody::contact_surface() const
{
  return surface.contact_surface(points.law().bulk_modulus(),
                                 kernel.mean_spacing());
}

std::vector<double>
SpgBody::flow_stress(const std::vector<std::size_t> &some_nodes) const
{
  FlowStressProbe probe(points.law());
  for (const std::size_t i : some_nodes)
    points.add_to(probe, i,
                  present_volume(fields, i) / fields.reference_volume[i]);
  return probe.flow_stress();
}

namespace
{
/** Rows of neighbors as they were saved, of the particles that are @p owned
    now. */
BondList::Rows restored_rows(StateVisitor &visitor, const StateItems &owned,
                             const std::string &name)
{
  std::vector<std::uint32_t> lengths(owned.n_held);
  visitor.visit_items("bond count", lengths, owned);
  std::vector<std::size_t> starts = {0};
  for (const std::uint32_t n : lengths)
    starts.push_back(starts.back() + n);
  const StateRows shape = {owned, name, starts.data(), lengths.data()};
  visitor.visit_shape(shape);
  std::vector<GlobalIndex> neighbors(starts.back());
  visitor.restore_neighbors("bond neighbor", neighbors.data(), neighbors.size(),
                            shape);
  BondList::Rows rows;
  for (std::size_t i = 0; i < lengths.size(); ++i)
  {
    rows.add(neighbors.begin() + starts[i], neighbors.begin() + starts[i + 1]);
    rows.end_row();
  }
  return rows;
}
} // namespace

void SpgBody::visit_bonds(StateVisitor &visitor)
{
  // The list itself is state: bonds fail, and ranks may be others now.
  StateItems owned = nodes_of_state(*this);
  owned.n_held = owned.n_saved;
  const std::string name_of_rows = "body " + name + "/bonds";
  if (visitor.is_restoring())
    renumber(restored_rows(visitor, owned, name_of_rows));
  owned.keys = nodal_state.global_id.data();
  const StateRows rows = bonds.rows(owned, name_of_rows);
  if (!visitor.is_restoring())
  {
    visitor.visit_items("bond count", bonds.count, owned);
    visitor.visit_shape(rows);
    visitor.visit_neighbors("bond neighbor", bonds.neighbor.data(),
                            bonds.capacity(), nodal_state.global_id.data(),
                            nodal_state.size(), rows);
  }
  visitor.visit_rows("bond weight", bonds.weight, rows);
  visitor.visit_rows("bond scaled weight", bonds.scaled_weight, rows);
  approximation.visit_bonds(visitor, bonds, rows);
  stabilization->visit_bonds(visitor, parts, rows);
}

namespace
{
/** What images have of their particles, from a checkpoint, which has none of
    them. Collective. */
void renew_images(SpgParts &body, Stabilization &form)
{
  for (AlignedVector<Vec> *const places :
       {&body.nodes.position, &body.fields.kernel_reference_position})
    body.exchange.update_positions(places->data());
  body.exchange.update(body.nodes.velocity.data());
  body.exchange.update(body.nodes.lumped_mass.data());
  body.exchange.update(body.nodes.inertia.data());
  body.exchange.update(body.fields.kernel.data());
  body.failure.renew_ghosts(body.exchange, body.nodes.size());
  form.renew_images(body);
}
} // namespace

void SpgBody::visit_state(StateVisitor &visitor)
{
  if (intake)
    intake->visit_state(visitor);
  visitor.visit_keys(nodes_of_state(*this));
  visit_bonds(visitor);
  const StateItems items = nodes_of_state(*this);
  if (intake)
  {
    visitor.visit_items("mass", nodal_state.lumped_mass, items);
    visitor.visit_items("reference volume", fields.reference_volume, items);
  }
  visitor.visit_items("position", nodal_state.position, items);
  visitor.visit_items("velocity", nodal_state.velocity, items);
  visitor.visit_items("force", nodal_state.force, items);
  visitor.visit_items("inertia", nodal_state.inertia, items);
  if (reaction)
  {
    visitor.visit_items("own force", fields.own_force, items);
    reaction->visit_state(visitor, items);
  }
  constraints.visit_state(visitor, name, nodal_state);
  fields.visit_state(visitor, items);
  points.visit_state(visitor, items, 1);
  approximation.visit_state(visitor, items);
  stabilization->visit_state(visitor, items);
  failure.visit_state(visitor, items);
  stable.visit_state(visitor, items);
  visitor.visit_step("stable step", watch.stable_step, watch.stable_step_item);
  visitor.visit_largest("largest change", watch.largest_change);
  visitor.visit_value("kernel updates", watch.n_updates);
  if (intake && visitor.is_restoring())
    heat.set_up(parts, failure, communicator);
  heat.visit_state(visitor);
  visit_scaling(visitor);
  if (visitor.is_restoring() && mirror.any())
    renew_images(parts, *stabilization);
}
} // namespace sabot
