// A ring of metal with a crumbled layer is pressed and sheared on.
#include "sabot/base/choice.h"
#include "sabot/couplings/friction/coulomb.h"
#include "verification/problem.h"
#include "verification/rubble.h"

#include <algorithm>

namespace sabot
{
namespace
{
struct ShearBox
{
  double pressure = 200e6; // [Pa]
  double friction = 0.3;
  double spacing = 1e-3; // [m]
  double layer = 4.;     // thickness over spacing
  double angle = 0.;     // of the lattice about (1, 1, 0) [degrees]
  /** Of sliding [m/s]: density times its square far below the pressure, or the
      pieces are a gas that lifts the piston. */
  double speed = 40.;
  std::string rule = "friction";
};

/** Means over the second half of the sliding. */
struct Sheared
{
  double shear;    // stress over the mean normal stress
  double pressure; // mean normal stress over the load
  double height;   // lost by the layer, over its thickness
};

constexpr double yield_stress = 324e6; // of a metal that does not harden [Pa]

/** A ring whose upper end turns and presses; particles keep their radius, so
    that nothing can escape sideways and sliding has no end. */
class RingShear
{
public:
  explicit RingShear(const ShearBox &box);
  Sheared run();

private:
  bool is_upper(const std::size_t i) const { return part[i] > 0; }
  /** After every kick: the lower end stands, the upper end is a piston. */
  void drive(NodalState &nodes, const double time) const;
  double angular_speed(const double time) const;
  /** Torque, normal force and height of the upper end. */
  void measure();

  // Slow against waves; pressure first, then sliding by slip [m].
  static constexpr double rise = 6e-6, start = 10e-6;
  const ShearBox box;
  const double scale, inner, outer, half_height, area, radius, slip;
  World world;
  DrivenSpgBody *body = nullptr;
  std::vector<int> part; // -1, 1: held below, above
  double piston = 0.;    // mass [kg]
  double piston_speed = 0.;
  double torque = 0., normal = 0., top = 0.;
};

RingShear::RingShear(const ShearBox &box)
    : box(box), scale(std::min(1., box.spacing / 0.5e-3)),
      inner(5.2e-3 * scale), outer(8.2e-3 * scale), half_height(4.2e-3 * scale),
      area(M_PI * (outer * outer - inner * inner)),
      radius(2. / 3. * (std::pow(outer, 3) - std::pow(inner, 3)) /
             (outer * outer - inner * inner)),
      slip(5. * box.spacing)
{
  SpgOptions options;
  options.set_critical_plastic_strain(0.4);
  options.residual_strength = choose<ResidualStrength>(box.rule);
  const auto in_ring = [&](const Vec &x)
  {
    const double r = std::hypot(x[0], x[1]);
    return r > inner && r < outer && std::abs(x[2]) < half_height;
  };
  const double root = std::sqrt(0.5);
  auto made = std::make_unique<DrivenSpgBody>(
      "ring",
      lattice_where(box.spacing, vec(root, root, 0.), box.angle * M_PI / 180.,
                    1.2 * (outer + half_height), in_ring),
      hardening_aluminum(yield_stress, 0.), options);
  body = made.get();
  world.bodies.push_back(std::move(made));
  body->set_internal_friction(box.friction);
  SelfContactOptions contact;
  contact.friction = coulomb(box.friction);
  world.couplings.push_back(std::make_unique<SelfContact>(
      "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
      contact, MPI_COMM_WORLD));
  world.distribute();
  NodalState &n = body->nodes();
  part.assign(n.n_owned, 0);
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const double z = n.reference_position[i][2];
    if (std::abs(z) <= 0.5 * box.layer * box.spacing * (1. + 1e-9))
      body->rooms().points.state("effective plastic strain")[i] = 1.;
    if (std::abs(z) > half_height - 1.6 * box.spacing)
      part[i] = z > 0. ? 1 : -1;
    if (is_upper(i))
      piston += 20. * n.lumped_mass[i];
    n.velocity[i] = Vec{};
  }
  body->drive = [this](NodalState &nodes, const double time)
  { drive(nodes, time); };
}

double RingShear::angular_speed(const double time) const
{
  return time < start
             ? 0.
             : box.speed / radius * std::min(1., (time - start) / rise);
}

void RingShear::drive(NodalState &nodes, const double time) const
{
  const double omega = angular_speed(time);
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    const Vec x = nodes.position[i];
    const double r = std::hypot(x[0], x[1]);
    const Vec radial = vec(x[0] / r, x[1] / r, 0.);
    Vec &v = nodes.velocity[i];
    if (part[i] == 0)
      v = v - dot(v, radial) * radial;
    else
      v = is_upper(i) ? vec(-omega * x[1], omega * x[0], piston_speed) : Vec{};
  }
}

void RingShear::measure()
{
  const NodalState &n = body->nodes();
  torque = normal = top = 0.;
  std::size_t n_top = 0;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (is_upper(i))
    {
      const Vec x = n.position[i], f = n.force[i];
      torque -= x[0] * f[1] - x[1] * f[0];
      normal += f[2];
      top += x[2];
      ++n_top;
    }
  top /= n_top;
}

