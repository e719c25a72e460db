// Bucket search of the faces that nodes may touch.
#include "sabot/couplings/contact_search.h"

#include "sabot/base/send_some.h"
#include "sabot/couplings/box_buckets.h"
#include "sabot/couplings/share_candidates.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Which faces of its own body a node may meet: those that it faces, from
    outside, and that are no neighbors of its own faces. */
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
  /** @p x: where node @p i is. */
  bool may_meet(const std::size_t i, const Vec x, const FaceNodes &face,
                const ContactMemory &memory) const
  {
    constexpr double cosine = 0.5; // as Contact
    // Corners look half away from what they meet (0.58), bent ones more.
    constexpr double facing = 0.25;
    for (const GlobalIndex a : ring[i])
      if (std::find(face.node.begin(), face.node.end(), a) != face.node.end())
        return false;
    const FaceProjection projection = project_on_face(x, face.x);
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

/** Quarters of the area vectors of a node's faces [m^2], current. */
AlignedVector<Vec> node_areas(const NodalState &nodes,
                              const ContactSurface &surface)
{
  AlignedVector<Vec> areas;
  areas.assign(nodes.size(), Vec{});
  for (const auto &face : surface.faces)
  {
    const Vec area =
        0.5 * cross(nodes.position[face[2]] - nodes.position[face[0]],
                    nodes.position[face[3]] - nodes.position[face[1]]);
    for (const std::size_t a : face)
      areas[a] += 0.25 * area;
  }
  return areas;
}

/** The boxes around a body's faces and nodes, reach included. */
struct Extent
{
  bool is_used = false; // the body is in a pair
  Box faces, nodes;
};

std::vector<Extent> find_extents(const ContactSearch &search,
                                 const double reach)
{
  std::vector<Extent> extents(search.bodies.size());
  for (const ContactPair &pair : search.pairs)
    extents[pair.faces_of].is_used = extents[pair.nodes_of].is_used = true;
  for (std::size_t b = 0; b < extents.size(); ++b)
  {
    Extent &extent = extents[b];
    if (!extent.is_used)
      continue;
    const NodalState &nodes = search.bodies[b]->nodes();
    for (const auto &face : search.surfaces[b].faces)
      for (const std::size_t a : face)
        extent.faces.add(nodes.position[a]);
    for (const std::size_t i : search.surfaces[b].nodes)
      extent.nodes.add(nodes.position[i]);
    extent.faces.reduce(search.communicator);
    extent.nodes.reduce(search.communicator);
    extent.faces.inflate(reach);
    extent.nodes.inflate(reach);
  }
  return extents;
}

/** Largest extent of a body's faces along an axis [m]. Collective. */
double widest_face(const NodalState &nodes, const ContactSurface &surface,
                   MPI_Comm communicator)
{
  double widest = 0.;
  for (const auto &face : surface.faces)
  {
    Box box;
    for (const std::size_t a : face)
      box.add(nodes.position[a]);
    for (int d = 0; d < 3; ++d)
      widest = std::max(widest, box.high[d] - box.low[d]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &widest, 1, MPI_DOUBLE, MPI_MAX, communicator);
  return widest;
}

/** To each rank the faces within @p distance [m] along all axes of a box around
    those of its nodes that may touch any, from all others. Collective. */
std::vector<FaceNodes> send_near(const ContactSearch &search,
                                 const std::vector<Extent> &extents,
                                 const std::vector<FaceNodes> &mine,
                                 const double distance)
{
  Box around;
  for (const ContactPair &pair : search.pairs)
    for (const std::size_t i : search.surfaces[pair.nodes_of].nodes)
    {
      const Vec x = search.bodies[pair.nodes_of]->nodes().position[i];
      if (extents[pair.faces_of].faces.contains(x))
        around.add(x);
    }
  around.inflate(distance);
  const std::vector<Box> boxes = boxes_of_ranks(around, search.communicator);
  std::vector<std::vector<FaceNodes>> to_rank(boxes.size());
  for (const FaceNodes &face : mine)
  {
    Box box;
    for (const Vec x : face.x)
      box.add(x);
    for (std::size_t r = 0; r < boxes.size(); ++r)
      if (boxes[r].meets(box))
        to_rank[r].push_back(face);
  }
  return send_some(to_rank, search.communicator);
}

/** Faces near nodes of other bodies, those around their corners, and those
    around nodes near other bodies' faces, for their normals; each from the rank
    of its lowest node, to those that have nodes near it. Collective. */
std::vector<FaceNodes> gather_faces(const ContactSearch &search,
                                    const std::vector<Extent> &extents,
                                    const double reach)
{
  int rank;
  MPI_Comm_rank(search.communicator, &rank);
  std::vector<FaceNodes> mine;
  double widest_of_all = 0.;
  for (std::size_t b = 0; b < extents.size(); ++b)
  {
    if (!extents[b].is_used)
      continue;
    const Body &body = *search.bodies[b];
    const NodalState &nodes = body.nodes();
    const double widest =
        widest_face(nodes, search.surfaces[b], search.communicator);
    widest_of_all = std::max(widest_of_all, widest);
    for (std::size_t f = 0; f < search.surfaces[b].faces.size(); ++f)
    {
      FaceNodes face;
      face.body = b;
      face.id = search.surfaces[b].face_id[f];
      Box box;
      for (int a = 0; a < 4; ++a)
      {
        const std::size_t i = search.surfaces[b].faces[f][a];
        face.node[a] = nodes.global_id[i];
        face.x[a] = nodes.position[i];
        box.add(face.x[a]);
      }
      if (body.node_owner[*std::min_element(face.node.begin(),
                                            face.node.end())] != rank)
        continue;
      Box with_neighbors = box;
      with_neighbors.inflate(widest);
      if (std::any_of(
              search.pairs.begin(), search.pairs.end(),
              [&](const ContactPair &pair)
              {
                return (pair.faces_of == int(b) &&
                        with_neighbors.meets(extents[pair.nodes_of].nodes)) ||
                       (pair.nodes_of == int(b) &&
                        with_neighbors.meets(extents[pair.faces_of].faces));
              }))
        mine.push_back(face);
    }
  }
  std::vector<FaceNodes> all =
      send_near(search, extents, mine, (1. + 1e-9) * reach + widest_of_all);
  std::sort(all.begin(), all.end(),
            [](const FaceNodes &a, const FaceNodes &b)
            { return a.body != b.body ? a.body < b.body : a.id < b.id; });
  return all;
}

/** Faces of each body by the buckets that they reach into. */
class FaceBuckets
{
public:
  FaceBuckets(const std::vector<FaceNodes> &faces, const std::size_t n_bodies,
              const double reach)
      : boxes(faces.size()), first_face(n_bodies + 1, 0)
  {
    std::vector<Box> around(faces.size());
    // Faces of a body are contiguous.
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      for (const Vec x : faces[f].x)
        boxes[f].add(x);
      around[f] = boxes[f];
      around[f].inflate(reach);
      ++first_face[faces[f].body + 1];
    }
    for (std::size_t b = 0; b < n_bodies; ++b)
    {
      first_face[b + 1] += first_face[b];
      buckets.emplace_back(std::vector<Box>(around.begin() + first_face[b],
                                            around.begin() + first_face[b + 1]),
                           reach);
    }
  }
  bool any_near(const int body, const Vec x) const
  {
    const auto near = buckets[body].find(x);
    return near.first != near.second;
  }
  /** Calls @p action(face) for the faces of @p body whose boxes are within
      @p distance of @p x, ascending: those that may be as near, and few others.
      @return the number of boxes that were looked at. */
  template <typename Action>
  std::int64_t for_near(const int body, const Vec x, const double distance,
                        const Action &action) const
  {
    const auto near = buckets[body].find(x);
    for (const std::int32_t *item = near.first; item != near.second; ++item)
    {
      const std::int64_t f = first_face[body] + *item;
      if (boxes[f].distance_square(x) <= distance * distance)
        action(f);
    }
    return near.second - near.first;
  }

private:
  std::vector<Box> boxes;
  std::vector<std::size_t> first_face; // of each body
  std::vector<BoxBuckets> buckets;     // per body
};

/** Depth up to which a node that went in still sees the face it came by. */
double deepest_known(const ContactSearch &search)
{
  return 3. * search.spacing;
}

ContactMemory recall(const ContactMemories &memories, const NodeKey &key)
{
  const auto known = std::lower_bound(memories.begin(), memories.end(), key,
                                      [](const auto &m, const NodeKey &k)
                                      { return m.first < k; });
  return known != memories.end() && known->first == key ? known->second
                                                        : ContactMemory();
}

/** ContactCandidate::cut of a node at @p x. */
double part_of_cut_node(const Vec x, const ContactSurface &own,
                        const ContactSurface &its)
{
  double part = 1.;
  for (const SymmetryPlane &plane : its.symmetry_planes)
    if (std::find(own.symmetry_planes.begin(), own.symmetry_planes.end(),
                  plane) == own.symmetry_planes.end() &&
        std::abs(x[plane.axis] - plane.coordinate) <= 1e-6 * its.spacing)
      part *= 0.5;
  return part;
}

/** Append to @p result what the nodes of @p pair that are owned here may
    touch. */
void try_nodes(const ContactSearch &search, const ContactPair &pair,
               const Box &face_box, const FaceBuckets &buckets,
               SearchResult &result)
{
  const Body &body = *search.bodies[pair.nodes_of];
  const ContactSurface &surface = search.surfaces[pair.nodes_of];
  const NodalState &nodes = body.nodes();
  const bool with_itself = pair.faces_of == pair.nodes_of;
  const ParticleView *const particles = body.particles();
  AlignedVector<Vec> areas;
  if (search.with_areas || with_itself)
    areas = node_areas(nodes, surface);
  const OwnFaces own_faces(body, with_itself ? surface : ContactSurface(),
                           areas);
  std::vector<std::int64_t> &near = result.face_of_candidate;
  std::vector<char> is_loose(particles != nullptr ? nodes.size() : 0, 0);
  if (particles != nullptr)
    for (const std::size_t i : particles->debris().nodes)
      is_loose[i] = 1;
  const auto try_node = [&](const std::size_t i, const double share)
  {
    const Vec x = nodes.position[i];
    if (!face_box.contains(x) || !buckets.any_near(pair.faces_of, x))
      return;
    const NodeKey key{pair.nodes_of, 0, nodes.global_id[i]};
    const ContactMemory memory = recall(search.memories, key);
    const double reach =
        std::clamp(memory.depth, search.spacing, deepest_known(search)) +
        search.skin;
    const std::int64_t first = near.size();
    result.n_compared += buckets.for_near(
        pair.faces_of, x, reach,
        [&](const std::int64_t f)
        {
          if (!with_itself || own_faces.may_meet(i, x, result.faces[f], memory))
            near.push_back(f);
        });
    const std::int64_t last = near.size();
    SmoothNormal own;
    if (last > first && particles != nullptr && !is_loose[i])
    {
      const SurfacePoint point = particles->surface_point(i);
      own = {point.normal, point.spread};
    }
    if (last > first)
      result.candidates.push_back(
          {key, share, first, last, memory,
           search.with_areas ? areas[i] : Vec{}, own,
           part_of_cut_node(x, surface, search.surfaces[pair.faces_of])});
  };
  if (!pair.loose_nodes_only)
    for (std::size_t k = 0; k < surface.nodes.size(); ++k)
      try_node(surface.nodes[k],
               surface.node_share.empty() ? 1. : surface.node_share[k]);
  else if (particles != nullptr)
    for (const std::size_t i : particles->debris().nodes)
      if (!nodes.is_follower(i)) // followers stay with their leaders
        try_node(i, 1.);
}
} // namespace

SearchResult ContactSearch::find() const
{
  double deepest = spacing;
  for (const auto &[key, memory] : memories)
    deepest = std::max(deepest, std::min(memory.depth, deepest_known(*this)));
  MPI_Allreduce(MPI_IN_PLACE, &deepest, 1, MPI_DOUBLE, MPI_MAX, communicator);
  const double reach = deepest + skin;
  const std::vector<Extent> extents = find_extents(*this, reach);
  SearchResult result;
  result.faces = gather_faces(*this, extents, reach);
  const FaceBuckets buckets(result.faces, bodies.size(), reach);
  result.candidates.reserve(2 * memories.size());
  for (const ContactPair &pair : pairs)
    try_nodes(*this, pair, extents[pair.faces_of].faces, buckets, result);
  share_candidates(result, bodies, communicator);
  return result;
}
} // namespace sabot
