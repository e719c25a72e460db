// What a kernel update finds anew: rows, neighbors of crumbled metal, steps.
#include "sabot/base/choice.h"
#include "sabot/bodies/spg/bond_rows.h"
#include "sabot/bodies/spg/failure/gaping_volume.h"
#include "sabot/bodies/spg/mirror_planes.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"
#include "sabot/bodies/spg/stable_step.h"
#include "sabot/bodies/spg/stiffness_bound.h"
#include "verification/balance.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace
{
using namespace sabot;

TEST(KernelUpdate, places_of_global_numbers)
{
  std::mt19937 random(1);
  for (const GlobalIndex gap : {1, 2, 7, 1000, 1000000000})
    for (const std::size_t n : {0, 1, 2, 50, 1000})
    {
      std::uniform_int_distribution<GlobalIndex> step(1, gap);
      std::vector<GlobalIndex> numbers;
      GlobalIndex last = 13;
      for (std::size_t k = 0; k < n; ++k)
        numbers.push_back(last += step(random));
      const NumberIndex place(numbers.data(), n);
      for (std::size_t k = 0; k < n; ++k)
        ASSERT_EQ(place(numbers[k]), k);
      for (int trial = 0; trial < 200; ++trial)
      {
        const GlobalIndex j =
            std::uniform_int_distribution<GlobalIndex>(0, last + 9)(random);
        const auto found = std::lower_bound(numbers.begin(), numbers.end(), j);
        const bool is_there = found != numbers.end() && *found == j;
        ASSERT_EQ(place(j), is_there ? found - numbers.begin() : n);
      }
    }
}

TEST(KernelUpdate, bonds_are_found_by_the_numbers_of_their_ends)
{
  World world;
  SpgOptions options;
  options.symmetry_faces = 0b000101; // a corner of two planes
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, make_box_cloud({{0, 0, 0}}, {{5e-3, 4e-3, 3e-3}}, 1e-3),
      hardening_aluminum(), options));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  const BondList &bonds = body.rooms().bonds;
  const NodalState &n = body.nodes();
  const ParticleView &view = *body.particles();
  std::vector<std::uint32_t> at_ghosts;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    std::set<GlobalIndex> neighbors;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const GlobalIndex id = n.global_id[j];
      EXPECT_EQ(bonds.first_from(i, id), b);
      EXPECT_EQ(bonds.first_from(i, id + 1), b + 1);
      if (j < n.n_owned)
      {
        neighbors.insert(id);
        continue;
      }
      if (at_ghosts.empty() || at_ghosts.back() != i)
        at_ghosts.push_back(i);
      const GlobalIndex particle = MirrorPlanes::particle_of(id);
      EXPECT_TRUE(view.are_bonded(i, particle, n.position[j]));
      EXPECT_FALSE(
          view.are_bonded(i, particle, n.position[j] + vec(3e-4, 0., 0.)));
    }
    for (std::size_t j = 0; j < n.n_owned; ++j)
      EXPECT_EQ(view.are_bonded(i, j), neighbors.count(j) == 1);
  }
  EXPECT_EQ(at_ghosts, bonds.rows_at_ghosts());
  EXPECT_GT(at_ghosts.size(), n.n_owned / 4);
  EXPECT_LT(at_ghosts.size(), n.n_owned);
}

TEST(KernelUpdate, rows_are_sorted_and_merged)
{
  BondRows rows;
  for (const GlobalIndex j : {5, 3, 5, 1})
    rows.add(j);
  rows.sort_and_end_row();
  rows.end_row();
  const GlobalIndex more[] = {2, 9};
  rows.merge_and_end_row({1, 4}, more, more + 2);
  rows.merge_and_end_row({3, 8}, more, more);
  ASSERT_EQ(rows.size(), 4u);
  const std::vector<std::vector<GlobalIndex>> expected = {
      {1, 3, 5}, {}, {1, 2, 4, 9}, {3, 8}};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(std::vector<GlobalIndex>(rows[i].begin(), rows[i].end()),
              expected[i]);
}

/** A block of which a share of the particles has crumbled, at random, and been
    thrown about: by a fifth of a spacing, a few far away. */
