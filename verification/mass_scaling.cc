// Mass scaling: frequencies of heavier bars, balances, contact and ties of what
// was made heavier.
#include "sabot/couplings/contact.h"
#include "sabot/couplings/tie.h"
#include "verification/driven.h"
#include "verification/linear_algebra.h"
#include "verification/meshes.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
constexpr double speed = 1e-6; // [m/s], small: strains stay linear

/** Energy that is kept [J]: that of the ledger without what whole steps have
    over half ones (Body::add_kick_energy). */
double kept_energy(const World &world)
{
  ExactSum kick;
  for (auto &body : world.bodies)
    body->add_kick_energy(world.stepper.last_step(), kick);
  return world.total_energy() - kick.value();
}

/** A free bar along x, nu = 0, with nodes at these places; motion along it
    only. */
struct Bar
{
  World world;
  FemBody *body = nullptr;
  std::vector<double> x; // [m]

  Bar(const std::vector<double> &places, const double width,
      const double smallest_step)
      : x(places)
  {
    const unsigned int n = places.size() - 1;
    const HexMesh mesh = mapped_block(
        {{{n, 1, 1}}, {{0., 0., 0.}}, {{double(n), width, width}}},
        [&](const MeshPoint &p) {
          return MeshPoint{{places[std::lround(p[0])], p[1], p[2]}};
        });
    FemOptions options;
    options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
    options.mass_scaling.smallest_step = smallest_step;
    options.mass_scaling.largest_share = 1.;
    world.bodies.push_back(std::make_unique<DrivenFemBody>(
        "bar", 0, mesh, elastic(0.), options, hold_lateral));
    world.distribute();
    body = static_cast<FemBody *>(world.bodies[0].get());
    world.stepper.initialize();
  }

  /** Place along the bar of a node. */
  std::size_t at(const std::size_t node) const
  {
    const double X = body->nodes().reference_position[node][0];
    return std::lower_bound(x.begin(), x.end(), X - 1e-9) - x.begin();
  }
  /** Sum over nodes of mass times @p shape times velocity. */
  double amplitude(const Eigen::VectorXd &shape) const
  {
    const NodalState &n = body->nodes();
    double sum = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      sum += n.inertia[i] * shape[at(i)] * n.velocity[i][0];
    return sum;
  }
  /** Frequency [rad/s] at which it swings by @p shape, one of its modes, from
      central differences with equal steps: v = cos(n omega_d dt), where
      sin(omega_d dt/2) = omega dt/2. */
  double frequency(const Eigen::VectorXd &shape)
  {
    NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
      n.velocity[i] = vec(speed * shape[at(i)], 0., 0.);
    const double start = amplitude(shape),
                 dt = 0.9 * world.stepper.propose(false).dt;
    double now = start;
    unsigned int steps = 0;
    while (now > 0.3 * start)
    {
      world.stepper.advance(dt);
      world.stepper.update();
      now = amplitude(shape);
      ++steps;
    }
    return 2. / dt * std::sin(0.5 * std::acos(now / start) / steps);
  }
};

/** Lowest mode that is no rigid motion of a chain of springs k_i between masses
    m_i: frequency [rad/s] and shape. */
std::pair<double, Eigen::VectorXd> chain_mode(const std::vector<double> &x,
                                              const double width,
                                              const std::vector<double> &mass)
{
  const int n = x.size();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i + 1 < n; ++i)
  {
    const double k =
        aluminum().young_modulus * width * width / (x[i + 1] - x[i]);
    K(i, i) += k;
    K(i + 1, i + 1) += k;
    K(i, i + 1) -= k;
    K(i + 1, i) -= k;
  }
  Eigen::VectorXd root(n);
  for (int i = 0; i < n; ++i)
    root[i] = 1. / std::sqrt(mass[i]);
  const auto modes = symmetric_modes(root.asDiagonal() * K * root.asDiagonal());
  return {std::sqrt(modes.first[1]), root.asDiagonal() * modes.second.col(1)};
}

/** Masses of the chain's nodes if cell i had (1 + share_i) of its own. */
std::vector<double> chain_masses(const std::vector<double> &x,
                                 const double width,
                                 const std::vector<double> &share)
{
  std::vector<double> mass(x.size(), 0.);
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
  {
    const double half = 0.5 * aluminum().density * width * width *
                        (x[i + 1] - x[i]) * (1. + share[i]);
    mass[i] += half;
    mass[i + 1] += half;
  }
  return mass;
}

