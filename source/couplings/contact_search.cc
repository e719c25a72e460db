#include "sabot/couplings/contact_search.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace sabot
{
namespace
{
struct Box
{
  Vec low = {1e300, 1e300, 1e300, 0}, high = {-1e300, -1e300, -1e300, 0};

  void add(const Vec x)
  {
    for (int d = 0; d < 3; ++d)
    {
      low[d] = std::min(low[d], x[d]);
      high[d] = std::max(high[d], x[d]);
    }
  }
  void inflate(const double r)
  {
    low -= vec(r, r, r);
    high += vec(r, r, r);
  }
  bool contains(const Vec x) const
  {
    for (int d = 0; d < 3; ++d)
      if (!(x[d] >= low[d] && x[d] <= high[d]))
        return false;
    return true;
  }
  bool meets(const Box &o) const
  {
    for (int d = 0; d < 3; ++d)
      if (!(o.high[d] >= low[d] && o.low[d] <= high[d]))
        return false;
    return true;
  }
  void reduce(MPI_Comm communicator)
  {
    double lows[3] = {low[0], low[1], low[2]},
           highs[3] = {high[0], high[1], high[2]};
    MPI_Allreduce(MPI_IN_PLACE, lows, 3, MPI_DOUBLE, MPI_MIN, communicator);
    MPI_Allreduce(MPI_IN_PLACE, highs, 3, MPI_DOUBLE, MPI_MAX, communicator);
    low = vec(lows[0], lows[1], lows[2]);
    high = vec(highs[0], highs[1], highs[2]);
  }
};

/** Faces by the buckets that their inflated boxes cover. */
class Buckets
{
public:
  Buckets(const double size) : size(size) {}

  void insert(const Box &box, const std::int64_t item)
  {
    std::array<std::int64_t, 3> a, b;
    for (int d = 0; d < 3; ++d)
    {
      a[d] = index(box.low[d]);
      b[d] = index(box.high[d]);
    }
    for (std::int64_t k = a[2]; k <= b[2]; ++k)
      for (std::int64_t j = a[1]; j <= b[1]; ++j)
        for (std::int64_t i = a[0]; i <= b[0]; ++i)
          table[key(i, j, k)].push_back(item);
  }
  const std::vector<std::int64_t> *find(const Vec x) const
  {
    const auto found = table.find(key(index(x[0]), index(x[1]), index(x[2])));
    return found == table.end() ? nullptr : &found->second;
  }

private:
  std::int64_t index(const double x) const { return std::floor(x / size); }
  static std::int64_t key(const std::int64_t i, const std::int64_t j,
                          const std::int64_t k)
  {
    constexpr std::int64_t mask = (1 << 21) - 1;
    return (i & mask) << 42 | (j & mask) << 21 | (k & mask);
  }
  const double size;
  std::unordered_map<std::int64_t, std::vector<std::int64_t>> table;
};

Box box_of_faces(const Body &body, const ContactSurface &surface)
{
  Box box;
  for (const auto &face : surface.faces)
    for (const std::size_t a : face)
      box.add(body.nodes().position[a]);
  return box;
}
} // namespace

SearchResult search_contacts(const std::vector<Body *> &bodies,
                             const std::vector<ContactPair> &pairs,
                             const ContactMemories &memories,
                             const double reach, MPI_Comm communicator)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::vector<ContactSurface> surfaces(bodies.size());
  std::vector<Box> face_box(bodies.size()), node_box(bodies.size());
  std::vector<char> used(bodies.size(), 0);
  for (const ContactPair &pair : pairs)
    used[pair.faces_of] = used[pair.nodes_of] = 1;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (used[b])
    {
      surfaces[b] = bodies[b]->contact_surface();
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

  // A bucket of about a face keeps both lists and look-ups short.
  double face_size = reach;
  std::vector<Box> boxes(result.faces.size());
  for (std::size_t f = 0; f < result.faces.size(); ++f)
  {
    for (const Vec x : result.faces[f].x)
      boxes[f].add(x);
    boxes[f].inflate(reach);
  }
  std::vector<Buckets> buckets(bodies.size(), Buckets(2. * face_size));
  for (std::size_t f = 0; f < result.faces.size(); ++f)
    buckets[result.faces[f].body].insert(boxes[f], f);

  std::vector<ContactCandidate> candidates;
  for (const ContactPair &pair : pairs)
  {
    const Body &body = *bodies[pair.nodes_of];
    const NodalState &nodes = body.nodes();
    const auto try_node = [&](const std::size_t i, const double share)
    {
      const Vec x = nodes.position[i];
      if (!face_box[pair.faces_of].contains(x))
        return;
      const auto *const near = buckets[pair.faces_of].find(x);
      if (near == nullptr)
        return;
      const NodeKey key{pair.nodes_of, 0, nodes.global_id[i]};
      const auto known = std::lower_bound(memories.begin(), memories.end(), key,
                                          [](const auto &m, const NodeKey &k)
                                          { return m.first < k; });
      const ContactMemory memory =
          known != memories.end() && known->first == key ? known->second
                                                         : ContactMemory();
      for (const std::int64_t f : *near)
        if (boxes[f].contains(x) && !is_farther(x, result.faces[f].x, reach) &&
            project_on_face(x, result.faces[f].x).distance_square <
                reach * reach)
          candidates.push_back({key, f, share, memory});
    };
    if (pair.loose_nodes_only)
    {
      for (const std::size_t i : body.debris().nodes)
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
  std::sort(result.candidates.begin(), result.candidates.end(),
            [](const ContactCandidate &a, const ContactCandidate &b)
            { return a.node == b.node ? a.face < b.face : a.node < b.node; });
  return result;
}

double largest_speed(const std::vector<Body *> &bodies, MPI_Comm communicator)
{
  double square = 0.;
  for (const Body *body : bodies)
    for (std::size_t i = 0; i < body->nodes().n_owned; ++i)
      square = std::max(square, norm_square(body->nodes().velocity[i]));
  MPI_Allreduce(MPI_IN_PLACE, &square, 1, MPI_DOUBLE, MPI_MAX, communicator);
  return std::sqrt(square);
}
} // namespace sabot
