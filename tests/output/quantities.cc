// Quantities of interest against exact values.
#include "temporary_folder.h"

#include "sabot/base/parameter_file.h"
#include "sabot/simulation/run.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace sabot
{
namespace
{
class Quantities : public TemporaryFolder
{
protected:
  /** result.json of a scene that is run in the folder. */
  nlohmann::json run(const std::string &scene_file,
                     const std::vector<std::string> &overrides) const
  {
    const ParameterFile file(scene_file, overrides);
    Scene scene(file, MPI_COMM_WORLD);
    EXPECT_EQ(
        sabot::Run(scene, folder + "/run", true, MPI_COMM_WORLD).execute(),
        ExitCode::done);
    nlohmann::json result;
    std::ifstream(folder + "/run/result.json") >> result;
    return result;
  }
};

double value(const nlohmann::json &result, const std::string &name)
{
  return result["quantities"][name]["value"].get<double>();
}

/** The material of the scenes here. */
const char *const metal = R"(
subsection Materials
  subsection metal
    set Model           = Elastic
    set Density         = 2700 kg/m^3
    set Young's modulus = 70 GPa
  end
end
)";

/** A block of particles that flies along x, cut at z = 0, with all quantities
    of one body. */
const char *const block = R"(
set End time           = 1 us
set List of bodies     = block
set List of quantities = hole, foot, middle, piece, plug, absorbed
subsection Bodies
  subsection block
    set Discretization   = SPG
    set Size             = 4 mm, 6 mm, 5 mm
    set Center           = 20 mm, 0 mm, 2.5 mm
    set Nodal spacing    = 1 mm
    set Symmetry faces   = -z
    set Material         = metal
    set Initial velocity = 100 m/s, 0 m/s, 0 m/s
  end
end
subsection Quantities
  subsection hole
    set Type = hole diameter
    set Body = block
  end
  subsection foot
    set Type      = outline radius
    set Body      = block
    set Direction = 0, 1, 0
  end
  subsection middle
    set Type      = outline radius
    set Body      = block
    set Direction = 0, 1, 0
    set Share of length = 0.4
  end
  subsection piece
    set Type      = largest piece velocity
    set Body      = block
    set Direction = 1, 0, 0
  end
  subsection plug
    set Type      = plug mass
    set Body      = block
    set Direction = 1, 0, 0
  end
  subsection absorbed
    set Type = absorbed energy
    set Body = block
  end
end
)";

TEST_F(Quantities, of_a_flying_block)
{
  std::ofstream(folder + "/block.prm") << metal << block;
  const nlohmann::json r = run(folder + "/block.prm", {});
  // After 1 us at 100 m/s its near face is at x = 18.1 mm.
  EXPECT_NEAR(value(r, "hole"), 2. * 18.1e-3, 1e-8);
  EXPECT_NEAR(value(r, "foot"), std::hypot(22.1e-3, 5e-3), 1e-8);
  EXPECT_NEAR(value(r, "middle"), std::hypot(22.1e-3, 5e-3), 1e-8);
  EXPECT_NEAR(value(r, "piece"), 100., 1e-9);
  EXPECT_EQ(value(r, "plug"), 0.);
  EXPECT_NEAR(value(r, "absorbed"), 0., 1e-9);
}

/** Settings of a quantity @p name of @p body along x. */
std::vector<std::string> quantity(const std::string &name,
                                  const std::string &type,
                                  const std::string &body)
{
  return {"Quantities/" + name + "/Type=" + type,
          "Quantities/" + name + "/Body=" + body,
          "Quantities/" + name + "/Direction=1, 0, 0"};
}

/** The torn bar with mass and velocity of its plug, its largest piece, and
    what the block that tears it has given away. */
std::vector<std::string> asked_of_torn_bar()
{
  std::vector<std::string> settings = {
      "List of quantities=mass, speed, largest, absorbed"};
  for (const auto &entries :
       {quantity("mass", "plug mass", "bar"),
        quantity("speed", "plug velocity", "bar"),
        quantity("largest", "largest piece velocity", "bar")})
    settings.insert(settings.end(), entries.begin(), entries.end());
  settings.push_back("Quantities/absorbed/Type=absorbed energy");
  settings.push_back("Quantities/absorbed/Body=weight");
  return settings;
}

constexpr const char *torn = SABOT_SOURCE_DIR "/tests/scenes/torn.prm";

TEST_F(Quantities, of_a_torn_bar)
{
  const nlohmann::json r = run(torn, asked_of_torn_bar());
  const auto &pieces = r["bodies"]["bar"]["fragments"];
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(value(r, "largest"), pieces[0]["velocity"][0].get<double>());
  EXPECT_EQ(value(r, "mass"), pieces[1]["mass"].get<double>());
  EXPECT_EQ(value(r, "speed"), pieces[1]["velocity"][0].get<double>());
  EXPECT_GT(value(r, "speed"), 10.);
  // Nothing but the bar acts on the block.
  const double mass = 2700. * 36e-9;
  double square = 0.;
  for (const auto &v : r["bodies"]["weight"]["velocity"])
    square += v.get<double>() * v.get<double>();
  const double lost = 0.5 * mass * (250. * 250. - square);
  EXPECT_GT(lost, 0.1);
  EXPECT_NEAR(value(r, "absorbed"), lost, 1e-9 * lost);
}