struct CrumbledBlock
{
  World world;
  SpgBody *body;
  CrumbledBlock(const double share, const unsigned int seed,
                const std::array<double, 3> &size = {{7e-3, 6e-3, 5e-3}})
  {
    SpgOptions options;
    options.set_critical_plastic_strain(0.45);
    options.residual_strength = choose<ResidualStrength>("friction");
    world.bodies.push_back(
        std::make_unique<SpgBody>("block", 0, perturbed_cloud(size, 1e-3, 0.1),
                                  hardening_aluminum(), options));
    world.distribute();
    body = static_cast<SpgBody *>(world.bodies[0].get());
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1., 1.);
    NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      const bool crumbles = 0.5 + 0.5 * number(random) < share;
      body->rooms().points.state("effective plastic strain")[i] =
          crumbles ? 1. : 0.;
      n.position[i] = 1.05 * n.reference_position[i];
      if (crumbles)
        for (int d = 0; d < 3; ++d)
          n.position[i][d] += 0.2e-3 * number(random);
      if (crumbles && number(random) > 0.95)
        n.position[i][i % 3] += 1e4 * number(random);
    }
    body->update_ghosts();
    EXPECT_TRUE(body->update_topology(30, 0.));
  }
};

TEST(KernelUpdate, crumbled_neighbors_are_those_within_the_support)
{
  for (const double share : {0.02, 0.3, 1.})
  {
    CrumbledBlock block(share, 7);
    const SpgParts &rooms = block.body->rooms();
    const NodalState &n = rooms.nodes;
    const BondList &bonds = rooms.bonds;
    const double reach = rooms.kernel.support() * rooms.kernel.mean_spacing();
    std::size_t n_pairs = 0;
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      std::set<std::uint32_t> expected, found;
      for (std::uint32_t j = 0; j < n.n_owned; ++j)
        if (i != j && rooms.failure.has_crumbled(i) &&
            rooms.failure.has_crumbled(j) &&
            norm(n.position[j] - n.position[i]) < reach)
          expected.insert(j);
      for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      {
        const std::uint32_t j = bonds.neighbor[b];
        EXPECT_EQ(bonds.neighbor[bonds.reverse[b]], i);
        EXPECT_EQ(bonds.weight[bonds.reverse[b]], bonds.weight[b]);
        EXPECT_TRUE(b == bonds.begin(i) || bonds.neighbor[b - 1] < j);
        if (!rooms.failure.is_cohesive(i, j))
          found.insert(j);
      }
      ASSERT_EQ(found, expected) << "share " << share << ", particle " << i;
      n_pairs += expected.size();
    }
    EXPECT_TRUE(share < 0.1 || n_pairs > 100u);
  }
}

TEST(KernelUpdate, stable_beside_cracks_without_measuring_anew)
{
  // Steps end at sqrt(3) over the largest frequency of an intact body, and the
  // bound of what has cracks is at most 2 over it.
  for (const double share : {0.01, 0.05, 0.2, 0.6, 1.})
    for (const unsigned int seed : {1, 2, 3})
    {
      CrumbledBlock block(share, seed);
      block.body->compute_forces(0., 0.);
      EXPECT_LE(
          block.body->stable_step().dt * block.body->largest_frequency(60), 2.)
          << "share " << share << ", seed " << seed;
    }
}

/** What rows say of the largest frequency of a body, over what it is. */
double bound_over_frequency(SpgBody &body, const char *const form_name)
{
  const SpgParts &rooms = body.rooms();
  const std::unique_ptr<Stabilization> form =
      choose<Stabilization>(form_name)();
  form->allocate(rooms);
  form->renew_ghosts(rooms);
  form->follow_functions(rooms);
  std::vector<double> rows =
      elastic_row_bounds(rooms, std::vector<char>(rooms.nodes.size(), 1));
  form->add_row_sums(rooms, rows);
  double square = 0.;
  for (std::size_t i = 0; i < rows.size(); ++i)
    square = std::max(square, rows[i] / rooms.nodes.inertia[i]);
  return std::sqrt(square) /
         largest_frequency(rooms, *form, 100, MPI_COMM_SELF);
}

