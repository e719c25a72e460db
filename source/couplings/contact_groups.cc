// Which nodes a contact watches, from one search to the next and in
// checkpoints.
#include "sabot/couplings/contact.h"
#include "sabot/couplings/faces_of_nodes.h"

#include <algorithm>

namespace sabot
{
double Contact::patch_radius(const int nodes_of, const int faces_of) const
{
  return ContactPatch::radius(*bodies[nodes_of], surfaces[nodes_of],
                              surfaces[faces_of]);
}

void Contact::search()
{
  traveled = 0.;
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
  const SearchResult found = ContactSearch{bodies,
                                           surfaces,
                                           pairs,
                                           memories,
                                           spacing,
                                           skin,
                                           options.shear_strength.is_limited(),
                                           communicator}
                                 .find();
  std::vector<std::size_t> number_of_face;
  const std::vector<KeptNode> kept = keep_relevant(found, number_of_face);
  groups.clear();
  groups.reserve(kept.size());
  for (const KeptNode &node : kept)
    groups.push_back(make_group(found, node, number_of_face));
  reset_slots();
  if (options.shear_strength.needs_flow_stress())
    halo.find_flow_stress(flow_stress);
}

namespace
{
NodeKey corner_of(const SearchResult &found, const std::size_t face,
                  const int corner)
{
  return {found.faces[face].body, 0, found.faces[face].node[corner]};
}

/** Mark also the faces around the marked nodes and around the corners of marked
    faces, for the normals there; mark the corners of all. */
void add_neighbors(const SearchResult &found, FacesOfNodes &around,
                   NodeTable &is_node_needed, std::vector<char> &is_needed)
{
  const auto mark_corners = [&]
  {
    for (std::size_t f = 0; f < is_needed.size(); ++f)
      if (is_needed[f])
        for (int a = 0; a < 4; ++a)
          is_node_needed[corner_of(found, f, a)] = 0;
  };
  mark_corners();
  for (const NodeKey &node : is_node_needed.keys())
    for (const std::size_t f : around.around(node))
      is_needed[f] = 1;
  mark_corners();
}
} // namespace

std::vector<Contact::KeptNode>
Contact::keep_relevant(const SearchResult &found,
                       std::vector<std::size_t> &number_of_face)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const auto owned = [&](const std::int32_t body, const GlobalIndex node)
  { return bodies[body]->node_owner[node] == rank; };
  std::vector<char> is_mine(found.faces.size(), 0),
      is_needed(found.faces.size(), 0);
  for (std::size_t f = 0; f < found.faces.size(); ++f)
    for (const GlobalIndex a : found.faces[f].node)
      is_mine[f] |= owned(found.faces[f].body, a);
  FacesOfNodes around(found.faces, bodies);
  NodeTable slot_of(bodies);
  std::vector<KeptNode> kept;
  const auto &c = found.candidates;
  for (std::size_t first = 0, last; first < c.size(); first = last)
  {
    // One candidate for each body that the node meets.
    bool is_relevant = owned(c[first].node.body, c[first].node.node);
    for (last = first; last < c.size() && c[last].node == c[first].node; ++last)
      for (auto k = c[last].first_face; k < c[last].last_face; ++k)
        is_relevant |= is_mine[found.face_of_candidate[k]];
    // It may press with a place on one of its own faces.
    const FacesOfNodes::Range own = around.around(c[first].node);
    for (const std::size_t f : own)
      is_relevant |= is_mine[f];
    if (!is_relevant)
      continue;
    for (const std::size_t f : own)
      is_needed[f] = 1;
    kept.push_back({first, last});
    slot_of[c[first].node] = 0;
    for (std::size_t i = first; i < last; ++i)
      for (auto k = c[i].first_face; k < c[i].last_face; ++k)
        is_needed[found.face_of_candidate[k]] = 1;
  }
  add_neighbors(found, around, slot_of, is_needed);
  halo.build(bodies, slot_of.keys(), communicator);
  slot_of.take_slots(halo);
  faces.clear();
  face_ids.clear();
  number_of_face.assign(found.faces.size(), 0);
  for (std::size_t f = 0; f < found.faces.size(); ++f)
    if (is_needed[f])
    {
      number_of_face[f] = faces.corners.size();
      std::array<std::size_t, 4> slots;
      for (int a = 0; a < 4; ++a)
        slots[a] = slot_of[corner_of(found, f, a)];
      faces.corners.push_back(slots);
      face_ids.push_back(found.faces[f].id);
    }
  return kept;
}

