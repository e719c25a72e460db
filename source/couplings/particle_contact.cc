// Contact between bodies of particles.
#include "sabot/couplings/particle_contact.h"

#include "sabot/couplings/contact_search.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
ParticleContact::ParticleContact(const std::string &name,
                                 const std::vector<Body *> &bodies,
                                 const std::vector<std::pair<int, int>> &pairs,
                                 const ContactOptions &options,
                                 MPI_Comm communicator)
    : Coupling(name), bodies(bodies), pairs(pairs), options(options),
      communicator(communicator), shared_work(pairs, communicator)
{
  forces.pairs = PairForces(pairs, bodies);
}

void ParticleContact::initialize()
{
  way.skin = 1e300;
  symmetry_planes.resize(bodies.size());
  for (const auto &[a, b] : pairs)
    for (const int body : {a, b})
    {
      const ContactSurface its = bodies[body]->contact_surface();
      symmetry_planes[body] = its.symmetry_planes;
      way.skin = std::min(way.skin, 0.4 * its.spacing);
    }
  search();
  update_halo();
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    const Standing at = locate(groups[g], slots[g]);
    if (at.fade > 0.)
      over_spacing.initial =
          std::max(over_spacing.initial, -at.gap / groups[g].spacing);
  }
  MPI_Allreduce(MPI_IN_PLACE, &over_spacing.initial, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
}

void ParticleContact::update_search(const unsigned int, const double dt)
{
  age.traveled += age.closing_speed.largest(bodies, pairs, communicator) * dt;
  // Bodies that grow have new particles at once.
  if (age.traveled > way.allowance || age.have_changed(bodies))
    search();
}

double ParticleContact::largest_friction(const Group &group,
                                         const Slots &at) const
{
  if (!options.shear_strength.needs_flow_stress())
    return options.shear_strength.value() * group.area;
  double its = 0.;
  for (const NearParticle &p : near)
    its += p.weight * flow_stress[p.slot];
  return ShearStrength::of_metals(flow_stress[at.node], its) * group.area;
}

void ParticleContact::update_halo()
{
  halo.update();
  for (std::size_t s = 0; s < halo.n_owned(); ++s)
  {
    const ParticleView &body = *halo.body(s).particles();
    if (is_on_surface[s])
      surface[s] = body.surface_point(halo.local(s));
    volume[s] = body.volume_point(halo.local(s));
    volume[s].content /= share[s];
  }
  halo.update_ghosts(surface.data());
  halo.update_ghosts(volume.data());
}

void ParticleContact::gather_near(const Group &group, const Slots &at,
                                  const Vec x)
{
  near.clear();
  images.find(symmetry_planes[group.other], x,
              2. * ParticleSearch::reach * group.its_spacing);
  for (std::size_t m = at.first_member; m < at.last_member; ++m)
  {
    const std::size_t slot = member_slots[m];
    const Vec its = halo.position[slot];
    for (unsigned int image = 0; image < images.size(); ++image)
      if (share[slot] == 1. ||
          !images.repeats(its, image, 1e-6 * group.its_spacing))
        near.push_back({slot, images.axes(image), x - images(its, image), 0.});
  }
}

Standing ParticleContact::locate(const Group &group, const Slots &at)
{
  gather_near(group, at, halo.position[at.node]);
  if (group.is_sound)
  {
    const Standing standing = stand_on_surface(
        {surface[at.node], group.memory.side, group.memory.depth > 0.}, near,
        surface);
    if (standing.fade > 0.)
      return standing;
  }
  return stand_in_volume(near, volume);
}

void ParticleContact::find_motion(const Slots &at, ContactPoint &point) const
{
  // What of the whole's reduced mass is in the model.
  double compliance = share[at.node] / halo.inertia[at.node];
  const AlignedVector<Vec> &start = halo.start_velocity();
  Vec v = halo.velocity[at.node], first = start[at.node];
  for (const NearParticle &p : near)
  {
    v -= p.weight * flipped(halo.velocity[p.slot], p.turned);
    first -= p.weight * flipped(start[p.slot], p.turned);
    compliance += p.weight * p.weight * share[p.slot] / halo.inertia[p.slot];
  }
  point.velocity = v;
  point.first_velocity = first;
  point.reduced_mass = share[at.node] / compliance;
}

