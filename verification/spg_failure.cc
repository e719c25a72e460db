// Failure of bonds: where each criterion fires, and that nothing heals.
#include "sabot/base/choice.h"
#include "sabot/base/text.h"
#include "sabot/materials/johnson_cook.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <algorithm>

namespace sabot
{
namespace
{
constexpr double h = 1e-3;

/** J2 plasticity without hardening. */
std::shared_ptr<const Material> perfect(const double yield)
{
  return hardening_aluminum(yield, 0.);
}

/** Bonds that fail go, as in the paper. */
SpgOptions inviscid()
{
  SpgOptions o;
  o.residual_strength = choose<ResidualStrength>("compression");
  o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
  o.failure_check_interval = 1;
  return o;
}

SpgBody &add_block(World &world, const SpgOptions &options,
                   std::shared_ptr<const Material> material)
{
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, perturbed_cloud({{4e-3, 4e-3, 4e-3}}, h, 0.1), material,
      options));
  world.distribute();
  return static_cast<SpgBody &>(*world.bodies[0]);
}

void deform(SpgBody &body, const Mat &A, const double dt, const int step)
{
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.size(); ++i)
    n.position[i] = A * n.reference_position[i];
  body.update_ghosts();
  body.compute_forces(0., dt);
  body.update_topology(step, 0.);
}

/** Load until the first bonds fail, then go back and load the other way.
    @p motion: A by the load, 0 at rest. */
template <typename Motion>
void add_criterion(std::vector<Check> &checks, const std::string &who,
                   const SpgOptions &options,
                   std::shared_ptr<const Material> material,
                   const double expected, const std::string &source,
                   const Motion &motion)
{
  World world;
  SpgBody &body = add_block(world, options, material);
  constexpr double dt = 1e-8;
  const double step = 5e-4 * expected;
  double load = 0., failed_at = std::nan("");
  int n = 0;
  while (std::isnan(failed_at) && load < 2. * expected)
  {
    load += step;
    deform(body, motion(load), dt, ++n);
    if (measure(body, "bonds broken") > 0.)
      failed_at = load;
  }
  checks.push_back({who + ": load of first failure", expected, failed_at,
                    2. * step, "1", source});
  const double broken = measure(body, "bonds broken");
  std::size_t left = 0;
  for (std::size_t i = 0; i < body.nodes().n_owned; ++i)
    left += body.rooms().bonds.n_bonds(i);
  checks.push_back({who + ": bonds that fail then", 1., broken, 0., "1",
                    "uniform deformation", Check::Kind::at_least});
  // Back to rest and beyond: none comes back, none fails in compression.
  double after = broken;
  std::size_t most = 0;
  for (; load > -0.5 * expected; load -= 5. * step)
  {
    deform(body, motion(load), dt, ++n);
    std::size_t bonds = 0;
    for (std::size_t i = 0; i < body.nodes().n_owned; ++i)
      bonds += body.rooms().bonds.n_bonds(i);
    most = std::max(most, bonds);
    after = measure(body, "bonds broken");
  }
  checks.push_back({who + ": bonds after unloading", double(left), double(most),
                    0., "1", "irreversible", Check::Kind::at_most});
  checks.push_back({who + ": broken bonds after unloading", broken, after, 0.,
                    "1", "irreversible", Check::Kind::at_least});
}

Mat uniaxial(const double e)
{
  Mat A = Mat::identity();
  A.set(0, 0, std::exp(e));
  return A;
}

SpgOptions principal_stress()
{
  SpgOptions o = inviscid();
  o.failure_criterion = choose<FailureCriterion>(
      "maximum principal stress", {{"Critical principal stress", "1 GPa"}});
  return o;
}

/** Both conditions, stress and stretch: the first bonds are those along the
    stretch. */
