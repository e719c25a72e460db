#include "sabot/couplings/contact_search.h"

#include "sabot/couplings/box_buckets.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
Box box_of_faces(const Body &body, const ContactSurface &surface)
{
  Box box;
  for (const auto &face : surface.faces)
    for (const std::size_t a : face)
      box.add(body.nodes().position[a]);
  return box;
}

/** Which faces of its own body a node may meet: those that it faces, from
    outside, and that are no neighbours of its own faces. */
class OwnFaces
{
public:
  OwnFaces(const Body &body, const ContactSurface &surface,
           const AlignedVector<Vec> &areas)
      : areas(areas), ring(surface.faces.empty() ? 0 : body.nodes().size())
  {
    for (const auto &face : surface.faces)
      for (const std::size_t a : face)
        for (const std::size_t b : face)
          ring[a].push_back(body.nodes().global_id[b]);
  }
  bool may_meet(const std::size_t i, const FaceNodes &face,
                const FaceProjection &projection,
                const ContactMemory &memory) const
  {
    constexpr double cosine = 0.5; // as Contact
    // Corners look half away from what they meet (0.58), bent ones more.
    constexpr double facing = 0.25;
    for (const GlobalIndex a : ring[i])
      if (std::find(face.node.begin(), face.node.end(), a) != face.node.end())
        return false;
    // The far side of a thin part looks the wrong way.
    if (memory.depth > 0.)
      return dot(projection.face_normal, memory.side) >= cosine;
    return projection.along >= 0. &&
           dot(areas[i], projection.face_normal) <= -facing * norm(areas[i]);
  }

private:
  const AlignedVector<Vec> &areas;
  std::vector<std::vector<GlobalIndex>> ring; // nodes of a node's faces
};
} // namespace

