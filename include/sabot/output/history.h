#ifndef sabot_output_history_h
#define sabot_output_history_h

#include "sabot/base/measures.h"

#include <map>
#include <string>
#include <vector>

namespace sabot
{
/**
 * Tables of numbers over time: one per body and one for the energy ledger, a
 * row per history step. history.h5 holds one compound dataset per table whose
 * fields are named with units ("velocity z [m/s]"), without time stamps: equal
 * runs give equal bytes. Kept in memory and written whole, new then renamed.
 */
class History
{
public:
  struct Table
  {
    std::vector<std::string> columns;
    std::vector<double> values; // row by row
    std::size_t n_rows() const
    {
      return columns.empty() ? 0 : values.size() / columns.size();
    }
  };
  /** Columns are fixed by the first row of a table. */
  void append(const std::string &table, const Measures &row);
  /** Write all tables; call on one rank. IOError. */
  void write(const std::string &file) const;
  /** Read tables written before, for a resumed run. IOError. */
  void read(const std::string &file);

  std::map<std::string, Table> tables;
};
} // namespace sabot

#endif