void critical_stretch(std::vector<Check> &checks)
{
  SpgOptions o = principal_stress();
  o.critical_stretch = 1.05;
  World world;
  SpgBody &body = add_block(world, o, elastic(0.33));
  double first = std::nan("");
  std::size_t wrong = 0;
  int n = 0;
  for (double e = 0.; e < 0.07 && std::isnan(first); e += 1e-4)
  {
    deform(body, uniaxial(e), 1e-8, ++n);
    if (measure(body, "bonds broken") > 0.)
      first = std::exp(e);
  }
  // What is left is not longer than the critical stretch.
  const NodalState &nodes = body.nodes();
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    for (std::size_t b = body.rooms().bonds.begin(i);
         b < body.rooms().bonds.end(i); ++b)
    {
      const std::uint32_t j = body.rooms().bonds.neighbor[b];
      wrong += norm(nodes.position[j] - nodes.position[i]) >
               1.05 * norm(nodes.reference_position[j] -
                           nodes.reference_position[i]);
    }
  checks.push_back({"critical stretch 1.05: stretch of first failure", 1.05,
                    first, 2e-3, "1", "the bond nearest to the axis",
                    Check::Kind::near});
  checks.push_back({"critical stretch 1.05: longer bonds left", 0.,
                    double(wrong), 0., "1", "both conditions are met"});
}

/** Johnson-Cook's damage: volume first, so that the mean stress is sigma* Y
    with perfect plasticity, then plastic flow at that triaxiality. */
template <typename Motion>
void add_damage(std::vector<Check> &checks, const double triaxiality,
                const Motion &isochoric)
{
  SpgOptions o = inviscid();
  o.failure_criterion = choose<FailureCriterion>("damage");
  JohnsonCookParameters p;
  p.A = aluminum_yield_stress();
  p.taylor_quinney = 0.;
  p.has_damage = true;
  // At the reference rate and room temperature the fracture strain is
  // D1 + D2 exp(D3 sigma*).
  p.reference_strain_rate = 1e10;
  p.D[0] = 0.02;
  p.D[1] = 0.1;
  p.D[2] = -1.5;
  const double volume = triaxiality * p.A / aluminum().bulk_modulus(),
               strain = p.D[0] + p.D[1] * std::exp(p.D[2] * triaxiality);
  add_criterion(
      checks, "damage at triaxiality " + formatted("%.2g", triaxiality), o,
      std::make_shared<JohnsonCook>(aluminum(), p),
      strain + p.A / (3. * aluminum().shear_modulus()),
      "D1 + D2 exp(D3 sigma*) + Y/(3 G)",
      [&](const double e) { return std::exp(volume / 3.) * isochoric(e); });
}

std::vector<Check> criteria()
{
  std::vector<Check> checks;
  const double K = aluminum().bulk_modulus(), G = aluminum().shear_modulus();
  const auto isochoric = [](const double e)
  {
    Mat A = Mat::zero();
    A.set(0, 0, std::exp(e));
    A.set(1, 1, std::exp(-0.5 * e));
    A.set(2, 2, std::exp(-0.5 * e));
    return A;
  };
  const auto shear = [](const double gamma)
  {
    Mat A = Mat::identity();
    A.set(0, 1, gamma);
    return A;
  };
  {
    // eps_p = e - Y/(3 G) in isochoric stretching without hardening.
    SpgOptions o = inviscid();
    o.set_critical_plastic_strain(0.1);
    const double Y = aluminum_yield_stress();
    add_criterion(checks, "plastic strain 0.1", o, perfect(Y),
                  0.1 + Y / (3. * G), "e - Y/(3 G)", isochoric);
  }
  {
    // Uniaxial strain: sigma_xx = (K + 4 G/3) e.
    add_criterion(checks, "principal stress 1 GPa", principal_stress(),
                  elastic(0.33), 1e9 / (K + 4. / 3. * G), "(K + 4 G/3) e",
                  uniaxial);
  }
  for (const double triaxiality : {0., 1. / 3., -0.5})
    add_damage(checks, triaxiality, isochoric);
  {
    // Simple shear: ln(l1/l3) = 2 asinh(gamma/2).
    SpgOptions o = inviscid();
    o.failure_criterion = choose<FailureCriterion>(
        "maximum shear strain", {{"Critical shear strain", "0.2"}});
    add_criterion(checks, "shear strain 0.2", o, elastic(0.33),
                  2. * std::sinh(0.1), "2 asinh(gamma/2)", shear);
  }
  critical_stretch(checks);
  return checks;
}

