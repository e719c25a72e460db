// What a particle stands on, and when contact forgets it.
#include "sabot/couplings/mirror_images.h"
#include "sabot/couplings/particle_standing.h"
#include "verification/world.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

constexpr double h = 1e-3;

/** A block of particles below z = 0, deformed by @p F. */
struct Block
{
  std::vector<Vec> position;
  AlignedVector<VolumePoint> volume;

  Block(const std::array<double, 3> &size, const std::array<double, 3> &center,
        const Mat &F, const std::uint32_t symmetry = 0)
  {
    SpgOptions options;
    options.symmetry_faces = symmetry;
    World world;
    world.bodies.push_back(std::make_unique<SpgBody>(
        "block", 0, make_box_cloud(center, size, h), elastic(), options));
    world.distribute();
    // Through a kernel update, as in a run.
    NodalState &n = world.bodies[0]->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
      n.position[i] = F * n.reference_position[i];
    world.bodies[0]->update_ghosts();
    world.bodies[0]->compute_forces(0., 1e-9);
    world.bodies[0]->update_topology(30, 0.);
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      position.push_back(n.position[i]);
      volume.push_back(world.bodies[0]->particles()->volume_point(i));
    }
  }

  Standing standing(const Vec x, std::vector<NearParticle> &near,
                    const MirrorImages &images = MirrorImages()) const
  {
    near.clear();
    for (std::size_t i = 0; i < position.size(); ++i)
      for (unsigned int image = 0; image < images.size(); ++image)
        near.push_back(
            {i, images.axes(image), x - images(position[i], image), 0.});
    return stand_in_volume(near, volume);
  }
};

std::vector<Mat> deformations()
{
  Mat shear = Mat::identity(), flat = Mat::identity(), long_one = flat;
  shear.set(0, 2, 1.2);
  for (int d = 0; d < 3; ++d)
  {
    flat.set(d, d, d == 2 ? 0.4 : 1.6);
    long_one.set(d, d, d == 2 ? 1.7 : 0.75);
  }
  return {Mat::identity(), shear, flat, long_one};
}

TEST(Standing, a_volume_ends_where_its_lattice_does)
{
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  for (const Mat &F : deformations())
  {
    const Block block({{10e-3, 10e-3, 6e-3}}, {{0., 0., -3e-3}}, F);
    const double along_normal = F(2, 2) * h; // spacing of the layers
    std::vector<NearParticle> near;
    for (int k = 0; k < 50; ++k)
      for (const double depth : {0., 0.1, 0.25, 0.5})
      {
        const Vec x =
            F * vec(uniform(generator) * h, uniform(generator) * h, 0.) -
            vec(0., 0., depth * along_normal);
        const Standing s = block.standing(x, near);
        // The lattice moves the place where half is filled by 0.005 spacings,
        // and down to half a spacing bends the profile by 6 % (12 % where it is
        // sheared) and tilts the normal by its slope inside, 0.06/h of 0.49/h
        // where it is not deformed and 0.21 of it, 12 degrees, at most here.
        EXPECT_NEAR(-s.gap, depth * along_normal,
                    (0.006 + 0.12 * depth) * along_normal);
        EXPECT_GT(s.normal[2], depth > 0.2 ? 0.978 : 0.998);
        EXPECT_EQ(s.fade, s.gap < 0. ? 1. : 0.);
        double sum = 0.;
        Vec moment = {};
        for (const NearParticle &p : near)
        {
          EXPECT_GE(p.weight, 0.);
          sum += p.weight;
          moment += p.weight * p.offset;
        }
        if (s.fade > 0.)
        {
          EXPECT_NEAR(sum, 1., 1e-12);
          // What presses on the surface is borne there.
          EXPECT_LT(norm(moment), (0.02 + 0.3 * depth) * h);
        }
      }
  }
}

TEST(Standing, deep_inside_no_side_is_nearer_and_outside_nothing_is_met)
{
  const Block block({{8e-3, 8e-3, 8e-3}}, {{0., 0., -4e-3}}, Mat::identity());
  std::vector<NearParticle> near;
  for (const double t : {0., 0.2, 0.5})
  {
    const Standing s =
        block.standing(vec(t * h, 0.3 * t * h, -4e-3 + t * h), near);
    EXPECT_TRUE(s.is_deep);
    EXPECT_EQ(s.fade, 0.);
    EXPECT_EQ(block.standing(vec(0., 0., 0.05 * h), near).fade, 0.);
  }
}

