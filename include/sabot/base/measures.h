#ifndef sabot_base_measures_h
#define sabot_base_measures_h

#include <cstdint>
#include <string>
#include <vector>

namespace sabot
{
/** A named number with its SI unit, for histories and results. */
struct Measure
{
  std::string name, unit;
  double value;
};
using Measures = std::vector<Measure>;

/** Values of one output field on the points or cells of an OutputMesh. */
struct OutputField
{
  std::string name, unit;
  unsigned int n_components = 1; // 1, 3, or 6 (xx, yy, zz, xy, yz, xz)
  std::vector<double> values;    // [n_items * n_components]
};

/** What one rank writes of one body: shared nodes on the deformed
    configuration, hexahedra or single points. */
struct OutputMesh
{
  std::vector<double> points;             // [n_points * 3]
  unsigned int nodes_per_cell = 8;        // 8: hexahedra (VTK order), 1: points
  std::vector<std::int64_t> connectivity; // [n_cells * nodes_per_cell]
  std::vector<OutputField> point_fields, cell_fields;
};
} // namespace sabot

#endif
