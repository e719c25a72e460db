// Contact of nodes with the faces of other bodies: the parts put together.
#include "sabot/couplings/contact.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
Contact::Contact(const std::string &name, const std::vector<Body *> &bodies,
                 const std::vector<ContactPair> &pairs,
                 const ContactOptions &options, MPI_Comm communicator)
    : Coupling(name), bodies(bodies), pairs(pairs), options(options),
      communicator(communicator), faces(halo), patch(halo, faces),
      shared_work(holds_apart(), communicator)
{
  forces.pairs = PairForces(holds_apart(), bodies);
}

std::vector<std::pair<int, int>> Contact::holds_apart() const
{
  std::vector<std::pair<int, int>> body_pairs;
  for (const ContactPair &pair : pairs)
    body_pairs.emplace_back(pair.faces_of, pair.nodes_of);
  return body_pairs;
}

void Contact::initialize()
{
  update_surfaces();
  skin = 1e300;
  for (const ContactPair &pair : pairs)
    for (const int b : {pair.faces_of, pair.nodes_of})
      skin = std::min(skin, surfaces[b].spacing);
  search();
  halo.update();
  double worst = 0.;
  for (Group &group : groups)
  {
    FaceProjection projection;
    ContactMemory memory;
    PressingPlace place;
    double nearest;
    if (faces.holding(group, memory, projection, place, nearest, 0.) >= 0 &&
        place.acting_depth() / group.spacing > worst)
    {
      worst = place.acting_depth() / group.spacing;
      initial_node = halo.key(group.slot);
    }
  }
  initial_over_spacing = worst;
  MPI_Allreduce(MPI_IN_PLACE, &initial_over_spacing, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
}

void Contact::update_surfaces()
{
  surfaces.assign(bodies.size(), ContactSurface());
  for (const ContactPair &pair : pairs)
    for (const int b : {pair.faces_of, pair.nodes_of})
      if (surfaces[b].spacing == 0.)
        surfaces[b] = bodies[b]->contact_surface();
}

void Contact::update_search(const unsigned int, const double dt)
{
  // Both sides move: candidates hold until together they covered the skin.
  traveled += closing_speed.largest(bodies, holds_apart(), communicator) * dt;
  unsigned int version = 0;
  for (const Body *body : bodies)
    version += body->contact_surface_version();
  if (version != surface_version)
    update_surfaces();
  if (traveled > skin || version != surface_version)
    search();
  surface_version = version;
}

void Contact::add_forces(const double dt)
{
  halo.update();
  forces.clear();
  if (!is_step(dt))
    return settle();
  points.clear();
  touched.clear();
  points.steady_step.follow(dt);
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (!(traveled < groups[g].wake)) // else still apart
      press(g, dt);
  points.find_forces(options, dt, &shared_work);
  for (const ContactPoint &point : points)
    push(point);
  forces.add_to_bodies(halo);
}

void Contact::settle()
{
  for (Group &group : groups)
  {
    FaceProjection projection;
    ContactMemory memory;
    PressingPlace place;
    double nearest;
    const bool is_inside =
        faces.holding(group, memory, projection, place, nearest, 0.) >= 0;
    group.memory.side = memory.side;
    if (!is_inside || place.acting_depth() < 1e-6 * group.spacing)
      group.memory.release();
  }
}

void Contact::press(const std::size_t number, const double dt)
{
  Group &group = groups[number];
  FaceProjection projection;
  PressingPlace place;
  double nearest;
  const std::ptrdiff_t f =
      faces.holding(group, group.memory, projection, place, nearest, dt);
  if (f < 0)
  {
    group.memory.release();
    group.wake = traveled + 0.99 * nearest;
    return;
  }
  ContactPoint point;
  point.item = number;
  point.first_touched = touched.size();
  press_between_nodes(group, place);
  point.first_of_other = touched.size();
  touch(group, f, projection, point.normal, place.depth);
  point.last_touched = touched.size();
  point.velocity = velocity_against(halo.velocity, group, point);
  point.first_velocity = velocity_against(halo.start_velocity(), group, point);
  const double acting = group.memory.effective_depth(
      place.acting_depth(), 2. * largest_speed(group, point) * dt);
  point.fade = place.fade;
  point.depth = acting / place.fade;
  if (point.depth <= 0.)
  {
    touched.resize(point.first_touched);
    return;
  }
  point.reduced_mass = reduced_mass(group, point.first_of_other);
  point.stiffness = options.stable_stiffness(
      group.stiffness, point.reduced_mass, points.steady_step.value);
  point.area = norm_square(group.area_vector) > 0.
                   ? std::max(0., -dot(group.area_vector, point.normal))
                   : group.area;
  point.largest_friction =
      shear_limit(group, point.first_of_other) * point.area;
  point.memory = &group.memory;
  point.pair = shared_work.number_of(halo.key(group.slot).body,
                                     halo.key(faces.corners[f][0]).body);
  point.is_owned = group.slot < halo.n_owned();
  points.add(point);
  penetration_over_spacing =
      std::max(penetration_over_spacing,
               std::min(point.depth, place.seen) / group.spacing);
}

void Contact::press_between_nodes(const Group &group,
                                  const PressingPlace &place)
{
  if (place.shares.empty())
    return;
  // What the node does not take itself.
  touched.push_back({group.slot, 1., 0});
  for (const PressingPlace::Share &share : place.shares)
    touched.push_back({share.slot, -share.weight, 0});
}

double Contact::largest_speed(const Group &group,
                              const ContactPoint &point) const
{
  // A place that wanders along the surface comes in without a speed of its own.
  double largest = point.largest_speed();
  const Vec place[2] = {velocity_of_place(halo.velocity, group, point),
                        velocity_of_place(halo.start_velocity(), group, point)};
  for (std::size_t i = point.first_touched; i < point.first_of_other; ++i)
  {
    const std::size_t slot = touched[i].slot;
    largest = std::max(
        {largest, norm(point.velocity + halo.velocity[slot] - place[0]),
         norm(point.first_velocity + halo.start_velocity()[slot] - place[1])});
  }
  return largest;
}

void Contact::touch(const Group &group, const std::ptrdiff_t face,
                    const FaceProjection &projection, Vec &normal,
                    double &depth)
{
  if (group.patch_radius > 0. && projection.along < 0. &&
      patch.spread(group, group.patch_radius, projection, touched, normal,
                   depth))
    return;
  for (int a = 0; a < 4; ++a)
    touched.push_back({faces.corners[face][a], projection.weight[a], 0});
  normal = projection.normal;
}

double Contact::reduced_mass(const Group &group, const std::size_t first) const
{
  // A node on a plane of symmetry has part of its mass here. Of a patch its
  // image is touched, too, and each of the two has half of the weight.
  double sum = 0.;
  for (std::size_t i = first; i < touched.size(); ++i)
  {
    const TouchedNode &t = touched[i];
    sum += t.weight * t.weight / halo.inertia[t.slot] *
           (group.patch_radius > 0. ? 1. : share[t.slot]);
  }
  return group.share * group.cut /
         (group.share / halo.inertia[group.slot] + sum);
}

Vec Contact::velocity_of_place(const AlignedVector<Vec> &velocity,
                               const Group &group,
                               const ContactPoint &point) const
{
  Vec v = velocity[group.slot];
  for (std::size_t i = point.first_touched; i < point.first_of_other; ++i)
    v -= touched[i].weight * velocity[touched[i].slot];
  return v;
}

Vec Contact::velocity_against(const AlignedVector<Vec> &velocity,
                              const Group &group,
                              const ContactPoint &point) const
{
  Vec v = {};
  for (std::size_t i = point.first_of_other; i < point.last_touched; ++i)
  {
    const TouchedNode &t = touched[i];
    v += t.weight * flipped(velocity[t.slot], t.mirrored);
  }
  return velocity_of_place(velocity, group, point) - v;
}

double Contact::shear_limit(const Group &group, const std::size_t first) const
{
  if (!options.shear_strength.needs_flow_stress())
    return options.shear_strength.value();
  double its = 0.;
  for (std::size_t i = first; i < touched.size(); ++i)
    its += touched[i].weight * flow_stress[touched[i].slot];
  return ShearStrength::of_metals(flow_stress[group.slot], its);
}

void Contact::push(const ContactPoint &point)
{
  const std::size_t slot = groups[point.item].slot;
  const Vec normal = point.normal_force(), friction = point.friction_force();
  forces.normal[slot] += normal;
  forces.friction[slot] += friction;
  for (std::size_t i = point.first_touched; i < point.last_touched; ++i)
  {
    const TouchedNode &t = touched[i];
    forces.normal[t.slot] -= flipped(t.weight * normal, t.mirrored);
    forces.friction[t.slot] -= flipped(t.weight * friction, t.mirrored);
    if (forces.pairs.any() && i >= point.first_of_other)
    {
      const Vec part = t.weight * (normal + friction);
      forces.pairs.add(halo, slot, t.slot, part);
      forces.pairs.add(halo, t.slot, slot, -1. * flipped(part, t.mirrored));
    }
  }
}

void Contact::accumulate_work(const double half_dt)
{
  forces.accumulate_work(halo, half_dt);
}

void Contact::add_energies(EnergyLedger &ledger) const
{
  forces.add_energies(ledger);
}

Measures Contact::measure() const
{
  double penetration = penetration_over_spacing;
  MPI_Allreduce(MPI_IN_PLACE, &penetration, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
  Measures measures = {
      {"penetration max over spacing", "1", penetration},
      {"initial penetration over spacing", "1", initial_over_spacing}};
  forces.add_measures(measures, communicator);
  return measures;
}
} // namespace sabot