TEST(Standing, a_quarter_with_its_images_is_the_whole)
{
  const Block whole({{8e-3, 8e-3, 4e-3}}, {{0., 0., -2e-3}}, Mat::identity()),
      quarter({{4e-3, 4e-3, 4e-3}}, {{2e-3, 2e-3, -2e-3}}, Mat::identity(),
              0b000101);
  const std::vector<SymmetryPlane> planes = {{0, 0.}, {1, 0.}};
  for (const Vec x : {vec(0., 0., -0.1e-3), vec(0.3e-3, 0., -0.2e-3),
                      vec(0.4e-3, 1.1e-3, -0.05e-3)})
  {
    MirrorImages images;
    images.find(planes, x, 3. * h);
    std::vector<NearParticle> of_whole, of_quarter;
    const Standing a = whole.standing(x, of_whole),
                   b = quarter.standing(x, of_quarter, images);
    EXPECT_NEAR(a.gap, b.gap, 1e-12 * h);
    EXPECT_NEAR(norm(a.normal - b.normal), 0., 1e-12);
    double sum_a = 0., sum_b = 0.; // of the parts times the height
    for (const NearParticle &p : of_whole)
      sum_a += p.weight * p.offset[2];
    for (const NearParticle &p : of_quarter)
      sum_b += p.weight * p.offset[2];
    EXPECT_NEAR(sum_a, sum_b, 1e-12 * h);
  }
}

TEST(Standing, all_that_is_met_on_one_line_bears_all)
{
  // A piece that has swollen fills half of the space alone; in what pushes it
  // nothing tells two of them in one direction apart.
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 2000; ++k)
  {
    Vec direction =
        vec(normal(generator), normal(generator), normal(generator));
    direction *= 1. / norm(direction);
    Block few({{h, h, h}}, {{0., 0., 0.}}, Mat::identity());
    few.position.resize(1 + k % 3);
    few.volume.resize(few.position.size());
    for (std::size_t i = 0; i < few.position.size(); ++i)
    {
      few.position[i] = 0.1 * double(i) * h * direction;
      few.volume[i].to_unit = 1. / (3. * h) * Mat::identity();
      few.volume[i].content = 2.;
    }
    std::vector<NearParticle> near;
    const Standing s = few.standing(1.2 * h * direction, near);
    ASSERT_GT(s.fade, 0.);
    double sum = 0.;
    for (const NearParticle &p : near)
    {
      EXPECT_GE(p.weight, 0.);
      sum += p.weight;
    }
    ASSERT_NEAR(sum, 1., 1e-12);
  }
}

TEST(Standing, surface_of_a_quarter_cylinder_is_its_foot_top_and_side)
{
  // Its boundary ids are not in the order of a box's faces, its particles are
  // not on a lattice.
  const double R = 8e-3, L = 10e-3;
  SpgOptions options;
  options.symmetry_faces = 1u << 3 | 1u << 4; // the cuts, across x and y
  World world;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "bar", 0,
      make_mesh_cloud(make_cylinder(R, L, 2, {{0., 0., 0.5 * L}}, h, 2)),
      elastic(), options));
  world.distribute();
  const Body &bar = *world.bodies[0];
  const NodalState &n = bar.nodes();
  std::size_t n_foot = 0, n_side = 0, n_rim = 0, n_inside = 0;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec x = n.position[i];
    const SurfacePoint point = bar.particles()->surface_point(i);
    const double r = std::hypot(x[0], x[1]);
    const bool on_side = r > R - 1e-6,
               on_foot = x[2]<1e-9, on_top = x[2]> L - 1e-9;
    // Mirror images take away what would look across a plane.
    for (int d = 0; d < 2; ++d)
      if (x[d] < 1e-9)
      {
        EXPECT_EQ(point.normal[d], 0.);
      }
    if (on_side && (on_foot || on_top))
    {
      EXPECT_LT(point.flatness, 0.1);
      ++n_rim;
    }
    else if (on_side)
    {
      EXPECT_GT(dot(point.normal, 1. / r * vec(x[0], x[1], 0.)), 1. - 1e-6);
      EXPECT_EQ(point.flatness, 1.);
      ++n_side;
    }
    else if (on_foot || on_top)
    {
      EXPECT_NEAR(point.normal[2], on_foot ? -1. : 1., 1e-12);
      EXPECT_EQ(point.flatness, 1.);
      n_foot += on_foot;
    }
    else
    {
      EXPECT_EQ(norm_square(point.normal), 0.);
      ++n_inside;
    }
  }
  EXPECT_GT(n_foot, 40u);
  EXPECT_GT(n_side, 80u);
  EXPECT_GT(n_rim, 20u);
  EXPECT_GT(n_inside, 400u);
}
} // namespace
