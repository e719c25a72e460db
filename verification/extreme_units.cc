// One impact in units scaled by 1e+-3 gives the same answer.
#include "sabot/couplings/contact.h"
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/couplings/tie.h"
#include "sabot/materials/laws.h"
#include "sabot/materials/mie_gruneisen.h"
#include "verification/balance.h"
#include "verification/problem.h"

namespace sabot
{
namespace
{
/** What a meter, a second and a kilogram are in the units of the numbers. */
struct Units
{
  double length = 1., time = 1., mass = 1.;
  double velocity() const { return length / time; }
  double density() const { return mass / (length * length * length); }
  double stress() const { return mass / (length * time * time); }
  double energy() const { return mass * length * length / (time * time); }
};

struct State
{
  std::vector<Vec> position, velocity; // in meters and seconds
  double energy;                       // [J]
  double plastic_strain, broken, temperature;
  unsigned int steps;
};

/** A block strikes a plate with a zone of particles that fail, all with
    Johnson-Cook and Mie-Gruneisen, contact with friction, debris and a tie. */
State run(const Units &u)
{
  const double mm = 1e-3 * u.length;
  JohnsonCookParameters p = johnson_cook_parameters("al6061-t6");
  p.A *= u.stress();
  p.B *= u.stress();
  p.reference_strain_rate /= u.time;
  p.specific_heat *= u.velocity() * u.velocity();
  ElasticConstants elasticity = aluminum();
  elasticity.density *= u.density();
  elasticity.young_modulus *= u.stress();
  MieGruneisenParameters shock = mie_gruneisen_parameters("al6061-t6-eos");
  shock.density = elasticity.density;
  shock.sound_speed *= u.velocity();
  const auto metal = std::make_shared<JohnsonCook>(
      elasticity, p, std::make_shared<MieGruneisen>(shock));
  World world;
  BoxSpecification box;
  box.size = {{9. * mm, 9. * mm, 3. * mm}};
  box.cell_size = mm;
  box.has_zone = true;
  box.zone_size = {{5. * mm, 5. * mm, 3. * mm}};
  FemOptions fem;
  fem.clamped_boundary_ids = {0, 1};
  world.bodies.push_back(
      std::make_unique<FemBody>("plate", 0, make_graded_box(box), metal, fem));
  SpgOptions spg;
  spg.set_critical_plastic_strain(0.1);
  world.bodies.push_back(std::make_unique<SpgBody>(
      "core", 1, make_box_cloud({{0., 0., 0.}}, box.zone_size, mm), metal,
      spg));
  BoxSpecification block;
  block.size = {{3. * mm, 3. * mm, 3. * mm}};
  block.center = {{0.25 * mm, 0.125 * mm, 3.0625 * mm}};
  block.cell_size = mm;
  FemOptions projectile;
  projectile.initial_velocity = {{0., 0., -600. * u.velocity()}};
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 2, make_graded_box(block), metal, projectile));
  ContactOptions contact;
  contact.friction = coulomb(0.3);
  world.couplings.push_back(std::make_unique<Contact>(
      "impact", world.pointers(),
      std::vector<ContactPair>{{0, 1, true}, {0, 2}, {2, 0}, {2, 1}}, contact,
      MPI_COMM_WORLD));
  SelfContactOptions debris;
  debris.friction = coulomb(0.3);
  world.couplings.push_back(std::make_unique<SelfContact>(
      "debris", world.pointers(), std::vector<std::pair<int, int>>{{1, 1}},
      debris, MPI_COMM_WORLD));
  world.couplings.push_back(std::make_unique<Tie>("zone", world.pointers(), 1,
                                                  0, 0.05, MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
  for (int step = 0; step < 60; ++step)
    world.advance(0.9);
  State s;
  for (const auto &body : world.bodies)
  {
    const NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      s.position.push_back((1. / u.length) * n.position[i]);
      s.velocity.push_back((1. / u.velocity()) * n.velocity[i]);
    }
  }
  s.energy = world.total_energy() / u.energy();
  s.plastic_strain = measure(*world.bodies[1], "plastic strain max");
  s.broken = world.bodies[1]->measure().bonds_broken_fraction;
  s.temperature = measure(*world.bodies[1], "temperature max");
  return s;
}

double largest_difference(const std::vector<Vec> &a, const std::vector<Vec> &b)
{
  double worst = 0.;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    const double off = norm(a[i] - b[i]);
    worst = off <= worst ? worst : off; // not-a-number stays
  }
  return worst;
}

std::vector<Check> units()
{
  const State reference = run(Units());
  std::vector<Check> checks = {
      {"broken bonds", 0.005, reference.broken, 0., "1",
       "so that there is something to compare", Check::Kind::at_least},
      {"largest plastic strain", 0.1, reference.plastic_strain, 0., "1",
       "so that there is something to compare", Check::Kind::at_least}};
  struct Case
  {
    std::string name;
    Units units;
  };
  for (const Case &c :
       {Case{"millimeters", {1e3, 1., 1.}}, Case{"kilometers", {1e-3, 1., 1.}},
        Case{"milliseconds", {1., 1e3, 1.}},
        Case{"kiloseconds", {1., 1e-3, 1.}}, Case{"grams", {1., 1., 1e3}},
        Case{"tonnes", {1., 1., 1e-3}}, Case{"mm, ms, g", {1e3, 1e3, 1e3}},
        Case{"km, ks, t", {1e-3, 1e-3, 1e-3}}})
  {
    const State s = run(c.units);
    // Round-off decides where a node is as near to two faces, which shows at
    // this level.
    const double bound = 1e-9;
    checks.push_back({c.name + ": positions over 9 mm", 0.,
                      largest_difference(s.position, reference.position) / 9e-3,
                      bound, "1", "the same motion"});
    checks.push_back({c.name + ": velocities over 600 m/s", 0.,
                      largest_difference(s.velocity, reference.velocity) / 600.,
                      100. * bound, "1", "the same motion"});
    checks.push_back({c.name + ": energy", 1., s.energy / reference.energy,
                      1e-9, "1", "the same motion"});
    checks.push_back({c.name + ": hottest particle", reference.temperature,
                      s.temperature, 1e-6 * reference.temperature, "K",
                      "the same motion"});
  }
  return checks;
}

const RegisterProblem registered({"extreme-units",
                                  "one impact in units scaled by 1e+-3",
                                  "extremes quick", units});
} // namespace
} // namespace sabot
