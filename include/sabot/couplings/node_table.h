#ifndef sabot_couplings_node_table_h
#define sabot_couplings_node_table_h

#include "sabot/couplings/node_halo.h"

#include <cstdint>
#include <vector>

namespace sabot
{
/**
 * A number for each of some nodes of some bodies, found at once by the node,
 * for the time of a search: four bytes for every node of each body that comes
 * up, against a logarithm of comparisons in a sorted list. Local to a rank.
 */
class NodeTable
{
public:
  static constexpr std::int32_t none = -1;

  /** @p bodies: indexed by NodeKey::body; must outlive this object. */
  explicit NodeTable(const std::vector<Body *> &bodies)
      : bodies(bodies), rows(bodies.size())
  {
  }
  /** The number of a node, to be set; none at first. */
  std::int32_t &operator[](const NodeKey &key)
  {
    std::vector<std::int32_t> &row = rows[key.body];
    if (row.empty())
      row.assign(bodies[key.body]->node_owner.size(), none);
    return row[key.node];
  }
  /** All nodes that have a number, ascending. */
  std::vector<NodeKey> keys() const
  {
    std::vector<NodeKey> found;
    for (std::size_t b = 0; b < rows.size(); ++b)
      for (std::size_t i = 0; i < rows[b].size(); ++i)
        if (rows[b][i] != none)
          found.push_back({std::int32_t(b), 0, GlobalIndex(i)});
    return found;
  }
  /** From now on the slots of @p halo, of nodes that have a number. */
  void take_slots(const NodeHalo &halo)
  {
    for (std::size_t s = 0; s < halo.size(); ++s)
    {
      const NodeKey &key = halo.key(s);
      if (!rows[key.body].empty())
        rows[key.body][key.node] = std::int32_t(s);
    }
  }

private:
  const std::vector<Body *> &bodies;
  std::vector<std::vector<std::int32_t>> rows; // empty: not asked for
};
} // namespace sabot

#endif
