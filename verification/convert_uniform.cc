// Cells that turn into particles in the middle of a uniform motion.
#include "verification/convert.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
constexpr double spacing = 1e-3, end = 1e-5; // [m], [s]

using Motion = std::function<Mat(const double time)>;

/** All nodes go where a uniform motion takes them. */
template <typename Base>
class Moved : public Base
{
public:
  template <typename... Arguments>
  Moved(const Motion &motion, const double dt, Arguments &&...arguments)
      : Base(std::forward<Arguments>(arguments)...), motion(motion), dt(dt)
  {
  }
  void impose_velocities(const double time) override
  {
    const Mat now = motion(time), next = motion(time + dt);
    NodalState &n = this->nodes();
    for (std::size_t i = 0; i < n.size(); ++i)
    {
      const Vec X = n.reference_position[i];
      n.velocity[i] = (1. / dt) * (next * X - now * X);
    }
  }

private:
  const Motion motion;
  const double dt;
};

Mat stretch(const double t)
{
  const double a = 0.1 * t / end;
  return {{vec(1. + a, 0., 0.), vec(0., 1. - 0.3 * a, 0.),
           vec(0., 0., 1. - 0.4 * a)}};
}
Mat shear(const double t)
{
  return {{vec(1., 0.3 * t / end, 0.), vec(0., 1., 0.), vec(0., 0., 1.)}};
}
Mat spin(const double t)
{
  // Stretched at first, then turned as it is.
  const double part = 0.2, turn = 1.5 * std::max(0., t / end - part);
  const Mat Q = {{vec(std::cos(turn), -std::sin(turn), 0.),
                  vec(std::sin(turn), std::cos(turn), 0.), vec(0., 0., 1.)}};
  return Q * stretch(std::min(t, part * end));
}

/** Means over a body's items, weighted alike as the field is uniform. */
std::array<double, 6> mean_stress(const FemBody &body)
{
  std::array<double, 6> sum{};
  for (std::size_t e = 0; e < body.n_local_cells(); ++e)
    for (int c = 0; c < 6; ++c)
      sum[c] += body.stress(c, e) / body.n_local_cells();
  return sum;
}

double measure_mass(const World &world)
{
  double mass = 0.;
  for (const auto &body : world.bodies)
    for (std::size_t i = 0; i < body->nodes().n_owned; ++i)
      mass += body->nodes().lumped_mass[i];
  return mass;
}

struct Outcome
{
  double stress, strain, temperature; // errors over the largest, or absolute
  double linear, angular;             // momentum, jump over |p|, |L|
  double energy, jump;                // over the internal energy
  double kinetic;                     // lost to lattices, over the same
};

