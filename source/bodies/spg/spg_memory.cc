// Bytes of an SPG body's arrays, room by room.
#include "sabot/bodies/memory_lists.h"
#include "sabot/bodies/spg/spg_body.h"

namespace sabot
{
void SpgBody::list_memory(MemoryTable &table) const
{
  sabot::list_memory(nodal_state, table);
  bonds.list_memory(table);
  fields.list_memory(table);
  approximation.list_memory(table);
  stabilization->list_memory(table);
  sabot::list_memory(points, table);
  failure.list_memory(table);
  stable.list_memory(table);
  kernel.list_memory(table);
  surface.list_memory(table);
  table.add("rank of every particle of the body", rank_of);
}
} // namespace sabot
