// What bonds that fail between kernel updates change, and what they leave.
#include "sabot/base/choice.h"
#include "sabot/bodies/spg/failure/fragments.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"
#include "sabot/bodies/spg/stable_step.h"
#include "verification/balance.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace
{
using namespace sabot;

/** A block that has been strained within three steps since its kernels are
    those of the start, by a linear field and some noise [m], and of which a
    part has then become brittle. */
struct CrackingBlock
{
  World world;
  SpgBody *body;
  const Mat A = {
      {vec(1.04, 0.015, 0.), vec(-0.01, 1.03, 0.02), vec(0.01, 0., 1.01)}};

  using Approximation = SpgOptions::Approximation;

  CrackingBlock(const double noise, const char *const rule = "friction",
                const char *const form = "bond residual",
                const Approximation functions = Approximation::least_squares)
  {
    SpgOptions options;
    options.approximation = functions;
    options.set_critical_plastic_strain(0.45);
    options.residual_strength = choose<ResidualStrength>(rule);
    options.stabilization = choose<Stabilization>(form);
    world.bodies.push_back(std::make_unique<SpgBody>(
        "block", 0, perturbed_cloud({{8e-3, 7e-3, 6e-3}}, 1e-3, 0.1),
        hardening_aluminum(), options));
    world.distribute();
    body = static_cast<SpgBody *>(world.bodies[0].get());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-noise, noise);
    NodalState &n = body->nodes();
    for (int step = 1; step <= 3; ++step)
    {
      const Mat now = Mat::identity() + step / 3. * (A - Mat::identity());
      for (std::size_t i = 0; i < n.n_owned; ++i)
        n.position[i] = now * n.reference_position[i] +
                        vec(number(random), number(random), number(random));
      body->update_ghosts();
      body->compute_forces(0., 1e-7);
    }
    // Beside the plane x = 2 mm, and here and there.
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (std::abs(n.reference_position[i][0] - 2e-3) < 0.6e-3 || i % 41 == 0)
        body->rooms().points.state("effective plastic strain")[i] = 1.;
  }
  const SpgParts &rooms() const { return body->rooms(); }
  Mat present_kernel(const std::size_t i) const
  {
    return rooms().fields.incremental_deformation_gradient[i] *
           rooms().fields.kernel[i];
  }
  double volume(const std::size_t i) const
  {
    return rooms().fields.kernel_reference_volume[i] *
           determinant(rooms().fields.incremental_deformation_gradient[i]);
  }
};

double norm_of(const Mat &a)
{
  return std::sqrt(norm_square(a.row[0]) + norm_square(a.row[1]) +
                   norm_square(a.row[2]));
}

TEST(CrackUpdate, bonds_go_and_kernels_stay)
{
  CrackingBlock block(5e-6);
  const SpgParts &rooms = block.rooms();
  const std::size_t n = rooms.nodes.n_owned;
  const AlignedVector<Vec> X = rooms.fields.kernel_reference_position;
  std::vector<double> volume(n);
  AlignedVector<Mat> F(n), kernel(n);
  std::size_t n_bonds = 0, n_left = 0, n_failed = 0, n_other = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    volume[i] = block.volume(i);
    F[i] = rooms.fields.deformation_gradient(i);
    kernel[i] = block.present_kernel(i);
    n_bonds += rooms.bonds.n_bonds(i);
  }
  const AlignedVector<Mat> F_inc =
      rooms.fields.incremental_deformation_gradient;
  const std::size_t n_updates = rooms.watch.n_updates;
  ASSERT_TRUE(block.body->update_topology(5, 0.));
  EXPECT_EQ(rooms.watch.n_updates, n_updates);
  for (std::size_t i = 0; i < n; ++i)
  {
    n_left += rooms.bonds.n_bonds(i);
    EXPECT_EQ(norm(rooms.fields.kernel_reference_position[i] - X[i]), 0.);
    EXPECT_NEAR(block.volume(i) / volume[i], 1., 1e-12);
    EXPECT_LT(norm_of(rooms.fields.deformation_gradient(i) - F[i]), 1e-12);
    EXPECT_LT(norm_of(block.present_kernel(i) - kernel[i]), 1e-12 * 2e-3);
    n_other += norm_of(rooms.fields.incremental_deformation_gradient[i] -
                       F_inc[i]) > 1e-3;
    for (std::size_t b = rooms.bonds.begin(i); b < rooms.bonds.end(i); ++b)
    {
      EXPECT_EQ(rooms.bonds.neighbor[rooms.bonds.reverse[b]], i);
      EXPECT_EQ(rooms.bonds.weight[rooms.bonds.reverse[b]],
                rooms.bonds.weight[b]);
    }
    n_failed += rooms.failure.is_failed[i];
  }
  EXPECT_LT(n_left + 300, n_bonds);
  EXPECT_GT(n_failed, 20u);
  EXPECT_GT(n_other, 20u);
}