std::vector<Check> scaled_bar()
{
  constexpr double h = 1e-3;
  constexpr int n = 24;
  std::vector<double> even, thin;
  for (int i = 0; i <= n; ++i)
    even.push_back(i * h);
  // The seventh cell has a tenth of the others' length.
  for (int i = 0; i <= n; ++i)
    thin.push_back((i <= 6 ? i : i - 0.9) * h);
  const double own = Bar(even, h, 0.).world.stepper.propose(false).dt,
               own_thin = Bar(thin, h, 0.).world.stepper.propose(false).dt;

  // All cells alike: 1.3 times the step is 1.69 times the mass.
  Bar all(even, h, 1.3 * own);
  const std::vector<double> none(n, 0.), alike(n, 0.69);
  const auto whole = chain_mode(even, h, chain_masses(even, h, alike)),
             light = chain_mode(even, h, chain_masses(even, h, none));
  const double all_step = all.world.stepper.propose(false).dt,
               frequency = all.frequency(whole.second);

  Bar one(thin, h, own);
  std::vector<double> share = none;
  share[6] = std::pow(own / own_thin, 2) - 1.;
  const auto heavy = chain_mode(thin, h, chain_masses(thin, h, share)),
             true_bar = chain_mode(thin, h, chain_masses(thin, h, none));
  const double added = measure(*one.body, "added mass"),
               expected = share[6] * 0.1 * h * h * h * aluminum().density,
               one_step = one.world.stepper.propose(false).dt,
               of_one = one.frequency(heavy.second);
  return {{"step of a bar whose cells are all held at 1.3 of their own", 1.3,
           all_step / own, 1e-12, "1", "definition"},
          {"its lowest frequency", whole.first, frequency, 1e-7 * whole.first,
           "rad/s", "modes of a chain of 1.69 times the mass"},
          {"the same over that of the bar", 1. / 1.3, frequency / light.first,
           1e-7, "1", "1/sqrt(1.69)"},
          {"step of a bar with one cell of a tenth", own, one_step, 1e-12 * own,
           "s", "that of the others"},
          {"its added mass", expected, added, 1e-12 * expected, "kg",
           "m [(dt_min/dt)^2 - 1] of one cell"},
          {"its lowest frequency with the cell held", heavy.first, of_one,
           1e-7 * heavy.first, "rad/s", "modes of the chain"},
          {"error of that frequency by the added mass", 0.,
           of_one / true_bar.first - 1., 0., "1", "modes of the bar as it is",
           Check::Kind::reported}};
}

/** Cells and particles, tied, that shake, fly and are held at steps above their
    own from the start. */
struct Shaken
{
  World world;
  std::array<double, 3> initial{};
  double energy = 0.;

  explicit Shaken(const double flight, const double scale)
  {
    constexpr double h = 1e-3;
    FemOptions cells;
    SpgOptions particles;
    if (scale > 0.)
    {
      cells.mass_scaling = {scale * 1.05e-7, 1.};
      particles.mass_scaling = {scale * 1.5e-7, 1.};
    }
    BoxSpecification box;
    box.size = {{4e-3, 3e-3, 3e-3}};
    box.cell_size = h;
    world.bodies.push_back(std::make_unique<FemBody>(
        "cells", 0, make_graded_box(box), elastic(), cells));
    world.bodies.push_back(std::make_unique<SpgBody>(
        "particles", 1,
        make_box_cloud({{4e-3, 0., 0.}}, {{4e-3, 3e-3, 3e-3}}, h), elastic(),
        particles));
    world.couplings.push_back(std::make_unique<Tie>("tie", world.pointers(), 1,
                                                    0, 0.05, MPI_COMM_WORLD));
    world.distribute();
    for (auto &body : world.bodies)
    {
      shake(*body, 20.);
      for (Vec &v : body->nodes().velocity)
        v += vec(flight, -0.5 * flight, 0.);
    }
    world.stepper.initialize();
    initial = momentum();
    energy = world.total_energy();
  }
  /** Kept: mass times velocity, and what the added mass won. */
  std::array<double, 3> momentum() const
  {
    std::array<double, 3> sum{};
    for (auto &body : world.bodies)
    {
      const BodyMeasures m = body->measure();
      for (int d = 0; d < 3; ++d)
        sum[d] += m.mass * m.velocity[d] + m.added_momentum[d];
    }
    return sum;
  }
};