Sheared RingShear::run()
{
  world.stepper.initialize();
  const double end = start + 0.5 * rise + slip / box.speed,
               half_way = start + 0.5 * rise + 0.5 * slip / box.speed,
               // of the piston on the ring as a spring, 0.3 of the critical
      damping = 0.6 * std::sqrt(piston * 70e9 * area / (2. * half_height));
  double dt = 0., highest = 0., sums[3] = {0., 0., 0.};
  while (world.stepper.time() < end)
  {
    measure();
    const double time = world.stepper.time(),
                 load = box.pressure * area * std::min(1., time / rise);
    if (time < start)
      highest = top;
    if (time > half_way)
    {
      sums[0] += torque / radius * dt;
      sums[1] += normal * dt;
      sums[2] += dt;
    }
    piston_speed = (piston_speed + dt * (normal - load) / piston) /
                   (1. + dt * damping / piston);
    dt = world.advance(0.7);
  }
  return {sums[0] / std::max(sums[1], 1e-3 * box.pressure * area * sums[2]),
          sums[1] / sums[2] / (box.pressure * area),
          (highest - top) / (box.layer * box.spacing)};
}

std::string describe(const ShearBox &box)
{
  char text[140];
  std::snprintf(text, sizeof(text),
                "%s, %g MPa, %g m/s, mu %g, %g mm, %g spacings thick, "
                "%g degrees",
                box.rule.c_str(), 1e-6 * box.pressure, box.speed, box.friction,
                1e3 * box.spacing, box.layer, box.angle);
  return text;
}

/** What pieces bear: their friction, or no more than the metal did. */
double expected_shear(const ShearBox &box)
{
  return std::min(box.friction, yield_stress / std::sqrt(3.) / box.pressure);
}

/** Judged where the layer is resolved; @p allowed beside 10 %: what keeps the
    particles of pieces without friction in order. */
void add_judged(std::vector<Check> &checks, const ShearBox &box)
{
  const Sheared s = RingShear(box).run();
  const double expected = expected_shear(box);
  const bool is_capped = expected < box.friction;
  checks.push_back({describe(box) + ": shear over pressure", expected, s.shear,
                    std::max(0.1 * expected, 0.03), "1",
                    is_capped ? "Y/sqrt(3) over the pressure" : "mu",
                    is_capped ? Check::Kind::at_most : Check::Kind::near});
  checks.push_back({describe(box) + ": pressure over the load", 0.8, s.pressure,
                    0., "1", "the layer bears it", Check::Kind::at_least});
  checks.push_back({describe(box) + ": height lost", 0., s.height, 0.1, "1",
                    "metal keeps its volume", Check::Kind::at_most});
}

void add_reported(std::vector<Check> &checks, const ShearBox &box)
{
  const Sheared s = RingShear(box).run();
  checks.push_back({describe(box) + ": shear over pressure", 0., s.shear, 0.,
                    "1", "", Check::Kind::reported});
  checks.push_back({describe(box) + ": pressure over the load", 0., s.pressure,
                    0., "1", "", Check::Kind::reported});
  checks.push_back({describe(box) + ": height lost", 0., s.height, 0., "1", "",
                    Check::Kind::reported});
}

std::vector<Check> shear_box()
{
  std::vector<Check> checks;
  const auto box = [](const std::function<void(ShearBox &)> &change)
  {
    ShearBox made;
    change(made);
    return made;
  };
  for (const double p : {20e6, 200e6, 1e9, 2e9})
    add_judged(checks, box([&](ShearBox &b) { b.pressure = p; }));
  for (const double p : {10e6, 20e6})
    for (const double mu : {0.3, 0.6})
      add_judged(checks, box(
                             [&](ShearBox &b)
                             {
                               b.pressure = p;
                               b.friction = mu;
                               b.speed = 10.;
                             }));
  for (const double p : {20e6, 100e6})
    add_judged(checks, box(
                           [&](ShearBox &b)
                           {
                             b.pressure = p;
                             b.layer = 2.;
                             b.speed = 10.;
                           }));
  for (const double mu : {0., 0.1, 0.2})
    add_judged(checks, box([&](ShearBox &b) { b.friction = mu; }));
  for (const double h : {0.5e-3, 0.25e-3})
    add_judged(checks, box([&](ShearBox &b) { b.spacing = h; }));
  for (const double angle : {0., 20., 45.})
    add_judged(checks, box(
                           [&](ShearBox &b)
                           {
                             b.spacing = 0.5e-3;
                             b.layer = 8.;
                             b.angle = angle;
                           }));
  // Layers as thin as a kernel, whose rough walls interlock. At the higher
  // pressures rows of particles bear it by turns, up to twice its mean, and
  // half of them reach the yield stress of sound metal before the mean does.
  // Last the rules under which pieces are loose particles.
  for (const double layer : {1., 2.})
    add_reported(checks, box([&](ShearBox &b) { b.layer = layer; }));
  for (const double angle : {20., 45.})
    add_reported(checks, box([&](ShearBox &b) { b.angle = angle; }));
  for (const double p : {100e6, 200e6})
    add_reported(checks, box(
                             [&](ShearBox &b)
                             {
                               b.pressure = p;
                               b.friction = 0.6;
                             }));
  for (const std::string rule : {"compression", "everything"})
    for (const double mu : {0., 0.3})
      add_reported(checks, box(
                               [&](ShearBox &b)
                               {
                                 b.rule = rule;
                                 b.friction = mu;
                               }));
  return checks;
}

const RegisterProblem a({"rubble-shear-box",
                         "a crumbled layer between sound metal is sheared on",
                         "long", shear_box});
} // namespace
} // namespace sabot
