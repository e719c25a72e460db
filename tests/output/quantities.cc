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

/** A block of particles that flies along x, cut at z = 0, with all quantities
    of one body. */
const char *const block = R"(
set End time           = 1 us
set List of bodies     = block
set List of quantities = hole, foot, middle, piece, plug, absorbed
subsection Materials
  subsection metal
    set Model           = Elastic
    set Density         = 2700 kg/m^3
    set Young's modulus = 70 GPa
  end
end
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
  std::ofstream(folder + "/block.prm") << block;
  const nlohmann::json r = run(folder + "/block.prm", {});
  // After 1 us at 100 m/s its near face is at x = 18.1 mm.
  EXPECT_NEAR(value(r, "hole"), 2. * 18.1e-3, 1e-8);
  EXPECT_NEAR(value(r, "foot"), std::hypot(22.1e-3, 5e-3), 1e-8);
  EXPECT_NEAR(value(r, "middle"), std::hypot(22.1e-3, 5e-3), 1e-8);
  EXPECT_NEAR(value(r, "piece"), 100., 1e-9);
  EXPECT_EQ(value(r, "plug"), 0.);
  EXPECT_NEAR(value(r, "absorbed"), 0., 1e-9);
}

TEST_F(Quantities, of_a_torn_bar)
{
  const auto quantity = [](const std::string &name, const std::string &type)
  {
    return std::vector<std::string>{"Quantities/" + name + "/Type=" + type,
                                    "Quantities/" + name + "/Body=bar",
                                    "Quantities/" + name +
                                        "/Direction=1, 0, 0"};
  };
  std::vector<std::string> settings = {
      "List of quantities=mass, speed, largest"};
  for (const auto &[name, type] :
       std::vector<std::pair<std::string, std::string>>{
           {"mass", "plug mass"},
           {"speed", "plug velocity"},
           {"largest", "largest piece velocity"}})
    for (const std::string &setting : quantity(name, type))
      settings.push_back(setting);
  const nlohmann::json r =
      run(SABOT_SOURCE_DIR "/tests/scenes/torn.prm", settings);
  const auto &pieces = r["bodies"]["bar"]["fragments"];
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(value(r, "largest"), pieces[0]["velocity"][0].get<double>());
  EXPECT_EQ(value(r, "mass"), pieces[1]["mass"].get<double>());
  EXPECT_EQ(value(r, "speed"), pieces[1]["velocity"][0].get<double>());
  EXPECT_GT(value(r, "speed"), 10.);
}
} // namespace
} // namespace sabot