TEST(CrackUpdate, forces_are_those_of_an_evaluation_of_all)
{
  for (const char *const form : {"bond residual", "none"})
    for (const char *const rule : {"friction", "everything"})
    {
      CrackingBlock block(5e-6, rule, form);
      NodalState &n = block.body->nodes();
      const Vec coupling = vec(1., -2., 3.);
      n.force[7] += coupling;
      ASSERT_TRUE(block.body->update_topology(5, 0.));
      AlignedVector<Vec> force(n.force.begin(), n.force.begin() + n.n_owned);
      force[7] -= coupling;
      double scale = 0.;
      Vec sum = {}, moment = {};
      for (std::size_t i = 0; i < n.n_owned; ++i)
      {
        const Vec x = n.position[i], f = force[i];
        scale = std::max(scale, norm(f));
        sum += f;
        moment += vec(x[1] * f[2] - x[2] * f[1], x[2] * f[0] - x[0] * f[2],
                      x[0] * f[1] - x[1] * f[0]);
      }
      EXPECT_LT(norm(sum) / scale, 1e-12) << form << rule;
      // Where no direction is lost; the arm is a few mm.
      if (!std::count(block.rooms().approximation.lost_direction.begin(),
                      block.rooms().approximation.lost_direction.end(), 1))
      {
        EXPECT_LT(norm(moment) / scale, 1e-3 * 1e-7) << form << rule;
      }
      block.body->compute_forces(0., 0.);
      for (std::size_t i = 0; i < n.n_owned; ++i)
        EXPECT_LT(norm(n.force[i] - force[i]) / scale, 1e-6)
            << form << rule << i;
    }
}

TEST(CrackUpdate, functions_stay_exact_for_linear_fields)
{
  CrackingBlock block(0.);
  const SpgParts &rooms = block.rooms();
  NodalState &n = block.body->nodes();
  ASSERT_TRUE(block.body->update_topology(5, 0.));
  const Mat B = {
      {vec(1.05, 0.02, 0.), vec(-0.01, 1.06, 0.02), vec(0.01, 0.01, 1.02)}};
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.position[i] = B * n.reference_position[i];
  block.body->update_ghosts();
  block.body->compute_forces(0., 1e-7);
  std::size_t n_whole = 0;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (!rooms.approximation.lost_direction[i])
    {
      EXPECT_LT(norm_of(rooms.fields.deformation_gradient(i) - B), 1e-9) << i;
      ++n_whole;
    }
  EXPECT_GT(n_whole, n.n_owned / 2);
}

TEST(CrackUpdate, steps_are_stable)
{
  using Approximation = SpgOptions::Approximation;
  for (const auto &[form, functions] :
       {std::pair{"bond residual", Approximation::least_squares},
        {"bond residual", Approximation::convex_exponential},
        {"second gradient", Approximation::convex_exponential},
        {"second gradient", Approximation::convex_arctangent}})
    for (const double noise : {5e-6, 2e-5, 1e-4})
    {
      CrackingBlock block(noise, "friction", form, functions);
      ASSERT_TRUE(block.body->update_topology(5, 0.));
      block.body->compute_forces(0., 0.);
      EXPECT_LE(
          block.body->stable_step().dt * block.body->largest_frequency(60), 2.)
          << form << ", " << int(functions) << ", noise " << noise;
    }
}

TEST(CrackUpdate, kernels_follow_at_regular_updates)
{
  CrackingBlock block(5e-6);
  ASSERT_TRUE(block.body->update_topology(5, 0.));
  ASSERT_TRUE(block.body->update_topology(30, 0.));
  const SpgParts &rooms = block.rooms();
  for (std::size_t i = 0; i < rooms.nodes.n_owned; ++i)
    ASSERT_EQ(norm(rooms.fields.kernel_reference_position[i] -
                   rooms.nodes.position[i]),
              0.);
}

/** Labels found anew. */
std::vector<GlobalIndex> labels_of(const SpgParts &rooms)
{
  return fragment_labels(rooms.nodes, rooms.bonds, rooms.failure,
                         rooms.exchange, MPI_COMM_SELF);
}

TEST(CrackUpdate, pieces_are_those_of_the_present_bonds)
{
  for (const char *const rule : {"friction", "everything"})
  {
    CrackingBlock block(5e-6, rule);
    const SpgParts &rooms = block.rooms();
    const FragmentView &pieces = *block.body->fragments();
    std::vector<GlobalIndex> before = pieces.piece_labels();
    EXPECT_EQ(before, labels_of(rooms)) << rule;
    EXPECT_EQ(pieces.connected_pieces().size(), 1u) << rule;
    for (const unsigned int step : {5u, 30u}) // cracks alone, and all kernels
    {
      ASSERT_TRUE(block.body->update_topology(step, 0.));
      EXPECT_NE(pieces.piece_labels(), before) << rule << step;
      before = pieces.piece_labels();
      EXPECT_EQ(before, labels_of(rooms)) << rule << step;
      EXPECT_EQ(pieces.connected_pieces().size(),
                std::set<GlobalIndex>(before.begin(), before.end()).size())
          << rule << step;
      // Another part becomes brittle.
      for (std::size_t i = 0; i < rooms.nodes.n_owned; ++i)
        if (std::abs(rooms.nodes.reference_position[i][0] - 4e-3) < 0.6e-3)
          rooms.points.state("effective plastic strain")[i] = 1.;
    }
  }
}
} // namespace