void ParticleContact::press(const std::size_t number, const double dt)
{
  Group &group = groups[number];
  const Slots &at = slots[number];
  const Standing standing = locate(group, at);
  ContactMemory &memory = group.memory;
  n_deep += standing.is_deep && at.node < halo.n_owned();
  if (standing.fade > 0.)
    memory.side = standing.normal;
  if (!is_step(dt))
  {
    if (standing.gap > -1e-6 * group.spacing)
      memory.release();
    return;
  }
  if (standing.fade <= 0. || standing.gap >= 0.)
    return memory.release();
  ContactPoint point;
  point.item = number;
  point.normal = standing.normal;
  point.fade = standing.fade;
  find_motion(at, point);
  point.depth =
      memory.effective_depth(-standing.gap, 2. * point.largest_speed() * dt);
  if (point.depth <= 0.)
    return;
  point.stiffness = options.stable_stiffness(
      group.stiffness, point.reduced_mass, points.steady_step.value);
  point.area = group.area;
  point.largest_friction = largest_friction(group, at);
  point.memory = &memory;
  point.pair = shared_work.number_of(group.node.body, group.other);
  point.is_owned = at.node < halo.n_owned();
  point.first_touched = touched.size();
  for (const NearParticle &p : near)
    if (p.weight != 0.)
      touched.push_back(p);
  point.last_touched = touched.size();
  points.add(point);
  over_spacing.largest =
      std::max(over_spacing.largest, point.depth / group.spacing);
}

void ParticleContact::push(const ContactPoint &point)
{
  const std::size_t node = slots[point.item].node;
  const Vec normal = point.normal_force(), friction = point.friction_force();
  forces.normal[node] += normal;
  forces.friction[node] += friction;
  for (std::size_t i = point.first_touched; i < point.last_touched; ++i)
  {
    const NearParticle &p = touched[i];
    forces.normal[p.slot] -= p.weight * flipped(normal, p.turned);
    forces.friction[p.slot] -= p.weight * flipped(friction, p.turned);
    if (forces.pairs.any())
    {
      const Vec part = p.weight * (normal + friction);
      forces.pairs.add(halo, node, p.slot, part);
      forces.pairs.add(halo, p.slot, node, -1. * flipped(part, p.turned));
    }
  }
}

void ParticleContact::add_forces(const double dt)
{
  update_halo();
  forces.clear();
  n_deep = 0;
  points.clear();
  touched.clear();
  points.steady_step.follow(dt);
  for (std::size_t g = 0; g < groups.size(); ++g)
    press(g, dt);
  points.find_forces(options, dt, &shared_work);
  for (const ContactPoint &point : points)
    push(point);
  forces.add_to_bodies(halo);
}

void ParticleContact::accumulate_work(const double half_dt)
{
  forces.accumulate_work(halo, half_dt);
}

void ParticleContact::add_energies(EnergyLedger &ledger) const
{
  forces.add_energies(ledger);
}

Measures ParticleContact::measure() const
{
  double penetration = over_spacing.largest;
  MPI_Allreduce(MPI_IN_PLACE, &penetration, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
  GlobalIndex deep = n_deep;
  MPI_Allreduce(MPI_IN_PLACE, &deep, 1, MPI_INT64_T, MPI_SUM, communicator);
  Measures measures = {
      {"penetration max over spacing", "1", penetration},
      {"initial penetration over spacing", "1", over_spacing.initial},
      {"nodes deep inside", "1", double(deep)}};
  forces.add_measures(measures, communicator);
  return measures;
}

void ParticleContact::visit_state(StateVisitor &visitor)
{
  age.visit_state(visitor);
  visitor.visit_value("allowance", way.allowance);
  visitor.visit_largest("penetration", over_spacing.largest);
  visitor.visit_value("steady step", points.steady_step.value);
  shared_work.visit_state(visitor);
  // Candidates were found where the bodies were at the last search.
  std::vector<Group> saved;
  std::vector<Member> its;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (slots[g].node < halo.n_owned())
    {
      saved.push_back(groups[g]);
      its.insert(its.end(), members.begin() + slots[g].first_member,
                 members.begin() + slots[g].last_member);
    }
  visitor.visit_all("groups", saved);
  visitor.visit_all("members", its);
  if (visitor.is_restoring())
  {
    keep_relevant(saved, its);
    build_halo();
    if (options.shear_strength.needs_flow_stress())
      flow_stress.resize(halo.size());
  }
  const std::vector<GlobalIndex> keys = halo.numbers();
  const StateItems of_slots = {visitor.section + "/slots", keys.data(),
                               halo.n_owned(), halo.size()};
  visitor.visit_keys(of_slots);
  visitor.visit_items("flow stress", flow_stress, of_slots);
  forces.visit_state(visitor, halo, of_slots);
}
} // namespace sabot
