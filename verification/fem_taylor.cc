// The copper Taylor bar of hexahedra on three meshes.
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/contact.h"
#include "verification/balance.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
struct Bar
{
  double length, radius, early_radius, plastic_strain; // [m], at 12 us
  double residual;
  double kinetic; // [J], at the start
};

/** The copper bar of the code comparison on a rigid frictionless wall, as a
    quarter with @p h cells, to 80 us. The wall is a plane of symmetry, or with
    @p by_contact a rigid body that its nodes meet. */
Bar taylor(const double h, const bool by_contact, const double step_factor)
{
  World world;
  FemOptions options;
  options.initial_velocity = {{0., 0., -227.}};
  options.symmetry_boundary_ids = {3, 4};
  if (!by_contact)
    options.symmetry_boundary_ids.push_back(0);
  world.bodies.push_back(std::make_unique<FemBody>(
      "bar", 0, make_cylinder(3.2e-3, 32.4e-3, 2, {{0, 0, 16.2e-3}}, h, 2),
      taylor_copper(), options));
  if (by_contact)
  {
    BoxSpecification box;
    box.size = {{12e-3, 12e-3, 1e-3}};
    box.center = {{4e-3, 4e-3, -0.5e-3}};
    box.cell_size = 1e-3;
    RigidOptions wall;
    wall.is_prescribed = true;
    world.bodies.push_back(std::make_unique<RigidBody>(
        "wall", 1, make_graded_box(box), taylor_copper(), wall));
    world.couplings.push_back(std::make_unique<Contact>(
        "impact", world.pointers(), std::vector<ContactPair>{{1, 0, false}},
        ContactOptions(), MPI_COMM_WORLD));
  }
  world.distribute();
  // The energy at the start, before the plane holds the struck face.
  Bar bar{};
  bar.kinetic = 4. * world.ledger().kinetic.value();
  world.stepper.initialize();
  EnergyWatch watch(world);
  const Body &body = *world.bodies[0];
  const auto extent = [&](const int d)
  {
    const BodyMeasures m = body.measure();
    return m.high[d] - m.low[d];
  };
  // At the foot: the largest radius of the struck face.
  const auto face_radius = [&]
  {
    const NodalState &n = body.nodes();
    double r = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (n.reference_position[i][2] < 1e-9)
        r = std::max(r, std::hypot(n.position[i][0], n.position[i][1]));
    return r;
  };
  while (world.stepper.time() < 80e-6)
  {
    world.advance(step_factor);
    if (bar.early_radius == 0. && world.stepper.time() >= 12e-6)
      bar.early_radius = face_radius();
    if (world.stepper.steps() % 20 == 0)
      watch.look();
  }
  watch.look();
  bar.residual = watch.residual();
  bar.length = extent(2);
  bar.radius = 0.5 * (extent(0) + extent(1));
  bar.plastic_strain = measure(body, "plastic strain max");
  return bar;
}

/** The order p and the limit that three values at sizes in the ratio @p r
    follow: y(h) = limit + a h^p. */
double order_of(const double coarse, const double middle, const double fine,
                const double r)
{
  return std::log((coarse - middle) / (middle - fine)) / std::log(r);
}

std::vector<Check> run()
{
  // Radius over 3.2, 5 and 8 cells.
  const double ratio = 1.6, sizes[3] = {1.024e-3, 0.64e-3, 0.4e-3};
  std::vector<Check> checks;
  Bar bars[3];
  for (int k = 0; k < 3; ++k)
  {
    bars[k] = taylor(sizes[k], false, 0.9);
    char text[32];
    std::snprintf(text, sizeof(text), "%g mm: ", 1e3 * sizes[k]);
    const std::string at = text;
    const auto kind = k == 2 ? Check::Kind::near : Check::Kind::reported;
    checks.push_back({at + "length", 21.42e-3, bars[k].length, 0.15e-3, "m",
                      "composite tetrahedra, data of the benchmark", kind});
    checks.push_back({at + "radius", 7.22e-3, bars[k].radius, 0.15e-3, "m",
                      "composite tetrahedra, data of the benchmark", kind});
    checks.push_back({at + "radius of the struck face at 12 us", 5.45e-3,
                      bars[k].early_radius, 0., "m", "5.444 to 5.457 mm",
                      Check::Kind::reported});
    checks.push_back({at + "largest plastic strain", 0., bars[k].plastic_strain,
                      0., "1", "2.5 to 3.3 published", Check::Kind::reported});
    checks.push_back({at + "energy residual", 0.01, bars[k].residual, 0., "1",
                      "energy balance", Check::Kind::at_most});
    checks.push_back({at + "kinetic energy at the start", 239.8,
                      bars[k].kinetic, 0.1, "J", "pi R^2 L rho v^2/2"});
  }
  const double p =
      order_of(bars[0].length, bars[1].length, bars[2].length, ratio);
  checks.push_back({"order of the length", 0., p, 0., "1", "three meshes",
                    Check::Kind::reported});
  const double limit = bars[2].length + (bars[2].length - bars[1].length) /
                                            (std::pow(ratio, p) - 1.);
  checks.push_back({"extrapolated length", 21.42e-3, limit, 0.15e-3, "m",
                    "limit of the three meshes"});
  const double q =
      order_of(bars[0].radius, bars[1].radius, bars[2].radius, ratio);
  checks.push_back({"order of the radius", 0., q, 0., "1", "three meshes",
                    Check::Kind::reported});
  checks.push_back({"extrapolated radius", 7.22e-3,
                    bars[2].radius + (bars[2].radius - bars[1].radius) /
                                         (std::pow(ratio, q) - 1.),
                    0.15e-3, "m", "limit of the three meshes"});
  // By contact the wall gives way by the depth of the penalty, which is bounded
  // by mass over step^2; the rim feels it.
  for (const double factor : {0.9, 0.4})
  {
    const Bar b = taylor(sizes[1], true, factor);
    char text[64];
    std::snprintf(text, sizeof(text),
                  "0.64 mm, by contact, step factor %g: ", factor);
    const std::string at = text;
    checks.push_back({at + "length over that on the plane", 1.,
                      b.length / bars[1].length, 2e-3, "1", "the same wall"});
    checks.push_back({at + "radius over that on the plane", 1.,
                      b.radius / bars[1].radius, 0., "1", "the same wall",
                      Check::Kind::reported});
    checks.push_back({at + "energy residual", 0.01, b.residual, 0., "1",
                      "energy balance", Check::Kind::at_most});
  }
  return checks;
}

const RegisterProblem registered({"fem-taylor",
                                  "copper bar on a rigid wall, three meshes",
                                  "long", run});
} // namespace
} // namespace sabot
