// Self-contact of one body of hexahedra: prongs that meet, and what must not.
#include "sabot/couplings/contact.h"
#include "verification/meshes.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
/** Two prongs of 2 x 2 mm, 12 and 14 mm long and 2 mm apart, on a common foot:
    one body. */
HexMesh fork()
{
  return hollow_block(
      {{{6, 2, 16}}, {{-3e-3, -1e-3, -2e-3}}, {{3e-3, 1e-3, 14e-3}}},
      [](const MeshPoint &x)
      {
        return (std::abs(x[0]) < 1e-3 && x[2] > 0.) ||
               (x[0] < 0. && x[2] > 12e-3);
      });
}

void add_self_contact(World &world)
{
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(), std::vector<ContactPair>{{0, 0, false}},
      ContactOptions(), MPI_COMM_WORLD));
}

/** The prongs are thrown against each other. */
std::vector<Check> prongs()
{
  const double v = 120.;
  std::vector<Check> checks;
  double free_gain = 0.;
  for (const bool held : {false, true})
  {
    World world;
    world.bodies.push_back(
        std::make_unique<FemBody>("fork", 0, fork(), elastic(), FemOptions()));
    if (held)
      add_self_contact(world);
    world.distribute();
    NodalState &n = world.bodies[0]->nodes();
    double thrown = 0.;
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      const Vec X = n.reference_position[i];
      const double along = std::max(0., X[2]) / 12e-3;
      n.velocity[i] = vec(std::copysign(v, -X[0]) * along, 0., 0.);
      thrown += 0.5 * n.lumped_mass[i] * std::abs(n.velocity[i][0]);
    }
    world.stepper.initialize();
    const double energy = world.total_energy();
    const auto before = world.momenta();
    double least = 1., gain = 0., given = 0.;
    while (world.stepper.time() < 60e-6)
    {
      world.advance(0.5);
      gain = std::max(gain, world.total_energy() / energy - 1.);
      given = std::max(given, -world.contact_energy() / energy);
      double left = -1., right = 1.;
      for (std::size_t i = 0; i < n.n_owned; ++i)
      {
        const Vec X = n.reference_position[i];
        // The shorter tip and what it meets.
        if (std::abs(X[2] - 12e-3) > 1.1e-3 ||
            std::abs(std::abs(X[0]) - 1e-3) > 1e-9)
          continue;
        if (X[0] < 0.)
          left = std::max(left, n.position[i][0]);
        else
          right = std::min(right, n.position[i][0]);
      }
      least = std::min(least, right - left);
    }
    const auto after = world.momenta();
    if (!held)
    {
      free_gain = gain;
      checks.push_back({"without contact: least gap of the tips", -1e-3, least,
                        0., "m", "they would pass", Check::Kind::at_most});
      continue;
    }
    // Both are turned, so that their highest nodes overlap before they touch.
    checks.push_back({"least gap of the tips over the spacing, above", -0.25,
                      least / 1e-3, 0., "1", "they do not pass",
                      Check::Kind::at_least});
    for (const Measure &m : world.couplings[0]->measure())
      if (m.name == "penetration max over spacing")
        checks.push_back({"penetration over the spacing", 0.2, m.value, 0., "1",
                          "closing at up to 240 m/s", Check::Kind::at_most});
    checks.push_back({"energy given by the contact, largest", 0., given, 1e-6,
                      "1", "it only takes", Check::Kind::at_most});
    checks.push_back({"least gap of the tips over the spacing, below", 0.05,
                      least / 1e-3, 0., "1", "they met", Check::Kind::at_most});
    checks.push_back({"momentum, change over one prong's", 0.,
                      (after[0] - before[0]) / thrown, 1e-11, "1",
                      "conservation"});
    checks.push_back({"largest gain of energy, over that without contact",
                      free_gain, gain, 1e-3, "1", "energy balance",
                      Check::Kind::at_most});
    checks.push_back({"energy kept by contact and its damping", 0.,
                      world.contact_energy() / energy, 0., "1", "it only takes",
                      Check::Kind::at_least});
  }
  return checks;
}

/** A plate of one layer of cells vibrates: its two sides are no contact. */
std::vector<Check> thin_plate()
{
  std::array<double, 2> energy{};
  double force = 0.;
  for (const bool held : {false, true})
  {
    World world;
    BoxSpecification box;
    box.size = {{8e-3, 8e-3, 1e-3}};
    box.center = {{0., 0., 0.}};
    box.cell_size = 1e-3;
    world.bodies.push_back(std::make_unique<FemBody>(
        "plate", 0, make_graded_box(box), elastic(), FemOptions()));
    if (held)
      add_self_contact(world);
    world.distribute();
    NodalState &n = world.bodies[0]->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      const Vec X = n.reference_position[i];
      n.velocity[i] = vec(50. * std::sin(900. * X[1]), 0.,
                          100. * std::cos(900. * X[0]) - 1e5 * X[2]);
    }
    world.stepper.initialize();
    while (world.stepper.time() < 10e-6)
      world.advance(0.9);
    energy[held] = world.ledger().kinetic.value();
    if (held)
      force = std::abs(world.contact_energy());
  }
  return {{"work of the contact", 0., force, 0., "J", "nothing touches"},
          {"kinetic energy with over without, less one", 0.,
           energy[1] / energy[0] - 1., 0., "1", "the same motion"}};
}

const RegisterProblem a({"contact-folding",
                         "two prongs of one body of hexahedra meet", "quick",
                         prongs}),
    b({"contact-own-sides", "a thin plate does not touch itself", "quick",
       thin_plate});
} // namespace
} // namespace sabot
