// Particles at their limits: one, two, coincident ones, a flight of 1e6 steps.
#include "sabot/couplings/self_contact.h"
#include "verification/balance.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
constexpr double h = 1e-3;

/** Particles at @p points, a spacing of 1 mm, in all settings' defaults. */
SpgBody &add(World &world, const std::vector<std::array<double, 3>> &points,
             const SpgOptions &options = SpgOptions())
{
  ParticleCloud cloud;
  cloud.position = points;
  cloud.volume.assign(points.size(), h * h * h);
  cloud.spacing = {{h, h, h}};
  cloud.on_face.assign(points.size(), 0);
  world.bodies.push_back(std::make_unique<SpgBody>(
      "cloud", 0, cloud, hardening_aluminum(), options));
  world.distribute();
  return static_cast<SpgBody &>(*world.bodies[0]);
}

/** One and two particles have no gradient: free masses. */
void few_particles(std::vector<Check> &checks, const int n)
{
  World world;
  std::vector<std::array<double, 3>> points;
  for (int i = 0; i < n; ++i)
    points.push_back({{i * h, 0., 0.}});
  SpgBody &body = add(world, points);
  NodalState &nodes = body.nodes();
  for (int i = 0; i < n; ++i)
    nodes.velocity[i] = vec(10. * (i + 1), -5., 2.);
  world.stepper.initialize();
  EnergyWatch watch(world);
  for (int step = 0; step < 1000; ++step)
    world.advance(0.9);
  watch.look();
  double error = 0.;
  for (int i = 0; i < n; ++i)
  {
    const Vec expected = nodes.reference_position[i] +
                         world.stepper.time() * vec(10. * (i + 1), -5., 2.);
    // Not-a-number must not pass through max().
    const double off = norm(nodes.position[i] - expected) / norm(expected);
    error = off <= error ? error : off;
  }
  const std::string who = n == 1 ? "one particle: " : "two particles: ";
  checks.push_back(
      {who + "position, relative error", 0., error, 1e-12, "1", "free flight"});
  checks.push_back(
      {who + "energy residual", 0., watch.residual(), 1e-12, "1", "free"});
  checks.push_back({who + "pieces", 0.,
                    double(body.fragments()->connected_pieces().size()), 0.,
                    "1", "", Check::Kind::reported});
}

/** A block flies apart and loses all bonds but those between @p n_whole of its
    particles; then it is driven together, so that its debris meets. */
void broken_block(std::vector<Check> &checks, const int n_whole)
{
  World world;
  SpgOptions options;
  options.set_critical_plastic_strain(0.45);
  options.failure_check_interval = 1;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, make_box_cloud({{0, 0, 0}}, {{3e-3, 3e-3, 3e-3}}, h),
      hardening_aluminum(), options));
  world.couplings.push_back(std::make_unique<SelfContact>(
      "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
      SelfContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &n = body.nodes();
  // Mean strains: 0.5 of a whole and a failed end, 0 between whole ones.
  int whole = n_whole;
  double mass = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i];
    const bool is_middle = std::abs(X[1] - 0.5e-3) < 1e-9 &&
                           std::abs(X[2] - 0.5e-3) < 1e-9 &&
                           std::abs(X[0]) < 0.6e-3;
    if (!(is_middle && whole-- > 0))
      body.rooms().points.state("effective plastic strain")[i] = 1.;
    n.velocity[i] = 2e5 * X; // faster than its waves
    mass += n.lumped_mass[i];
  }
  world.stepper.initialize();
  EnergyWatch watch(world);
  const auto before = world.momenta();
  const auto run = [&](const double time)
  {
    const double end = world.stepper.time() + time;
    while (world.stepper.time() < end)
    {
      world.advance(0.2);
      watch.look();
    }
  };
  run(1e-6);
  const double bonds_left = measure(body, "bonds broken") *
                            (1. / body.measure().bonds_broken_fraction - 1.);
  const std::size_t n_pieces = body.fragments()->connected_pieces().size();
  // Back together: the ledger goes on with the kinetic energy put in.
  for (std::size_t i = 0; i < n.n_owned; ++i)
    n.velocity[i] = -2e4 * n.reference_position[i];
  EnergyWatch meeting(world);
  const double first = world.total_energy();
  const double end = world.stepper.time() + 40e-6;
  double highest = first;
  // While debris touches, central difference misjudges the energy of the
  // penalty by O((omega dt)^2); what counts is the energy once it has parted.
  while (world.stepper.time() < end)
  {
    world.advance(0.2);
    meeting.look();
    highest = std::max(highest, world.total_energy());
  }
  const double last = world.total_energy();
  const auto after = world.momenta();
  double change = 0., twist = 0.;
  for (int d = 0; d < 3; ++d)
  {
    change = std::max(change, std::abs(after[d] - before[d]));
    twist = std::max(twist, std::abs(after[3 + d] - before[3 + d]));
  }
  const double speed = 2e4 * 2.6e-3;
  const std::string who =
      n_whole > 0 ? "one surviving bond: " : "all bonds broken: ";
  checks.push_back({who + "bonds left", n_whole > 0 ? 1. : 0., bonds_left, 1e-9,
                    "1", "criterion"});
  checks.push_back({who + "pieces", n_whole > 0 ? 63. : 64., double(n_pieces),
                    0., "1", "connected components"});
  // All bonds fail at once while they carry 0.5 GPa.
  checks.push_back({who + "energy residual while it breaks", 0.005,
                    watch.residual(), 0., "1", "energy balance",
                    Check::Kind::at_most});
  checks.push_back({who + "momentum, change over m v", 0.,
                    change / (mass * speed), 1e-12, "1", "conservation"});
  checks.push_back({who + "angular momentum, change over m v h", 0.,
                    twist / (mass * speed * h), 1e-9, "1", "conservation"});
  checks.push_back({who + "energy residual of the debris that meets", 0.01,
                    meeting.residual(), 0., "1", "energy balance",
                    Check::Kind::at_most});
  checks.push_back({who + "energy gained by the debris", 0., last / first - 1.,
                    1e-3, "1", "self-contact makes no energy",
                    Check::Kind::at_most});
  checks.push_back({who + "largest gain in between", 0., highest / first - 1.,
                    0., "1", "", Check::Kind::reported});
  checks.push_back({who + "numbers", 1., double(is_finite(world)), 0., "1",
                    "no not-a-number"});
}

