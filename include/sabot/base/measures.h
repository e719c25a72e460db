#ifndef sabot_base_measures_h
#define sabot_base_measures_h

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sabot
{
/** A named number with its SI unit ("1" for a pure number), for histories and
    results: a column "name [unit]". */
struct Measure
{
  std::string name, unit;
  double value;
};
using Measures = std::vector<Measure>;

/**
 * The value of the measure called @p name; throws std::logic_error where there
 * is none.
 * The first of that name; names are few, so the search is linear.
 */
double find_measure(const Measures &measures, const std::string &name);

/**
 * A whole body at one moment, the same on all ranks and, to the last bit, for
 * every number of ranks. What all bodies have stands in members, so that nobody
 * has to look for it by name; what only some kinds have stands in `own`.
 * In the fixed frame of the scene; bounds are of the present configuration.
 * Eroded mass and momentum have left the body since the start.
 */
struct BodyMeasures
{
  double mass = 0.;                    // [kg]
  std::array<double, 3> velocity{};    // of the center of mass [m/s]
  double kinetic_energy = 0.;          // [J]
  std::array<double, 3> low{}, high{}; // bounds of the nodes [m]
  double internal_energy = 0.;         // [J]
  /** What holds the discretization where it has no strain of its own:
      "hourglass" control of cells, "stabilization" of particles; empty where
      nothing does. Its energy [J] is also a column of own. */
  std::string control;
  double control_energy = 0.;
  /** The part of it that metal has which has failed by now [J]. */
  double control_in_failed = 0.;
  double eroded_mass = 0.;                 // [kg]
  std::array<double, 3> eroded_momentum{}; // [kg m/s]
  /** Momentum of what mass scaling added, less what that brought: it belongs to
      the balance, but not to mass times velocity. */
  std::array<double, 3> added_momentum{}; // [kg m/s]
  double bonds_broken_fraction = 0.;      // of all bonds of the start
  /** What the kind of body knows besides, e.g. hourglass energy, largest
      plastic strain, broken bonds: more columns of the history. */
  Measures own;

  /** All of it as columns of the history: mass, velocity, kinetic energy,
      bounds, internal energy, own. */
  Measures columns() const;
  /**
   * The column called @p name; throws std::logic_error where there is none.
   * Makes all columns for it: for results, not for loops.
   */
  double find(const std::string &name) const
  {
    return find_measure(columns(), name);
  }
};

/**
 * Values of one output field on the points or cells of an OutputMesh. Name,
 * unit and components are those of its description (output_fields.h).
 * Item after item, components of one item side by side. SI.
 */
struct OutputField
{
  std::string name, unit;
  unsigned int n_components = 1; // 1, 3, or 6 (xx, yy, zz, xy, yz, xz)
  std::vector<double> values;    // [n_items * n_components]
};

/** Output fields, all that there are or those that are wanted only. */
struct FieldList : std::vector<OutputField>
{
  std::vector<std::string> wanted; // names; empty: all
  bool wants(const std::string &name) const
  {
    return wanted.empty() ||
           std::find(wanted.begin(), wanted.end(), name) != wanted.end();
  }
};

/**
 * What one rank writes of one body: shared nodes on the deformed
 * configuration, hexahedra or single points. A rank without nodes of the body
 * has empty arrays, but the same fields, so that the pieces fit together.
 */
struct OutputMesh
{
  std::vector<double> points;             // [n_points * 3]
  unsigned int nodes_per_cell = 8;        // 8: hexahedra (VTK order), 1: points
  std::vector<std::int64_t> connectivity; // [n_cells * nodes_per_cell]
  FieldList point_fields, cell_fields;
};
} // namespace sabot

#endif
