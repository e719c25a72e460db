// Adds the output "CSV": averages and energies as text, one file for each table
// that history.h5 would have, in the folder csv of the run,
//
//   time [s],mass [kg],velocity x [m/s],...
//   0,0.0027,10,...
//
// after RFC 4180, numbers with all their digits, for programs that read no HDF5
// and for whoever watches a run. To keep it, copy this file into source/output.
// Scene: output.prm.
#include "sabot/output/output.h"
#include "sabot/base/error.h"
#include "sabot/base/registry.h"
#include "sabot/output/file_tools.h"
#include "sabot/output/run_files.h"

#include <iomanip>
#include <limits>
#include <sstream>

namespace sabot
{
namespace
{
std::string to_csv(const History::Table &table)
{
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10);
  const std::size_t n = table.columns.size();
  for (std::size_t c = 0; c < n; ++c)
    text << (c > 0 ? "," : "") << table.columns[c];
  for (std::size_t i = 0; i < table.values.size(); ++i)
    text << (i % n > 0 ? "," : "\n") << table.values[i];
  text << "\n";
  return text.str();
}

class CsvOutput : public SceneOutput
{
public:
  /** The run appends a row to every table before each write. The tables are
      part of checkpoints, so that a resumed run writes what the straight one
      would. */
  bool needs_rows() const override { return true; }

protected:
  void write(const OutputMoment &, RunFiles &files) override
  {
    // The tables are the same on every rank: the first writes, all learn
    // whether it could.
    int rank, is_bad = 0;
    MPI_Comm_rank(files.communicator, &rank);
    std::string problem = "rank 0 could not write its output";
    if (rank == 0)
      try
      {
        const std::string folder = files.folder + "/csv";
        make_folder(folder);
        for (const auto &[name, table] : files.history.tables)
          write_text(folder + "/" + name + ".csv", to_csv(table));
      }
      catch (const IOError &error)
      {
        problem = error.what();
        is_bad = 1;
      }
    MPI_Bcast(&is_bad, 1, MPI_INT, 0, files.communicator);
    if (is_bad)
      throw IOError(problem);
  }
};

const Registry<SceneOutput>::Add
    registered({"CSV", "averages and energies as text in csv.", nullptr,
                [](const Parameters &, const std::string &)
                { return std::make_unique<CsvOutput>(); }});
} // namespace
} // namespace sabot
