// The SPG body: composes its rooms, drives kernel updates, and shows itself to
// couplings.
#include "sabot/bodies/spg/spg_body.h"

#include "sabot/bodies/spg/crack_update.h"
#include "sabot/bodies/spg/failure/crumbled_neighbors.h"
#include "sabot/bodies/spg/failure/gaping_volume.h"
#include "sabot/bodies/spg/failure/release_stress.h"
#include "sabot/bodies/spg/image_rows.h"
#include "sabot/bodies/spg/neighbor_search.h"
#include "sabot/bodies/spg/smooth_reference.h"
#include "sabot/bodies/spg/spg_mass_scaling.h"

#include <algorithm>
#include <stdexcept>

namespace sabot
{
namespace
{
MirrorPlanes images_of(const ParticleCloud &cloud,
                       const ParticleSurface &surface)
{
  // As for fragments: particles are a spacing apart.
  constexpr double within = 1e-3;
  return {surface.planes(), cloud.position,
          within *
              *std::min_element(cloud.spacing.begin(), cloud.spacing.end())};
}
} // namespace

SpgBody::SpgBody(const std::string &name, const int id, ParticleCloud cloud,
                 std::shared_ptr<const Material> material,
                 const SpgOptions &options,
                 std::shared_ptr<const SplitMesh> lattices)
    : ScaledBody(name, id), cloud(std::move(cloud)), options(options),
      n_global(options.grows ? 0 : this->cloud.position.size()),
      points(std::move(material)), kernel(options, this->cloud),
      approximation(options), surface(this->cloud, options, "Bodies/" + name),
      mirror(images_of(this->cloud, surface)),
      stabilization(options.stabilization()), failure(options),
      residual_strength(options.residual_strength()), parts{this->name,
                                                            this->options,
                                                            nodal_state,
                                                            node_exchange,
                                                            mirror,
                                                            reaction,
                                                            bonds,
                                                            fields,
                                                            points,
                                                            kernel,
                                                            approximation,
                                                            failure,
                                                            *residual_strength,
                                                            stable,
                                                            constraints,
                                                            work,
                                                            watch},
      views(parts, surface, *stabilization, rank_of, communicator)
{
  if (mirror.any())
    reaction = std::make_unique<ImageReaction>(mirror.across());
  if (options.grows)
    intake = std::make_unique<ParticleIntake>(
        ParticleIntake::Rooms{{parts},
                              this->cloud,
                              std::move(lattices),
                              kernel,
                              approximation,
                              stable,
                              surface,
                              *stabilization,
                              rank_of,
                              node_owner,
                              n_global,
                              communicator,
                              [this](const unsigned int step)
                              { update_kernel_and_forces(step, false); }});
  else
    outline = outline_of(this->cloud, options.symmetry_faces);
  prescribed_velocities = &constraints;
  options.failure_criterion->check(points, "Bodies/" + name);
  if (options.conducts_heat && !(points.law().conductivity() > 0.))
    throw InputError("Bodies/" + name + "/Heat conduction",
                     "the body's material has no temperature or no thermal "
                     "conductivity; set \"Thermal conductivity\" of a law "
                     "with temperature, for example 167 W/m/K");
}

namespace
{
/** Owned nodes at their places of the start, with masses rho V. */
void start_nodes(const std::vector<std::array<double, 3>> &position,
                 const std::vector<GlobalIndex> &ids,
                 const std::vector<double> &volume, const double density,
                 const std::array<double, 3> &velocity, NodalState &nodes)
{
  nodes.resize(ids.size());
  nodes.n_owned = ids.size();
  nodes.global_id = ids;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const auto &p = position[ids[i]];
    nodes.reference_position[i] = nodes.position[i] = vec(p[0], p[1], p[2]);
    nodes.velocity[i] = vec(velocity[0], velocity[1], velocity[2]);
    nodes.force[i] = Vec{};
    nodes.lumped_mass[i] = nodes.inertia[i] = density * volume[i];
  }
}
} // namespace