Contact::Group
Contact::make_group(const SearchResult &found, const KeptNode &node,
                    const std::vector<std::size_t> &number_of_face)
{
  const ContactCandidate &candidate = found.candidates[node.first];
  Group group;
  group.slot = halo.slot(candidate.node);
  group.memory = candidate.memory;
  group.first_face = faces.face_of_node.size();
  const std::int32_t body = candidate.node.body;
  group.spacing = surfaces[body].spacing;
  double modulus = surfaces[body].bulk_modulus;
  // Where both sides' nodes meet faces, each carries half of the shear.
  double sides = 1.;
  for (std::size_t i = node.first; i < node.last; ++i)
  {
    const ContactCandidate &c = found.candidates[i];
    const int other = found.faces[found.face_of_candidate[c.first_face]].body;
    group.cut = std::min(group.cut, c.cut);
    modulus = std::min(modulus, surfaces[other].bulk_modulus);
    for (const ContactPair &pair : pairs)
      if (pair.faces_of == body && pair.nodes_of == other &&
          !pair.loose_nodes_only)
        sides = 2.;
    for (auto k = c.first_face; k < c.last_face; ++k)
      faces.face_of_node.push_back(number_of_face[found.face_of_candidate[k]]);
    group.patch_radius =
        std::max(group.patch_radius, patch_radius(body, other));
  }
  group.last_face = faces.face_of_node.size();
  group.share = candidate.share;
  const double part = candidate.share * group.cut;
  group.stiffness = part * options.stiffness_scale * modulus * group.spacing;
  group.area = part * group.spacing * group.spacing / sides;
  group.area_vector = (group.cut / sides) * candidate.area;
  group.own = candidate.own;
  return group;
}

void Contact::reset_slots()
{
  forces.resize(halo.size());
  patch.reset(surfaces, halo.size());
  std::vector<std::vector<SymmetryPlane>> planes;
  double spacing = 1e300;
  for (const ContactSurface &surface : surfaces)
  {
    planes.push_back(surface.symmetry_planes);
    if (surface.spacing > 0.)
      spacing = std::min(spacing, surface.spacing);
  }
  share = gather_of_slots(&ContactSurface::node_share, 1.);
  std::vector<double> reach =
      gather_of_slots(&ContactSurface::edge_distance, 0.);
  for (double &distance : reach)
    distance /= spacing;
  faces.build_normals(planes, 1e-6 * spacing, reach);
}

std::vector<double>
Contact::gather_of_slots(std::vector<double> ContactSurface::*const of_surface,
                         const double otherwise) const
{
  std::vector<double> value(halo.size(), otherwise);
  for (std::size_t s = 0; s < halo.n_owned(); ++s)
  {
    const ContactSurface &surface = surfaces[halo.key(s).body];
    const auto node = std::lower_bound(surface.nodes.begin(),
                                       surface.nodes.end(), halo.local(s));
    if (!(surface.*of_surface).empty() && node != surface.nodes.end() &&
        *node == halo.local(s))
      value[s] = (surface.*of_surface)[node - surface.nodes.begin()];
  }
  halo.update_ghosts(value.data());
  return value;
}

void Contact::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("traveled", traveled);
  closing_speed.visit_state(visitor);
  visitor.visit_value("surface version", surface_version);
  visitor.visit_largest("penetration", penetration_over_spacing);
  visitor.visit_value("steady step", points.steady_step.value);
  shared_work.visit_state(visitor);
  SavedGroups saved = save_groups();
  visitor.visit_all("groups", saved.groups);
  visitor.visit_all("faces of nodes", saved.faces_of_nodes);
  visitor.visit_all("faces", saved.faces);
  if (visitor.is_restoring())
  {
    update_surfaces(); // as the restored bodies have them
    restore_groups(saved);
    if (options.shear_strength.needs_flow_stress())
      flow_stress.resize(halo.size());
  }
  const std::vector<GlobalIndex> keys = halo.numbers();
  const StateItems slots = {visitor.section + "/slots", keys.data(),
                            halo.n_owned(), halo.size()};
  visitor.visit_keys(slots);
  visitor.visit_items("flow stress", flow_stress, slots);
  forces.visit_state(visitor, halo, slots);
}