std::vector<Check> few()
{
  std::vector<Check> checks;
  few_particles(checks, 1);
  few_particles(checks, 2);
  broken_block(checks, 2);
  broken_block(checks, 0);
  std::string message;
  try
  {
    World world;
    add(world, {{{0., 0., 0.}}, {{h, 0., 0.}}, {{h, 0., 0.}}, {{0., h, 0.}}});
  }
  catch (const InputError &e)
  {
    message = e.parameter + ": " + e.what();
  }
  checks.push_back(
      {"coincident particles: refused by name and number", 1.,
       double(message.find("Bodies/cloud") != std::string::npos &&
              message.find("particles 1 and 2 coincide") != std::string::npos),
       0., "1", "message"});
  return checks;
}

/** 10^6 steps of a free body that flies, turns and rings. */
void add_flight(std::vector<Check> &checks, const std::string &who,
                std::unique_ptr<Body> body)
{
  World world;
  world.bodies.push_back(std::move(body));
  world.distribute();
  NodalState &n = world.bodies[0]->nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i];
    n.velocity[i] = vec(100., 20., -50.) + cross(vec(2e3, 1e3, -3e3), X) +
                    vec(2e3 * X[0], 1e3 * X[2], -1e3 * X[1] + 3e3 * X[2]);
  }
  world.stepper.initialize();
  const double dt = 0.4 * world.stepper.propose(false).dt;
  // Without the translation: what the body itself keeps.
  const auto own_energy = [&]
  {
    const auto p = world.momenta();
    double mass = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      mass += n.inertia[i];
    return world.total_energy() -
           0.5 * (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / mass;
  };
  const double own = own_energy();
  const auto before = world.momenta();
  // Angular momentum about the moving center of mass.
  const auto spin = [&]
  {
    Vec c{}, l{};
    double mass = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      c += n.inertia[i] * n.position[i];
      mass += n.inertia[i];
    }
    c = (1. / mass) * c;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      l += n.inertia[i] * cross(n.position[i] - c, n.velocity[i]);
    return l;
  };
  const Vec l = spin();
  const unsigned int n_steps = 1000000, window = 10000;
  double first = 0., last = 0.;
  for (unsigned int step = 0; step < n_steps; ++step)
  {
    world.stepper.advance(dt);
    world.stepper.update();
    if (step < window)
      first += own_energy() / window;
    if (step >= n_steps - window)
      last += own_energy() / window;
  }
  const auto after = world.momenta();
  double change = 0.;
  for (int d = 0; d < 3; ++d)
    change =
        std::max(change, std::abs(after[d] - before[d]) / std::abs(before[0]));
  checks.push_back({who + "momentum, relative change", 0., change, 1e-10, "1",
                    "conservation, 1e6 steps"});
  checks.push_back({who + "spin about the center, relative change", 0.,
                    norm(spin() - l) / norm(l), 1e-7, "1",
                    "conservation, 1e6 steps"});
  checks.push_back({who + "own energy, last over first 1e4 steps", 1.,
                    last / first, 2e-3, "1", "no drift"});
  checks.push_back({who + "own energy at the start", 0., own, 0., "J", "",
                    Check::Kind::reported});
}

std::vector<Check> long_flight()
{
  std::vector<Check> checks;
  BoxSpecification box;
  box.size = {{h, h, h}};
  box.cell_size = h;
  FemOptions fem;
  fem.hourglass = "stiffness";
  fem.bulk_viscosity_linear = fem.bulk_viscosity_quadratic = 0.;
  add_flight(checks, "a cell: ",
             std::make_unique<FemBody>("cell", 0, make_graded_box(box),
                                       elastic(), fem));
  SpgOptions spg;
  spg.bulk_viscosity_linear = spg.bulk_viscosity_quadratic = 0.;
  add_flight(checks, "eight particles: ",
             std::make_unique<SpgBody>(
                 "particles", 0, make_box_cloud({{0, 0, 0}}, {{h, h, h}}, h),
                 elastic(), spg));
  return checks;
}

const RegisterProblem a({"extreme-particles",
                         "one particle, two, one bond, none, coincident ones",
                         "extremes quick", few}),
    b({"extreme-flight", "a free body through 1e6 steps", "extremes long",
       long_flight});
} // namespace
} // namespace sabot
