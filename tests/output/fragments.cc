// Fragments of a torn bar, in fields and in result.json.
#include "temporary_folder.h"

#include "sabot/base/parameter_file.h"
#include "sabot/simulation/run.h"
#include "verification/metals.h"

#include <nlohmann/json.hpp>

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace
{
using namespace sabot;

/** A body's points in a file of fields. */
struct Frame
{
  explicit Frame(const std::string &file)
  {
    reader->SetFileName(file.c_str());
    reader->Update();
    grid = reader->GetOutput();
  }
  double field(const char *const name, const vtkIdType i, const int c = 0) const
  {
    return grid->GetPointData()->GetArray(name)->GetComponent(i, c);
  }
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  vtkUnstructuredGrid *grid;
};

/** What the points of one fragment add up to. */
struct Sum
{
  std::set<vtkIdType> points;
  double mass = 0., momentum[3] = {};
};

/** A bar of 10 x 3 x 3 mm, particles 1 mm apart, also on its faces. */
class Torn : public TemporaryFolder
{
protected:
  /** Runs the scene; by fragment id, from the last frame. Masses are those of
      the lattice at the start: halves on faces. */
  std::map<double, Sum> tear(const std::vector<std::string> &overrides)
  {
    const ParameterFile file(SABOT_SOURCE_DIR "/tests/scenes/torn.prm",
                             overrides);
    Scene scene(file, MPI_COMM_WORLD);
    EXPECT_EQ(sabot::Run(scene, folder, true, MPI_COMM_WORLD).execute(),
              ExitCode::done);
    std::ifstream(folder + "/result.json") >> result;
    int last = 0;
    while (std::filesystem::exists(frame_file(last + 1)))
      ++last;
    EXPECT_EQ(last, 6); // 30 us, every 5
    const Frame first(frame_file(0)), end(frame_file(last));
    EXPECT_EQ(first.grid->GetNumberOfPoints(), 11 * 4 * 4);
    EXPECT_EQ(end.grid->GetNumberOfPoints(), 11 * 4 * 4);
    std::map<double, Sum> sums;
    for (vtkIdType i = 0; i < end.grid->GetNumberOfPoints(); ++i)
    {
      EXPECT_EQ(first.field("fragment", i), 0.);
      const double *const X = first.grid->GetPoint(i);
      double mass = aluminum().density * 1e-9;
      for (const double from_face :
           {X[0], X[0] + 10e-3, std::abs(X[1]) - 1.5e-3,
            std::abs(X[2]) - 1.5e-3})
        mass *= std::abs(from_face) < 1e-9 ? 0.5 : 1.;
      Sum &sum = sums[end.field("fragment", i)];
      sum.points.insert(i);
      sum.mass += mass;
      for (int d = 0; d < 3; ++d)
      {
        sum.momentum[d] += mass * end.field("velocity", i, d);
        EXPECT_NEAR(end.field("displacement", i, d),
                    end.grid->GetPoint(i)[d] - X[d], 1e-15);
      }
    }
    return sums;
  }
  std::string frame_file(const int frame) const
  {
    return folder + "/fields/bar_00000" + std::to_string(frame) + ".vtu";
  }
  /** result.json lists the same pieces, heaviest first. */
  void compare(const std::map<double, Sum> &sums) const
  {
    const auto &bar = result["bodies"]["bar"];
    EXPECT_EQ(bar["fragment_count"], sums.size());
    EXPECT_EQ(bar["fragments"].size(), std::min<std::size_t>(20, sums.size()));
    std::set<double> unseen;
    for (const auto &[id, sum] : sums)
      unseen.insert(id);
    double before = 1e300, speed = 0.;
    for (const auto &piece : bar["fragments"])
    {
      EXPECT_LE(piece["mass"], before);
      before = piece["mass"];
      // Its own among the ids not yet met: number, mass and velocity agree.
      bool found = false;
      for (const double id : std::set<double>(unseen))
      {
        const Sum &sum = sums.at(id);
        bool same =
            piece["particles"] == sum.points.size() &&
            std::abs(piece["mass"].get<double>() - sum.mass) < 1e-12 * sum.mass;
        for (int d = 0; d < 3; ++d)
          same = same && std::abs(piece["velocity"][d].get<double>() -
                                  sum.momentum[d] / sum.mass) < 1e-9;
        if (!found && same)
          unseen.erase(id);
        found = found || same;
      }
      EXPECT_TRUE(found) << piece;
      speed = std::max(speed, std::abs(piece["velocity"][0].get<double>()));
    }
    EXPECT_GT(speed, 10.); // there is something to compare
  }
  nlohmann::json result;
};

TEST_F(Torn, in_two_between_the_tied_particles_and_the_next)
{
  const std::map<double, Sum> sums = tear({});
  ASSERT_EQ(sums.size(), 2u);
  EXPECT_EQ(sums.rbegin()->first, 1.);
  const Frame first(frame_file(0));
  for (const auto &[id, sum] : sums)
  {
    // Numbered by mass from 0, and a piece is all of one side.
    const bool held = id == 0.;
    EXPECT_EQ(sum.points.size(), held ? 160u : 16u);
    for (const vtkIdType i : sum.points)
      EXPECT_EQ(first.grid->GetPoint(i)[0] < -0.5e-3, held);
    EXPECT_NEAR(sum.mass, aluminum().density * 9e-6 * (held ? 9.5e-3 : 0.5e-3),
                1e-12 * sum.mass);
  }
  compare(sums);
  // The piece that flies does so with what it is tied to.
  EXPECT_NEAR(sums.rbegin()->second.momentum[0] / sums.rbegin()->second.mass,
              result["bodies"]["weight"]["velocity"][0].get<double>(), 20.);
}

/** A quarter of a bar of 4 x 4 mm, and one that planes of symmetry do not cut.
 */
TEST_F(Torn, pieces_that_planes_of_symmetry_cut_are_counted_whole)
{
  const auto pieces = [&](const std::vector<std::string> &overrides)
  {
    const ParameterFile file(SABOT_SOURCE_DIR "/tests/scenes/torn.prm",
                             overrides);
    Scene scene(file, MPI_COMM_WORLD);
    EXPECT_EQ(sabot::Run(scene, folder, true, MPI_COMM_WORLD).execute(),
              ExitCode::done);
    nlohmann::json all;
    std::ifstream(folder + "/result.json") >> all;
    std::filesystem::remove_all(folder);
    return all["bodies"]["bar"]["fragments"];
  };
  const auto whole = pieces({"Bodies/bar/Size=10 mm, 4 mm, 4 mm",
                             "Bodies/weight/Size=4 mm, 4 mm, 4 mm"});
  const auto quarter = pieces({"Bodies/bar/Size=10 mm, 2 mm, 2 mm",
                               "Bodies/weight/Size=4 mm, 2 mm, 2 mm",
                               "Bodies/bar/Center=-5 mm, 1 mm, 1 mm",
                               "Bodies/weight/Center=2 mm, 1 mm, 1 mm",
                               "Bodies/bar/Symmetry faces=-y, -z",
                               "Bodies/weight/Symmetry faces=-y, -z"});
  ASSERT_EQ(whole.size(), 2u);
  ASSERT_EQ(quarter.size(), 2u);
  for (std::size_t p = 0; p < 2; ++p)
  {
    const double mass = whole[p]["mass"], speed = whole[p]["velocity"][0];
    EXPECT_NEAR(quarter[p]["mass"].get<double>(), mass, 1e-12 * mass);
    EXPECT_NEAR(quarter[p]["velocity"][0].get<double>(), speed, 0.01 * 250.);
    for (const int d : {1, 2})
    {
      EXPECT_EQ(quarter[p]["velocity"][d], 0.);
      EXPECT_NEAR(whole[p]["velocity"][d].get<double>(), 0., 0.01 * 250.);
    }
    EXPECT_EQ(quarter[p]["copies"], 1);
    EXPECT_EQ(whole[p]["copies"], 1);
  }
  EXPECT_GT(whole[1]["velocity"][0].get<double>(), 100.);
}

TEST_F(Torn, to_splinters)
{
  const std::map<double, Sum> sums =
      tear({"Bodies/weight/Initial velocity=400 m/s, 0 m/s, 0 m/s",
            "Bodies/bar/Critical effective plastic strain=0.1"});
  EXPECT_GT(sums.size(), 5u);
  double mass = 0.;
  std::size_t n = 0;
  double next = 0., before = 1e300;
  for (const auto &[id, sum] : sums)
  {
    EXPECT_EQ(id, next++);
    EXPECT_LE(sum.mass, before * (1. + 1e-12));
    before = sum.mass;
    mass += sum.mass;
    n += sum.points.size();
  }
  EXPECT_EQ(n, 176u);
  EXPECT_NEAR(mass, result["bodies"]["bar"]["mass"].get<double>(),
              1e-12 * mass);
  compare(sums);
}
} // namespace
