// Laws of contact: rebound, friction and its cap, Hertz, the cost of a search.
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/contact.h"
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/geometry/round_bodies.h"
#include "sabot/materials/johnson_cook.h"
#include "sabot/materials/laws.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <ctime>
#include <functional>

namespace sabot
{
namespace
{

HexMesh brick(const std::array<double, 3> &size,
              const std::array<double, 3> &center, const double h)
{
  BoxSpecification b;
  b.size = size;
  b.center = center;
  b.cell_size = h;
  return make_graded_box(b);
}

void add_contact(World &world, const std::vector<ContactPair> &pairs,
                 const ContactOptions &options)
{
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(), pairs, options, MPI_COMM_WORLD));
}

/** Two equal rigid bars at +-227 m/s: the penalty is a spring, so they part
    with the same speed. */
std::vector<Check> rigid_rebound()
{
  const double v = 227.;
  World world;
  for (const int side : {-1, 1})
  {
    RigidOptions options;
    options.initial_velocity = {{-side * v, 0., 0.}};
    world.bodies.push_back(std::make_unique<RigidBody>(
        side < 0 ? "left" : "right", world.bodies.size(),
        brick({{10e-3, 4e-3, 4e-3}}, {{side * 5.001e-3, 0., 0.}}, 1e-3),
        elastic(), options));
  }
  ContactOptions options;
  options.damping_fraction = 0.;
  add_contact(world, {{0, 1, false}, {1, 0, false}}, options);
  world.distribute();
  world.stepper.initialize();
  const double energy = world.total_energy();
  double deepest = 0.;
  while (world.stepper.time() < 15e-6)
  {
    world.stepper.advance(4e-10);
    deepest = std::max(deepest, energy - world.ledger().kinetic.value());
  }
  return {{"speed of rebound", v, world.bodies[1]->measure().velocity[0],
           1e-6 * v, "m/s", "elastic rebound of equal bodies"},
          {"energy after over before, less one", 0.,
           world.total_energy() / energy - 1., 1e-6, "1", "conservation"},
          {"kinetic energy that was stored over the first", 1.,
           deepest / energy, 1e-3, "1", "both stand still once"},
          {"momentum over one bar's", 0.,
           world.momenta()[0] / (world.bodies[0]->measure().mass * v), 1e-11,
           "1", "conservation"}};
}

/** A block with a weight of its own. */
class HeavyBody : public FemBody
{
public:
  HeavyBody(HexMesh mesh, const FemOptions &options, const double weight)
      : FemBody("block", 0, std::move(mesh), elastic(), options), weight(weight)
  {
  }
  void compute_forces(const double time, const double dt) override
  {
    FemBody::compute_forces(time, dt);
    NodalState &n = nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
      n.force[i] += vec(0., 0., -weight * n.lumped_mass[i]);
  }

private:
  const double weight; // [m/s^2]
};

/** Says that it yields at sqrt(3) MPa, but stays elastic. */
class Soft : public Elastic
{
public:
  Soft() : Elastic(aluminum()) {}
  std::optional<double> initial_yield_stress() const override
  {
    return std::sqrt(3.) * 1e6;
  }
};

struct Slide
{
  double velocity, normal_impulse; // [m/s], at @p end; per mass
  /** Time in which the weight alone would have pressed as much as it and the
      block's bounces did until a fiftieth of the speed was left [s]. */
  double stopped_at = std::nan(""), distance = 0.;
};

/** A block of 4 x 4 x 2 mm slides over a held plate at v for @p end; the plate
    may be given a past. */
