// Contact, self-contact and ties on few nodes.
#include "verification/world.h"

#include "sabot/couplings/contact.h"
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/couplings/tie.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

BoxSpecification box(const std::array<double, 3> &size,
                     const std::array<double, 3> &center, const double h)
{
  BoxSpecification b;
  b.size = size;
  b.center = center;
  b.cell_size = h;
  return b;
}

void add_fem(World &world, const HexMesh &mesh,
             const std::array<double, 3> &velocity = {{0, 0, 0}},
             const double viscosity = 1.)
{
  FemOptions options;
  options.initial_velocity = velocity;
  options.bulk_viscosity_linear *= viscosity;
  options.bulk_viscosity_quadratic *= viscosity;
  world.bodies.push_back(
      std::make_unique<FemBody>("fem" + std::to_string(world.bodies.size()),
                                world.bodies.size(), mesh, elastic(), options));
}

void add_spg(World &world, const std::array<double, 3> &size,
             const std::array<double, 3> &center, const double h,
             const std::array<double, 3> &velocity = {{0, 0, 0}})
{
  SpgOptions options;
  options.initial_velocity = velocity;
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "spg" + std::to_string(world.bodies.size()), world.bodies.size(),
      make_box_cloud(center, size, h), elastic(), options));
}

/** A bar of hexahedra (cells of @p cell) and particles (spacing 1 mm), tied. */
void add_tied_bar(World &world, const double cell)
{
  add_fem(world,
          make_graded_box(box({{20e-3, 4e-3, 4e-3}}, {{-10e-3, 0, 0}}, cell)),
          {{0, 0, 0}}, 0.);
  add_spg(world, {{20e-3, 4e-3, 4e-3}}, {{10e-3, 0, 0}}, 1e-3);
  world.couplings.push_back(std::make_unique<Tie>("tie", world.pointers(), 1, 0,
                                                  0.05, MPI_COMM_WORLD));
  world.distribute();
}

TEST(Tie, followers_take_linear_fields_exactly)
{
  for (const double cell : {1e-3, 2e-3, 1.5e-3})
  {
    World world;
    add_tied_bar(world, cell);
    EXPECT_EQ(world.couplings[0]->measure()[0].value, 25.);
    const auto field = [](const Vec x)
    { return vec(1. + 300. * x[0] - 20. * x[1], 5. * x[2], -7. * x[1]); };
    NodalState &leaders = world.bodies[0]->nodes(),
               &followers = world.bodies[1]->nodes();
    for (std::size_t i = 0; i < leaders.size(); ++i)
      leaders.velocity[i] = field(leaders.reference_position[i]);
    world.couplings[0]->impose_kinematics();
    for (std::size_t i = 0; i < followers.n_owned; ++i)
      if (followers.is_follower(i))
      {
        const Vec v = field(followers.reference_position[i]);
        EXPECT_NEAR(norm(followers.velocity[i] - v), 0., 1e-13);
      }
  }
}

TEST(Tie, a_pulse_crosses_and_momentum_and_energy_stay)
{
  for (const double cell : {1e-3, 2e-3})
  {
    World world;
    add_tied_bar(world, cell);
    // A smooth pulse that travels from the hexahedra into the particles.
    NodalState &n = world.bodies[0]->nodes();
    for (std::size_t i = 0; i < n.size(); ++i)
    {
      const double s = (n.reference_position[i][0] + 10e-3) / 3e-3;
      n.velocity[i] = vec(2. * std::exp(-s * s), 0., 0.);
    }
    world.stepper.initialize();
    const double energy = world.total_energy();
    const auto before = world.momenta();
    double worst = 0., arrived = 0.;
    while (world.stepper.time() < 5e-6)
    {
      world.advance(0.6);
      worst = std::max(worst, std::abs(world.total_energy() - energy));
      NodalState &p = world.bodies[1]->nodes();
      for (std::size_t i = 0; i < p.n_owned; ++i)
        if (p.reference_position[i][0] > 12e-3)
          arrived = std::max(arrived, p.velocity[i][0]);
    }
    const auto after = world.momenta();
    EXPECT_NEAR(after[0], before[0], 1e-12 * before[0]);
    EXPECT_LT(worst, 0.01 * energy);
    EXPECT_GT(arrived, 0.7); // half of the pulse goes to the right
  }
}