using Pairs = std::vector<std::pair<GlobalIndex, GlobalIndex>>;

/** The bonds of @p body by numbers of their ends, in order. */
Pairs pairs_of(const SpgBody &body)
{
  const NodalState &n = body.nodes();
  Pairs all;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    for (std::size_t b = body.rooms().bonds.begin(i);
         b < body.rooms().bonds.end(i); ++b)
      all.emplace_back(n.global_id[i],
                       n.global_id[body.rooms().bonds.neighbor[b]]);
  return all;
}

/** What is in @p some and not in @p others. */
Pairs without(const Pairs &some, const Pairs &others)
{
  Pairs rest;
  std::set_difference(some.begin(), some.end(), others.begin(), others.end(),
                      std::back_inserter(rest));
  return rest;
}

SpgOptions with_policy(const SpgOptions::NeighborPolicy policy)
{
  SpgOptions o = inviscid();
  o.neighbor_policy = policy;
  o.kernel_update_interval = 4;
  return o;
}

/** Bonds of the middle of a block fail; the halves are then pressed together
    through many kernel updates with a search. */
void press_halves(std::vector<Check> &checks,
                  const SpgOptions::NeighborPolicy policy)
{
  using Policy = SpgOptions::NeighborPolicy;
  World world;
  SpgOptions o = with_policy(policy);
  o.kernel_update_strain = 0.;
  o.set_critical_plastic_strain(0.1);
  SpgBody &body = add_block(world, o, perfect(aluminum_yield_stress()));
  const NodalState &n = body.nodes();
  // The particles beside the middle plane are strained beyond the limit.
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (std::abs(n.reference_position[i][0]) < 0.5e-3)
      body.rooms().points.state("effective plastic strain")[i] = 0.25;
  const Pairs original = pairs_of(body);
  int step = 0;
  Mat A = Mat::identity();
  for (; step < 20; ++step)
  {
    A.set(0, 0, 1. + 1e-3 * (step + 1));
    deform(body, A, 1e-8, step + 1);
  }
  const Pairs failed = without(original, pairs_of(body));
  // Compression and shear by half a spacing over the height: searches find
  // what has come near.
  const std::size_t updates = body.rooms().watch.n_updates;
  for (int k = 0; k < 200; ++k, ++step)
  {
    A.set(0, 0, 1.02 - 5e-4 * k);
    A.set(0, 1, 3e-3 * k);
    deform(body, A, 1e-8, step + 1);
  }
  const Pairs now = pairs_of(body), added = without(now, original);
  const std::size_t n_healed = failed.size() - without(failed, now).size();
  const std::string who = policy == Policy::lagrangian ? "Lagrangian list: "
                          : policy == Policy::search   ? "search: "
                                                       : "search undamaged: ";
  checks.push_back({who + "bonds failed", 10., double(failed.size()), 0., "1",
                    "so that some could heal", Check::Kind::at_least});
  checks.push_back({who + "kernel updates since", 40.,
                    double(body.rooms().watch.n_updates - updates), 0., "1",
                    "searches", Check::Kind::at_least});
  checks.push_back({who + "failed bonds that came back", 0., double(n_healed),
                    0., "1", "irreversible"});
  if (policy != Policy::search)
    checks.push_back({who + "new bonds of damaged particles", 0.,
                      double(added.size()), 0., "1",
                      "the whole block is damaged"});
  else
    checks.push_back({who + "new bonds", 1., double(added.size()), 0., "1",
                      "what came near without a failed bond",
                      Check::Kind::at_least});
}