SearchResult search_contacts(const std::vector<Body *> &bodies,
                             const std::vector<ContactSurface> &surfaces,
                             const std::vector<ContactPair> &pairs,
                             const ContactMemories &memories,
                             const double spacing, const double skin,
                             const bool with_areas, MPI_Comm communicator)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  // A node that went deeper than a spacing still sees the face it came by.
  const double deepest_known = 3. * spacing;
  double deepest = spacing;
  for (const auto &[key, memory] : memories)
    deepest = std::max(deepest, std::min(memory.depth, deepest_known));
  MPI_Allreduce(MPI_IN_PLACE, &deepest, 1, MPI_DOUBLE, MPI_MAX, communicator);
  const double reach = deepest + skin;
  std::vector<Box> face_box(bodies.size()), node_box(bodies.size());
  std::vector<char> used(bodies.size(), 0);
  for (const ContactPair &pair : pairs)
    used[pair.faces_of] = used[pair.nodes_of] = 1;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (used[b])
    {
      face_box[b] = box_of_faces(*bodies[b], surfaces[b]);
      for (const std::size_t i : surfaces[b].nodes)
        node_box[b].add(bodies[b]->nodes().position[i]);
      face_box[b].reduce(communicator);
      node_box[b].reduce(communicator);
      face_box[b].inflate(reach);
      node_box[b].inflate(reach);
    }

  // Faces near the other body, from the rank of their lowest node.
  std::vector<FaceNodes> mine;
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    if (!used[b])
      continue;
    const NodalState &nodes = bodies[b]->nodes();
    for (std::size_t f = 0; f < surfaces[b].faces.size(); ++f)
    {
      FaceNodes face;
      face.body = b;
      face.id = surfaces[b].face_id[f];
      Box box;
      for (int a = 0; a < 4; ++a)
      {
        const std::size_t i = surfaces[b].faces[f][a];
        face.node[a] = nodes.global_id[i];
        face.x[a] = nodes.position[i];
        box.add(face.x[a]);
      }
      if (bodies[b]->node_owner[*std::min_element(face.node.begin(),
                                                  face.node.end())] != rank)
        continue;
      bool near = false;
      for (const ContactPair &pair : pairs)
        near = near ||
               (pair.faces_of == int(b) && box.meets(node_box[pair.nodes_of]));
      if (near)
        mine.push_back(face);
    }
  }
  SearchResult result;
  result.faces = gather_all(mine, communicator);
  std::sort(result.faces.begin(), result.faces.end(),
            [](const FaceNodes &a, const FaceNodes &b)
            { return a.body != b.body ? a.body < b.body : a.id < b.id; });

  // Faces of a body are contiguous.
  std::vector<Box> boxes(result.faces.size());
  std::vector<std::size_t> first_face(bodies.size() + 1, 0);
  for (std::size_t f = 0; f < result.faces.size(); ++f)
  {
    for (const Vec x : result.faces[f].x)
      boxes[f].add(x);
    boxes[f].inflate(reach);
    ++first_face[result.faces[f].body + 1];
  }
  std::vector<BoxBuckets> buckets;
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    first_face[b + 1] += first_face[b];
    buckets.emplace_back(std::vector<Box>(boxes.begin() + first_face[b],
                                          boxes.begin() + first_face[b + 1]),
                         reach);
  }

  std::vector<ContactCandidate> candidates;
  std::vector<std::int64_t> near_faces;
  for (const ContactPair &pair : pairs)
  {
    const Body &body = *bodies[pair.nodes_of];
    const NodalState &nodes = body.nodes();
    AlignedVector<Vec> areas;
    const bool with_itself = pair.faces_of == pair.nodes_of;
    if (with_areas || with_itself)
    {
      areas.assign(nodes.size(), Vec{});
      for (const auto &face : surfaces[pair.nodes_of].faces)
      {
        const Vec area =
            0.5 * cross(nodes.position[face[2]] - nodes.position[face[0]],
                        nodes.position[face[3]] - nodes.position[face[1]]);
        for (const std::size_t a : face)
          areas[a] += 0.25 * area;
      }
    }
    const OwnFaces own_faces(
        body, with_itself ? surfaces[pair.nodes_of] : ContactSurface(), areas);
    const auto try_node = [&](const std::size_t i, const double share)
    {
      const Vec x = nodes.position[i];
      if (!face_box[pair.faces_of].contains(x))
        return;
      const auto near = buckets[pair.faces_of].find(x);
      if (near.first == near.second)
        return;
      const NodeKey key{pair.nodes_of, 0, nodes.global_id[i]};
      const auto known = std::lower_bound(memories.begin(), memories.end(), key,
                                          [](const auto &m, const NodeKey &k)
                                          { return m.first < k; });
      ContactMemory memory;
      if (known != memories.end() && known->first == key)
        memory = known->second;
      const double my_reach =
          std::clamp(memory.depth, spacing, deepest_known) + skin;
      const std::int64_t first = near_faces.size();
      for (const std::int32_t *item = near.first; item != near.second; ++item)
      {
        const std::int64_t f = first_face[pair.faces_of] + *item;
        const FaceNodes &face = result.faces[f];
        if (!boxes[f].contains(x) || is_farther(x, face.x, my_reach))
          continue;
        const FaceProjection projection = project_on_face(x, face.x);
        if (projection.distance_square < my_reach * my_reach &&
            (!with_itself || own_faces.may_meet(i, face, projection, memory)))
          near_faces.push_back(f);
      }
      const std::int64_t last = near_faces.size();
      if (last > first)
        candidates.push_back(
            {key, share, first, last, memory, with_areas ? areas[i] : Vec{}});
    };
    if (pair.loose_nodes_only)
    {
      if (body.particles() != nullptr)
        for (const std::size_t i : body.particles()->debris().nodes)
          if (nodes.inertia[i] > 0.) // followers stay with their leaders
            try_node(i, 1.);
    }
    else
    {
      const ContactSurface &surface = surfaces[pair.nodes_of];
      for (std::size_t k = 0; k < surface.nodes.size(); ++k)
        try_node(surface.nodes[k],
                 surface.node_share.empty() ? 1. : surface.node_share[k]);
    }
  }
  result.candidates = gather_all(candidates, communicator);
  result.face_of_candidate = gather_all(near_faces, communicator);
  // Lists of later ranks moved to the back.
  std::int64_t first = 0;
  for (ContactCandidate &c : result.candidates)
  {
    c.last_face += first - c.first_face;
    c.first_face = first;
    first = c.last_face;
  }
  const auto body_of_faces = [&](const ContactCandidate &c)
  { return result.faces[result.face_of_candidate[c.first_face]].body; };
  std::sort(result.candidates.begin(), result.candidates.end(),
            [&](const ContactCandidate &a, const ContactCandidate &b)
            {
              return a.node == b.node ? body_of_faces(a) < body_of_faces(b)
                                      : a.node < b.node;
            });
  return result;
}

double largest_closing_speed(const std::vector<Body *> &bodies,
                             const std::vector<std::pair<int, int>> &pairs,
                             MPI_Comm communicator)
{
  std::vector<char> used(bodies.size(), 0);
  for (const auto &pair : pairs)
    used[pair.first] = used[pair.second] = 1;
  Box all;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (used[b])
    {
      const NodalState &nodes = bodies[b]->nodes();
      for (std::size_t i = 0; i < nodes.n_owned; ++i)
        all.add(nodes.velocity[i]);
    }
  all.reduce(communicator);
  const Vec middle = 0.5 * (all.low + all.high);
  std::vector<double> square(bodies.size(), 0.);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (used[b])
    {
      const NodalState &nodes = bodies[b]->nodes();
      for (std::size_t i = 0; i < nodes.n_owned; ++i)
        square[b] =
            std::max(square[b], norm_square(nodes.velocity[i] - middle));
    }
  MPI_Allreduce(MPI_IN_PLACE, square.data(), square.size(), MPI_DOUBLE, MPI_MAX,
                communicator);
  double speed = 0.;
  for (const auto &pair : pairs)
    speed = std::max(speed, std::sqrt(square[pair.first]) +
                                std::sqrt(square[pair.second]));
  return speed;
}
} // namespace sabot
