// A ring of metal with a crumbled layer is pressed and sheared on.
#include "sabot/base/choice.h"
#include "sabot/couplings/friction/coulomb.h"
#include "verification/problem.h"
#include "verification/rubble.h"

#include <cstdlib>

namespace sabot
{
namespace
{
struct ShearBox
{
  double pressure = 200e6, friction = 0.3; // [Pa]
  double spacing = 1e-3;
  double layer = 2.; // thickness over spacing
  double angle = 0.; // of the lattice [degrees]
  std::string rule = "friction";
};

struct Sheared
{
  double traction; // shear over pressure
  double peak;
  double scatter;
  double momentum;
  double residual; // energy over the work of the drive
  double height;   // change over the layer
  double isolated, failed;
};

/** Ring shear: the upper part turns on the lower one. */
Sheared shear(const ShearBox &box)
{
  const double h = box.spacing, R_in = 5.2e-3, R_out = 8.2e-3,
               half_height = 4.2e-3, half_layer = 0.5 * box.layer * h + 1e-9,
               grip = half_height - 1.6 * h;
  SpgOptions options;
  options.set_critical_plastic_strain(0.4);
  options.residual_strength = choose<ResidualStrength>(box.rule);
  auto made = std::make_unique<DrivenSpgBody>(
      "ring",
      lattice_where(h, vec(1. / std::sqrt(2.), 1. / std::sqrt(2.), 0.),
                    box.angle * M_PI / 180., 14e-3,
                    [&](const Vec &x)
                    {
                      const double r = std::hypot(x[0], x[1]);
                      return r > R_in && r < R_out &&
                             std::abs(x[2]) < half_height;
                    }),
      metal("al6061-t6"), options);
  DrivenSpgBody &body = *made;
  World world;
  world.bodies.push_back(std::move(made));
  body.set_internal_friction(box.friction);
  SelfContactOptions contact;
  contact.friction = coulomb(box.friction);
  world.couplings.push_back(std::make_unique<SelfContact>(
      "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
      contact, MPI_COMM_WORLD));
  world.distribute();
  NodalState &n = body.nodes();
  std::vector<int> part(n.n_owned, 0); // -1, 1: held below, above
  double mass = 0., inertia = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i];
    if (std::abs(X[2]) <= half_layer)
      body.set_state("effective plastic strain", i, 1.);
    if (std::abs(X[2]) > grip)
      part[i] = X[2] > 0. ? 1 : -1;
    if (part[i] > 0)
      mass += n.lumped_mass[i];
    n.velocity[i] = Vec{};
  }
  const double area = M_PI * (R_out * R_out - R_in * R_in),
               radius = 2. / 3. * (R_out * R_out * R_out - R_in * R_in * R_in) /
                        (R_out * R_out - R_in * R_in);
  (void)inertia;
  // Piston of the grip's own mass times some; pressure and speed rise slowly.
  const double piston = 20. * mass, speed = 40., rise = 6e-6, start = 10e-6;
  double piston_speed = 0., dt = 0., work = 0.;
  double torque = 0., normal = 0.;
  const double damping =
      2. * std::sqrt(piston * 70e9 * area / (2. * half_height)) * 0.3;
  const auto angular_speed = [&](const double t) {
    return t < start ? 0. : speed / radius * std::min(1., (t - start) / rise);
  };
  body.drive = [&](NodalState &nodes, const double time)
  {
    const double omega = angular_speed(time);
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      const Vec x = nodes.position[i];
      const double r = std::hypot(x[0], x[1]);
      const Vec radial = vec(x[0] / r, x[1] / r, 0.),
                around = vec(-x[1] / r, x[0] / r, 0.);
      if (part[i] == 0)
        nodes.velocity[i] =
            nodes.velocity[i] - dot(nodes.velocity[i], radial) * radial;
      else
        nodes.velocity[i] = part[i] > 0
                                ? r * omega * around + vec(0., 0., piston_speed)
                                : Vec{};
    }
  };
  world.stepper.initialize();
  Sheared result{};
  std::vector<double> ratios;
  const double slip = 4. * h + 1.0e-3, end = start + 0.5 * rise + slip / speed;
  double top = 0., n_top = 0., top_start = 0.;
  const bool trace = std::getenv("TRACE");
  double next = 0., tsum = 0., nsum = 0.;
  int ns = 0;
  while (world.stepper.time() < end)
  {
    torque = normal = 0.;
    top = n_top = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (part[i] > 0)
      {
        const Vec x = n.position[i], f = n.force[i];
        torque += x[0] * f[1] - x[1] * f[0];
        normal += f[2];
        top += x[2];
        n_top += 1.;
      }
    const double t = world.stepper.time(),
                 load = box.pressure * area * std::min(1., t / rise);
    piston_speed = (piston_speed + dt * (normal - load) / piston) /
                   (1. + dt * damping / piston);
    dt = world.advance(0.7);
    if (t < start)
      top_start = top / n_top;
    tsum += -torque / radius;
    nsum += normal;
    ++ns;
    if (t > start + rise)
    {
      ratios.push_back(-torque / radius /
                       std::max(0.05 * area * box.pressure, normal));
      work += -torque * angular_speed(t) * dt;
    }
    if (t > next)
    {
      if (trace)
        std::printf("t %.2f slip/h %.2f T/N %.3f N/(pA) %.3f up %.4f iso %g "
                    "broken %g\n",
                    t * 1e6, t > start ? speed * (t - start) / h : 0.,
                    tsum / nsum, nsum / ns / (box.pressure * area),
                    (top / n_top - top_start) / h, 0.,
                    body.measure().bonds_broken_fraction);
      tsum = nsum = 0.;
      ns = 0;
      next += 2e-6;
    }
  }
  std::size_t failed = 0, isolated = 0;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    failed += body.has_failed(i);
    isolated += body.bond_list().n_bonds(i) == 0;
  }
  const std::size_t half = ratios.size() / 2;
  double sum = 0., square = 0.;
  for (std::size_t k = half; k < ratios.size(); ++k)
    sum += ratios[k], square += ratios[k] * ratios[k];
  const double count = ratios.size() - half;
  result.traction = sum / count;
  result.scatter =
      std::sqrt(std::max(0., square / count - sum * sum / count / count));
  result.height = (top / n_top - top_start) / (box.layer * h);
  result.failed = failed;
  result.isolated = isolated;
  return result;
}

