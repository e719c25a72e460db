// What a study concludes from repeated runs and over impact velocities.
#include "sabot/base/error.h"
#include "sabot/study/results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace sabot
{
namespace
{
const char *const text = R"(
set Scene       = bar.prm
set Combination = grid
subsection Parameters
  subsection spacing
    set Entries = Bodies/block/Nodal spacing
    set Values  = 1.25 mm; 1 mm; 0.8333 mm
    set Role    = spacing
  end
  subsection impact
    set Entries = Bodies/block/Initial velocity
    set Values  = 200 m/s, 0 m/s, 0 m/s; 300 m/s, 0 m/s, 0 m/s; 400 m/s, 0 m/s, 0 m/s; 500 m/s, 0 m/s, 0 m/s
    set Role    = physics
  end
  subsection start
    set Entries = Step factor
    set Values  = 0.5; 0.5001
    set Role    = repeat
  end
end
subsection Quantities
  subsection speed
    set Ballistic fit over = impact
    set Measured curve     = 300: 200; 400 m/s: 310 m/s
  end
end
)";

std::string study_file(std::string contents)
{
  const std::string folder =
      (std::filesystem::temp_directory_path() / "sabot-repeats").string();
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(SABOT_SOURCE_DIR "/tests/scenes/bar.prm",
                             folder + "/bar.prm",
                             std::filesystem::copy_options::overwrite_existing);
  std::ofstream(folder + "/study.prm") << contents;
  return folder + "/study.prm";
}

TEST(Repeats, scatter_convergence_and_ballistic_curve)
{
  const StudyFile study(study_file(text), {});
  EXPECT_EQ(study.quantities[0].measured_curve.size(), 2u);
  std::vector<StudyOutcome> outcomes(study.runs.size());
  for (std::size_t run = 0; run < outcomes.size(); ++run)
  {
    const auto &choice = study.runs[run].choice;
    const double h = study.parameters[0].values[choice[0]].number,
                 impact = study.parameters[1].values[choice[1]].number;
    outcomes[run].status = "completed";
    outcomes[run].units = {"m/s"};
    // Limit 150 m/s plus an error that falls with h^2, +-1 m/s of scatter.
    outcomes[run].quantities = {std::sqrt(impact * impact - 150. * 150.) +
                                1e7 * h * h + (choice[2] == 0 ? 1. : -1.)};
  }
  const StudyResults results(study, outcomes);
  ASSERT_EQ(results.scatter.size(), 12u);
  for (const RepeatScatter &s : results.scatter)
  {
    EXPECT_EQ(s.n, 2u);
    EXPECT_NEAR(s.range, 2., 1e-9);
    EXPECT_NEAR(s.deviation, std::sqrt(2.), 1e-9);
  }
  ASSERT_EQ(results.convergence.size(), 4u);
  for (const ConvergenceSeries &s : results.convergence)
  {
    EXPECT_NEAR(s.fit.order, 2., 1e-3);
    EXPECT_EQ(s.value.size(), 3u);
  }
  ASSERT_EQ(results.ballistic.size(), 3u); // one for each spacing
  for (const BallisticSeries &s : results.ballistic)
  {
    EXPECT_TRUE(s.fit.exists);
    EXPECT_EQ(s.fit.n_perforating, 8u);
    EXPECT_NEAR(s.fit.limit, 150., 20.);
  }
}

TEST(Repeats, from_a_measured_zero_the_difference_counts)
{
  std::string asked = text;
  asked.replace(asked.find("set Ballistic"), 0, "set Measured value = 0\n    ");
  const StudyFile study(study_file(asked), {});
  std::vector<StudyOutcome> outcomes(study.runs.size());
  for (std::size_t run = 0; run < outcomes.size(); ++run)
  {
    outcomes[run].status = "completed";
    outcomes[run].units = {"m/s"};
    outcomes[run].quantities = {-2.5 - run};
    outcomes[run].cpu_seconds = 1. + run;
  }
  const StudyResults results(study, outcomes);
  EXPECT_FALSE(results.has_relative_error(0));
  EXPECT_DOUBLE_EQ(results.error(1, 0), 3.5);
  const std::string file =
      std::filesystem::path(study_file(asked)).replace_filename("table");
  const auto contents = [&]()
  {
    std::ifstream stream(file);
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  const auto has = [&](const std::string &part)
  { return contents().find(part) != std::string::npos; };
  write_csv(results, file);
  EXPECT_TRUE(has("difference of speed [m/s]"));
  EXPECT_FALSE(has("relative"));
  write_report(results, results.charts(), file);
  EXPECT_TRUE(has("difference [m/s]"));
  EXPECT_TRUE(has("<td>3.5</td>"));
  EXPECT_FALSE(has("error [%]"));
}

TEST(Repeats, a_fit_needs_a_parameter_of_velocities)
{
  std::string wrong = text;
  wrong.replace(wrong.find("= impact"), 8, "= speed");
  EXPECT_THROW(StudyFile(study_file(wrong), {}), InputError);
  wrong = text;
  wrong.replace(wrong.find("300: 200"), 8, "fast: 1");
  EXPECT_THROW(StudyFile(study_file(wrong), {}), InputError);
}
} // namespace
} // namespace sabot