Contact::SavedGroups Contact::save_groups() const
{
  // Candidates were found where the bodies were at the last search, so they
  // cannot be found anew. Slots depend on nothing but the nodes.
  SavedGroups saved;
  for (const Group &group : groups)
  {
    if (group.slot >= halo.n_owned())
      continue; // its owner has it
    saved.groups.push_back(
        {halo.key(group.slot), std::int64_t(group.last_face - group.first_face),
         group.stiffness, group.spacing, group.area, group.area_vector,
         group.own, group.memory, group.wake, group.patch_radius, group.share,
         group.cut});
    for (std::size_t f = group.first_face; f < group.last_face; ++f)
      saved.faces_of_nodes.push_back(key_of_face(faces.face_of_node[f]));
  }
  for (std::size_t f = 0; f < faces.corners.size(); ++f)
  {
    saved.faces.push_back({key_of_face(f), {}});
    for (int a = 0; a < 4; ++a)
      saved.faces.back().node[a] = halo.key(faces.corners[f][a]).node;
  }
  return saved;
}

void Contact::restore_groups(SavedGroups &saved)
{
  // As if they had just been found, by all ranks.
  SearchResult found;
  std::sort(saved.faces.begin(), saved.faces.end(),
            [](const SavedFace &a, const SavedFace &b)
            { return a.key < b.key; });
  for (const SavedFace &face : saved.faces)
    if (found.faces.empty() || !(face.key == NodeKey{found.faces.back().body, 0,
                                                     found.faces.back().id}))
    {
      found.faces.emplace_back();
      found.faces.back().body = face.key.body;
      found.faces.back().id = face.key.node;
      found.faces.back().node = face.node;
    }
  const auto number_of = [&](const NodeKey &key)
  {
    return std::lower_bound(found.faces.begin(), found.faces.end(), key,
                            [](const FaceNodes &face, const NodeKey &k) {
                              return NodeKey{face.body, 0, face.id} < k;
                            }) -
           found.faces.begin();
  };
  for (const NodeKey &face : saved.faces_of_nodes)
    found.face_of_candidate.push_back(number_of(face));
  std::vector<std::size_t> first = {0}, order;
  for (const SavedGroup &group : saved.groups)
  {
    order.push_back(order.size());
    first.push_back(first.back() + group.n_faces);
  }
  std::sort(order.begin(), order.end(),
            [&](const std::size_t a, const std::size_t b)
            { return saved.groups[a].node < saved.groups[b].node; });
  for (const std::size_t g : order)
  {
    ContactCandidate candidate{};
    candidate.node = saved.groups[g].node;
    candidate.first_face = first[g];
    candidate.last_face = first[g + 1];
    found.candidates.push_back(candidate);
  }
  std::vector<std::size_t> number_of_face;
  const std::vector<KeptNode> kept = keep_relevant(found, number_of_face);
  groups.clear();
  for (const KeptNode &node : kept)
    groups.push_back(
        restored_group(saved.groups[order[node.first]], found, number_of_face));
  reset_slots();
}

Contact::Group
Contact::restored_group(const SavedGroup &from, const SearchResult &found,
                        const std::vector<std::size_t> &number_of_face)
{
  const auto candidate = std::lower_bound(
      found.candidates.begin(), found.candidates.end(), from.node,
      [](const ContactCandidate &c, const NodeKey &k) { return c.node < k; });
  Group group;
  group.slot = halo.slot(from.node);
  group.first_face = faces.face_of_node.size();
  for (auto k = candidate->first_face; k < candidate->last_face; ++k)
    faces.face_of_node.push_back(number_of_face[found.face_of_candidate[k]]);
  group.last_face = faces.face_of_node.size();
  group.stiffness = from.stiffness;
  group.spacing = from.spacing;
  group.area = from.area;
  group.area_vector = from.area_vector;
  group.own = from.own;
  group.memory = from.memory;
  group.wake = from.wake;
  group.patch_radius = from.patch_radius;
  group.share = from.share;
  group.cut = from.cut;
  return group;
}
} // namespace sabot
