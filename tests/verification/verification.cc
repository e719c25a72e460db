// Every problem of the label "quick" is a test.
#include "verification/problem.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace sabot;

class Verification : public testing::TestWithParam<VerificationProblem>
{
};

TEST_P(Verification, passes)
{
  const std::vector<Check> checks = GetParam().run();
  EXPECT_FALSE(checks.empty());
  for (const Check &c : checks)
    EXPECT_TRUE(c.pass()) << c.name << ": expected " << c.expected << ", got "
                          << c.got << ", tolerance " << c.tolerance << " "
                          << c.unit;
}

std::vector<VerificationProblem> quick_problems()
{
  std::vector<VerificationProblem> quick;
  for (const VerificationProblem &p : verification_problems())
    if (p.has_label("quick"))
      quick.push_back(p);
  return quick;
}

INSTANTIATE_TEST_SUITE_P(
    quick, Verification, testing::ValuesIn(quick_problems()),
    [](const testing::TestParamInfo<VerificationProblem> &info)
    {
      std::string name = info.param.name;
      for (char &c : name)
        c = c == '-' ? '_' : c;
      return name;
    });

TEST(Checks, fail_when_they_should)
{
  Check c{"", 1., 1.1, 0.05, "", "", Check::Kind::near};
  EXPECT_FALSE(c.pass());
  c.kind = Check::Kind::at_least;
  EXPECT_TRUE(c.pass());
  c.kind = Check::Kind::at_most;
  EXPECT_FALSE(c.pass());
  c.kind = Check::Kind::reported;
  EXPECT_TRUE(c.pass());
  c.got = std::nan("");
  EXPECT_FALSE(c.pass());
}
} // namespace
