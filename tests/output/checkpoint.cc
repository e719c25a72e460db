// Checkpoints: written, read, damaged, resumed.
#include "sabot/output/checkpoint.h"

#include "sabot/base/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace sabot;

namespace
{
/** A state as a body has it: arrays of fixed and of changing length. */
struct State
{
  std::vector<double> position = {1. / 3., -0., 4e-310};
  std::vector<int> pairs = {1, 2, 3, 4};
  std::vector<char> empty;
  double value = 2.5;

  void visit(StateVisitor &visitor)
  {
    visitor.visit_array("position", position);
    visitor.visit_resized("pairs", pairs);
    visitor.visit_resized("empty", empty);
    visitor.visit_value("value", value);
  }
};

class Checkpoint : public ::testing::Test
{
protected:
  void SetUp() override
  {
    folder = (std::filesystem::temp_directory_path() / "sabot-XXXXXX").string();
    ASSERT_NE(mkdtemp(&folder[0]), nullptr);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  void write(State &state, const unsigned int step,
             const std::string &name = "")
  {
    CheckpointHeader header;
    header.version = "1.2.3";
    header.parameters = "set Title = test\n";
    header.n_ranks = 1;
    header.step = step;
    header.time = 1. / 7.;
    const auto visit = [&](StateVisitor &visitor)
    {
      visitor.section = "body a b/c";
      state.visit(visitor);
    };
    CheckpointFolder(folder, MPI_COMM_SELF).write(header, visit, name);
  }
  static State restore(const std::string &file)
  {
    StateRestorer restorer(std::make_shared<CheckpointFile>(file), 0, 1);
    restorer.section = "body a b/c";
    State state;
    state.position = {0., 0., 0.};
    state.pairs.clear();
    state.visit(restorer);
    return state;
  }
  std::string folder;
};

TEST_F(Checkpoint, gives_back_every_bit_and_keeps_the_last_two)
{
  State state;
  for (const unsigned int step : {5u, 70u, 900u})
  {
    state.value = step;
    state.pairs.push_back(step);
    write(state, step);
  }
  write(state, 901, "failed");
  const std::vector<std::string> files = CheckpointFolder::list(folder);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0], folder + "/step-0000000900.h5");
  EXPECT_EQ(files[1], folder + "/step-0000000070.h5");
  const CheckpointHeader header = CheckpointFile::verify(files[0]);
  EXPECT_EQ(header.version, "1.2.3");
  EXPECT_EQ(header.parameters, "set Title = test\n");
  EXPECT_EQ(header.step, 900u);
  EXPECT_EQ(header.time, 1. / 7.);
  const State back = restore(files[0]);
  EXPECT_EQ(back.position, state.position);
  EXPECT_TRUE(std::signbit(back.position[1]));
  EXPECT_EQ(back.pairs, state.pairs);
  EXPECT_EQ(back.value, 900.);
  EXPECT_EQ(restore(files[1]).pairs.size(), 6u);
  CheckpointFolder(folder, MPI_COMM_SELF).clear();
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(Checkpoint, damage_anywhere_is_seen)
{
  State state;
  write(state, 1);
  const std::string file = CheckpointFolder::list(folder)[0];
  std::ifstream stream(file, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  const auto put = [&](const std::string &bytes)
  { std::ofstream(file, std::ios::binary) << bytes; };
  for (std::size_t i = 0; i < whole.size(); i += 7)
  {
    std::string damaged = whole;
    damaged[i] ^= 0x40;
    put(damaged);
    EXPECT_THROW(CheckpointFile::verify(file), IOError) << "byte " << i;
  }
  put(whole.substr(0, whole.size() / 2));
  EXPECT_THROW(CheckpointFile::verify(file), IOError);
  put("");
  EXPECT_THROW(CheckpointFile::verify(file), IOError);
  put(whole);
  EXPECT_NO_THROW(CheckpointFile::verify(file));
  EXPECT_EQ(restore(file).position, state.position);
}

TEST_F(Checkpoint, a_state_of_another_shape_is_refused)
{
  State state;
  write(state, 1);
  StateRestorer restorer(
      std::make_shared<CheckpointFile>(CheckpointFolder::list(folder)[0]), 0,
      1);
  restorer.section = "body a b/c";
  std::vector<double> longer(4);
  EXPECT_THROW(restorer.visit_array("position", longer), IOError);
  EXPECT_THROW(restorer.visit_array("velocity", state.position), IOError);
}
} // namespace
