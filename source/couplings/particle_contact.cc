#include "sabot/couplings/particle_contact.h"

#include "sabot/couplings/contact_search.h"
#include "sabot/couplings/particle_search.h"
#include "sabot/kernels/kernel_function.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Mean of the sum of cubic splines of radius 1.5 spacings over a plane of
    particles: 2 pi 1.5^2 integral of phi r dr. */
constexpr double full_sum = 0.8247;
/** Part of it below which a surface has ended, and from which it is whole:
    least values half a spacing beyond a straight rim and inside of it. */
constexpr double least_sum = 0.5, whole_sum = 0.875;

/** 0 for directions at right angles or worse, 1 within 60 degrees. */
double alignment(const double cosine)
{
  return std::clamp(2. * cosine, 0., 1.);
}
} // namespace

ParticleContact::ParticleContact(const std::string &name,
                                 const std::vector<Body *> &bodies,
                                 const std::vector<std::pair<int, int>> &pairs,
                                 const ContactOptions &options,
                                 MPI_Comm communicator)
    : Coupling(name), bodies(bodies), pairs(pairs), options(options),
      communicator(communicator)
{
}

void ParticleContact::initialize()
{
  skin = 1e300;
  for (const auto &[a, b] : pairs)
    for (const int body : {a, b})
      skin = std::min(skin, 0.4 * bodies[body]->contact_surface().spacing);
  search();
  update_halo();
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    const Standing at = locate(groups[g], slots[g]);
    if (at.fade > 0.)
      initial_over_spacing =
          std::max(initial_over_spacing, -at.gap / groups[g].spacing);
  }
  MPI_Allreduce(MPI_IN_PLACE, &initial_over_spacing, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
}

void ParticleContact::update_search(const unsigned int, const double dt)
{
  travelled += largest_closing_speed(bodies, pairs, communicator) * dt;
  if (travelled > allowance)
    search();
}

void ParticleContact::search()
{
  travelled = 0.;
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const ParticleSearch found(bodies, pairs, skin, communicator);
  allowance = std::max(skin, found.gap());

  // Owners look for what their nodes may touch; everyone then keeps what
  // touches nodes of his own, in the same order.
  std::vector<Group> my_groups;
  std::vector<NodeKey> my_members;
  for (const OpenParticle &node : found.mine())
    for (const auto &[a, b] : pairs)
    {
      if (node.key.body != a && node.key.body != b)
        continue;
      const int other = node.key.body == a ? b : a;
      const std::size_t before = my_members.size();
      found.near(node, other, my_members);
      if (my_members.size() == before)
        continue;
      const ContactSurface &mine = found.surface(node.key.body),
                           &its = found.surface(other);
      Group group{};
      group.node = node.key;
      group.other = other;
      group.is_sound = node.is_sound;
      group.n_members = my_members.size() - before;
      group.spacing = mine.spacing;
      group.stiffness = node.share * options.stiffness_scale *
                        std::min(mine.bulk_modulus, its.bulk_modulus) *
                        mine.spacing;
      // Where both sides meet surfaces, each carries half of the shear.
      group.area =
          node.share * mine.spacing * mine.spacing / (node.is_sound ? 2. : 1.);
      const auto old = std::lower_bound(groups.begin(), groups.end(), group);
      if (old != groups.end() && !(group < *old))
        group.memory = old->memory;
      my_groups.push_back(group);
    }
  const std::vector<Group> all = gather_all(my_groups, communicator);
  const std::vector<NodeKey> all_members = gather_all(my_members, communicator);
  std::vector<std::size_t> first(all.size() + 1, 0), order(all.size());
  for (std::size_t g = 0; g < all.size(); ++g)
  {
    first[g + 1] = first[g] + all[g].n_members;
    order[g] = g;
  }
  std::sort(order.begin(), order.end(),
            [&](const std::size_t a, const std::size_t b)
            { return all[a] < all[b]; });
  const auto owned = [&](const NodeKey &key)
  { return bodies[key.body]->node_owner[key.node] == rank; };
  groups.clear();
  members.clear();
  for (const std::size_t g : order)
  {
    const auto begin = all_members.begin() + first[g],
               end = all_members.begin() + first[g + 1];
    if (!owned(all[g].node) && std::none_of(begin, end, owned))
      continue;
    groups.push_back(all[g]);
    members.insert(members.end(), begin, end);
  }
  build_halo();
  if (options.limit_by_yield)
    halo.find_flow_stress(flow_stress);
}