/** @p ratio: particles per cell along each edge. */
Outcome run(const Motion &motion, const bool all, const std::string &rule,
            const unsigned int ratio)
{
  const auto law = metal("al6061-t6", {"Johnson-Cook/Damage=false"});
  const double dt = 2e-8;
  ConvertingOptions options;
  options.fem.integration = rule;
  options.fem.bulk_viscosity_linear = options.fem.bulk_viscosity_quadratic = 0.;
  options.spg.bulk_viscosity_linear = options.spg.bulk_viscosity_quadratic = 0.;
  // Lattices as fine as the cells that are not split.
  const double edge = ratio > 1 ? 2e-3 : spacing;
  if (ratio > 1)
    options.spacing = edge / ratio;
  const HexMesh mesh = block_mesh({{6e-3, ratio > 1 ? 4e-3 : 5e-3, 4e-3}},
                                  {{1e-3, 0., 0.}}, edge);
  World world, pure;
  const auto where = add_converting<Moved<FemBody>, Moved<SpgBody>>(
      world, mesh, law, options, motion, dt);
  join_converting(world);
  pure.bodies.push_back(std::make_unique<Moved<FemBody>>(
      motion, dt, "pure", 0, mesh, law, options.fem));
  Outcome worst{};
  for (World *w : {&world, &pure})
  {
    w->distribute();
    w->stepper.initialize();
    for (double t = 0.; t < end - 0.5 * dt; t += dt)
    {
      if (std::abs(t - 0.5 * end) < 0.5 * dt)
        *where = [all](const Place &x) { return all || x[0] > 1e-3; };
      w->stepper.advance(dt);
      const auto before = w->momenta();
      const double held = w->total_energy();
      w->stepper.update();
      const auto after = w->momenta();
      // Over sqrt(2 m E): the momentum of a field with zero mean is zero.
      const EnergyLedger energy = w->ledger();
      const double size = std::sqrt(2. * measure_mass(*w) *
                                    energy.kinetic.value()),
                   arm = 3e-3;
      double dp = 0., dL = 0.;
      for (int d = 0; d < 3; ++d)
      {
        dp += std::abs(after[d] - before[d]);
        dL += std::abs(after[3 + d] - before[3 + d]);
      }
      worst.linear = std::max(worst.linear, dp / size);
      worst.angular = std::max(worst.angular, dL / (size * arm));
      worst.energy =
          std::max(worst.energy, std::abs(w->total_energy() - held) /
                                     std::max(1e-30, w->internal_energy()));
    }
  }
  const auto &cells = static_cast<const FemBody &>(*pure.bodies[0]);
  const auto &zone = static_cast<const SpgBody &>(*world.bodies[1]);
  const std::array<double, 6> exact = mean_stress(cells);
  double size = 0.;
  for (const double s : exact)
    size = std::max(size, std::abs(s));
  const double strain = cells.cell_state("effective plastic strain")[0],
               temperature = cells.cell_state("temperature")[0];
  for (std::size_t i = 0; i < zone.nodes().n_owned; ++i)
  {
    for (int c = 0; c < 6; ++c)
      worst.stress =
          std::max(worst.stress, std::abs(zone.stress(c, i) - exact[c]) / size);
    worst.strain = std::max(
        worst.strain,
        std::abs(zone.rooms().points.state("effective plastic strain")[i] -
                 strain));
    worst.temperature = std::max(
        worst.temperature,
        std::abs(zone.rooms().points.state("temperature")[i] - temperature));
  }
  const Measures measures = world.couplings[0]->measure();
  worst.jump =
      find_measure(measures, "energy lost by means") / world.internal_energy();
  if (ratio > 1)
    worst.kinetic = find_measure(measures, "kinetic energy lost to lattices") /
                    world.internal_energy();
  return worst;
}

std::vector<Check> uniform()
{
  std::vector<Check> checks;
  const struct
  {
    const char *name;
    Mat (*motion)(double);
  } motions[] = {{"stretch", stretch}, {"shear", shear}, {"spin", spin}};
  for (const auto &m : motions)
    for (const bool all : {true, false})
      for (const auto &[rule, ratio] :
           {std::pair<std::string, unsigned int>{"one point", 1},
            {"B-bar", 1},
            {"one point", 2},
            {"one point", 3}})
      {
        const Outcome o = run(m.motion, all, rule, ratio);
        const std::string what =
            std::string(m.name) + ", " + (all ? "all of it" : "half of it") +
            ", " + rule +
            (ratio > 1 ? ", split by " + std::to_string(ratio) : "") + ": ";
        const auto add = [&](const std::string &name, const double got,
                             const double bound, const std::string &unit)
        {
          checks.push_back({what + name, 0., got, bound, unit, "pure cells",
                            Check::Kind::at_most});
        };
        add("stress", o.stress, 1e-3, "of the largest component");
        add("plastic strain", o.strain, 1e-4, "1");
        add("temperature", o.temperature, 0.05, "K");
        add("jump of momentum", o.linear, 1e-10, "of it");
        add("jump of angular momentum", o.angular, 1e-10, "of it");
        add("jump of the balance", o.energy, 1e-10, "of the internal energy");
        add("energy lost by means", o.jump, 1e-3, "of the internal energy");
        if (ratio > 1)
          checks.push_back({what + "kinetic energy lost to lattices", 0.,
                            o.kinetic, 0., "of the internal energy", "",
                            Check::Kind::reported});
      }
  return checks;
}

const RegisterProblem registered({"convert-uniform",
                                  "Stretch, shear and spin of metal whose "
                                  "cells turn into particles half-way.",
                                  "quick", uniform});
} // namespace
} // namespace sabot
