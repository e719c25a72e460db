// Numbers of a study as CSV and HDF5.
#include "sabot/output/file_tools.h"
#include "sabot/study/results.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace sabot
{
namespace
{
/** A field as RFC 4180 wants it. */
std::string field(const std::string &text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}
} // namespace

void write_csv(const StudyResults &results, const std::string &file)
{
  const StudyFile &study = results.study;
  std::ostringstream csv;
  csv << std::setprecision(10) << "run,status";
  for (const StudyParameter &parameter : study.parameters)
    csv << "," << field(parameter.name);
  for (std::size_t q = 0; q < study.quantities.size(); ++q)
    csv << "," << field(study.quantities[q].name + " [" + results.unit(q) + "]")
        << ","
        << field(results.error_name(q) + (results.has_relative_error(q)
                                              ? ""
                                              : " [" + results.unit(q) + "]"));
  csv << ",CPU time [s],wall time [s],steps,cells and particles,"
         "energy residual";
  const std::vector<std::string> parts = energy_parts(results);
  for (const std::string &part : parts)
    csv << "," << field("energy " + part + " [J]");
  csv << ",zone verdict,reason\n";
  const auto number = [&](const double value)
  {
    csv << ",";
    if (std::isfinite(value)) // an empty field stands for no value
      csv << value;
  };
  for (std::size_t run = 0; run < study.runs.size(); ++run)
  {
    const StudyOutcome &outcome = results.outcomes[run];
    csv << study.runs[run].key << "," << outcome.status;
    for (std::size_t p = 0; p < study.parameters.size(); ++p)
      csv << ","
          << field(study.parameters[p].values[study.runs[run].choice[p]].label);
    for (std::size_t q = 0; q < study.quantities.size(); ++q)
    {
      number(outcome.quantities[q]);
      number(results.error(run, q));
    }
    for (const double value :
         {outcome.cpu_seconds, outcome.wall_seconds, outcome.steps,
          outcome.items, outcome.energy_residual})
      number(value);
    for (const std::string &part : parts)
      number(outcome.energy_of(part));
    csv << "," << field(outcome.zone) << "," << field(outcome.reason) << "\n";
  }
  write_text(file, csv.str());
}

void write_hdf5(const StudyResults &results, const std::string &file)
{
  const StudyFile &study = results.study;
  History tables;
  for (std::size_t run = 0; run < study.runs.size(); ++run)
  {
    const StudyOutcome &outcome = results.outcomes[run];
    Measures row = {{"run", "1", double(run)},
                    {"is complete", "1", double(outcome.is_complete())}};
    for (std::size_t p = 0; p < study.parameters.size(); ++p)
    {
      const std::size_t v = study.runs[run].choice[p];
      row.push_back(
          {study.parameters[p].name + ", number of value", "1", double(v)});
      row.push_back({study.parameters[p].name, "SI",
                     study.parameters[p].values[v].number});
    }
    for (std::size_t q = 0; q < study.quantities.size(); ++q)
    {
      row.push_back(
          {study.quantities[q].name, results.unit(q), outcome.quantities[q]});
      row.push_back({results.error_name(q), results.error_unit(q),
                     results.error(run, q)});
    }
    row.push_back({"CPU time", "s", outcome.cpu_seconds});
    row.push_back({"wall time", "s", outcome.wall_seconds});
    row.push_back({"steps", "1", outcome.steps});
    row.push_back({"energy residual", "1", outcome.energy_residual});
    tables.append("runs", row);
    if (!outcome.history.columns.empty())
      tables.tables["history of run " + std::to_string(run)] = outcome.history;
  }
  tables.write(file);
}
} // namespace sabot
