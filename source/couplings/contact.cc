#include "sabot/couplings/contact.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
Contact::Contact(const std::string &name, const std::vector<Body *> &bodies,
                 const std::vector<ContactPair> &pairs,
                 const ContactOptions &options, MPI_Comm communicator)
    : Coupling(name), bodies(bodies), pairs(pairs), options(options),
      communicator(communicator)
{
}

void Contact::initialize()
{
  for (const ContactPair &pair : pairs)
    body_pairs.emplace_back(pair.faces_of, pair.nodes_of);
  update_surfaces();
  skin = 1e300;
  for (const ContactPair &pair : pairs)
    for (const int b : {pair.faces_of, pair.nodes_of})
      skin = std::min(skin, 0.5 * surfaces[b].spacing);
  search();
  halo.update();
  double worst = 0.;
  for (const Group &group : groups)
  {
    FaceProjection projection;
    if (closest_face(group, projection) >= 0 &&
        -projection.gap / group.spacing > worst)
    {
      worst = -projection.gap / group.spacing;
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
  symmetry_planes.clear();
  for (const ContactSurface &surface : surfaces)
    for (const SymmetryPlane &plane : surface.symmetry_planes)
      if (std::find(symmetry_planes.begin(), symmetry_planes.end(), plane) ==
          symmetry_planes.end())
        symmetry_planes.push_back(plane);
}

void Contact::update_search(const unsigned int, const double dt)
{
  // Both sides move: candidates hold until together they covered the skin.
  travelled += largest_closing_speed(bodies, body_pairs, communicator) * dt;
  unsigned int version = 0;
  for (const Body *body : bodies)
    version += body->contact_surface_version();
  if (version != surface_version)
    update_surfaces();
  if (travelled > skin || version != surface_version)
    search();
  surface_version = version;
}

void Contact::search()
{
  travelled = 0.;
  int rank;
  MPI_Comm_rank(communicator, &rank);
  double spacing = 0.;
  for (const ContactPair &pair : pairs)
    for (const int b : {pair.faces_of, pair.nodes_of})
      spacing = std::max(spacing, surfaces[b].spacing);
  for (const ContactPair &pair : pairs)
    spacing = std::max(spacing, patch_radius(pair.nodes_of, pair.faces_of));
  ContactMemories memories;
  for (const Group &group : groups)
    if (group.slot < halo.n_owned())
      memories.emplace_back(halo.key(group.slot), group.memory);
  const SearchResult found =
      search_contacts(bodies, surfaces, pairs, memories, spacing, skin,
                      options.has_shear_limit(), communicator);

  // Keep the groups in which any node is owned here: whoever owns a node
  // computes all that acts on it, from the same numbers in the same order.
  const auto owned = [&](const std::int32_t body, const GlobalIndex node)
  { return bodies[body]->node_owner[node] == rank; };
  std::vector<char> face_is_mine(found.faces.size(), 0),
      face_is_needed(found.faces.size(), 0);
  for (std::size_t f = 0; f < found.faces.size(); ++f)
    for (const GlobalIndex a : found.faces[f].node)
      face_is_mine[f] |= owned(found.faces[f].body, a);
  std::vector<NodeKey> needed;
  std::vector<std::pair<std::size_t, std::size_t>> kept;
  const auto &c = found.candidates;
  const auto &faces_of = found.face_of_candidate;
  for (std::size_t first = 0, last; first < c.size(); first = last)
  {
    bool relevant = owned(c[first].node.body, c[first].node.node);
    for (last = first; last < c.size() && c[last].node == c[first].node; ++last)
      for (auto k = c[last].first_face; k < c[last].last_face && !relevant; ++k)
        relevant = face_is_mine[faces_of[k]];
    if (!relevant)
      continue;
    kept.emplace_back(first, last);
    needed.push_back(c[first].node);
    for (std::size_t i = first; i < last; ++i)
      for (auto k = c[i].first_face; k < c[i].last_face; ++k)
        face_is_needed[faces_of[k]] = 1;
  }
  for (std::size_t f = 0; f < found.faces.size(); ++f)
    if (face_is_needed[f])
      for (const GlobalIndex a : found.faces[f].node)
        needed.push_back({found.faces[f].body, 0, a});
  halo.build(bodies, needed, communicator);

  face_slots.clear();
  std::vector<std::size_t> face_number(found.faces.size(), 0);
  for (std::size_t f = 0; f < found.faces.size(); ++f)
    if (face_is_needed[f])
    {
      face_number[f] = face_slots.size();
      std::array<std::size_t, 4> slots;
      for (int a = 0; a < 4; ++a)
        slots[a] = halo.slot({found.faces[f].body, 0, found.faces[f].node[a]});
      face_slots.push_back(slots);
    }
  groups.clear();
  face_of_group.clear();
  for (const auto &[first, last] : kept)
  {
    Group group;
    group.slot = halo.slot(c[first].node);
    group.memory = c[first].memory;
    group.first_face = face_of_group.size();
    const std::int32_t body = c[first].node.body;
    group.spacing = surfaces[body].spacing;
    double modulus = surfaces[body].bulk_modulus;
    // Where both sides' nodes meet faces, each carries half of the shear.
    double sides = 1.;
    for (std::size_t i = first; i < last; ++i)
    {
      const int other = found.faces[faces_of[c[i].first_face]].body;
      modulus = std::min(modulus, surfaces[other].bulk_modulus);
      for (const ContactPair &pair : pairs)
        if (pair.faces_of == body && pair.nodes_of == other &&
            !pair.loose_nodes_only)
          sides = 2.;
      for (auto k = c[i].first_face; k < c[i].last_face; ++k)
        face_of_group.push_back(face_number[faces_of[k]]);
      group.patch_radius =
          std::max(group.patch_radius, patch_radius(body, other));
    }
    group.last_face = face_of_group.size();
    group.share = c[first].share;
    group.stiffness =
        c[first].share * options.stiffness_scale * modulus * group.spacing;
    group.area = c[first].share * group.spacing * group.spacing / sides;
    group.area_vector = (1. / sides) * c[first].area;
    groups.push_back(group);
  }
  forces.resize(halo.size());
  touched_number.assign(halo.size(), -1);
  if (options.limit_by_yield)
    halo.find_flow_stress(flow_stress);
}

std::ptrdiff_t Contact::closest_face(const Group &group, FaceProjection &best,
                                     const Vec *const side) const
{
  constexpr double cosine = 0.5;
  const Vec p = halo.position[group.slot];
  const double touching = 1e-6 * group.spacing;
  const auto approach = [&](const std::size_t f, const FaceProjection &to)
  {
    Vec v = halo.velocity[group.slot];
    for (int a = 0; a < 4; ++a)
      v -= to.weight[a] * halo.velocity[face_slots[f][a]];
    return -dot(v, to.face_normal);
  };
  std::ptrdiff_t closest = -1;
  for (std::size_t k = group.first_face; k < group.last_face; ++k)
  {
    const std::size_t f = face_of_group[k];
    std::array<Vec, 4> x;
    for (int a = 0; a < 4; ++a)
      x[a] = halo.position[face_slots[f][a]];
    // With a margin, so that faces with the same closest point stay in.
    if (closest >= 0 &&
        is_farther(p, x, 1.001 * std::sqrt(best.distance_square) + touching))
      continue;
    const FaceProjection projection = project_on_face(p, x);
    if (side != nullptr && dot(projection.face_normal, *side) < cosine)
      continue;
    // Faces that share the closest edge: the one that faces the point more
    // squarely tells the right side.
    const bool tie =
        std::abs(projection.distance_square - best.distance_square) <=
        1e-10 * best.distance_square;
    // Of faces that it touches, the one it moves against.
    const bool touches_both =
        closest >= 0 && std::max(projection.distance_square,
                                 best.distance_square) < touching * touching;
    if (closest < 0 ||
        (touches_both ? approach(f, projection) > approach(closest, best)
         : tie        ? projection.facing > best.facing
                      : projection.distance_square < best.distance_square))
    {
      best = projection;
      closest = f;
    }
  }
  return closest;
}

double Contact::relative_speed(const Group &group, const std::ptrdiff_t face,
                               const FaceProjection &projection) const
{
  Vec v = halo.velocity[group.slot];
  for (int a = 0; a < 4; ++a)
    v -= projection.weight[a] * halo.velocity[face_slots[face][a]];
  return norm(v);
}

std::ptrdiff_t Contact::holding_face(Group &group, FaceProjection &best,
                                     const double dt) const
{
  // Sideways, in spacings, to which a face reaches beyond its rim: equal
  // cross-sections that meet bulge by unequal fractions of this.
  constexpr double rim = 0.1;
  constexpr double cosine = 0.5; // as closest_face()
  ContactMemory &memory = group.memory;
  const std::ptrdiff_t closest = closest_face(group, best);
  if (closest < 0)
    return -1;
  const bool was_inside = memory.depth > 0.,
             has_side = norm_square(memory.side) > 0.;
  const double tolerance = rim * group.spacing;
  if (has_side && (was_inside || best.gap < tolerance) &&
      !(best.gap < 0. && dot(best.face_normal, memory.side) >= cosine))
  {
    FaceProjection held;
    const std::ptrdiff_t f = closest_face(group, held, &memory.side);
    if (f >= 0 && held.along < 0.)
    {
      const double sideways = std::sqrt(
          std::max(0., held.distance_square - held.along * held.along));
      const double motion = 2. * relative_speed(group, f, held) * dt;
      if (sideways < tolerance && (was_inside || -held.along <= motion))
      {
        best = held;
        // Let go gradually past the rim.
        best.gap = held.along * (1. - sideways / tolerance);
        best.normal = held.face_normal;
        memory.side = held.face_normal;
        return f;
      }
    }
  }
  memory.side = best.face_normal;
  return best.gap < 0. ? closest : -1;
}

void Contact::add_forces(const double dt)
{
  halo.update();
  forces.clear();
  if (dt <= 0.)
  {
    // Where everything starts: bodies may touch already.
    for (Group &group : groups)
    {
      FaceProjection projection;
      if (closest_face(group, projection) < 0)
        continue;
      group.memory.side = projection.face_normal;
      if (projection.gap > -1e-6 * group.spacing)
        group.memory.release();
    }
    return;
  }
  for (Group &group : groups)
  {
    if (travelled < group.wake)
      continue; // still apart
    FaceProjection projection;
    const std::ptrdiff_t f = holding_face(group, projection, dt);
    if (f < 0)
    {
      group.memory.release();
      group.wake = travelled + 0.99 * std::sqrt(projection.distance_square);
      continue;
    }
    Vec n;
    double geometric_depth;
    spread(group, f, projection, n, geometric_depth);
    const double face_compliance = compliance(group);
    const Vec v = halo.velocity[group.slot] - velocity_of_touched();
    const double depth =
        group.memory.effective_depth(geometric_depth, 2. * norm(v) * dt);
    if (depth <= 0.)
      continue;
    const double reduced_mass =
        1. / (1. / halo.inertia[group.slot] + face_compliance);
    const double k = std::min(group.stiffness, options.stability_fraction *
                                                   reduced_mass / (dt * dt));
    const double area = norm_square(group.area_vector) > 0.
                            ? std::max(0., -dot(group.area_vector, n))
                            : group.area;
    const auto [fn, ft] = contact_forces(options, k, reduced_mass, depth, v, n,
                                         shear_limit(group) * area, dt);
    const double part = backed_part(group.memory, k * depth * n, v, k, dt);
    forces.normal[group.slot] += part * fn;
    forces.friction[group.slot] += part * ft;
    push_touched(part * fn, forces.normal);
    push_touched(part * ft, forces.friction);
    penetration_over_spacing =
        std::max(penetration_over_spacing, depth / group.spacing);
  }
  forces.add_to_bodies(halo);
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

void Contact::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("travelled", travelled);
  visitor.visit_value("surface version", surface_version);
  visitor.visit_value("penetration", penetration_over_spacing);
  // Candidates were found where the bodies were at the last search, so they
  // cannot be found anew. Slots depend on nothing but the nodes.
  std::vector<SavedGroup> saved;
  std::vector<NodeKey> face_nodes;
  for (const Group &group : groups)
  {
    saved.push_back(
        {halo.key(group.slot), std::int64_t(group.last_face - group.first_face),
         group.stiffness, group.spacing, group.area, group.area_vector,
         group.memory, group.wake, group.patch_radius, group.share});
    for (std::size_t k = group.first_face; k < group.last_face; ++k)
      for (const std::size_t slot : face_slots[face_of_group[k]])
        face_nodes.push_back(halo.key(slot));
  }
  visitor.visit_resized("groups", saved);
  visitor.visit_resized("face nodes", face_nodes);
  if (visitor.is_restoring())
  {
    update_surfaces(); // as the restored bodies have them
    restore_groups(saved, face_nodes);
  }
  visitor.visit_resized("flow stress", flow_stress);
  forces.visit_state(visitor);
}

void Contact::restore_groups(const std::vector<SavedGroup> &saved,
                             const std::vector<NodeKey> &face_nodes)
{
  std::vector<NodeKey> needed = face_nodes;
  for (const SavedGroup &group : saved)
    needed.push_back(group.node);
  halo.build(bodies, needed, communicator);
  groups.clear();
  face_slots.clear();
  face_of_group.clear();
  for (const SavedGroup &from : saved)
  {
    Group group;
    group.slot = halo.slot(from.node);
    group.first_face = face_slots.size();
    group.last_face = group.first_face + from.n_faces;
    group.stiffness = from.stiffness;
    group.spacing = from.spacing;
    group.area = from.area;
    group.area_vector = from.area_vector;
    group.memory = from.memory;
    group.wake = from.wake;
    group.patch_radius = from.patch_radius;
    group.share = from.share;
    for (std::size_t f = group.first_face; f < group.last_face; ++f)
    {
      std::array<std::size_t, 4> slots;
      for (int a = 0; a < 4; ++a)
        slots[a] = halo.slot(face_nodes[4 * f + a]);
      face_of_group.push_back(face_slots.size());
      face_slots.push_back(slots);
    }
    groups.push_back(group);
  }
  forces.resize(halo.size());
  touched_number.assign(halo.size(), -1);
}
} // namespace sabot
