// An SPG body that grows: new particles of what cells of the host give.
#include "sabot/bodies/spg/particle_intake.h"

#include "sabot/base/gather_all.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/failure/residual_strength.h"
#include "sabot/bodies/spg/image_reaction.h"
#include "sabot/bodies/spg/image_rows.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/particle_surface.h"
#include "sabot/bodies/spg/spg_options.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"
#include "sabot/bodies/spg/stable_step.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/kernels/mirrored.h"

#include <algorithm>

namespace sabot
{
void ParticleIntake::set_up()
{
  if (body.lattices)
    forget_places();
  else
    skin = body.surface.skin_of(body.cloud);
  if (body.options.symmetry_faces != 0)
    body.constraints.expect(VelocityConstraints::Holder::symmetry);
  if (body.options.clamped_faces != 0)
    body.constraints.expect(VelocityConstraints::Holder::clamp);
}

std::vector<std::size_t> ParticleIntake::failed_particles() const
{
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
    if (body.failure.has_cracks(i))
      found.push_back(i);
  return found;
}

NodalMatter::Entry ParticleIntake::content(const std::size_t i) const
{
  NodalMatter::Entry now;
  now.reference_volume = body.fields.reference_volume[i];
  now.volume = body.fields.kernel_reference_volume[i] *
               determinant(body.fields.incremental_deformation_gradient[i]);
  for (std::size_t c = 0; c < n_symmetric; ++c)
    now.stress[c] = body.points.stress_row(c)[i];
  return now;
}

void ParticleIntake::set_free(const std::size_t i)
{
  body.nodes.inertia[i] = body.nodes.lumped_mass[i];
}

std::optional<std::size_t>
ParticleIntake::particle_at(const GlobalIndex at) const
{
  const auto found = local_of_site.find(at);
  if (found == local_of_site.end())
    return std::nullopt;
  return found->second;
}

Vec ParticleIntake::free_components(const std::size_t k) const
{
  const std::uint32_t faces = body.cloud.on_face[place_of(k)];
  if (faces & body.options.clamped_faces)
    return Vec{};
  Vec free = vec(1., 1., 1.);
  const unsigned int held =
      axes_across(faces & body.options.symmetry_faces, body.cloud.face_axis);
  for (int d = 0; d < 3; ++d)
    if (held >> d & 1)
      free[d] = 0.;
  return free;
}

void ParticleIntake::take(const NodalMatter &given, const unsigned int step,
                          ExactSum &lost_energy)
{
  matter = &given;
  lost = &lost_energy;
  body.update(step);
  matter = nullptr;
  ++n_taken;
}

std::vector<std::size_t> ParticleIntake::number_new()
{
  std::vector<GlobalIndex> mine;
  std::vector<std::size_t> entries;
  for (std::size_t k = 0; k < matter->entries.size(); ++k)
  {
    const GlobalIndex at = matter->entries[k].site;
    if (local_of_site.count(at) > 0)
      continue;
    mine.push_back(at);
    entries.push_back(k);
  }
  std::vector<GlobalIndex> all = gather_all(mine, body.communicator);
  std::sort(all.begin(), all.end());
  const std::size_t first = site.size();
  site.insert(site.end(), all.begin(), all.end());
  learn_places(first);
  return entries;
}

void ParticleIntake::forget_places()
{
  // Spacing and planes stay.
  ParticleCloud empty;
  empty.spacing = body.cloud.spacing;
  empty.face_axis = body.cloud.face_axis;
  body.cloud = std::move(empty);
  skin = {};
}

void ParticleIntake::learn_places(const std::size_t first)
{
  const std::vector<GlobalIndex> fresh(site.begin() + first, site.end());
  for (const GlobalIndex at : fresh)
  {
    const GlobalIndex node =
        body.lattices ? body.lattices->carrier(at).node[0] : at;
    body.rank_of.push_back((*host_owner)[node]);
    body.node_owner.push_back((*host_owner)[node]);
  }
  body.n_global = site.size();
  if (!body.lattices || fresh.empty())
    return;
  ParticleSurface::Skin more;
  const ParticleCloud cloud = body.lattices->cloud_of(
      fresh, body.options.symmetry_faces, more.normal, more.spacing);
  const auto append = [](auto &all, const auto &some)
  { all.insert(all.end(), some.begin(), some.end()); };
  append(body.cloud.position, cloud.position);
  append(body.cloud.shape, cloud.shape);
  append(body.cloud.on_face, cloud.on_face);
  append(skin.normal, more.normal);
  append(skin.spacing, more.spacing);
}

std::vector<GlobalIndex> ParticleIntake::places() const
{
  std::vector<GlobalIndex> all;
  for (std::size_t k = 0; k < site.size(); ++k)
    all.push_back(place_of(k));
  return all;
}

void ParticleIntake::extend(const std::vector<GlobalIndex> &fresh)
{
  NodalState &nodes = body.nodes;
  const std::size_t before = nodes.n_owned, n = before + fresh.size();
  nodes.resize(before); // ghosts are numbered anew
  nodes.n_owned = n;
  nodes.resize(n);
  std::vector<GlobalIndex> where;
  for (std::size_t k = 0; k < fresh.size(); ++k)
  {
    where.push_back(place_of(fresh[k]));
    const auto &X = body.cloud.position[where[k]];
    nodes.reference_position[before + k] = vec(X[0], X[1], X[2]);
    local_of_site[site[fresh[k]]] = before + k;
  }
  body.fields.extend(n);
  body.fields.note_planes(body.mirror, nodes);
  if (body.reaction)
    body.reaction->extend(n);
  body.points.extend(n);
  body.kernel.extend(body.kernel.initial_kernels_of(body.cloud, where));
  body.approximation.extend(n);
  body.failure.extend(n, body.residual_strength);
  body.stable_step.extend(n);
  body.stabilization.extend(n);
  for (const GlobalIndex place : places())
    largest_spacing = std::max(largest_spacing, skin.spacing[place]);
  body.surface.set_largest_spacing(largest_spacing);
  body.surface.extend(body.cloud, skin, where, body.options.clamped_faces,
                      body.constraints);
}

ParticleIntake::Gift ParticleIntake::gift_to(const std::size_t i,
                                             const std::size_t entry) const
{
  const auto states = matter->states.begin() + entry * matter->n_rows;
  Gift gift{matter->entries[entry], {states, states + matter->n_rows}};
  const unsigned int axes = MirrorPlanes::held_axes(
      body.mirror.planes_at(body.nodes.reference_position[i]));
  if (axes == 0)
    return gift;
  NodalMatter::Entry &e = gift.entry;
  Mat mean = e.gradient;
  take_mean_of_images(mean, axes);
  e.gradient = mean_gradient(mean, 1., mean, 1., e.volume / e.reference_volume);
  take_mean_of_images(e.stress.data(), axes);
  std::size_t row = 0;
  for (const StateVariable &variable : body.points.law().state_variables())
  {
    if (variable.is_tensor)
      take_mean_of_images(&gift.states[row], axes);
    row += variable.is_tensor ? n_symmetric : 1;
  }
  return gift;
}

void ParticleIntake::fill_new(const std::size_t i, const std::size_t entry)
{
  const Gift gift = gift_to(i, entry);
  const NodalMatter::Entry &e = gift.entry;
  NodalState &nodes = body.nodes;
  nodes.position[i] = e.position;
  nodes.velocity[i] = e.velocity;
  nodes.force[i] = Vec{};
  nodes.lumped_mass[i] = e.mass;
  nodes.inertia[i] = e.is_bare ? e.mass : 0.;
  ParticleFields &fields = body.fields;
  fields.reference_volume[i] = e.reference_volume;
  fields.kernel_reference_volume[i] = e.volume;
  fields.kernel_reference_deformation_gradient[i] = e.gradient;
  fields.kernel[i] = body.kernel.carried_kernel(i, e.gradient);
  for (int c = 0; c < n_symmetric; ++c)
    body.points.stress_row(c)[i] = e.stress[c];
  for (std::size_t r = 0; r < matter->n_rows; ++r)
    body.points.state_row(r)[i] = gift.states[r];
  body.points.viscous_pressure[i] = e.viscous_pressure;
  body.points.plastic_work[i] = e.plastic_work;
  const double loss =
      e.elastic_energy -
      e.volume * elastic_energy_density(e.stress, body.points.law());
  body.points.internal_energy[i] = e.internal_energy - loss;
  lost->add(loss);
}

void ParticleIntake::merge(const std::size_t i, const std::size_t entry)
{
  const Gift gift = gift_to(i, entry);
  const NodalMatter::Entry &e = gift.entry;
  ParticleFields &fields = body.fields;
  MaterialPoints &points = body.points;
  const double V_0 = fields.reference_volume[i],
               V_0_sum = V_0 + e.reference_volume,
               V = fields.kernel_reference_volume[i], V_sum = V + e.volume;
  body.nodes.lumped_mass[i] += e.mass;
  fields.kernel_reference_deformation_gradient[i] =
      mean_gradient(fields.kernel_reference_deformation_gradient[i], V_0,
                    e.gradient, e.reference_volume, V_sum / V_0_sum);
  fields.reference_volume[i] = V_0_sum;
  fields.kernel_reference_volume[i] = V_sum;
  std::array<double, n_symmetric> old, mean;
  for (int c = 0; c < n_symmetric; ++c)
  {
    old[c] = points.stress_row(c)[i];
    mean[c] = (V * old[c] + e.volume * e.stress[c]) / V_sum;
    points.stress_row(c)[i] = mean[c];
  }
  for (std::size_t r = 0; r < matter->n_rows; ++r)
  {
    double &state = points.state_row(r)[i];
    state = (V_0 * state + e.reference_volume * gift.states[r]) / V_0_sum;
  }
  points.viscous_pressure[i] =
      (V * points.viscous_pressure[i] + e.volume * e.viscous_pressure) / V_sum;
  points.plastic_work[i] += e.plastic_work;
  const Material &law = points.law();
  const double loss = e.elastic_energy + V * elastic_energy_density(old, law) -
                      V_sum * elastic_energy_density(mean, law);
  points.internal_energy[i] += e.internal_energy - loss;
  lost->add(loss);
}

BondList::Rows ParticleIntake::grow()
{
  const GlobalIndex first_new = site.size();
  const std::vector<std::size_t> fresh = number_new();
  std::vector<GlobalIndex> numbers;
  for (const std::size_t entry : fresh)
    numbers.push_back(std::lower_bound(site.begin() + first_new, site.end(),
                                       matter->entries[entry].site) -
                      site.begin());
  const std::size_t before = body.nodes.n_owned;
  for (std::size_t k = 0; k < matter->entries.size(); ++k)
  {
    const auto known = local_of_site.find(matter->entries[k].site);
    if (known != local_of_site.end())
      merge(known->second, k);
  }
  BondList::Rows old_rows;
  for (std::size_t i = 0; i < before; ++i)
  {
    for (std::size_t b = body.bonds.begin(i); b < body.bonds.end(i); ++b)
      old_rows.add(body.nodes.global_id[body.bonds.neighbor[b]]);
    old_rows.end_row();
  }
  extend(numbers);
  for (std::size_t k = 0; k < fresh.size(); ++k)
  {
    const std::size_t i = before + k;
    body.nodes.global_id[i] = numbers[k];
    fill_new(i, fresh[k]);
  }
  const BondList::Rows with_new = rows_with(first_new);
  BondList::Rows rows;
  std::vector<char> has_grown(with_new.size(), 0);
  for (std::size_t i = 0; i < with_new.size(); ++i)
  {
    if (i < before)
      rows.add(old_rows[i].begin(), old_rows[i].end());
    rows.add(with_new[i].begin(), with_new[i].end());
    rows.sort_and_end_row();
    has_grown[i] = i >= before || with_new[i].size() > 0;
  }
  body.approximation.renew_intact(has_grown);
  return rows;
}

BondList::Rows ParticleIntake::rows_with(const GlobalIndex first_new) const
{
  // Of the undeformed lattice, as in a zone of the start.
  const std::vector<GlobalIndex> place = places();
  std::vector<std::array<double, 3>> points(place.size());
  for (std::size_t k = 0; k < place.size(); ++k)
    points[k] = body.cloud.position[place[k]];
  const std::vector<GlobalIndex> owned(body.nodes.global_id.begin(),
                                       body.nodes.global_id.begin() +
                                           body.nodes.n_owned);
  const BondList::Rows all = rows_with_images(
      points, body.kernel.initial_kernels_of(body.cloud, place),
      body.options.has_tensor_kernel(), body.mirror, owned);
  BondList::Rows rows;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    for (const GlobalIndex j : all[i])
      if (owned[i] >= first_new || MirrorPlanes::particle_of(j) >= first_new)
        rows.add(j);
    rows.end_row();
  }
  return rows;
}

bool ParticleIntake::has_grown_much()
{
  constexpr double much = 1.05;
  if (!(body.n_global > much * n_measured))
    return false;
  n_measured = body.n_global;
  return true;
}

void ParticleIntake::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("particles of the last calibration", n_measured);
  visitor.visit_value("times that particles came", n_taken);
  visitor.visit_resized("host nodes", site);
  if (!visitor.is_restoring())
    return;
  int rank;
  MPI_Comm_rank(body.communicator, &rank);
  body.rank_of.clear();
  body.node_owner.clear();
  if (body.lattices)
    forget_places();
  learn_places(0);
  std::vector<GlobalIndex> ids;
  for (std::size_t k = 0; k < site.size(); ++k)
    if (body.rank_of[k] == rank)
      ids.push_back(k);
  const std::size_t before = body.nodes.n_owned;
  extend({ids.begin() + before, ids.end()});
  std::copy(ids.begin(), ids.end(), body.nodes.global_id.begin());
}
} // namespace sabot
