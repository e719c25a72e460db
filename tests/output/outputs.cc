// Outputs of a run: when they write, and what they share.
#include "temporary_folder.h"

#include "sabot/base/registry.h"
#include "sabot/bodies/body.h"
#include "sabot/output/checkpoint.h"
#include "sabot/output/output.h"
#include "sabot/output/run_files.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace
{
using namespace sabot;

class Outputs : public TemporaryFolder
{
protected:
  std::unique_ptr<SceneOutput> make(const std::string &type,
                                    const std::string &interval)
  {
    Parameters prm;
    SceneOutput::declare_parameters(prm, type);
    EXPECT_TRUE(prm.set("Type", type));
    EXPECT_TRUE(prm.set("Interval", interval));
    return SceneOutput::make(prm, "Outputs/some");
  }
  bool is_there(const std::string &file)
  {
    return std::filesystem::exists(folder + "/" + file);
  }
};

TEST_F(Outputs, are_found_by_name)
{
  std::vector<std::string> names;
  for (const auto &entry : Registry<SceneOutput>::entries())
    names.push_back(entry.name);
  EXPECT_EQ(names, (std::vector<std::string>{"VTU", "gauge", "history"}));
}

TEST_F(Outputs, fall_due_at_multiples_of_their_interval)
{
  RunFiles files(folder, MPI_COMM_WORLD);
  const auto output = make("VTU", "2 us");
  output->open(files);
  std::vector<double> written;
  for (int step = 0; step <= 10; ++step)
  {
    const double time = 0.7e-6 * step; // [s]
    if (output->is_due(time))
      written.push_back(time);
    output->write_when_due({time, unsigned(step), false, {}}, files);
  }
  ASSERT_EQ(written.size(), 4u);
  const double due[] = {0., 2.1e-6, 4.2e-6, 6.3e-6};
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(written[i], due[i], 1e-12);
  EXPECT_TRUE(is_there("sabot.pvd"));
}

TEST_F(Outputs, histories_are_written_at_the_end_or_with_fields)
{
  RunFiles files(folder, MPI_COMM_WORLD);
  const auto history = make("history", "1 us"), fields = make("VTU", "1 us");
  EXPECT_TRUE(history->needs_rows());
  EXPECT_FALSE(fields->needs_rows());
  files.history.append("ledger", {{"time", "s", 0.}});
  history->write_when_due({0., 0, false, {}}, files);
  EXPECT_FALSE(is_there("history.h5"));
  fields->write_when_due({0., 0, false, {}}, files);
  EXPECT_TRUE(is_there("history.h5"));
  std::filesystem::remove(folder + "/history.h5");
  // Without new rows there is nothing to write.
  history->write_when_due({1e-6, 1, true, {}}, files);
  EXPECT_FALSE(is_there("history.h5"));
  files.history.append("ledger", {{"time", "s", 1e-6}});
  history->write_when_due({1e-6, 1, true, {}}, files);
  EXPECT_TRUE(is_there("history.h5"));
}

TEST_F(Outputs, no_time_is_written_twice_and_a_resumed_run_goes_on)
{
  RunFiles files(folder, MPI_COMM_WORLD);
  EXPECT_TRUE(files.write_fields(0., {}));
  EXPECT_FALSE(files.write_fields(0., {}));
  files.history.append("ledger", {{"time", "s", 0.}, {"total", "J", 2.}});
  const auto output = make("VTU", "1 us");
  output->write_when_due({0., 0, false, {}}, files);
  const auto saved = std::make_shared<StateCopies>();
  saved->add_rank(
      [&](StateVisitor &visitor)
      {
        files.visit_state(visitor);
        output->visit_state(visitor, "next some");
      });

  RunFiles again(folder, MPI_COMM_WORLD);
  const auto other = make("VTU", "1 us");
  StateRestorer restorer(saved, 0, 1);
  again.visit_state(restorer);
  other->visit_state(restorer, "next some");
  EXPECT_FALSE(again.write_fields(0., {}));
  EXPECT_FALSE(other->is_due(0.5e-6));
  EXPECT_TRUE(other->is_due(1e-6));
  EXPECT_EQ(again.history.tables["ledger"].columns,
            (std::vector<std::string>{"time [s]", "total [J]"}));
  EXPECT_EQ(again.history.tables["ledger"].values,
            (std::vector<double>{0., 2.}));
}
} // namespace