double ParticleContact::largest_friction(const Group &group,
                                         const Slots &at) const
{
  if (!options.limit_by_yield)
    return options.shear_limit * group.area;
  double its = 0.;
  for (std::size_t m = at.first_member; m < at.last_member; ++m)
    its += weight[m - at.first_member] * flow_stress[member_slots[m]];
  return std::min(flow_stress[at.node], its) / std::sqrt(3.) * group.area;
}

void ParticleContact::build_halo()
{
  std::vector<NodeKey> needed = members;
  for (const Group &group : groups)
    needed.push_back(group.node);
  halo.build(bodies, needed, communicator);
  slots.clear();
  member_slots.clear();
  std::size_t most = 0;
  for (const NodeKey &member : members)
    member_slots.push_back(halo.slot(member));
  std::size_t first = 0;
  for (const Group &group : groups)
  {
    slots.push_back({halo.slot(group.node), first, first + group.n_members});
    first += group.n_members;
    most = std::max(most, std::size_t(group.n_members));
  }
  weight.resize(most);
  along_normal.resize(most);
  surface.resize(halo.size());
  forces.resize(halo.size());
}

void ParticleContact::update_halo()
{
  halo.update();
  for (std::size_t s = 0; s < halo.n_owned(); ++s)
    surface[s] = halo.body(s).surface_point(halo.local(s));
  halo.update_ghosts(surface.data());
}

ParticleContact::Standing ParticleContact::locate(const Group &group,
                                                  const Slots &at)
{
  // A node that comes from outside is caught before half a spacing; the other
  // side of a thin part is a spacing deep at least.
  const bool inside = group.memory.depth > 0.;
  const double deepest = inside ? ParticleSearch::reach : 0.5;
  const Vec x = halo.position[at.node];
  const SurfacePoint own = group.is_sound ? surface[at.node] : SurfacePoint();
  const bool has_normal = norm_square(own.normal) > 0.;
  Standing standing;
  double sum = 0.;
  Vec normal = {};
  for (std::size_t m = at.first_member; m < at.last_member; ++m)
  {
    double &w = weight[m - at.first_member];
    w = 0.;
    const std::size_t j = member_slots[m];
    Vec n = surface[j].normal;
    double facing = norm_square(n) > 0. ? 1. : 0.;
    if (has_normal)
    {
      facing *= alignment(-dot(own.normal, n));
      n = surface[j].flatness * n - own.flatness * own.normal;
    }
    if (facing <= 0.)
      continue;
    n *= 1. / norm(n);
    if (inside)
      facing *= alignment(dot(n, group.memory.side));
    const Vec d = x - halo.position[j];
    const double along = dot(d, n), spacing = surface[j].spacing;
    if (along < -deepest * spacing)
      continue;
    const double lateral =
        std::sqrt(std::max(0., norm_square(d) - along * along));
    w = facing * cubic_spline(lateral / (ParticleSearch::reach * spacing));
    sum += w;
    normal += w * n;
    along_normal[m - at.first_member] = along;
  }
  const double part = sum / full_sum;
  if (part <= least_sum || norm_square(normal) == 0.)
    return standing;
  standing.normal = (1. / norm(normal)) * normal;
  balance_weights(at, standing.normal);
  standing.gap = 0.;
  for (std::size_t m = 0; m < at.last_member - at.first_member; ++m)
    standing.gap += weight[m] * along_normal[m];
  standing.fade = std::min(1., (part - least_sum) / (whole_sum - least_sum));
  return standing;
}

