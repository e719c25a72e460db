// Quantity of interest: what a column of the histories comes to.
#include "sabot/base/nearest_name.h"
#include "sabot/output/history.h"
#include "sabot/simulation/quantity_of_interest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sabot
{
namespace
{
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/** "kinetic" of "kinetic [J]". */
std::string without_unit(const std::string &column)
{
  return column.substr(0, column.rfind(" ["));
}

/** The last, largest or smallest value in the rows of a column so far. Rows are
    all there is: nothing is added to them. */
class HistoryValue : public QuantityOfInterest
{
public:
  explicit HistoryValue(const QuantityRequest &request)
      : path(request.path), table(request.prm.get("Table")),
        column(request.prm.get("Column")), which(request.prm.get("Value"))
  {
    if (std::find(request.tables.begin(), request.tables.end(), table) ==
        request.tables.end())
      throw_unknown_name(path + "/Table", "table", table, request.tables);
  }
  void check(const ColumnsOf &columns_of) override
  {
    std::vector<std::string> names;
    for (const std::string &name : columns_of(table))
    {
      if (name == column || without_unit(name) == column)
      {
        found = name;
        return;
      }
      names.push_back(without_unit(name));
    }
    throw_unknown_name(path + "/Column", "column of table \"" + table + "\"",
                       column, names);
  }
  void attach(const History &its) override { history = &its; }

  double value() const override { return row().value; }
  std::string unit() const override
  {
    const std::size_t begin = found.rfind('[') + 1;
    return found.substr(begin, found.size() - begin - 1);
  }
  Measures details() const override { return {{"at time", "s", row().time}}; }

private:
  struct Row
  {
    double time = nothing, value = nothing; // [s], SI
  };
  /** The first of those that are as far out. */
  Row row() const
  {
    Row best;
    if (history == nullptr || history->tables.count(table) == 0)
      return best;
    const History::Table &its = history->tables.at(table);
    const std::size_t c =
        std::find(its.columns.begin(), its.columns.end(), found) -
        its.columns.begin();
    for (std::size_t r = 0; r < its.n_rows() && c < its.columns.size(); ++r)
    {
      const double *const values = &its.values[r * its.columns.size()];
      const double v = values[c];
      // What is no number stays, so that it is seen.
      if (r == 0 || which == "final" || std::isnan(v) ||
          (which == "maximum" && v > best.value) ||
          (which == "minimum" && v < best.value) ||
          (which == "largest magnitude" && std::abs(v) > std::abs(best.value)))
        best = {values[0], v};
    }
    return best;
  }

  const std::string path, table, column, which;
  std::string found; // the column with its unit
  const History *history = nullptr;
};

void declare(Parameters &prm)
{
  prm.declare_entry("Table", "ledger", any_text(),
                    "Table of history.h5: a body, an output of type gauge, "
                    "ledger, forces or impulses.");
  prm.declare_entry(
      "Column", "total", any_text(),
      "Its column, with or without the unit: \"kinetic\", \"impact "
      "on plate z\".");
  prm.declare_entry("Value", "maximum",
                    one_of("final|maximum|minimum|largest magnitude"),
                    "Which of the values in its rows so far; the time of the "
                    "row stands in result.json.");
}

const Registry<QuantityOfInterest>::Add registered(
    {"history", "the last or an extreme value in the rows of a history.",
     declare, [](const QuantityRequest &request) {
       return std::make_unique<HistoryValue>(request);
     }});
} // namespace
} // namespace sabot
