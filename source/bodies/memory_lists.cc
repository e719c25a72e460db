// Bytes of what bodies of cells and of particles have in common.
#include "sabot/bodies/memory_lists.h"

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/material_points.h"

namespace sabot
{
void list_memory(const NodalState &nodes, MemoryTable &table)
{
  table.add("node numbers", nodes.global_id);
  table.add("positions of the start", nodes.reference_position);
  table.add("positions", nodes.position);
  table.add("velocities", nodes.velocity);
  table.add("forces", nodes.force);
  table.add("masses", nodes.lumped_mass);
  table.add("inertias", nodes.inertia);
  table.add("added masses", nodes.added_mass);
}

void list_memory(const MaterialPoints &points, MemoryTable &table)
{
  table.add("stress", points.stress);
  table.add("state of the law", points.state_data);
  table.add("viscous pressure", points.viscous_pressure);
  table.add("internal energy", points.internal_energy);
  table.add("plastic work", points.plastic_work);
}

const MemoryView *memory_view(const Body &body)
{
  if (const auto *const view =
          dynamic_cast<const MemoryView *>(body.particles()))
    return view;
  return dynamic_cast<const MemoryView *>(body.faces());
}
} // namespace sabot
