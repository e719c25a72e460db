#include "sabot/couplings/contact_search.h"

#include <algorithm>
#include <cmath>

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

/** Faces by the buckets of a regular grid that their boxes cover, as one
    compressed list. */
class Buckets
{
public:
  /** @p boxes: of the items; @p size: of a bucket, made larger where boxes are
      far between. */
  Buckets(const std::vector<Box> &boxes, double size)
  {
    Box all;
    for (const Box &box : boxes)
    {
      all.add(box.low);
      all.add(box.high);
    }
    low = all.low;
    if (boxes.empty())
      return;
    const double most = 20. * boxes.size() + 1000.;
    for (;; size *= 1.3)
    {
      double total = 1.;
      for (int d = 0; d < 3; ++d)
      {
        const double cells = std::floor((all.high[d] - low[d]) / size) + 1.;
        total *= cells;
        n[d] = std::int64_t(std::min(cells, 1e9));
      }
      if (total <= most)
        break;
    }
    scale = 1. / size;
    start.assign(n[0] * n[1] * n[2] + 1, 0);
    for (const Box &box : boxes)
      for_all(box, [&](const std::int64_t bucket) { ++start[bucket + 1]; });
    for (std::size_t k = 1; k < start.size(); ++k)
      start[k] += start[k - 1];
    items.resize(start.back());
    std::vector<std::int32_t> next(start.begin(), start.end() - 1);
    for (std::size_t item = 0; item < boxes.size(); ++item)
      for_all(boxes[item],
              [&](const std::int64_t bucket) { items[next[bucket]++] = item; });
  }
  /** Items whose box may contain @p x, ascending. */
  std::pair<const std::int32_t *, const std::int32_t *> find(const Vec x) const
  {
    std::array<std::int64_t, 3> i;
    for (int d = 0; d < 3; ++d)
    {
      const double cell = std::floor((x[d] - low[d]) * scale);
      if (!(cell >= 0. && cell < double(n[d])))
        return {nullptr, nullptr};
      i[d] = std::int64_t(cell);
    }
    const std::int64_t bucket = (i[2] * n[1] + i[1]) * n[0] + i[0];
    return {items.data() + start[bucket], items.data() + start[bucket + 1]};
  }

private:
  template <typename Action>
  void for_all(const Box &box, const Action &action) const
  {
    std::array<std::int64_t, 3> a, b;
    for (int d = 0; d < 3; ++d)
    {
      a[d] = std::int64_t((box.low[d] - low[d]) * scale);
      b[d] = std::min(std::int64_t((box.high[d] - low[d]) * scale), n[d] - 1);
    }
    for (std::int64_t k = a[2]; k <= b[2]; ++k)
      for (std::int64_t j = a[1]; j <= b[1]; ++j)
        for (std::int64_t i = a[0]; i <= b[0]; ++i)
          action((k * n[1] + j) * n[0] + i);
  }
  Vec low;
  double scale = 0.;
  std::array<std::int64_t, 3> n{{0, 0, 0}};
  std::vector<std::int32_t> start, items;
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
  std::vector<Buckets> buckets;
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
    if (with_areas)
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
        if (boxes[f].contains(x) &&
            !is_farther(x, result.faces[f].x, my_reach) &&
            project_on_face(x, result.faces[f].x).distance_square <
                my_reach * my_reach)
          near_faces.push_back(f);
      }
      const std::int64_t last = near_faces.size();
      if (last > first)
        candidates.push_back(
            {key, share, first, last, memory, with_areas ? areas[i] : Vec{}});
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
