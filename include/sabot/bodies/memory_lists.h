#ifndef sabot_bodies_memory_lists_h
#define sabot_bodies_memory_lists_h

#include "sabot/base/memory_table.h"

namespace sabot
{
class Body;
class MaterialPoints;
struct NodalState;

/** The arrays of a body's nodes and of its material points, for tables of
    memory. */
void list_memory(const NodalState &nodes, MemoryTable &table);
void list_memory(const MaterialPoints &points, MemoryTable &table);
/** Where the memory of @p body goes; null for one that does not say. */
const MemoryView *memory_view(const Body &body);
} // namespace sabot

#endif