/** Intact, sheared by 100 %: neighbors change, F stays exact. */
void shear_intact(std::vector<Check> &checks,
                  const SpgOptions::NeighborPolicy policy)
{
  World world;
  SpgBody &body = add_block(world, with_policy(policy), elastic(0.33));
  const double before = pairs_of(body).size();
  Mat A = Mat::identity();
  for (int step = 1; step <= 400; ++step)
  {
    A.set(0, 1, 2.5e-3 * step);
    deform(body, A, 1e-8, step);
  }
  double error = 0.;
  for (std::size_t i = 0; i < body.nodes().n_owned; ++i)
    error = std::max(
        error,
        std::abs(body.rooms().fields.deformation_gradient(i)(0, 1) - A(0, 1)));
  const std::string who = policy == SpgOptions::NeighborPolicy::search
                              ? "search, intact block: "
                              : "search undamaged, intact block: ";
  checks.push_back({who + "shear of F, largest error", 0., error, 1e-9, "1",
                    "uniform deformation"});
  checks.push_back({who + "bonds over those of the start", 0.,
                    pairs_of(body).size() / before, 0., "1", "",
                    Check::Kind::reported});
}

std::vector<Check> no_healing()
{
  using Policy = SpgOptions::NeighborPolicy;
  std::vector<Check> checks;
  for (const Policy policy :
       {Policy::lagrangian, Policy::search_undamaged, Policy::search})
    press_halves(checks, policy);
  for (const Policy policy : {Policy::search_undamaged, Policy::search})
    shear_intact(checks, policy);
  return checks;
}

/** A particle that lost a side goes on: plastic flow under compression and
    shear, no stress in tension, and its state is kept when it is alone. */
std::vector<Check> weak_particles()
{
  World world;
  SpgOptions o = inviscid();
  o.set_critical_plastic_strain(0.1);
  const double Y = aluminum_yield_stress();
  SpgBody &body = add_block(world, o, perfect(Y));
  NodalState &n = body.nodes();
  // The layer before the last comes loose: the last is a sheet.
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (std::abs(n.reference_position[i][0] - h) < 0.5 * h)
      body.rooms().points.state("effective plastic strain")[i] = 0.25;
  int step = 0;
  Mat A = Mat::identity();
  for (; step < 20; ++step)
  {
    A.set(0, 0, 1. + 1e-3 * (step + 1));
    deform(body, A, 1e-8, step + 1);
  }
  std::vector<std::size_t> weak;
  double tension = -1e300;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (body.rooms().approximation.lost_direction[i] &&
        body.rooms().bonds.n_bonds(i) >= 4)
    {
      weak.push_back(i);
      for (int c = 0; c < 3; ++c)
        tension = std::max(tension, body.stress(c, i));
    }
  // Compressed along the sheet.
  for (int k = 0; k < 200; ++k, ++step)
  {
    A.set(1, 1, 1. - 5e-4 * k);
    deform(body, A, 1e-8, step + 1);
  }
  // The sheet is held in its plane and free across: uniaxial strain there.
  double strained = 0., extra = -1e300, pressed = 0.;
  const double expected =
      aluminum().bulk_modulus() * std::log(A(1, 1)) - 2. / 3. * Y;
  for (const std::size_t i : weak)
  {
    pressed = std::min(pressed, body.stress(1, i));
    strained = std::max(
        strained, body.rooms().points.state("effective plastic strain")[i]);
    for (int c = 0; c < 3; ++c)
      extra = std::max(extra, body.stress(c, i));
  }
  return {{"particles that lost a direction", 10., double(weak.size()), 0., "1",
           "a sheet of 5 x 5 particles", Check::Kind::at_least},
          {"their largest tension over yield", 0., std::max(tension, extra) / Y,
           1e-9, "1", "no tension across a gap", Check::Kind::at_most},
          {"stress along the sheet", expected, pressed,
           0.03 * std::abs(expected), "Pa", "K ln J - 2 Y/3: it flows"},
          {"their largest plastic strain", 0.05, strained, 0., "1",
           "the state goes on", Check::Kind::at_least}};
}

const RegisterProblem a({"spg-failure-criteria",
                         "level and irreversibility of the three criteria",
                         "quick", criteria}),
    b({"spg-no-healing", "failed bonds and the neighbor policies", "quick",
       no_healing}),
    c({"spg-weak-particles", "what particles beside a crack carry", "quick",
       weak_particles});
} // namespace
} // namespace sabot