void ParticleContact::balance_weights(const Slots &at, const Vec n)
{
  // w (1 + c . d), d tangential, has no first moment where the node stands
  // between particles; beyond the last it gets as near as w >= 0 allows.
  const Vec x = halo.position[at.node];
  const auto tangential = [&](const std::size_t m)
  {
    const Vec d = x - halo.position[member_slots[m]];
    return d - dot(d, n) * n;
  };
  Vec first = {};
  Mat second = Mat::zero();
  for (std::size_t m = at.first_member; m < at.last_member; ++m)
    if (weight[m - at.first_member] > 0.)
    {
      const Vec d = tangential(m), wd = weight[m - at.first_member] * d;
      first += wd;
      add_outer(second, wd, d);
    }
  const double size = trace(second);
  Vec slope = {};
  if (size > 0.)
  {
    add_outer(second, size * n, n);
    slope = -1. * (inverse(second + 1e-6 * size * Mat::identity()) * first);
  }
  double least = 0.;
  for (std::size_t m = at.first_member; m < at.last_member; ++m)
    if (weight[m - at.first_member] > 0.)
      least = std::min(least, dot(slope, tangential(m)));
  if (least < -1.)
    slope *= -1. / least;
  double sum = 0.;
  for (std::size_t m = at.first_member; m < at.last_member; ++m)
  {
    double &w = weight[m - at.first_member];
    if (w > 0.)
      w *= std::max(0., 1. + dot(slope, tangential(m)));
    sum += w;
  }
  for (std::size_t m = 0; m < at.last_member - at.first_member; ++m)
    weight[m] /= sum;
}

void ParticleContact::add_forces(const double dt)
{
  update_halo();
  forces.clear();
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    Group &group = groups[g];
    const Slots &at = slots[g];
    const Standing standing = locate(group, at);
    ContactMemory &memory = group.memory;
    if (standing.fade > 0.)
      memory.side = standing.normal;
    if (dt <= 0.)
    {
      // Where everything starts: bodies may touch already.
      if (standing.gap > -1e-6 * group.spacing)
        memory.release();
      continue;
    }
    if (standing.fade <= 0. || standing.gap >= 0.)
    {
      memory.release();
      continue;
    }
    const double *const w = weight.data() - at.first_member;
    double compliance = 1. / halo.inertia[at.node];
    Vec v = halo.velocity[at.node];
    for (std::size_t m = at.first_member; m < at.last_member; ++m)
    {
      compliance += w[m] * w[m] / halo.inertia[member_slots[m]];
      v -= w[m] * halo.velocity[member_slots[m]];
    }
    const double depth =
        memory.effective_depth(-standing.gap, 2. * norm(v) * dt);
    if (depth <= 0.)
      continue;
    const double reduced_mass = 1. / compliance;
    const double k = std::min(group.stiffness, options.stability_fraction *
                                                   reduced_mass / (dt * dt));
    const ContactForces force =
        contact_forces(options, k, reduced_mass, depth, v, standing.normal,
                       largest_friction(group, at), dt);
    const double part =
        standing.fade * backed_part(memory,
                                    standing.fade * k * depth * standing.normal,
                                    v, k, dt);
    const Vec fn = part * force.normal, ft = part * force.friction;
    forces.normal[at.node] += fn;
    forces.friction[at.node] += ft;
    for (std::size_t m = at.first_member; m < at.last_member; ++m)
    {
      forces.normal[member_slots[m]] -= w[m] * fn;
      forces.friction[member_slots[m]] -= w[m] * ft;
    }
    penetration_over_spacing =
        std::max(penetration_over_spacing, depth / group.spacing);
  }
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
  double penetration = penetration_over_spacing;
  MPI_Allreduce(MPI_IN_PLACE, &penetration, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
  Measures measures = {
      {"penetration max over spacing", "1", penetration},
      {"initial penetration over spacing", "1", initial_over_spacing}};
  forces.add_measures(measures, communicator);
  return measures;
}

void ParticleContact::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("travelled", travelled);
  visitor.visit_value("allowance", allowance);
  visitor.visit_value("penetration", penetration_over_spacing);
  // Candidates were found where the bodies were at the last search.
  visitor.visit_resized("groups", groups);
  visitor.visit_resized("members", members);
  if (visitor.is_restoring())
    build_halo();
  visitor.visit_resized("flow stress", flow_stress);
  forces.visit_state(visitor);
}
} // namespace sabot
