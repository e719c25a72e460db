// Fields and histories that the outputs of a run share.
#include "sabot/output/run_files.h"

#include "sabot/base/error.h"
#include "sabot/base/error_report.h"
#include "sabot/base/text.h"
#include "sabot/bodies/body.h"
#include "sabot/output/first_rank.h"
#include "sabot/output/vtu_writer.h"

namespace sabot
{
RunFiles::RunFiles(const std::string &folder, MPI_Comm communicator)
    : folder(folder), communicator(communicator)
{
}

RunFiles::~RunFiles() = default;

void RunFiles::keep_folder()
{
  kept = std::make_unique<KeptFolder>(folder);
}

std::string RunFiles::folder_trouble() const
{
  return kept ? kept->trouble() : "";
}

void RunFiles::open_fields()
{
  if (!fields)
    fields = std::make_unique<VtuWriter>(folder, communicator);
}

bool RunFiles::write_fields(const double time,
                            const std::vector<const Body *> &bodies)
{
  open_fields();
  if (!fields->frames.empty() && fields->frames.back().first == time)
    return false;
  std::vector<std::string> names;
  for (const Body *const body : bodies)
  {
    within_memory(
        "the fields of \"Bodies/" + body->name + "\"",
        [&]() { fields->write_body(body->name, body->output_mesh(), frame); });
    names.push_back(body->name);
  }
  fields->add_time(time, frame, names);
  ++frame;
  return true;
}

std::size_t RunFiles::n_rows() const
{
  std::size_t n = 0;
  for (const auto &table : history.tables)
    n += table.second.n_rows();
  return n;
}

void RunFiles::write_history()
{
  if (n_rows() == n_written)
    return;
  n_written = n_rows();
  on_first_rank(communicator, "write its output",
                [&]()
                {
                  if (kept)
                    kept->check();
                  history.write(folder + "/history.h5");
                });
}

void RunFiles::visit_history(StateVisitor &visitor)
{
  std::string names;
  for (const auto &table : history.tables)
    names += table.first + "\n";
  visitor.visit_text("tables", names);
  for (const std::string &name : split(names, '\n'))
  {
    History::Table &table = history.tables[name];
    std::string columns;
    for (const std::string &column : table.columns)
      columns += column + "\n";
    visitor.visit_text(name + " columns", columns);
    table.columns = split(columns, '\n');
    visitor.visit_resized(name + " values", table.values);
  }
}

void RunFiles::visit_state(StateVisitor &visitor)
{
  // The same on every rank, so that any rank can write them.
  visit_history(visitor);
  visitor.visit_value("frame", frame);
  std::vector<double> times;
  std::vector<unsigned int> numbers;
  if (fields)
    for (const auto &[time, number] : fields->frames)
    {
      times.push_back(time);
      numbers.push_back(number);
    }
  visitor.visit_resized("frame times", times);
  visitor.visit_resized("frame numbers", numbers);
  if (!visitor.is_restoring() || times.empty())
    return;
  open_fields();
  fields->frames.clear();
  for (std::size_t i = 0; i < times.size(); ++i)
    fields->frames.emplace_back(times[i], numbers[i]);
}
} // namespace sabot
