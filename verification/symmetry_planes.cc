// What comes to a plane of symmetry meets its mirror image there.
#include "sabot/base/choice.h"
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/closing_limit.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/couplings/symmetry_walls.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <map>

namespace sabot
{
namespace
{
constexpr double spacing = 1e-3;

/** Lets all bonds of a block of particles fail: it is pulled apart, x across
    the plane, until each is alone. */
void crumble(World &world)
{
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
    body.rooms().points.state("effective plastic strain")[i] = 1.;
  world.stepper.initialize();
  for (int step = 0; step < 2000 && measure(body, "bonds broken fraction") < 1.;
       ++step)
  {
    if (step % 20 == 0)
      for (std::size_t i = 0; i < n.n_owned; ++i)
        n.velocity[i] = 2e5 * n.position[i];
    world.advance(0.5);
  }
}

std::unique_ptr<SpgBody> cloud_of(const double low, const double high,
                                  const unsigned int symmetry_faces)
{
  SpgOptions options;
  options.symmetry_faces = symmetry_faces;
  options.set_critical_plastic_strain(0.1);
  options.residual_strength = choose<ResidualStrength>("compression");
  return std::make_unique<SpgBody>(
      "debris", 0,
      make_box_cloud({{0.5 * (low + high), 1.5e-3, 0.}},
                     {{high - low, 3e-3, 3e-3}}, spacing),
      hardening_aluminum(), options);
}

/** A place and a velocity that depend on the place in the lattice only. */
Vec scattered(const Vec X, const double size, const int salt)
{
  Vec r{};
  for (int d = 0; d < 3; ++d)
    r[d] = size * std::sin(1e4 * (3.1 + d) * std::abs(X[0]) + 1.3e4 * X[1] +
                           1.7e4 * X[2] + d + salt);
  return r;
}

/** Half of a cloud of loose particles against the whole: dense enough that all
    meet their own images and those of others. */
std::vector<Check> debris_at_planes()
{
  World half, whole;
  // In y both are cut, in x only the half is.
  half.bodies.push_back(cloud_of(0., 4e-3, 1 | 4));
  whole.bodies.push_back(cloud_of(-4e-3, 4e-3, 4));
  for (World *world : {&half, &whole})
  {
    SelfContactOptions contact;
    contact.friction = nullptr;
    // That of a pair goes by its masses, which planes cut.
    contact.damping_fraction = 0.;
    world->couplings.push_back(std::make_unique<SelfContact>(
        "debris", world->pointers(), std::vector<std::pair<int, int>>{{0, 0}},
        contact, MPI_COMM_WORLD));
    world->couplings.push_back(
        std::make_unique<SymmetryWalls>(world->pointers(), MPI_COMM_WORLD));
    world->distribute();
    crumble(*world);
    NodalState &n = world->bodies[0]->nodes();
    // What met before is forgotten far apart.
    for (std::size_t i = 0; i < n.n_owned; ++i)
      n.position[i] = 9. * n.reference_position[i];
    world->couplings[0]->initialize();
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      const Vec X = n.reference_position[i];
      Vec x = 1.2 * X + scattered(X, 0.1 * spacing, 0);
      Vec v = scattered(X, 200., 5);
      v[0] -= 100.;
      if (X[0] == 0.)
        x[0] = v[0] = 0.;
      if (X[1] == 0.)
        x[1] = v[1] = 0.;
      if (X[0] < 0.)
      {
        x[0] = 1.2 * X[0] - (x[0] - 1.2 * X[0]);
        v[0] = -v[0];
      }
      n.position[i] = x;
      n.velocity[i] = v;
    }
    world->couplings[0]->initialize();
    world->stepper.advance(1e-12); // forces of these places
  }
  const double energy = half.total_energy();
  double beyond = 0., rising = 0.;
  for (int step = 0; step < 400; ++step)
  {
    half.stepper.advance(1e-8);
    whole.stepper.advance(1e-8);
    const NodalState &n = half.bodies[0]->nodes();
    for (std::size_t i = 0; i < n.n_owned; ++i)
      for (int d = 0; d < 2; ++d)
        beyond = std::max(beyond, -n.position[i][d] / spacing);
  }
  std::map<std::array<long, 3>, Vec> places;
  const NodalState &w = whole.bodies[0]->nodes(), &n = half.bodies[0]->nodes();
  const auto key = [](const Vec X)
  {
    return std::array<long, 3>{{std::lround(1e9 * X[0]),
                                std::lround(1e9 * X[1]),
                                std::lround(1e9 * X[2])}};
  };
  for (std::size_t i = 0; i < w.n_owned; ++i)
    places[key(w.reference_position[i])] = w.position[i];
  double apart = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    apart = std::max(
        apart, norm(n.position[i] - places.at(key(n.reference_position[i]))));
    rising = std::max(rising, std::abs(n.position[i][0]));
  }
  return {{"bonds that failed", 1.,
           measure(*half.bodies[0], "bonds broken fraction"), 1e-12, "1",
           "so that all are loose"},
          {"places, largest difference of half and whole over spacing", 0.,
           apart / spacing, 1e-6, "1", "symmetry of the problem"},
          {"beyond a plane over spacing", 0., beyond, 1e-9, "1",
           "the image is there", Check::Kind::at_most},
          {"energy, relative change", 0., half.total_energy() / energy - 1.,
           1e-2, "1", "energy balance"},
          {"contact energy over all", 1e-4, half.contact_energy() / energy, 0.,
           "1", "so that they have met", Check::Kind::at_least}};
}

