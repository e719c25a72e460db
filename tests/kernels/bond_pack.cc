// Four bonds at once: storage in single precision, sums over lanes, roots.
#include "sabot/kernels/bond_pack.h"
#include "sabot/base/types.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace
{
using namespace sabot;

TEST(BondPack, cube_roots_of_many_magnitudes)
{
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> exponent(-119., 116.);
  for (int i = 0; i < 10000; ++i)
  {
    const double a = std::exp2(exponent(generator));
    const Pack root = pack_cbrt(Pack{a, 8. * a, 1., 1e-9});
    EXPECT_NEAR(root[0] / std::cbrt(a), 1., 2e-15);
    EXPECT_NEAR(root[1] / root[0], 2., 4e-15);
    EXPECT_NEAR(root[2], 1., 1e-15);
    EXPECT_NEAR(root[3], 1e-3, 1e-18);
  }
}

TEST(BondPack, bonds_come_back_as_the_nearest_floats)
{
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  AlignedVector<BondVec> stored(8);
  Pack in[3], out[3];
  for (Pack &component : in)
    for (int l = 0; l < 4; ++l)
      component[l] = uniform(generator);
  const Pack exact[3] = {in[0], in[1], in[2]};
  store_bonds(&stored[4], in);
  load_bonds(&stored[4], out);
  for (int l = 0; l < 4; ++l)
  {
    const Vec one = load(stored[4 + l]);
    const BondVec again = store_bond(one);
    EXPECT_EQ(std::memcmp(&again, &stored[4 + l], sizeof(again)), 0);
    for (int d = 0; d < 3; ++d)
    {
      EXPECT_EQ(out[d][l], double(float(exact[d][l])));
      EXPECT_EQ(in[d][l], out[d][l]);
      EXPECT_EQ(one[d], out[d][l]);
    }
    EXPECT_EQ(one[3], 0.);
  }
}

TEST(BondPack, sums_and_transposition)
{
  Pack a[4] = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}, {13, 14, 15, 16}};
  const Pack sums = sum_lanes(a[0], a[1], a[2], a[3]);
  transpose_lanes(a);
  for (int l = 0; l < 4; ++l)
  {
    EXPECT_EQ(sums[l], 10. + 16. * l);
    for (int k = 0; k < 4; ++k)
      EXPECT_EQ(a[l][k], 1. + l + 4. * k);
  }
}
} // namespace