TEST(Tie, leaders_do_not_feel_bonds_that_failed)
{
  World world;
  add_fem(world,
          make_graded_box(box({{4e-3, 4e-3, 4e-3}}, {{-2e-3, 0, 0}}, 1e-3)));
  SpgOptions options;
  options.set_critical_plastic_strain(0.45);
  options.critical_stretch = 1.005;
  options.failure_check_interval = 1;
  const auto metal = hardening_aluminum(1e3 * aluminum_yield_stress(), 150e6);
  world.bodies.push_back(std::make_unique<SpgBody>(
      "spg", 1, make_box_cloud({{2e-3, 0, 0}}, {{4e-3, 4e-3, 4e-3}}, 1e-3),
      metal, options));
  world.couplings.push_back(std::make_unique<Tie>("tie", world.pointers(), 1, 0,
                                                  0.05, MPI_COMM_WORLD));
  world.distribute();
  Body &fem = *world.bodies[0];
  auto &spg = static_cast<SpgBody &>(*world.bodies[1]);
  NodalState &leaders = fem.nodes(), &n = spg.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    spg.rooms().points.state("effective plastic strain")[i] = 1.;
    n.velocity[i] = vec(1e5 * n.reference_position[i][0], 0., 0.);
  }
  world.stepper.initialize();
  const double energy = world.total_energy();
  double broken = 0.;
  while (broken == 0.)
  {
    world.stepper.advance(5e-9);
    const AlignedVector<Vec> before = leaders.force;
    AlignedVector<Vec> own = n.force;
    world.stepper.update();
    broken = measure(spg, "bonds broken");
    // What the leaders lose is what their followers lose: all forces balance.
    Vec sum = {}, change = {}, followers = {};
    double size = 0.;
    for (std::size_t i = 0; i < leaders.n_owned; ++i)
    {
      sum += leaders.force[i];
      change += leaders.force[i] - before[i];
      size += norm(leaders.force[i]);
    }
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (!n.is_follower(i))
      {
        sum += n.force[i];
        size += norm(n.force[i]);
      }
      else
        followers += n.force[i] - own[i];
    EXPECT_LT(norm(sum), 1e-12 * size);
    EXPECT_LT(norm(change - followers), 1e-12 * size);
    if (broken > 0.)
    {
      EXPECT_GT(norm(followers), 0.01 * size);
    }
  }
  // The same after some steps of a half-broken body.
  for (int step = 0; step < 100; ++step)
    world.advance(0.2);
  EXPECT_NEAR(world.total_energy(), energy, 2e-3 * energy);
}

TEST(Contact, two_bars_collide_and_part_with_momentum_and_energy)
{
  for (const bool particles : {false, true})
  {
    World world;
    const double v = 50.;
    add_fem(
        world,
        make_graded_box(box({{3e-3, 3e-3, 10e-3}}, {{0, 0, 5.01e-3}}, 1e-3)),
        {{0, 0, -v}});
    if (particles)
      add_spg(world, {{3e-3, 3e-3, 10e-3}}, {{0, 0, -5.01e-3}}, 1e-3,
              {{0, 0, v}});
    else
      add_fem(
          world,
          make_graded_box(box({{3e-3, 3e-3, 10e-3}}, {{0, 0, -5.01e-3}}, 1e-3)),
          {{0, 0, v}});
    std::vector<ContactPair> pairs = {{0, 1, false}};
    if (!particles)
      pairs.push_back({1, 0, false});
    world.couplings.push_back(std::make_unique<Contact>(
        "contact", world.pointers(), pairs, ContactOptions(), MPI_COMM_WORLD));
    world.distribute();
    world.stepper.initialize();
    const double energy = world.total_energy();
    while (world.stepper.time() < 20e-6)
      world.advance(0.9);
    const auto after = world.momenta();
    const double m = world.bodies[0]->measure().mass;
    EXPECT_NEAR(after[2], 0., 1e-12 * m * v);
    EXPECT_NEAR(world.total_energy(), energy, 2e-3 * energy);
    // Equal bars exchange their velocities, but for what keeps vibrating.
    const double rebound = world.bodies[0]->measure().velocity[2];
    EXPECT_GT(rebound, 0.8 * v);
    EXPECT_LT(rebound, 1.001 * v);
  }
}

TEST(Contact, friction_slows_a_sliding_block_by_coulomb)
{
  // A block pressed by its own approach slides; the impulses of friction and
  // pressure are in the ratio of the coefficient while it slides.
  World world;
  const double mu = 0.3;
  add_fem(world,
          make_graded_box(box({{4e-3, 4e-3, 2e-3}}, {{0, 0, 1.001e-3}}, 1e-3)),
          {{10., 0., -2.}});
  add_fem(world, make_graded_box(
                     box({{20e-3, 8e-3, 4e-3}}, {{4e-3, 0, -2e-3}}, 1e-3)));
  ContactOptions options;
  options.friction = coulomb(mu);
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(),
      std::vector<ContactPair>{{0, 1, false}, {1, 0, false}}, options,
      MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
  while (world.stepper.time() < 4e-6)
    world.advance(0.9);
  const Body &block = *world.bodies[0];
  const double pressed = block.measure().velocity[2] + 2.,
               slowed = 10. - block.measure().velocity[0];
  EXPECT_GT(pressed, 0.5);
  // The leading edge digs in a little, which adds to the drag.
  EXPECT_NEAR(slowed / pressed, mu, 0.03 * mu);
}

