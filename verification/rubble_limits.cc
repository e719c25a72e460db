// What metal that has crumbled must not bear, and what it must: columns, free
// flight, and a bar with a crumbled core.
#include "sabot/couplings/friction/coulomb.h"
#include "verification/problem.h"
#include "verification/rubble.h"

#include <algorithm>

namespace sabot
{
namespace
{
constexpr double friction = 0.3, h = 0.5e-3;
const double slope = std::sqrt(3.) * friction;

/** A block of size 6 x 6 x 10 spacings, or what @p crumbles of it, with ends
    that a drive moves. */
struct Rubble
{
  World world;
  DrivenSpgBody *body;

  Rubble(const std::array<double, 3> &size,
         const std::function<bool(const Vec &)> &crumbles,
         const double yield_stress)
  {
    SpgOptions options;
    options.set_critical_plastic_strain(0.4);
    auto made = std::make_unique<DrivenSpgBody>(
        "block", make_box_cloud({{0., 0., 0.}}, size, h),
        hardening_aluminum(yield_stress, 0.), options);
    body = made.get();
    world.bodies.push_back(std::move(made));
    body->set_internal_friction(friction);
    SelfContactOptions contact;
    contact.friction = coulomb(friction);
    world.couplings.push_back(std::make_unique<SelfContact>(
        "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
        contact, MPI_COMM_WORLD));
    world.distribute();
    NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (crumbles(n.reference_position[i]))
        body->rooms().points.state("effective plastic strain")[i] = 1.;
  }
};

/** Stretch a little along z, so that every bond that can has failed, and back:
    what is left is crumbled metal of its old volume. */
void crumble(Rubble &rubble)
{
  NodalState &n = rubble.body->nodes();
  rubble.world.stepper.initialize();
  for (const double sign : {1., -1.})
    for (const double stop = rubble.world.stepper.time() + 1e-6;
         rubble.world.stepper.time() < stop;)
    {
      rubble.body->drive = [&, sign](NodalState &nodes, const double)
      {
        for (std::size_t i = 0; i < nodes.n_owned; ++i)
          nodes.velocity[i] = sign * 3e3 * nodes.reference_position[i];
      };
      rubble.world.advance(0.5);
    }
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.velocity[i] = Vec{};
}

struct Column
{
  double stress;   // axial over the yield stress, compressive
  double expected; // of confined metal
  double ratio;    // q/p inside
  double residual; // of energy over the work of the ends
  double tension;  // largest when it is drawn out again, over the yield stress
};

/** Two ends of a crumbled column approach; @p confined: not sideways. */
Column press(const bool confined)
{
  const double Y = 300e6, Lz = 12. * h, L = 8. * h, speed = 10.,
               shortening = confined ? 0.004 : 0.1;
  Rubble rubble(
      {{L, L, Lz}}, [](const Vec &) { return true; }, Y);
  crumble(rubble);
  NodalState &n = rubble.body->nodes();
  std::vector<int> end(n.n_owned, 0);
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const double z = n.reference_position[i][2];
    end[i] = std::abs(z) > 0.5 * Lz - 1.5 * h ? (z > 0. ? 1 : -1) : 0;
  }
  rubble.body->drive = [&](NodalState &nodes, const double)
  {
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      const double z = nodes.reference_position[i][2];
      Vec &v = nodes.velocity[i];
      if (confined)
        v = vec(0., 0., -2. * speed * z / Lz); // homogeneous
      else if (end[i] != 0)
        v = vec(v[0], v[1], -end[i] * speed);
    }
  };
  const double start = rubble.world.stepper.time(),
               duration = shortening * Lz / (2. * speed);
  const double before = rubble.world.internal_energy();
  const auto power = [&]
  {
    double sum = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (confined || end[i] != 0)
        sum -= dot(n.force[i], n.velocity[i]);
    return sum;
  };
  double work = 0., old_power = power();
  while (rubble.world.stepper.time() < start + duration)
  {
    const double dt = rubble.world.advance(0.5), new_power = power();
    work += 0.5 * (old_power + new_power) * dt;
    old_power = new_power;
  }
  Column column{};
  double volume = 0., J = 1., q = 0., p = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (norm(n.reference_position[i]) < 2.1 * h)
    {
      double s[6];
      for (int c = 0; c < 6; ++c)
        s[c] = rubble.body->stress(c, i);
      const double mean = (s[0] + s[1] + s[2]) / 3.;
      double square = 0.;
      for (int c = 0; c < 3; ++c)
        square += (s[c] - mean) * (s[c] - mean) + 2. * s[c + 3] * s[c + 3];
      column.stress -= s[2] / Y;
      q += std::sqrt(1.5 * square);
      p -= mean;
      J = determinant(rubble.body->rooms().fields.deformation_gradient(i));
      volume += 1.;
    }
  column.stress /= volume;
  column.ratio = p > 0. ? q / p : 0.;
  column.expected =
      -aluminum().bulk_modulus() * std::log(J) * (1. + 2. / 3. * slope) / Y;
  column.residual =
      work > 0.
          ? std::abs(rubble.world.internal_energy() - before - work) / work
          : 0.;
  // Drawn out again, beyond where it started.
  rubble.body->drive = [&](NodalState &nodes, const double)
  {
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
      nodes.velocity[i] =
          vec(0., 0., 2. * speed * nodes.reference_position[i][2] / Lz);
  };
  const double turn = rubble.world.stepper.time();
  while (rubble.world.stepper.time() < turn + 2. * duration)
    rubble.world.advance(0.5);
  for (std::size_t i = 0; i < n.n_owned; ++i)
    for (int c = 0; c < 3; ++c)
      column.tension = std::max(column.tension, rubble.body->stress(c, i) / Y);
  return column;
}

