#ifndef sabot_tests_output_temporary_folder_h
#define sabot_tests_output_temporary_folder_h

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

/** Gives each test a folder of its own, which goes with it. */
class TemporaryFolder : public testing::Test
{
protected:
  void SetUp() override
  {
    folder = std::filesystem::temp_directory_path() / "sabot-test-XXXXXX";
    ASSERT_NE(mkdtemp(folder.data()), nullptr);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::string folder;
};

#endif