/** What one kind of body does at the plane x = 0 of another one. */
struct Rebound
{
  double beyond, speed, energy; // over spacing, over -v, relative change
};

Rebound rebound(std::unique_ptr<Body> flyer, const double v, const bool loose)
{
  World world;
  world.bodies.push_back(std::move(flyer));
  BoxSpecification b;
  b.size = {{2e-3, 2e-3, 2e-3}};
  b.center = {{1e-3, 40e-3, 0.}};
  b.cell_size = spacing;
  FemOptions cut;
  cut.symmetry_boundary_ids = {0};
  world.bodies.push_back(std::make_unique<FemBody>(
      "owner of the plane", 1, make_graded_box(b), elastic(), cut));
  world.couplings.push_back(
      std::make_unique<SymmetryWalls>(world.pointers(), MPI_COMM_WORLD));
  world.couplings.push_back(std::make_unique<ClosingLimit>(
      world.pointers(), world.couplings, MPI_COMM_WORLD));
  world.distribute();
  if (loose)
    crumble(world);
  Body &body = *world.bodies[0];
  NodalState &n = body.nodes();
  if (loose)
    for (Vec &velocity : n.velocity)
      velocity = vec(-v, 0., 0.);
  world.stepper.initialize();
  const double energy = world.total_energy();
  const double end = world.stepper.time() + 12e-3 / v;
  double beyond = 0.;
  while (world.stepper.time() < end)
  {
    world.advance(0.7);
    for (std::size_t i = 0; i < n.n_owned; ++i)
      beyond = std::max(beyond, -n.position[i][0] / spacing);
  }
  return {beyond, body.measure().velocity[0] / v,
          world.total_energy() / energy - 1.};
}

/** A cube of 4 mm at 1 mm from the plane. */
std::unique_ptr<Body> cube(const std::string &kind, const double v)
{
  BoxSpecification b;
  b.size = {{4e-3, 4e-3, 4e-3}};
  b.center = {{3e-3, 0., 0.}};
  b.cell_size = spacing;
  if (kind == "rigid")
  {
    RigidOptions options;
    options.initial_velocity = {{-v, 0., 0.}};
    return std::make_unique<RigidBody>("cube", 0, make_graded_box(b), elastic(),
                                       options);
  }
  if (kind == "hexahedra")
  {
    FemOptions options;
    options.initial_velocity = {{-v, 0., 0.}};
    return std::make_unique<FemBody>("cube", 0, make_graded_box(b), elastic(),
                                     options);
  }
  SpgOptions options;
  options.initial_velocity = {{-v, 0., 0.}};
  if (kind == "loose particles")
  {
    options.set_critical_plastic_strain(0.1);
    options.residual_strength = choose<ResidualStrength>("compression");
  }
  return std::make_unique<SpgBody>(
      "cube", 0, make_box_cloud({{3e-3, 0., 0.}}, b.size, spacing),
      kind == "loose particles" ? hardening_aluminum() : elastic(), options);
}

std::vector<Check> kinds_at_plane()
{
  std::vector<Check> checks;
  for (const std::string kind :
       {"hexahedra", "particles", "loose particles", "rigid"})
    for (const double v : {20., 500.})
    {
      const Rebound r = rebound(cube(kind, v), v, kind == "loose particles");
      const std::string who = kind + " at " + std::to_string(int(v)) + " m/s: ";
      const bool is_rigid = kind == "rigid",
                 is_loose = kind == "loose particles";
      // The step grows by up to 0.05 after the force was found.
      checks.push_back({who + "beyond the plane over spacing", 0., r.beyond,
                        is_rigid ? 0.1 : 5e-3, "1", "held exactly by steps",
                        Check::Kind::at_most});
      // A cube keeps much of its motion as vibration.
      if (is_rigid || is_loose)
        checks.push_back({who + "velocity after over that before", 1., r.speed,
                          is_rigid ? 0.03 : 1e-9, "1", "mirror image"});
      else
        checks.push_back({who + "velocity after over that before", 0.6, r.speed,
                          0., "1", "it comes back", Check::Kind::at_least});
      checks.push_back({who + "energy, relative change", 0., r.energy,
                        is_rigid ? 5e-3 : 2e-2, "1", "energy balance"});
    }
  return checks;
}

const RegisterProblem a({"symmetry-debris",
                         "debris and its images at planes of symmetry", "quick",
                         debris_at_planes}),
    b({"symmetry-kinds", "bodies of all kinds at another one's plane", "quick",
       kinds_at_plane});
} // namespace
} // namespace sabot