void SpgBody::distribute(const std::vector<int> &owner, MPI_Comm comm)
{
  communicator = comm;
  rank_of = owner;
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::vector<GlobalIndex> ids;
  for (std::size_t i = 0; i < owner.size(); ++i)
    if (owner[i] == rank)
      ids.push_back(i);
  if (intake)
    ids.clear();
  const std::size_t n = ids.size();
  const AlignedVector<Mat> kernels = kernel.initial_kernels(cloud);
  BondList::Rows rows;
  try
  {
    rows = rows_with_images(cloud.position, kernels,
                            options.has_tensor_kernel(), mirror, ids);
  }
  catch (const std::invalid_argument &e)
  {
    throw InputError("Bodies/" + name, e.what());
  }
  const Material &law = points.law();
  std::vector<double> volume(n);
  for (std::size_t i = 0; i < n; ++i)
    volume[i] = cloud.volume[ids[i]];
  start_nodes(cloud.position, ids, volume, law.density(),
              options.initial_velocity, nodal_state);
  surface.distribute(cloud, ids, options.clamped_faces, constraints);
  kernel.distribute(kernels, ids);
  if (intake)
    intake->set_up();
  else
    cloud = ParticleCloud();
  fields.allocate(volume, law.stiffens());
  fields.note_planes(mirror, nodal_state);
  if (reaction)
    reaction->extend(n);
  // Before the calibration, which takes the most memory of all.
  std::vector<double>().swap(volume);
  std::vector<GlobalIndex>().swap(ids);
  points.allocate(n, n);
  approximation.allocate(n);
  failure.allocate(n, *residual_strength);
  stable.allocate(n);
  stabilization->allocate(parts);
  renumber(std::move(rows));

  kernel.start(fields, node_exchange);
  fields.kernel_reference_position = nodal_state.position;
  update_functions();
  failure.judge(approximation.lost_direction, *residual_strength);
  if (options.stores_gradients())
    approximation.set_convex_masses(nodal_state, bonds, node_exchange);
  if (options.mass_scaling.is_on())
    scaling = std::make_unique<SpgMassScaling>(
        options.mass_scaling, parts, stable, *stabilization, communicator);
  stable.estimate(parts, *stabilization);
  if (n_global > 1)
    stable.calibrate(parts, *stabilization, 0, true, communicator);
  heat.set_up(parts, failure, communicator);
}

void SpgBody::renumber(BondList::Rows rows)
{
  const std::size_t n = nodal_state.n_owned;
  std::vector<GlobalIndex> ids(nodal_state.global_id.begin(),
                               nodal_state.global_id.begin() + n);
  std::vector<GlobalIndex> ghosts;
  if (n < static_cast<std::size_t>(n_global) || mirror.any())
    ghosts = BondList::ghosts_of(rows, ids);
  std::vector<int> ghost_owner;
  for (const GlobalIndex g : ghosts)
    ghost_owner.push_back(rank_of[MirrorPlanes::particle_of(g)]);
  node_exchange =
      ParticleExchange(mirror, nodal_state, ghosts, ghost_owner, communicator);
  ids.insert(ids.end(), ghosts.begin(), ghosts.end());
  nodal_state.resize(ids.size());
  nodal_state.global_id = ids;
  nodal_state.n_images = node_exchange.n_images();
  node_exchange.update_positions(nodal_state.reference_position.data());
  node_exchange.update_positions(nodal_state.position.data());
  node_exchange.update(nodal_state.velocity.data());
  node_exchange.update(nodal_state.lumped_mass.data());
  node_exchange.update(nodal_state.inertia.data());
  if (mirror.any())
    bonds.reflect_in(mirror, mirror.planes_of(nodal_state));
  bonds.connect(std::move(rows), ids, ghost_owner, n_global, communicator);
  fields.resize(ids.size());
  failure.renew_ghosts(node_exchange, ids.size());
  stabilization->carry_bonds(bonds);
  bonds.settle();
  stabilization->renew_ghosts(parts);
}

void SpgBody::update_ghosts()
{
  node_exchange.update_positions(nodal_state.position.data());
}

void SpgBody::compute_forces(const double /*time*/, const double dt)
{
  const std::size_t n = watch.n_updates;
  watch = StepWatch();
  watch.n_updates = n;
  std::fill(fields.own_step.begin(), fields.own_step.end(), watch.stable_step);
  evaluate_forces(dt);
  // Only now: the other ranks wait for the exchanges of the loop.
  if (!watch.problem.empty())
    throw PhysicsError(watch.problem);
}

void SpgBody::evaluate_forces(const double dt)
{
  watch.restart();
  if (reaction)
    reaction->settle(fields.own_force);
  stabilization->compute_forces(parts, dt);
  std::copy_n(nodal_state.force.begin(), nodal_state.n_owned,
              fields.own_force.begin());
}

void SpgBody::accumulate_work(const double half_dt)
{
  // Of a body that makes substeps a kick of the scene has that part.
  const double part =
      nodal_state.kick_change.empty() ? 1. : 1. / nodal_state.n_substeps;
  if (reaction)
    reaction->wait(part * half_dt);
}

std::vector<Resultant> SpgBody::reactions() const
{
  if (!reaction)
    return {};
  return {reaction->resultant(id, fields.own_force, communicator)};
}

StableStep SpgBody::stable_step() const
{
  return {watch.stable_step, watch.stable_step_item};
}

double SpgBody::largest_frequency(const unsigned int n)
{
  return sabot::largest_frequency(parts, *stabilization, n, communicator);
}

bool SpgBody::update_topology(const unsigned int step, const double time)
{
  // Regular updates where something has deformed; at once where a particle has
  // been stretched by much or a bond fails. All ranks must agree.
  const bool regular = kernel.is_regular_step(step),
             looks = failure.is_due(step) || regular;
  const auto find_failed = [&]
  {
    return failure.find(nodal_state, bonds, fields, points, node_exchange,
                        communicator);
  };
  constexpr double by_cracks = 1., by_strain = 2.;
  double due = kernel.has_changed(watch.largest_change) ||
                       (regular && kernel.has_strained(fields))
                   ? by_strain
                   : 0.;
  if (looks && find_failed())
    due = std::max(due, by_cracks);
  MPI_Allreduce(MPI_IN_PLACE, &due, 1, MPI_DOUBLE, MPI_MAX, communicator);
  if (due > 0.)
  {
    if (!looks)
      find_failed();
    update_kernel_and_forces(step, due == by_cracks);
  }
  stabilization->after_step(parts, step);
  heat.advance(time, options.conduction_interval, points);
  return due > 0.;
}

