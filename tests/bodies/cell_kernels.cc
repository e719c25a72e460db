// The kernels of hexahedra alone, with numbers.
#include "sabot/bodies/fem/cell_kernels.h"
#include "sabot/base/parameters.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/fem/fem_options.h"
#include "sabot/bodies/fem/hourglass.h"
#include "sabot/bodies/fem/one_point.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace sabot;

PackMat same(const Mat &a)
{
  PackMat r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r.m[i][j] = a(i, j) + Pack{};
  return r;
}

TEST(CellKernels, a_rotation_strains_nothing)
{
  const double c = std::cos(0.6), s = std::sin(0.6);
  const Mat R = {{vec(c, -s, 0), vec(s, c, 0), vec(0, 0, 1)}},
            F = {{vec(1.2, 0.1, 0), vec(0, 0.9, 0.2), vec(0.05, 0, 1.1)}};
  const PackMat l = midpoint_increment(same(F), same(R * F));
  for (std::size_t lane = 0; lane < n_lanes; ++lane)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(l.m[i][j][lane] + l.m[j][i][lane], 0., 1e-15);
  // Cayley: the spin is 2 tan(angle/2).
  EXPECT_NEAR(l.m[1][0][0], 2. * std::tan(0.3), 1e-14);
}

TEST(CellKernels, a_stretch_is_its_midpoint_strain)
{
  const Mat F = {{vec(1.1, 0, 0), vec(0, 1, 0), vec(0, 0, 1)}};
  const PackMat l = midpoint_increment(same(Mat::identity()), same(F));
  EXPECT_NEAR(l.m[0][0][2], 0.1 / 1.05, 1e-15);
  EXPECT_NEAR(l.m[1][1][2], 0., 1e-15);
}

TEST(CellKernels, the_bound_of_the_eigenvalue)
{
  Pack G[6] = {};
  G[0] = 4. + Pack{};
  EXPECT_DOUBLE_EQ(largest_eigenvalue_bound(G)[1], 4.); // one direction
  G[1] = G[2] = G[0];
  EXPECT_NEAR(largest_eigenvalue_bound(G)[3], 4. * std::sqrt(3.), 1e-14);
}

TEST(CellKernels, damping_shortens_the_step)
{
  const Pack undamped = 2. + Pack{}, xi = 0.75 + Pack{};
  EXPECT_DOUBLE_EQ(damped_step(undamped, Pack{})[0], 2.);
  EXPECT_DOUBLE_EQ(damped_step(undamped, xi)[0], 1.);
}

TEST(Hourglass, modes_see_no_linear_field_and_forces_do_their_work)
{
  constexpr double X[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                              {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  double field[8], any[8], linear[3], mode[4], force[8];
  for (int a = 0; a < 8; ++a)
  {
    field[a] = 3. + 2. * X[a][0] - X[a][1] + 0.5 * X[a][2];
    any[a] = std::sin(1. + a);
  }
  corner_sums(field, linear, mode);
  const double slope[3] = {2., -1., 0.5};
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(linear[k], 4. * slope[k], 1e-14);
  for (const double m : mode)
    EXPECT_NEAR(m, 0., 1e-15);
  const double along[3] = {-0.9, 0.2, 0.6},
               amplitude[4] = {0.3, -0.7, 1.1, 0.4};
  corner_spread(along, amplitude, force);
  corner_sums(any, linear, mode);
  double work = 0., modal_work = 0., sum = 0.;
  for (int a = 0; a < 8; ++a)
  {
    work += force[a] * any[a];
    sum += force[a];
  }
  for (int k = 0; k < 3; ++k)
    modal_work += along[k] * linear[k];
  for (int m = 0; m < 4; ++m)
    modal_work += amplitude[m] * mode[m];
  EXPECT_NEAR(work, modal_work, 1e-14);
  EXPECT_NEAR(sum, 0., 1e-15);
  // Each mode alone has the signs that it is named by.
  constexpr double h[4][8] = {{1, 1, -1, -1, -1, -1, 1, 1},
                              {1, -1, -1, 1, -1, 1, 1, -1},
                              {1, -1, 1, -1, 1, -1, 1, -1},
                              {-1, 1, -1, 1, 1, -1, 1, -1}};
  for (int m = 0; m < 4; ++m)
  {
    corner_sums(h[m], linear, mode);
    for (int k = 0; k < 4; ++k)
      EXPECT_EQ(mode[k], k == m ? 8. : 0.);
  }
}

FemOptions options_with(const std::string &entry, const std::string &value)
{
  Parameters prm;
  FemOptions::declare_parameters(prm);
  EXPECT_TRUE(prm.set(entry, value)) << entry << " = " << value;
  return FemOptions::parse(prm, "Bodies/b");
}

TEST(FemOptions, never_has_a_name_and_old_numbers_mean_it)
{
  for (const std::string text : {"never", "1e10", "1e300"})
  {
    EXPECT_FALSE(options_with("Erosion plastic strain", text).erodes()) << text;
    EXPECT_FALSE(options_with("Erosion damage", text).erodes()) << text;
  }
  for (const std::string text : {"never", "0 s"})
    EXPECT_FALSE(options_with("Erosion step", text).erodes()) << text;
  EXPECT_TRUE(options_with("Erosion step", "1 ns").erodes());
  const auto limits = options_with("Erosion damage", "0.9").erosion_limits();
  ASSERT_EQ(limits.size(), 1u);
  EXPECT_EQ(limits[0].variable, "damage");
  EXPECT_EQ(limits[0].value, 0.9);
}

TEST(Registries, forms_of_hexahedra)
{
  for (const char *const name : {"one point", "B-bar"})
    EXPECT_NE(Registry<Hexahedra>::find(name), nullptr) << name;
  for (const char *const name : {"viscous", "stiffness"})
    EXPECT_NE(Registry<OnePoint>::find(name), nullptr) << name;
}
} // namespace