std::vector<Check> shear_box()
{
  std::vector<Check> checks;
  ShearBox box;
  const auto get = [](const char *name, double fallback)
  { return std::getenv(name) ? std::atof(std::getenv(name)) : fallback; };
  box.pressure = get("P", 200) * 1e6;
  box.friction = get("MU", 0.3);
  box.spacing = get("H", 1) * 1e-3;
  box.layer = get("LAYER", 2);
  box.angle = get("ANGLE", 0);
  if (std::getenv("RULE"))
    box.rule = std::getenv("RULE");
  const Sheared s = shear(box);
  checks.push_back({"shear over pressure", box.friction, s.traction,
                    0.1 * box.friction, "1", ""});
  checks.push_back(
      {"scatter", 0., s.scatter, 0., "1", "", Check::Kind::reported});
  checks.push_back(
      {"height", 0., s.height, 0., "1", "", Check::Kind::reported});
  checks.push_back(
      {"failed", 0., s.failed, 0., "1", "", Check::Kind::reported});
  checks.push_back(
      {"isolated", 0., s.isolated, 0., "1", "", Check::Kind::reported});
  return checks;
}

const RegisterProblem a({"rubble-shear-box",
                         "a crumbled layer between sound metal is sheared on",
                         "long", shear_box});
} // namespace
} // namespace sabot