Slide slide(const double weight, const double v, const ContactOptions &options,
            const double end,
            const std::shared_ptr<const Material> &material = elastic(),
            const std::function<void(FemBody &)> &prepare = {})
{
  World world;
  FemOptions block, plate;
  block.initial_velocity = {{v, 0., 0.}};
  plate.clamped_boundary_ids = {4};
  world.bodies.push_back(std::make_unique<HeavyBody>(
      brick({{4e-3, 4e-3, 2e-3}}, {{0.5e-3, 0.5e-3, 1e-3}}, 1e-3), block,
      weight));
  world.bodies.push_back(std::make_unique<FemBody>(
      "plate", 1, brick({{10e-3, 8e-3, 2e-3}}, {{0, 0, -1e-3}}, 1e-3), material,
      plate));
  add_contact(world, {{0, 1, false}, {1, 0, false}}, options);
  world.distribute();
  if (prepare)
  {
    prepare(static_cast<FemBody &>(*world.bodies[1]));
    world.couplings[0]->update_search(0, 1.); // looks anew
  }
  world.stepper.initialize();
  Slide result{};
  double x = 0.;
  while (world.stepper.time() < end)
  {
    const double dt = world.advance(0.5);
    result.velocity = world.bodies[0]->measure().velocity[0];
    x += dt * result.velocity;
    if (std::isnan(result.stopped_at) && result.velocity <= 0.02 * v)
    {
      result.stopped_at = world.stepper.time() +
                          world.bodies[0]->measure().velocity[2] / weight;
      result.distance = x;
    }
  }
  result.normal_impulse =
      weight * world.stepper.time() + world.bodies[0]->measure().velocity[2];
  return result;
}

std::vector<Check> sliding()
{
  const double g = 2e6, v = 10., mu = 0.3;
  std::vector<Check> checks;
  ContactOptions options;
  options.friction = coulomb(mu);
  const Slide stop = slide(g, v, options, 20e-6);
  checks.push_back({"time to a fiftieth of the speed", 0.98 * v / (mu * g),
                    stop.stopped_at, 0.02 * v / (mu * g), "s",
                    "0.98 v/(mu g)"});
  checks.push_back({"stopping distance", v * v / (2. * mu * g), stop.distance,
                    0.02 * v * v / (2. * mu * g), "m", "v^2/(2 mu g)"});
  const Slide half = slide(g, v, options, 8e-6);
  checks.push_back({"loss of speed over impulse of the normal force", mu,
                    (v - half.velocity) / half.normal_impulse, 1e-3 * mu, "1",
                    "Coulomb"});

  const double beta = 0.2, a = 0.1, b = mu - a;
  options.friction = coulomb(mu, a, beta);
  const Slide decay = slide(g, v, options, 15e-6);
  const double exact =
      std::log(((a * std::exp(beta * v) + b) *
                    std::exp(-a * beta * decay.normal_impulse) -
                b) /
               a) /
      beta;
  checks.push_back({"speed with exponential decay", exact, decay.velocity,
                    0.02 * (v - exact), "m/s",
                    "dv/dI = -(mu_d + (mu_s - mu_d) exp(-beta v))"});

  ContactOptions limited;
  limited.friction = coulomb(0.5);
  limited.shear_strength = ShearStrength::given(1e6);
  const double lost = 1e6 / (aluminum().density * 2e-3) * 10e-6;
  checks.push_back({"loss of speed at the shear strength", lost,
                    v - slide(g, v, limited, 10e-6).velocity, 0.05 * lost,
                    "m/s", "tau t/(rho height)"});
  limited.shear_strength = ShearStrength::of_yield();
  checks.push_back(
      {"loss of speed at the shear strength of the softer side", lost,
       v - slide(g, v, limited, 10e-6, std::make_shared<Soft>()).velocity,
       0.05 * lost, "m/s", "Y/sqrt(3) t/(rho height)"});
  return checks;
}

/** The shear strength follows the state of the touched metal, whose flow stress
    is four times as high or low as at the start; it is constant around that
    state, for what is sheared at its strength flows, and is soon pressed in. */