TEST(KernelUpdate, rows_bound_the_largest_frequency)
{
  using Approximation = SpgOptions::Approximation;
  for (const char *const form : {"bond residual", "none"})
    for (const Approximation functions :
         {Approximation::least_squares, Approximation::convex_exponential})
      for (const double part : {0., 0.2, 0.35})
        for (const double flat : {1., 0.5})
        {
          World world;
          SpgOptions options;
          options.approximation = functions;
          options.stabilization = choose<Stabilization>(form);
          ParticleCloud cloud =
              perturbed_cloud({{5e-3, 4e-3, 4e-3}}, 1e-3, part);
          for (auto &p : cloud.position)
            p[2] *= flat;
          world.bodies.push_back(std::make_unique<SpgBody>(
              "block", 0, std::move(cloud), elastic(), options));
          world.distribute();
          const double ratio = bound_over_frequency(
              static_cast<SpgBody &>(*world.bodies[0]), form);
          EXPECT_GE(ratio, 1.) << form << " " << part << " " << flat;
          EXPECT_LE(ratio, 2.7) << form << " " << part << " " << flat;
        }
  for (const double share : {0.01, 0.05, 0.2, 0.6, 1.})
    for (const unsigned int seed : {1, 2, 3, 4})
    {
      CrumbledBlock block(share, seed);
      EXPECT_GE(bound_over_frequency(*block.body, "bond residual"), 1.)
          << "share " << share << ", seed " << seed;
    }
}

TEST(KernelUpdate, metal_that_gapes_bears_nothing_but_viscosity)
{
  CrumbledBlock block(0.5, 3);
  SpgBody &body = *block.body;
  const SpgParts &rooms = body.rooms();
  NodalState &n = body.nodes();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1., 1.);
  std::size_t n_gaping = 0, n_sound = 0;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n_sound += !rooms.failure.is_failed[i] && stiffness_share(rooms, i) == 1.;
  EXPECT_EQ(n_sound, n.n_owned - std::count(rooms.failure.is_failed.begin(),
                                            rooms.failure.is_failed.end(), 1));
  // All is stretched, and then moved about and pressed by less than a tenth.
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.position[i] = 1.15 * n.position[i];
  body.update_ghosts();
  body.compute_forces(0., 1e-9);
  body.update_topology(60, 0.);
  std::vector<char> gapes(n.n_owned);
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n_gaping += gapes[i] = stiffness_share(rooms, i) < 1.;
  EXPECT_GT(n_gaping, n.n_owned / 10);
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.position[i] = 0.98 * n.position[i] +
                    1e-5 * vec(number(random), number(random), number(random));
  body.update_ghosts();
  body.compute_forces(0., 1e-9);
  for (std::size_t i = 0; i < n.n_owned; ++i)
    for (unsigned int c = 0; c < 6 && gapes[i]; ++c)
      ASSERT_EQ(body.stress(c, i), 0.) << i;
}

TEST(KernelUpdate, metal_that_gapes_has_no_more_than_a_kernel_for_itself)
{
  CrumbledBlock block(0.5, 3);
  SpgBody &body = *block.body;
  const SpgParts &rooms = body.rooms();
  ParticleFields &fields = rooms.fields;
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    // Where bodies come to that have gaped for long.
    fields.kernel_reference_volume[i] *= 1e3;
    fields.kernel_reference_deformation_gradient[i] =
        10. * fields.kernel_reference_deformation_gradient[i];
    n.position[i] = 1.15 * n.position[i];
  }
  body.update_ghosts();
  body.compute_forces(0., 1e-9);
  std::vector<char> gaped(n.n_owned);
  for (std::size_t i = 0; i < n.n_owned; ++i)
    gaped[i] = gapes(rooms, i);
  ASSERT_TRUE(body.update_topology(60, 0.));
  const double most = 4. / 3. * M_PI * std::pow(rooms.kernel.support(), 3);
  std::size_t n_bound = 0, n_sound = 0;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const double J =
        fields.kernel_reference_volume[i] / fields.reference_volume[i];
    EXPECT_NEAR(determinant(fields.deformation_gradient(i)) / J, 1., 1e-9);
    if (gaped[i])
      n_bound += J <= most * (1. + 1e-12);
    else
      n_sound += J > 900.;
  }
  EXPECT_GT(n_bound, n.n_owned / 10);
  EXPECT_GT(n_sound, n.n_owned / 10);
  EXPECT_EQ(n_bound + n_sound, n.n_owned);
}

