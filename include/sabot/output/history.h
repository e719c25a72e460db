#ifndef sabot_output_history_h
#define sabot_output_history_h

#include "sabot/base/measures.h"

#include <map>
#include <string>
#include <vector>

namespace sabot
{
/** Tables that every history may have: no body or gauge can be called so. */
inline bool is_table_of_runs(const std::string &name)
{
  return name == "ledger" || name == "quantities" || name == "forces" ||
         name == "impulses";
}

/**
 * Tables of numbers over time: one per body, one for the energy ledger and one
 * for the quantities of interest, a row per history step, SI units. history.h5
 * holds one compound dataset per table whose fields are named with units
 * ("velocity z [m/s]"), without time stamps: equal runs give equal bytes. Kept
 * in memory and written whole, new then renamed. Python reads a table with
 * h5py.File("history.h5")["ledger"]["kinetic [J]"]. Rows are appended on all
 * ranks alike, so that each can save them.
 *
 *     ledger      time, step size, the terms of the energy (energy_terms), the
 *                 total and its residual
 *     <body>      time, mass, velocity, kinetic energy, bounds, internal
 *                 energy, and what the kind of body knows besides
 *     quantities  time, and the scene's quantities of interest
 */
class History
{
public:
  /** Columns with their numbers. */
  struct Table
  {
    std::vector<std::string> columns; // "name [unit]"
    std::vector<double> values;       // row by row, [n_rows * n_columns]
    std::size_t n_rows() const
    {
      return columns.empty() ? 0 : values.size() / columns.size();
    }
  };
  /** Columns are fixed by the first row of a table; std::logic_error for a row
      of another length. */
  void append(const std::string &table, const Measures &row);
  /** Write all tables that have columns; call on one rank. IOError. */
  void write(const std::string &file) const;
  /** Replace the tables by those of a file that write() has made. IOError
      where it is missing or damaged. */
  void read(const std::string &file);

  std::map<std::string, Table> tables; // by name
};
} // namespace sabot

#endif