std::vector<Check> sliding_on_worked_metal()
{
  const double g = 5e5, v = 10., tau = 1e6, end = 2e-6;
  const double Y = std::sqrt(3.) * tau,
               lost = tau / (aluminum().density * 2e-3) * end;
  ContactOptions options;
  options.friction = coulomb(8.); // ten times the shear strength
  options.shear_strength = ShearStrength::of_yield();
  const ElasticConstants &constants = aluminum();
  HardeningParameters hardening;
  hardening.table_strain = {0., 1., 2.};
  hardening.table_stress = {0.25 * Y, 0.25 * Y, Y};
  const auto metal =
      std::make_shared<HardeningPlasticity>(constants, hardening);
  const auto harden = [](const std::function<bool(const double x)> &where)
  {
    return [where](FemBody &plate)
    {
      const OutputMesh mesh = plate.output_mesh();
      std::vector<double> change;
      for (std::size_t e = 0; e < plate.n_local_cells(); ++e)
      {
        double x = 0.;
        for (std::size_t a = 8 * e; a < 8 * e + 8; ++a)
          x += 0.125 * mesh.points[3 * mesh.connectivity[a]];
        change.push_back(where(x) ? 3. : 0.);
      }
      plate.shift_state("effective plastic strain", change);
    };
  };
  const auto loss = [&](const std::shared_ptr<const Material> &material,
                        const std::function<void(FemBody &)> &prepare)
  { return v - slide(g, v, options, end, material, prepare).velocity; };
  std::vector<Check> checks;
  checks.push_back({"loss of speed on hardened metal", lost,
                    loss(metal, harden([](double) { return true; })),
                    0.01 * lost, "m/s", "Y(eps)/sqrt(3) t/(rho height)"});
  // The block covers x < 0 with 1.5 of 4 mm, and 0.01 mm less in the mean.
  const double soft = 1.49 / 4.;
  checks.push_back({"loss of speed on metal hardened for x > 0",
                    lost * (1. - 0.75 * soft),
                    loss(metal, harden([](const double x) { return x > 0.; })),
                    0.01 * lost, "m/s", "area mean of Y(eps)/sqrt(3)"});
  JohnsonCookParameters p;
  p.A = 4. * Y;
  p.taylor_quinney = 0.;
  checks.push_back({"loss of speed on heated metal", lost,
                    loss(std::make_shared<JohnsonCook>(constants, p),
                         [&](FemBody &plate)
                         {
                           plate.shift_state("temperature",
                                             std::vector<double>(
                                                 plate.n_local_cells(),
                                                 0.75 * (p.melt_temperature -
                                                         p.room_temperature)));
                         }),
                    0.01 * lost, "m/s", "Y(T)/sqrt(3) t/(rho height)"});
  return checks;
}

/** Two equal spheres meet: Hertz 1882 (Timoshenko and Goodier, Theory of
    Elasticity, art. 140, 141). */
std::vector<Check> hertz()
{
  const double R = 10e-3, v = 40., nu = 0.33;
  const double modulus = aluminum().young_modulus / (2. * (1. - nu * nu)),
               mass = 0.5 * aluminum().density * 4. / 3. * M_PI * R * R * R;
  const double approach =
      std::pow(15. * mass * v * v / (16. * modulus * std::sqrt(0.5 * R)), 0.4);
  const double duration = 2.943 * approach / v;
  const double force =
      4. / 3. * modulus * std::sqrt(0.5 * R) * std::pow(approach, 1.5);
  std::vector<Check> checks;
  std::vector<double> errors, cells = {2e-3, 1.4e-3, 1e-3, 0.7e-3};
  for (const double h : cells)
  {
    World world;
    for (const int side : {-1, 1})
    {
      FemOptions options;
      options.initial_velocity = {{0., 0., -side * 0.5 * v}};
      // Elastic: nothing of the cells may damp either.
      options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
      options.hourglass = "stiffness";
      HexMesh mesh = make_sphere(R, {{0., 0., 0.}}, h);
      double low = 0.;
      for (const auto &p : mesh.nodes)
        low = std::min(low, p[2]);
      for (auto &p : mesh.nodes)
        p[2] += side * (1e-6 - low);
      world.bodies.push_back(std::make_unique<FemBody>(
          side < 0 ? "lower" : "upper", world.bodies.size(), mesh, elastic(nu),
          options));
    }
    // Hertz's contact is elastic.
    ContactOptions undamped;
    undamped.damping_fraction = 0.;
    add_contact(world, {{0, 1, false}, {1, 0, false}}, undamped);
    world.distribute();
    world.stepper.initialize();
    double largest = 0., old_momentum = 0., old_time = 0.;
    const double m = world.bodies[1]->measure().mass;
    old_momentum = -0.5 * m * v;
    while (world.stepper.time() < 1.5 * duration)
    {
      world.advance(0.9);
      // Force as the slope of the momentum over a twentieth of the contact.
      if (world.stepper.time() - old_time < 0.05 * duration)
        continue;
      const double p = m * world.bodies[1]->measure().velocity[2];
      largest = std::max(largest, (p - old_momentum) /
                                      (world.stepper.time() - old_time));
      old_momentum = p;
      old_time = world.stepper.time();
    }
    char where[40];
    std::snprintf(where, sizeof(where), "%.1f mm: ", h * 1e3);
    errors.push_back(std::abs(largest / force - 1.));
    checks.push_back({std::string(where) + "largest force", force, largest,
                      0.05 * force, "N", "Hertz",
                      h < 1e-3 ? Check::Kind::near : Check::Kind::reported});
    checks.push_back({std::string(where) + "velocity of rebound over the first",
                      1., 2. * world.bodies[1]->measure().velocity[2] / v, 0.05,
                      "1", "elastic",
                      h < 1e-3 ? Check::Kind::near : Check::Kind::reported});
  }
  checks.push_back({"order of the force", 1.,
                    std::log(errors.front() / errors.back()) /
                        std::log(cells.front() / cells.back()),
                    0., "1", "resolution", Check::Kind::reported});
  return checks;
}