std::vector<Check> scaled_block()
{
  Shaken still(0., 1.), flying(100., 1.), light(0., 0.);
  const double own = light.world.stepper.propose(false).dt;
  double energy = 0., momentum = 0., shortest = 1., drift = 0., added = 0.;
  const auto first_share = [](const Shaken &s, const int body)
  { return measure(*s.world.bodies[body], "added mass share"); };
  const double at_start = first_share(still, 0) + first_share(still, 1);
  const double scale = 20. * still.world.bodies[0]->measure().mass;
  for (int step = 0; step < 200; ++step)
  {
    // The same steps for both, so that they can be compared.
    const double least = still.world.stepper.propose(false).dt,
                 dt = 0.9 * least;
    shortest = std::min(shortest, least / 1.05e-7);
    for (Shaken *const s : {&still, &flying})
    {
      s->world.stepper.advance(dt);
      s->world.stepper.update();
    }
    energy = std::max(energy,
                      std::abs(kept_energy(still.world) / still.energy - 1.));
    const auto p = flying.momentum();
    for (int d = 0; d < 3; ++d)
      momentum = std::max(momentum, std::abs(p[d] - flying.initial[d]) / scale);
  }
  for (int b = 0; b < 2; ++b)
  {
    added += first_share(still, b);
    const NodalState &a = still.world.bodies[b]->nodes(),
                     &c = flying.world.bodies[b]->nodes();
    const double t = still.world.stepper.time();
    for (std::size_t i = 0; i < a.n_owned; ++i)
      drift = std::max(
          drift, norm(c.position[i] - a.position[i] - t * vec(100., -50., 0.)));
  }
  return {{"step of the blocks by themselves over that they are held at", 1.,
           own / 1.05e-7, 0., "1", "what is held is shorter by itself",
           Check::Kind::at_most},
          {"least step over the smallest asked for", 1., shortest, 1e-9, "1",
           "definition", Check::Kind::at_least},
          {"shares of the masses added in the run", 1e-4, added - at_start, 0.,
           "1", "steps shrink, mass follows", Check::Kind::at_least},
          {"change of momentum over that of the motion", 0., momentum, 1e-12,
           "1", "momentum with that of the added mass"},
          {"change of energy", 0., energy, 1e-3, "1", "energy balance"},
          {"difference to the same block in flight over the spacing", 0.,
           drift / 1e-3, 1e-6, "1", "no frame is preferred"}};
}

/** A bar with a thin cell at its struck end, held at the step of the others,
    meets one like it. */
std::vector<Check> scaled_contact()
{
  constexpr double h = 1e-3, v = 20.;
  std::vector<Check> checks;
  double gone[2] = {0., 0.}, own = 0.;
  for (const bool is_held : {false, true})
  {
    World world;
    for (const int side : {-1, 1})
    {
      FemOptions options;
      if (is_held)
        options.mass_scaling = {2. * own, 1.};
      if (side < 0)
        options.initial_velocity = {{v, 0., 0.}};
      constexpr unsigned int n = 40;
      const HexMesh mesh =
          mapped_block({{{n, 1, 1}}, {{0., 0., 0.}}, {{double(n), h, h}}},
                       [&](const MeshPoint &p)
                       {
                         // The last cell towards the other bar has a tenth.
                         const double k = side < 0 ? n - p[0] : p[0];
                         const double depth = (k < 0.5 ? 0. : k - 0.9) * h;
                         return MeshPoint{{side * depth, p[1], p[2]}};
                       });
      world.bodies.push_back(std::make_unique<DrivenFemBody>(
          side < 0 ? "striker" : "bar", world.bodies.size(), mesh, elastic(0.),
          options, hold_lateral));
    }
    world.couplings.push_back(std::make_unique<Contact>(
        "contact", world.pointers(),
        std::vector<ContactPair>{{0, 1, false}, {1, 0, false}},
        ContactOptions(), MPI_COMM_WORLD));
    world.distribute();
    world.stepper.initialize();
    const double energy = world.total_energy(),
                 step = world.stepper.propose(false).dt;
    if (!is_held)
      own = step;
    double worst = 0., momentum = 0.;
    const double m = world.bodies[0]->measure().mass;
    while (world.stepper.time() < 30e-6)
    {
      world.advance(0.9);
      worst = std::max(worst, std::abs(kept_energy(world) / energy - 1.));
      double p = -m * v;
      for (auto &body : world.bodies)
        p += body->measure().mass * body->measure().velocity[0] +
             body->measure().added_momentum[0];
      momentum = std::max(momentum, std::abs(p) / (m * v));
    }
    gone[is_held] = world.bodies[1]->measure().velocity[0];
    if (!is_held)
      continue;
    checks.push_back({"step of the held bars over their own", 2., step / own,
                      1e-12, "1", "definition"});
    checks.push_back({"change of energy", 0., worst, 1e-3, "1",
                      "a penalty bounded by m/dt^2 of what moves"});
    checks.push_back({"change of momentum", 0., momentum, 1e-12, "1",
                      "momentum with that of the added mass"});
    checks.push_back({"velocity of the struck bar", v, gone[1], 0.02 * v, "m/s",
                      "equal bars exchange velocities"});
    checks.push_back({"the same without mass scaling", gone[0], gone[1],
                      0.02 * v, "m/s", "what the mass costs"});
  }
  return checks;
}

const RegisterProblem
    bar({"mass-scaling-bar",
         "Bars whose cells are held at a longer step swing as "
         "much heavier ones do.",
         "quick", scaled_bar});
const RegisterProblem block({"mass-scaling-block",
                             "Cells and particles, tied, that shake while mass "
                             "is added: momentum, energy, frames.",
                             "quick", scaled_block});
const RegisterProblem contact({"mass-scaling-contact",
                               "Thin cells held at a longer step meet.",
                               "quick", scaled_contact});
} // namespace
} // namespace sabot
