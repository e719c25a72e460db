// Bytes of a FEM body's arrays.
#include "sabot/bodies/fem/fem_body.h"
#include "sabot/bodies/memory_lists.h"

namespace sabot
{
void Hexahedra::list_memory(MemoryTable &table) const
{
  table.add("corners of cells", connectivity);
  table.add("cell numbers", cell_id);
  table.add("volumes of the start", volume);
  table.add("hourglass energy", hourglass_energy);
  table.add("steps of cells", cell_step);
  table.add("added shares", added_share);
  sabot::list_memory(points, table);
}

void FemBody::list_memory(MemoryTable &table) const
{
  sabot::list_memory(nodal_state, table);
  cells->list_memory(table);
  table.add("owned cells", owned_cell);
  table.add("faces", boundary.faces);
  table.add("face numbers", boundary.face_id);
  table.add("cells of faces", known_cell_of_faces);
}
} // namespace sabot