void SpgBody::update_kernel_and_forces(const unsigned int step,
                                       const bool only_cracks)
{
  CrackUpdate cracks(parts, approximation, *stabilization, stable,
                     communicator);
  const bool leaves_kernels = only_cracks && cracks.may_leave_kernels(step) &&
                              !(intake && intake->is_waiting());
  const CrackUpdate::Rest rest =
      leaves_kernels ? cracks.update(step) : CrackUpdate::Rest::all_kernels;
  if (rest == CrackUpdate::Rest::nothing)
    return;
  // The next step begins with half a kick by these forces, and the ledger will
  // count the work that the new bonds and functions do along it.
  const std::size_t n = nodal_state.n_owned;
  AlignedVector<Vec> added(n);
  for (std::size_t i = 0; i < n; ++i)
    added[i] = nodal_state.force[i] - fields.own_force[i];
  if (rest == CrackUpdate::Rest::all_kernels)
    update_kernel(step, only_cracks);
  evaluate_forces(no_step); // no problem where nothing is deformed yet
  for (std::size_t i = 0; i < n; ++i)
    nodal_state.force[i] += added[i];
}

void SpgBody::update_functions()
{
  approximation.update(bonds, fields, kernel,
                       stabilization->second_derivatives());
  stabilization->follow_functions(parts);
}

void SpgBody::update_kernel(const unsigned int step, const bool only_cracks)
{
  const std::size_t n = nodal_state.n_owned;
  stabilization->begin_kernel_update(parts);
  stable.carry(fields);
  const std::optional<AlignedVector<Vec>> sawtooth =
      find_sawtooth(parts, communicator);
  kernel.follow(fields);
  bound_gaping_volumes(parts);
  if (failure.keeps_crumbled())
    for (std::size_t i = 0; i < n; ++i)
      if (failure.has_crumbled(i))
        fields.kernel[i] = kernel.round_kernel();
  node_exchange.update(fields.kernel.data());
  std::vector<double> held(n);
  for (std::size_t i = 0; i < n; ++i)
    held[i] = stabilization->held_energy(parts, i);
  const std::vector<std::uint32_t> failed_before = failure.n_failed;
  std::vector<char> lost_before = approximation.lost_direction;
  const std::vector<char> failed_already = failure.is_failed;
  failure.count(nodal_state, bonds, node_exchange);
  const bool renews = failure.renews_crumbled(communicator),
             searches = options.neighbor_policy !=
                        SpgOptions::NeighborPolicy::lagrangian;
  // Rows of crumbled metal come without the bonds that failed.
  if ((searches || !renews) && failure.remove(bonds))
    stabilization->carry_bonds(bonds);
  bonds.settle();
  if (searches)
  {
    renumber(search_neighbors(parts, communicator));
    node_exchange.update(fields.kernel.data());
  }
  if (renews)
  {
    renumber(renew_crumbled_neighbors(nodal_state, bonds, failure, kernel,
                                      mirror, communicator));
    failure.forget_marks();
    node_exchange.update(fields.kernel.data());
  }
  const bool grows = intake && intake->is_waiting();
  if (grows)
  {
    renumber(intake->grow());
    node_exchange.update(fields.kernel.data());
    heat.set_up(parts, failure, communicator);
    lost_before.resize(nodal_state.n_owned, 0);
  }

  fields.kernel_reference_position = nodal_state.position;
  if (sawtooth)
  {
    for (std::size_t i = 0; i < n; ++i)
      fields.kernel_reference_position[i] -= (*sawtooth)[i];
    node_exchange.update_positions(fields.kernel_reference_position.data());
  }
  update_functions();
  if (sawtooth)
    settle_gradients(parts);
  stabilization->end_kernel_update(parts, lost_before);
  failure.judge(approximation.lost_direction, *residual_strength);
  for (std::size_t i = 0; i < n; ++i)
  {
    const bool just_lost = approximation.lost_direction[i] && !lost_before[i];
    if (failure.is_failed[i] && !failed_already[i])
      release_stress(parts, i);
    if (just_lost || failure.n_failed[i] != failed_before[i])
      failure.loss[i] += held[i] - stabilization->held_energy(parts, i);
  }
  // Where nothing but cracks calls for the update, metal away from them has
  // hardly changed since the last one; all are measured every interval.
  only_cracks && !searches && !grows && !kernel.is_regular_step(step)
      ? stable.estimate_beside_cracks(parts, *stabilization)
      : stable.estimate(parts, *stabilization);
  ++watch.n_updates;
  const bool has_grown = intake && intake->has_grown_much();
  if (n_global > 1 &&
      (has_grown || stable.calibration_is_due(parts, step, communicator)))
    stable.calibrate(parts, *stabilization, step, !stable.is_calibrated(),
                     communicator);
}
} // namespace sabot