/** Kinetic energy kept by a block that flies apart. */
double expand()
{
  const double Y = 300e6, L = 8. * h;
  Rubble rubble(
      {{L, L, L}}, [](const Vec &) { return true; }, Y);
  crumble(rubble);
  NodalState &n = rubble.body->nodes();
  rubble.body->drive = nullptr;
  const auto kinetic = [&] { return rubble.world.ledger().kinetic.value(); };
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.velocity[i] = 2e5 * n.position[i]; // up to 700 m/s
  const double before = kinetic(), start = rubble.world.stepper.time();
  while (rubble.world.stepper.time() < start + 5e-6)
    rubble.world.advance(0.5);
  return kinetic() / before;
}

/** Load of a bar whose core of three rows has crumbled, over that of the sound
    rest, yield stress times area. */
double pull()
{
  const double Y = 300e6, Lx = 8. * h, Ly = 16. * h, Lz = 24. * h, speed = 5.;
  Rubble rubble(
      {{Lx, Ly, Lz}},
      [](const Vec &X)
      { return std::abs(X[1]) < 1.1 * h && std::abs(X[2]) < 8.1 * h; },
      Y);
  NodalState &n = rubble.body->nodes();
  rubble.body->drive = [&](NodalState &nodes, const double)
  {
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      const double z = nodes.reference_position[i][2];
      if (std::abs(z) > 0.5 * Lz - 1.5 * h)
        nodes.velocity[i] = vec(nodes.velocity[i][0], nodes.velocity[i][1],
                                z > 0. ? speed : -speed);
    }
  };
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.velocity[i] = vec(0., 0., 2. * speed * n.position[i][2] / Lz);
  rubble.world.stepper.initialize();
  double sum = 0., count = 0.;
  const double end = 0.03 * Lz / (2. * speed);
  while (rubble.world.stepper.time() < end)
  {
    rubble.world.advance(0.7);
    if (rubble.world.stepper.time() < 0.5 * end)
      continue;
    // Mean axial force in the middle third, from stresses and volumes.
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (std::abs(n.reference_position[i][2]) < 4.1 * h)
      {
        const Vec X = n.reference_position[i];
        const double wx = std::abs(X[0]) > 0.5 * Lx - 0.1 * h ? 0.5 : 1.,
                     wy = std::abs(X[1]) > 0.5 * Ly - 0.1 * h ? 0.5 : 1.;
        sum += wx * wy * h * h * rubble.body->stress(2, i);
      }
    count += 9.; // layers
  }
  // A row of particles stands for one spacing.
  return sum / count / (Y * (Lx * (Ly - 3. * h)));
}

std::vector<Check> limits()
{
  const Column free = press(false), held = press(true);
  return {{"unconfined column: axial stress over yield", 0., free.stress, 0.02,
           "1", "a heap without walls bears nothing"},
          {"confined column: axial stress", held.expected, held.stress,
           0.02 * held.expected, "Y", "-K ln J (1 + 2/3 sqrt(3) mu)"},
          {"confined column: q over p", slope, held.ratio, 0.02 * slope, "1",
           "sqrt(3) mu"},
          {"confined column: energy residual", 0., held.residual, 1e-2, "1",
           "work of the ends"},
          {"confined column, drawn out again: largest tension over yield", 0.,
           held.tension, 1e-9, "1", "what has crumbled does not heal"},
          {"flying apart: kinetic energy kept", 1., expand(), 1e-3, "1",
           "no cohesion"},
          {"bar with a crumbled core: load over that of the sound rest", 1.,
           pull(), 0.05, "1", "metal beside a crack is sound along it"}};
}

const RegisterProblem a({"rubble-limits",
                         "columns, free flight and a bar of crumbled metal",
                         "quick", limits});
} // namespace
} // namespace sabot
