// Rigid bodies: a free top, an impact on a block, a prescribed pusher.
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/contact.h"
#include "sabot/geometry/round_bodies.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
HexMesh brick(const std::array<double, 3> &size, const double h,
              const double height = 0.)
{
  BoxSpecification b;
  b.size = size;
  b.center = {{0., 0., height}};
  b.cell_size = h;
  return make_graded_box(b);
}

/** A brick that spins about its intermediate axis turns over and over. */
std::vector<Check> spinning_brick()
{
  World world;
  RigidOptions options;
  options.initial_velocity = {{3., -2., 5.}};
  options.angular_velocity = {{10., 1000., 1.}};
  world.bodies.push_back(std::make_unique<RigidBody>(
      "top", 0, brick({{30e-3, 20e-3, 10e-3}}, 5e-3), elastic(), options));
  world.distribute();
  const auto &body = static_cast<RigidBody &>(*world.bodies[0]);
  world.stepper.initialize();
  const double energy = world.total_energy();
  const auto before = world.momenta();
  const NodalState &n = world.bodies[0]->nodes();
  const auto spin_momentum = [&] // about the center that the nodes have now
  {
    Vec c{}, l{};
    for (std::size_t i = 0; i < n.n_owned; ++i)
      c += (n.inertia[i] / body.total_mass()) * n.position[i];
    for (std::size_t i = 0; i < n.n_owned; ++i)
      l += n.inertia[i] * cross(n.position[i] - c, n.velocity[i]);
    return l;
  };
  // Two nodes apart along the axis of rotation only.
  std::size_t top = 0, bottom = 0;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i];
    if (X[0] > 15e-3 - 1e-9 && X[2] > 5e-3 - 1e-9)
      (X[1] > 0. ? top : bottom) = std::abs(X[1]) > 10e-3 - 1e-9 ? i
                                   : X[1] > 0.                   ? top
                                                                 : bottom;
  }
  const Vec l = spin_momentum();
  double worst = 0., turned = 0., worst_l = 0., distance = 0.;
  const double first = norm(n.position[top] - n.position[bottom]);
  for (int step = 0; step < 100000; ++step)
  {
    world.stepper.advance(5e-7); // half a thousandth of a radian
    if (step % 50 != 0)
      continue;
    worst = std::max(worst, std::abs(world.total_energy() / energy - 1.));
    worst_l = std::max(worst_l, norm(spin_momentum() - l) / norm(l));
    turned =
        std::min(turned, (n.position[top] - n.position[bottom])[1] / first);
    distance = std::max(
        distance,
        std::abs(norm(n.position[top] - n.position[bottom]) / first - 1.));
  }
  const auto after = world.momenta();
  const double product = body.inertia_tensor()(0, 0);
  const double exact = aluminum().density * 30e-3 * 20e-3 * 10e-3 *
                       (20e-3 * 20e-3 + 10e-3 * 10e-3) / 12.;
  return {{"energy, largest relative change in 50 rad", 0., worst, 1e-6, "1",
           "free rotation"},
          {"angular momentum, largest relative change", 0., worst_l, 1e-12, "1",
           "free rotation"},
          {"momentum after over before", 1., after[0] / before[0], 1e-13, "1",
           "free flight"},
          {"lowest direction cosine of the intermediate axis", -0.9, turned, 0.,
           "1", "it is unstable and turns over", Check::Kind::at_most},
          {"distance of two nodes, relative change", 0., distance, 1e-12, "1",
           "rigid"},
          // Lumped masses: (n^2 + 2)/n^2 for n cells along an edge.
          {"moment of inertia of the lumped masses over the solid's",
           (16. + 2.) / 16. * 0.8 + (4. + 2.) / 4. * 0.2, product / exact,
           1e-12, "1", "trapezoidal rule, 4 and 2 cells"}};
}

/** A rigid ball meets an elastic block off its center: momenta and energy. */
std::vector<Check> impact()
{
  World world;
  RigidOptions options;
  options.initial_velocity = {{0., 0., -20.}};
  world.bodies.push_back(std::make_unique<RigidBody>(
      "ball", 0, make_sphere(3e-3, {{1.5e-3, 0.5e-3, 3.05e-3}}, 1e-3),
      elastic(), options));
  FemOptions fem;
  fem.bulk_viscosity_linear = fem.bulk_viscosity_quadratic = 0.;
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 1, brick({{10e-3, 10e-3, 4e-3}}, 1e-3, -2e-3), elastic(), fem));
  ContactOptions contact;
  contact.damping_fraction = 0.;
  // Friction acts at the node and at its projection, a little apart.
  contact.friction = nullptr;
  world.couplings.push_back(std::make_unique<Contact>(
      "impact", world.pointers(), std::vector<ContactPair>{{0, 1}, {1, 0}},
      contact, MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
  const auto before = world.momenta();
  const double energy = world.total_energy();
  while (world.stepper.time() < 60e-6)
    world.advance(0.5);
  const auto after = world.momenta();
  const double scale = std::abs(before[2]), arm = 3e-3;
  double linear = 0., angular = 0.;
  for (int d = 0; d < 3; ++d)
  {
    linear = std::max(linear, std::abs(after[d] - before[d]) / scale);
    angular = std::max(angular,
                       std::abs(after[3 + d] - before[3 + d]) / (scale * arm));
  }
  return {{"momentum, change over the first", 0., linear, 1e-11, "1",
           "conservation"},
          {"angular momentum, change over m v r", 0., angular, 1e-9, "1",
           "conservation"},
          {"energy after over before", 1., world.total_energy() / energy, 5e-3,
           "1", "conservation"},
          {"speed of the block", 0.5, -world.bodies[1]->measure().velocity[2],
           0., "m/s", "so that they have met", Check::Kind::at_least}};
}

/** A driven rigid plate pushes a block: its work is the energy gained. */
std::vector<Check> pusher()
{
  World world;
  RigidOptions options;
  options.is_prescribed = true;
  options.initial_velocity = {{0., 0., -5.}};
  world.bodies.push_back(std::make_unique<RigidBody>(
      "pusher", 0, brick({{6.4e-3, 6.4e-3, 2e-3}}, 0.8e-3, 1.01e-3), elastic(),
      options));
  FemOptions fem;
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 1, brick({{4e-3, 4e-3, 4e-3}}, 1e-3, -2e-3), elastic(), fem));
  world.couplings.push_back(std::make_unique<Contact>(
      "push", world.pointers(), std::vector<ContactPair>{{0, 1}, {1, 0}},
      ContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
  const double energy = world.total_energy();
  while (world.stepper.time() < 20e-6)
    world.advance(0.5);
  const double work = world.ledger().external.value();
  return {{"energy gained over the work done", 1.,
           1. + (world.total_energy() - energy) / work, 0.01, "1",
           "energy balance"},
          {"velocity of the pusher", -5.,
           world.bodies[0]->measure().velocity[2], 1e-12, "m/s", "prescribed"},
          {"work", 1e-4, work, 0., "J", "so that they have met",
           Check::Kind::at_least}};
}

const RegisterProblem a({"rigid-top", "free rotation of an asymmetric body",
                         "quick", spinning_brick}),
    b({"rigid-impact", "a rigid ball on an elastic block", "quick", impact}),
    c({"rigid-pusher", "work of a prescribed rigid body", "quick", pusher});
} // namespace
} // namespace sabot
