// Forces, gauges and extremes over time: against momentum and plane waves.
#include "temporary_folder.h"

#include "sabot/base/parameter_file.h"
#include "sabot/simulation/run.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace
{
using namespace sabot;

class Answers : public TemporaryFolder
{
protected:
  void run(const std::string &scene_file,
           const std::vector<std::string> &overrides = {})
  {
    const ParameterFile file(SABOT_SOURCE_DIR "/tests/scenes/" + scene_file,
                             overrides);
    Scene scene(file, MPI_COMM_WORLD);
    ASSERT_EQ(
        sabot::Run(scene, folder + "/run", true, MPI_COMM_WORLD).execute(),
        ExitCode::done);
    history.read(folder + "/run/history.h5");
    std::ifstream(folder + "/run/result.json") >> result;
  }
  std::vector<double> column(const std::string &table,
                             const std::string &name) const
  {
    const History::Table &its = history.tables.at(table);
    const std::size_t c =
        std::find(its.columns.begin(), its.columns.end(), name) -
        its.columns.begin();
    EXPECT_LT(c, its.columns.size()) << table << " has no " << name;
    std::vector<double> values;
    for (std::size_t r = 0; r < its.n_rows(); ++r)
      values.push_back(its.values[r * its.columns.size() + c]);
    return values;
  }
  /** Sum of all columns of a table that end so. */
  std::vector<double> sum_of(const std::string &table,
                             const std::string &end) const
  {
    std::vector<double> sum(history.tables.at(table).n_rows(), 0.);
    for (const std::string &name : history.tables.at(table).columns)
      if (name.size() > end.size() &&
          name.compare(name.size() - end.size(), end.size(), end) == 0)
      {
        const std::vector<double> values = column(table, name);
        for (std::size_t r = 0; r < sum.size(); ++r)
          sum[r] += values[r];
      }
    return sum;
  }
  double quantity(const std::string &name,
                  const std::string &key = "value") const
  {
    return result["quantities"][name][key].get<double>();
  }

  History history;
  nlohmann::json result;
};

TEST_F(Answers, impulses_are_the_change_of_momentum_of_every_body)
{
  for (const bool smooths : {false, true})
  {
    run("held-plate.prm",
        smooths ? std::vector<std::string>{"Bodies/core/Stabilization=velocity "
                                           "smoothing"}
                : std::vector<std::string>{});
    const double thrown = 2e-3 * 2e-3 * 4e-3 * 2700. * 600.;
    double moved = 0., pushed = 0.;
    for (const std::string body : {"plate", "core", "projectile"})
    {
      const std::vector<double> mass = column(body, "mass [kg]");
      for (const char axis : {'x', 'y', 'z'})
      {
        const std::vector<double> v = column(body, std::string("velocity ") +
                                                       axis + " [m/s]"),
                                  impulse =
                                      sum_of("impulses", " on " + body + " " +
                                                             axis + " [N s]");
        ASSERT_EQ(v.size(), impulse.size());
        EXPECT_EQ(impulse.front(), 0.);
        for (std::size_t r = 0; r < v.size(); ++r)
        {
          EXPECT_NEAR(mass[r] * v[r] - mass[0] * v[0], impulse[r],
                      1e-12 * thrown)
              << body << " " << axis << " row " << r;
          moved = std::max(moved, std::abs(mass[r] * v[r] - mass[0] * v[0]));
          if (axis == 'z')
            pushed = std::max(pushed, std::abs(impulse[r]));
        }
      }
    }
    // They do something, and nothing comes from the couplings along z.
    EXPECT_GT(moved, 0.2 * thrown);
    EXPECT_GT(pushed, 0.2 * thrown);
    for (const std::string coupling : {"zone", "impact"})
    {
      std::vector<double> sum(history.tables["impulses"].n_rows(), 0.);
      for (const std::string &name : history.tables["impulses"].columns)
        if (name.compare(0, coupling.size() + 1, coupling + " ") == 0 &&
            name.find(" z [") != std::string::npos)
        {
          const std::vector<double> its = column("impulses", name);
          for (std::size_t r = 0; r < its.size(); ++r)
            sum[r] += its[r];
        }
      for (const double s : sum)
        EXPECT_NEAR(s, 0., 1e-13 * thrown);
    }
    // Of three bodies each pair by itself.
    const std::vector<double> on_core = column(
                                  "impulses",
                                  "impact by projectile on core z [N s]"),
                              on_projectile = column(
                                  "impulses",
                                  "impact by core on projectile z [N s]");
    for (std::size_t r = 0; r < on_core.size(); ++r)
      EXPECT_NEAR(on_core[r], -on_projectile[r], 1e-13 * thrown);
    EXPECT_LT(on_core.back(), -0.2 * thrown);
    EXPECT_LT(result["momentum_residual_max"].get<double>(), 1e-12);
  }
}

TEST_F(Answers, forces_are_the_rates_of_impulses)
{
  // Without updates of the kernel, after which forces are those of new
  // functions already.
  run("held-plate.prm",
      {"Outputs/averages/Interval=1 ns", "End time=1 us",
       "Bodies/core/Kernel update interval=1000",
       "Bodies/core/Critical effective plastic strain=never"});
  // A row at every step: the impulse grows by the mean of two forces.
  const std::vector<double> t = column("forces", "time [s]");
  for (const std::string &name : history.tables["forces"].columns)
  {
    if (name == "time [s]")
      continue;
    const std::vector<double> f = column("forces", name),
                              p = column("impulses",
                                         name.substr(0, name.size() - 3) +
                                             "[N s]");
    double largest = 0.;
    for (const double force : f)
      largest = std::max(largest, std::abs(force));
    for (std::size_t r = 2; r < t.size(); ++r)
      EXPECT_NEAR(p[r] - p[r - 1], 0.5 * (t[r] - t[r - 1]) * (f[r] + f[r - 1]),
                  1e-11 * largest * (t[r] - t[r - 1]))
          << name << " row " << r;
  }
}

TEST_F(Answers, a_drawn_bar_bears_rho_c_v)
{
  run("driven-bar.prm");
  const double c = std::sqrt(70e9 * 0.75 / (1.25 * 0.5) / 2700.), area = 4e-6,
               sigma = 2700. * c * 10.;
  // What draws pulls along -x, the section carries tension.
  EXPECT_NEAR(quantity("drawn"), -sigma * area, 0.02 * sigma * area);
  EXPECT_NEAR(quantity("section"), sigma * area, 0.02 * sigma * area);
  // The gauge in the middle: nothing before the front, then the plane wave.
  const std::vector<double> t = column("middle", "time [s]"),
                            v = column("middle", "velocity x [m/s]"),
                            s = column("middle", "stress xx [Pa]"),
                            x = column("middle", "position x [m]"),
                            u = column("middle", "displacement x [m]");
  EXPECT_EQ(std::count(t.begin(), t.end(), t.back()), 1);
  for (std::size_t r = 0; r < t.size(); ++r)
  {
    EXPECT_NEAR(x[r] - u[r], 5.25e-3, 1e-12);
    if (t[r] * c < 4e-3)
    {
      EXPECT_NEAR(v[r], 0., 0.1);
    }
    if (t[r] * c > 9e-3)
    {
      EXPECT_NEAR(v[r], -10., 0.5);
      EXPECT_NEAR(s[r], sigma, 0.05 * sigma);
    }
  }
  // The impulse of the drive is the momentum of the bar.
  EXPECT_NEAR(result["bodies"]["bar"]["resultants"][1]["impulse"][0],
              -sigma * area * 3e-6, 0.02 * sigma * area * 3e-6);
  EXPECT_LT(result["momentum_residual_max"].get<double>(), 1e-12);
}

TEST_F(Answers, quantities_know_the_gauges_of_their_moment)
{
  run("driven-bar.prm",
      {"List of quantities=now", "Quantities/now/Type=history",
       "Quantities/now/Table=middle", "Quantities/now/Value=final",
       "Quantities/now/Column=velocity x"});
  const std::vector<double> t = column("quantities", "time [s]"),
                            its = column("quantities", "now [m/s]"),
                            t_of_gauge = column("middle", "time [s]"),
                            v = column("middle", "velocity x [m/s]");
  ASSERT_GT(t.size(), 2u);
  for (std::size_t r = 0, g = 0; r < t.size(); ++r)
  {
    while (g + 1 < t_of_gauge.size() && t_of_gauge[g + 1] <= t[r])
      ++g;
    EXPECT_EQ(its[r], v[g]) << t[r];
  }
  EXPECT_EQ(its.back(), quantity("now"));
}

TEST_F(Answers, extremes_have_a_time_and_a_place)
{
  run("held-plate.prm");
  const std::vector<double> t = column("quantities", "time [s]"),
                            peak = column("quantities", "peak [m/s]");
  // It never falls, and the time is that at which it was reached.
  for (std::size_t r = 1; r < t.size(); ++r)
    EXPECT_GE(peak[r], peak[r - 1]);
  const std::size_t at =
      std::find(peak.begin(), peak.end(), peak.back()) - peak.begin();
  EXPECT_EQ(quantity("peak", "at_time"), t[at]);
  EXPECT_EQ(quantity("peak"), peak.back());
  // Of the particles that the projectile strikes, in its path.
  EXPECT_LT(quantity("peak", "x"), 3e-3);
  EXPECT_LT(quantity("peak", "y"), 3e-3);
  EXPECT_LT(quantity("stress"), -300e6);

  const std::vector<double> f =
      column("forces", "impact by core on projectile z [N]");
  EXPECT_EQ(quantity("impact force"), *std::max_element(f.begin(), f.end()));
  const std::vector<double> g =
      column("forces", "clamped faces on plate z [N]");
  double largest = 0.;
  for (const double force : g)
    if (std::abs(force) > std::abs(largest))
      largest = force;
  EXPECT_EQ(quantity("clamp force"), largest);
  const std::vector<double> v = column("rear", "velocity z [m/s]");
  EXPECT_EQ(quantity("speed"), *std::min_element(v.begin(), v.end()));
}

TEST_F(Answers, what_a_scene_does_not_have_is_refused)
{
  const std::vector<std::array<std::string, 2>> cases = {
      {{"Quantities/speed/Table=reer", "did you mean \"rear\""}},
      {{"Quantities/speed/Column=velocity", "did you mean"}},
      {{"Quantities/stress/Field=stres", "did you mean \"stress\""}},
      {{"Quantities/stress/Component=zx", "there is: "}},
      {{"Quantities/stress/Field=temperature", "has no field"}},
      {{"Outputs/rear/Body=cor", "did you mean \"core\""}},
      {{"Outputs/rear/Point=0 mm, 0 mm, -9 mm", "lies outside"}},
      {{"Quantities/section/Direction=1, 1, 0", "planes of symmetry"}}};
  for (const auto &[setting, expected] : cases)
    try
    {
      const ParameterFile file(SABOT_SOURCE_DIR "/tests/scenes/held-plate.prm",
                               {setting});
      Scene scene(file, MPI_COMM_WORLD);
      scene.distribute();
      ADD_FAILURE() << setting << " was accepted";
    }
    catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos)
          << error.what();
    }
}
} // namespace
