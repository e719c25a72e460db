// A bar of particles torn in two: momentum and energy.
#include "sabot/couplings/self_contact.h"
#include "verification/balance.h"
#include "verification/problem.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** Energy that unloading would give back, by the stresses [J]. */
double elastic_energy(const SpgBody &body)
{
  const double K = aluminum().bulk_modulus(), G = aluminum().shear_modulus();
  double sum = 0.;
  const NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const double s[6] = {body.stress(0, i), body.stress(1, i),
                         body.stress(2, i), body.stress(3, i),
                         body.stress(4, i), body.stress(5, i)};
    const double p = (s[0] + s[1] + s[2]) / 3.;
    double square = 0.;
    for (int c = 0; c < 3; ++c)
      square += (s[c] - p) * (s[c] - p) + 2. * s[3 + c] * s[3 + c];
    sum += n.lumped_mass[i] / aluminum().density *
           (p * p / (2. * K) + square / (4. * G));
  }
  return sum;
}

/** A bar whose ends fly apart at 2 x 250 m/s is torn in two. */
std::vector<Check> tension_bar()
{
  std::vector<Check> checks;
  for (const auto &[spacing, length] :
       std::vector<std::pair<double, double>>{{1e-3, 0.},
                                              {0.75e-3, 0.},
                                              {0.5e-3, 0.},
                                              {0.75e-3, 1e-3},
                                              {0.5e-3, 1e-3}})
  {
    const double L = 12e-3, w = 3e-3, v = 250.;
    World world;
    SpgOptions o;
    o.set_critical_plastic_strain(0.4);
    if (length > 0.)
      o.nonlocal_length = length;
    const auto metal = hardening_aluminum();
    world.bodies.push_back(std::make_unique<SpgBody>(
        "bar", 0, make_box_cloud({{0, 0, 0}}, {{L, w, w}}, spacing), metal, o));
    world.couplings.push_back(std::make_unique<SelfContact>(
        "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
        SelfContactOptions(), MPI_COMM_WORLD));
    world.distribute();
    auto &body = static_cast<SpgBody &>(*world.bodies[0]);
    NodalState &n = body.nodes();
    // The middle third is stretched, its ends pull, and the whole bar flies.
    for (std::size_t i = 0; i < n.n_owned; ++i)
      n.velocity[i] = vec(
          v * std::clamp(n.reference_position[i][0] / (L / 6.), -1., 1.) + 3.,
          -1., 2.);
    world.stepper.initialize();
    EnergyWatch watch(world);
    const auto before = world.momenta();
    const double energy = world.total_energy(), mass = body.measure().mass;
    double torn = std::nan("");
    while (world.stepper.time() < 150e-6)
    {
      world.advance(0.9);
      if (world.stepper.steps() % 10 != 0)
        continue;
      watch.look();
      if (std::isnan(torn))
      {
        const auto pieces = body.fragments()->connected_pieces();
        if (pieces.size() > 1 && pieces[1].mass > 0.1 * mass)
          torn = world.stepper.time();
      }
      if (!std::isnan(torn) && world.stepper.time() > torn + 10e-6)
        break;
    }
    watch.look();
    const auto after = world.momenta();
    double change = 0., piece_momentum[3] = {0., 0., 0.}, piece_mass = 0.;
    const auto pieces = body.fragments()->connected_pieces();
    for (const Fragment &f : pieces)
    {
      piece_mass += f.mass;
      for (int d = 0; d < 3; ++d)
        piece_momentum[d] += f.mass * f.velocity[d];
    }
    double pieces_off = 0.;
    for (int d = 0; d < 3; ++d)
    {
      change = std::max(change, std::abs(after[d] - before[d]) / (mass * v));
      pieces_off = std::max(pieces_off, std::abs(piece_momentum[d] - after[d]) /
                                            (mass * v));
    }
    const EnergyLedger e = world.ledger();
    // What is neither motion nor elastic energy is dissipated: plastic work,
    // what failed bonds and weak particles gave up, viscosity.
    const double stored = elastic_energy(body),
                 lost = energy - e.kinetic.value() - stored,
                 plastic = e.plastic_work.value();
    char text[60];
    std::snprintf(text, sizeof(text),
                  length > 0. ? "%g mm, length %g mm: " : "%g mm: ",
                  1e3 * spacing, 1e3 * length);
    const std::string at = text;
    checks.push_back({at + "pieces of a tenth of the mass", 2.,
                      double(std::count_if(pieces.begin(), pieces.end(),
                                           [&](const Fragment &f)
                                           { return f.mass > 0.1 * mass; })),
                      0., "1", "torn in two"});
    checks.push_back({at + "pieces' mass over the bar's", 1., piece_mass / mass,
                      1e-12, "1", "failure keeps the mass"});
    checks.push_back({at + "momentum, change over m v", 0., change, 1e-12, "1",
                      "conservation"});
    checks.push_back({at + "momentum of the pieces, error over m v", 0.,
                      pieces_off, 1e-12, "1", "accounting"});
    checks.push_back({at + "energy residual", 0.01, watch.residual(), 0., "1",
                      "energy balance", Check::Kind::at_most});
    checks.push_back({at + "time of the break", 0., torn, 0., "s", "",
                      Check::Kind::reported});
    checks.push_back({at + "dissipated energy", 0., lost, 0., "J", "",
                      Check::Kind::reported});
    checks.push_back({at + "of it counted as plastic work", 0., plastic / lost,
                      0., "1", "", Check::Kind::reported});
    checks.push_back({at + "of it lost with failed bonds", 0.,
                      (lost - plastic) / lost, 0., "1", "",
                      Check::Kind::reported});
  }
  return checks;
}

const RegisterProblem registered({"spg-tension-bar",
                                  "a bar torn in two: momentum and energy",
                                  "long", tension_bar});
} // namespace
} // namespace sabot
