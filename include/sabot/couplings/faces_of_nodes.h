#ifndef sabot_couplings_faces_of_nodes_h
#define sabot_couplings_faces_of_nodes_h

#include "sabot/couplings/contact_search.h"
#include "sabot/couplings/node_table.h"

#include <vector>

namespace sabot
{
/** The faces around each node, ascending, of those that a search found. Local
    to a rank. */
class FacesOfNodes
{
public:
  /** Numbers of faces, as of the list at construction. */
  struct Range
  {
    const std::size_t *first, *last;
    const std::size_t *begin() const { return first; }
    const std::size_t *end() const { return last; }
  };

  FacesOfNodes(const std::vector<FaceNodes> &of,
               const std::vector<Body *> &bodies)
      : number(bodies), first(1, 0)
  {
    std::vector<std::size_t> count;
    for (const FaceNodes &face : of)
      for (const GlobalIndex a : face.node)
      {
        std::int32_t &node = number[{face.body, 0, a}];
        if (node == NodeTable::none)
        {
          node = std::int32_t(count.size());
          count.push_back(0);
        }
        ++count[node];
      }
    for (const std::size_t n : count)
      first.push_back(first.back() + n);
    faces.resize(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t f = 0; f < of.size(); ++f)
      for (const GlobalIndex a : of[f].node)
        faces[next[number[{of[f].body, 0, a}]]++] = f;
  }
  Range around(const NodeKey &node)
  {
    const std::int32_t n = number[node];
    if (n == NodeTable::none)
      return {nullptr, nullptr};
    return {faces.data() + first[n], faces.data() + first[n + 1]};
  }

private:
  NodeTable number;
  std::vector<std::size_t> first, faces;
};
} // namespace sabot

#endif