TEST(KernelUpdate, kernels_follow_the_motion_where_places_are_smoothed)
{
  for (const bool can_fail : {false, true})
  {
    World world;
    SpgOptions options;
    if (can_fail)
      options.set_critical_plastic_strain(0.45);
    world.bodies.push_back(std::make_unique<SpgBody>(
        "block", 0, make_box_cloud({}, {{6e-3, 5e-3, 5e-3}}, 1e-3),
        hardening_aluminum(), options));
    world.distribute();
    SpgBody &body = static_cast<SpgBody &>(*world.bodies[0]);
    const ParticleFields &fields = body.rooms().fields;
    const LagrangianKernel &kernel = body.rooms().kernel;
    NodalState &n = body.nodes();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-2e-5, 2e-5);
    double smoothed = 0.;
    for (const double size : {0.96, 0.95, 0.96})
    {
      for (std::size_t i = 0; i < n.n_owned; ++i)
        n.position[i] = size * n.reference_position[i] +
                        vec(number(random), number(random), number(random));
      body.update_ghosts();
      body.compute_forces(0., 1e-9);
      ASSERT_TRUE(body.update_topology(30, 0.));
      for (std::size_t i = 0; i < n.n_owned; ++i)
      {
        const Mat F = fields.incremental_deformation_gradient[i],
                  now = F * fields.kernel[i],
                  expected = kernel.support() * kernel.mean_spacing() *
                             fields.deformation_gradient(i);
        for (int d = 0; d < 3; ++d)
          EXPECT_LT(norm(now.row[d] - expected.row[d]), 1e-15);
        smoothed = std::max(smoothed, std::abs(determinant(F) - 1.));
      }
    }
    EXPECT_GT(smoothed, 1e-3);
  }
}

TEST(KernelUpdate, a_crack_that_holds_the_least_bound_asks_for_no_calibration)
{
  CrumbledBlock block(0.3, 4);
  const SpgParts &rooms = block.body->rooms();
  double least[2] = {1., 1.}; // intact, cracked
  for (std::size_t i = 0; i < rooms.nodes.n_owned; ++i)
  {
    double &bound = least[rooms.failure.has_cracks(i)];
    bound = std::min(bound, rooms.stable_step.data()[i]);
  }
  ASSERT_LT(2.1 * least[1], least[0]); // whatever the factor
  EXPECT_FALSE(
      rooms.stable_step.calibration_is_due(rooms, 100000, MPI_COMM_SELF));
  // An intact body has it measured by age.
  World world;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "intact", 0, perturbed_cloud({{4e-3, 4e-3, 4e-3}}, 1e-3, 0.1), elastic(),
      SpgOptions()));
  world.distribute();
  const SpgParts &intact = static_cast<SpgBody &>(*world.bodies[0]).rooms();
  EXPECT_FALSE(
      intact.stable_step.calibration_is_due(intact, 299, MPI_COMM_SELF));
  EXPECT_TRUE(
      intact.stable_step.calibration_is_due(intact, 300, MPI_COMM_SELF));
}

TEST(KernelUpdate, the_linearized_body_is_the_step_of_a_small_motion)
{
  using Approximation = SpgOptions::Approximation;
  for (const char *const name : {"bond residual", "none"})
    for (const Approximation functions :
         {Approximation::least_squares, Approximation::convex_exponential})
    {
      World world;
      SpgOptions options;
      options.approximation = functions;
      options.stabilization = choose<Stabilization>(name);
      options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
      world.bodies.push_back(std::make_unique<SpgBody>(
          "block", 0, perturbed_cloud({{5e-3, 4e-3, 4e-3}}, 1e-3, 0.2),
          elastic(), options));
      world.distribute();
      SpgBody &body = static_cast<SpgBody &>(*world.bodies[0]);
      NodalState &n = body.nodes();
      const std::unique_ptr<Stabilization> form = options.stabilization();
      form->allocate(body.rooms());
      form->renew_ghosts(body.rooms());
      form->follow_functions(body.rooms());
      std::mt19937 random(3);
      std::uniform_real_distribution<double> number(-1., 1.);
      AlignedVector<Vec> motion(n.size()), force(n.n_owned);
      for (Vec &u : motion)
        u = 1e-9 * vec(number(random), number(random), number(random));
      form->apply_linearized(body.rooms(), motion, force);
      for (std::size_t i = 0; i < n.n_owned; ++i)
        n.position[i] = n.reference_position[i] + motion[i];
      body.update_ghosts();
      body.compute_forces(0., 1e-9);
      double scale = 0.;
      for (const Vec f : force)
        scale = std::max(scale, norm(f));
      ASSERT_GT(scale, 0.);
      for (std::size_t i = 0; i < n.n_owned; ++i)
        EXPECT_NEAR(norm(n.force[i] - force[i]) / scale, 0., 2e-5) << name;
    }
}
} // namespace