TEST(Contact, a_node_that_starts_inside_gains_no_energy)
{
  World world;
  add_fem(world,
          make_graded_box(box({{3e-3, 3e-3, 3e-3}}, {{0, 0, 1.4e-3}}, 1e-3)));
  add_fem(world,
          make_graded_box(box({{5e-3, 5e-3, 3e-3}}, {{0, 0, -1.5e-3}}, 1e-3)));
  auto contact = std::make_unique<Contact>(
      "contact", world.pointers(),
      std::vector<ContactPair>{{0, 1, false}, {1, 0, false}}, ContactOptions(),
      MPI_COMM_WORLD);
  const Contact &c = *contact;
  world.couplings.push_back(std::move(contact));
  world.distribute();
  EXPECT_NEAR(c.initial_penetration(), 0.1, 0.01);
  world.stepper.initialize();
  while (world.stepper.time() < 2e-6)
    world.advance(0.9);
  EXPECT_LT(world.ledger().kinetic.value(), 1e-12);
}

TEST(Contact, random_oblique_shots_do_not_pass_through)
{
  // Loose particles against a block, from all sides and at all angles.
  World world;
  add_fem(world, make_graded_box(box({{8e-3, 8e-3, 8e-3}}, {{0, 0, 0}}, 2e-3)));
  ParticleCloud cloud;
  cloud.spacing = {{1e-4, 1e-4, 1e-4}};
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-3.8e-3, 3.8e-3);
  std::vector<Vec> aim;
  for (int i = 0; i < 2000; ++i)
  {
    Vec d = vec(normal(generator), normal(generator), normal(generator));
    d *= 1. / norm(d);
    cloud.position.push_back({{9e-3 * d[0], 9e-3 * d[1], 9e-3 * d[2]}});
    cloud.volume.push_back(1e-12);
    cloud.on_face.push_back(0);
    aim.push_back(
        vec(uniform(generator), uniform(generator), uniform(generator)));
  }
  world.bodies.push_back(
      std::make_unique<SpgBody>("shots", 1, cloud, elastic(), SpgOptions()));
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(), std::vector<ContactPair>{{0, 1, false}},
      ContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  NodalState &n = world.bodies[1]->nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec to = aim[n.global_id[i]] - n.position[i];
    n.velocity[i] = (500. / norm(to)) * to;
  }
  world.stepper.initialize();
  while (world.stepper.time() < 30e-6)
  {
    world.advance(0.9);
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      const Vec x = n.position[i];
      ASSERT_FALSE(std::abs(x[0]) < 3.4e-3 && std::abs(x[1]) < 3.4e-3 &&
                   std::abs(x[2]) < 3.4e-3)
          << "particle " << n.global_id[i] << " got in";
    }
  }
}

TEST(SelfContact, two_failed_particles_meet_and_part)
{
  // Two single particles (no bonds at all) are debris from the start only
  // when a bond of theirs failed; a pair is made here by pulling one apart.
  World world;
  SpgOptions options;
  options.set_critical_plastic_strain(0.01);
  const auto metal = hardening_aluminum(100e6, 0.);
  world.bodies.push_back(std::make_unique<SpgBody>(
      "bar", 0, make_box_cloud({{0, 0, 0}}, {{8e-3, 2e-3, 2e-3}}, 1e-3), metal,
      options));
  world.couplings.push_back(std::make_unique<SelfContact>(
      "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
      SelfContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  NodalState &n = world.bodies[0]->nodes();
  const auto throw_halves = [&](const double speed)
  {
    for (std::size_t i = 0; i < n.n_owned; ++i)
      n.velocity[i] =
          vec(n.reference_position[i][0] > 0.5e-3 ? speed : -speed, 0, 0);
  };
  throw_halves(200.);
  world.stepper.initialize();
  while (world.stepper.time() < 15e-6)
    world.advance(0.9);
  ASSERT_GT(world.bodies[0]->measure().bonds_broken_fraction, 0.02);
  throw_halves(-60.); // back against each other
  const auto before = world.momenta();
  const double energy = world.total_energy();
  while (world.stepper.time() < 80e-6)
    world.advance(0.9);
  const auto after = world.momenta();
  EXPECT_NEAR(after[0], before[0], 1e-12 * std::abs(before[0]) + 1e-15);
  EXPECT_NEAR(world.total_energy(), energy, 0.01 * energy);
  // They met: the halves did not pass through each other.
  double left = -1., right = 1.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (n.reference_position[i][0] > 3.5e-3)
      right = std::min(right, n.position[i][0]);
    else if (n.reference_position[i][0] < -3.5e-3)
      left = std::max(left, n.position[i][0]);
  EXPECT_GT(right, left + 2e-3);
}
} // namespace