TEST_F(Quantities, of_half_a_torn_bar_as_of_the_whole)
{
  std::vector<std::string> settings = asked_of_torn_bar();
  settings.push_back("Bodies/bar/Nodal spacing=0.75 mm");
  settings.push_back("Bodies/weight/Cell size=0.75 mm");
  const nlohmann::json whole = run(torn, settings);
  for (const char *const half :
       {"Bodies/bar/Size=10 mm, 3 mm, 1.5 mm",
        "Bodies/bar/Center=-5 mm, 0 mm, 0.75 mm",
        "Bodies/bar/Symmetry faces=-z", "Bodies/weight/Size=4 mm, 3 mm, 1.5 mm",
        "Bodies/weight/Center=2 mm, 0 mm, 0.75 mm",
        "Bodies/weight/Symmetry faces=-z"})
    settings.push_back(half);
  const nlohmann::json r = run(torn, settings);
  const auto &pieces = r["bodies"]["bar"]["fragments"];
  ASSERT_GE(pieces.size(), 2u);
  EXPECT_EQ(value(r, "mass"), pieces[1]["mass"].get<double>());
  EXPECT_NEAR(value(r, "mass"), value(whole, "mass"),
              1e-12 * value(whole, "mass"));
  // Kernels end at the cut, so half a body is another discretization; a factor
  // of two left out would be off by a half.
  for (const char *const name : {"speed", "absorbed"})
    EXPECT_NEAR(value(r, name), value(whole, name), 5e-3 * value(whole, name))
        << name;
}

TEST_F(Quantities, half_a_body_does_not_move_across_its_cut)
{
  // Pressed against its plane of symmetry it does, and its image, too.
  const std::string scene = std::string(metal) + R"(
set End time           = 0.3 us
set List of bodies     = block
set List of loads      = squeeze
set List of quantities = across, piece, along, slanted, absorbed
subsection Bodies
  subsection block
    set Size             = 4 mm, 2 mm, 4 mm
    set Center           = 0 mm, 1 mm, 0 mm
    set Cell size        = 1 mm
    set Symmetry faces   = -y
    set Material         = metal
    set Initial velocity = 100 m/s, 0 m/s, 0 m/s
  end
end
subsection Loads
  subsection squeeze
    set Type     = pressure
    set Body     = block
    set Faces    = +y
    set Pressure = 200 MPa
  end
end
subsection Quantities
  subsection across
    set Type      = velocity
    set Body      = block
    set Direction = 0, 1, 0
  end
  subsection piece
    set Type      = largest piece velocity
    set Body      = block
    set Direction = 0, -1, 0
  end
  subsection along
    set Type      = velocity
    set Body      = block
    set Direction = 1, 0, 0
  end
  subsection slanted
    set Type      = velocity
    set Body      = block
    set Direction = 1, 1, 0
  end
  subsection absorbed
    set Type = absorbed energy
    set Body = block
  end
end
)";
  const std::string path = folder + "/squeezed.prm";
  std::ofstream(path) << scene;
  const nlohmann::json r = run(path, {});
  EXPECT_LT(r["bodies"]["block"]["velocity"][1].get<double>(), -1.);
  EXPECT_EQ(value(r, "across"), 0.);
  EXPECT_EQ(value(r, "piece"), 0.);
  EXPECT_NEAR(value(r, "along"), 100., 1e-6);
  EXPECT_NEAR(value(r, "slanted"), std::sqrt(0.5) * 100., 1e-6);
  // 2 * 2700 kg/m^3 * 32 mm^3 * (100 m/s)^2/2 = 0.864 J were there.
  EXPECT_NEAR(value(r, "absorbed"), 0., 1e-6);
}

/** A plate of cells at rest out of which particles are carved. */
const char *const carved = R"(
set End time           = 0.1 us
set List of bodies     = plate, core
set List of couplings  = zone
set List of quantities = hole, filled
subsection Bodies
  subsection plate
    set Size      = 16 mm, 16 mm, 2 mm
    set Cell size = 1 mm
    set Material  = metal
  end
  subsection core
    set Discretization = SPG
    set Carve from     = plate
    set Size           = 6 mm, 4 mm, 2 mm
    set Nodal spacing  = 1 mm
    set Material       = metal
    set Initial velocity = 0 m/s, 0 m/s, 0.001 m/s
  end
end
subsection Couplings
  subsection zone
    set Type     = tie
    set Follower = core
    set Leader   = plate
  end
end
subsection Quantities
  subsection hole
    set Type      = hole diameter
    set Body      = plate
    set Direction = 0, 0, 1
  end
  subsection filled
    set Type      = hole diameter
    set Body      = core
    set Direction = 0, 0, 1
  end
end
)";

TEST_F(Quantities, of_a_carved_hole)
{
  std::ofstream(folder + "/carved.prm") << metal << carved;
  const nlohmann::json r = run(folder + "/carved.prm", {});
  EXPECT_NEAR(value(r, "hole"), 4e-3, 1e-8); // the nearer faces
  EXPECT_NEAR(value(r, "filled"), 0., 1e-8);
}
} // namespace
} // namespace sabot