/** Boxes that a search compares and pairs that it finds, per node of two plates
    that touch everywhere: counts, for time depends on what else the machine
    does. */
std::vector<Check> search_cost()
{
  std::vector<Check> checks;
  std::vector<double> compared, nodes;
  const auto report =
      [&](const std::string &name, const double value, const std::string &unit)
  {
    checks.push_back(
        {name, 0., value, 0., unit, "measured", Check::Kind::reported});
  };
  for (const int n : {12, 39, 124, 223})
  {
    World world;
    const double w = n * 1e-3;
    for (const int side : {-1, 1})
      world.bodies.push_back(std::make_unique<FemBody>(
          side < 0 ? "lower" : "upper", world.bodies.size(),
          brick({{w, w, 2e-3}}, {{0, 0, side * 1.01e-3}}, 1e-3), elastic(),
          FemOptions()));
    add_contact(world, {{0, 1, false}, {1, 0, false}}, ContactOptions());
    world.distribute();
    const std::vector<Body *> bodies = world.pointers();
    const std::vector<ContactPair> pairs = {{0, 1, false}, {1, 0, false}};
    std::vector<ContactSurface> surfaces;
    for (const Body *body : bodies)
      surfaces.push_back(body->contact_surface());
    const std::clock_t start = std::clock(); // of the processor
    const SearchResult found =
        ContactSearch{bodies, surfaces, pairs, {},
                      1e-3,   1e-3,     false, MPI_COMM_WORLD}
            .find();
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    nodes.push_back(4. * (n + 1) * (n + 1) + 8. * n);
    compared.push_back(found.n_compared);
    const std::string name = std::to_string(int(nodes.back())) + " nodes, ";
    report(name + "boxes compared", compared.back() / nodes.back(), "per node");
    report(name + "faces found", found.face_of_candidate.size() / nodes.back(),
           "per node");
    report(name + "time of the processor", 1e9 * seconds / nodes.back(),
           "ns per node");
  }
  // Of nodes on the plates' rims fewer faces are near, and a share of 1/n of
  // the nodes is there.
  checks.push_back({"exponent of what is compared", 1.,
                    std::log(compared.back() / compared.front()) /
                        std::log(nodes.back() / nodes.front()),
                    0.05, "1", "linear; rims shrink", Check::Kind::at_most});
  return checks;
}

const RegisterProblem a({"contact-rigid-rebound",
                         "two rigid bars part as they met", "quick",
                         rigid_rebound}),
    b({"contact-sliding", "friction of a heavy block", "quick", sliding}),
    e({"contact-worked-metal",
       "shear strength of friction on hardened and on hot metal", "quick",
       sliding_on_worked_metal}),
    c({"contact-hertz", "impact of two elastic spheres", "long", hertz}),
    d({"contact-search-cost", "what a search looks at, by number of nodes",
       "long", search_cost});
} // namespace
} // namespace sabot
