// Ties of cells and particles: linear fields, waves across, nested pipes.
#include "sabot/couplings/tie.h"
#include "verification/meshes.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
constexpr double coarse = 1e-3; // [m], cells of the hexahedra

/** A body whose end across x at @p end moves as a burst of two periods, then
    is held: a wave of one length. */
template <typename Base>
class Driven : public Base
{
public:
  template <typename... Arguments>
  Driven(const double end, const double period, Arguments &&...arguments)
      : Base(std::forward<Arguments>(arguments)...), end(end), period(period)
  {
  }
  void impose_velocities(const double time) override
  {
    Base::impose_velocities(time);
    const double window = std::sin(0.5 * M_PI * time / period);
    const double v = time < 2. * period
                         ? window * window * std::sin(2. * M_PI * time / period)
                         : 0.;
    NodalState &n = this->nodes();
    for (std::size_t i = 0; i < n.size(); ++i)
      if (std::abs(n.reference_position[i][0] - end) < 1e-9)
        n.velocity[i] = vec(v, 0., 0.);
  }

private:
  const double end, period;
};

double energy_of(const Body &body)
{
  EnergyLedger e;
  body.add_energies(e);
  return e.total().value();
}

struct Crossing
{
  double reflected, lost; // over the energy sent in
  double tie_work;        // over the energy sent in
};

/** A plane wave of @p n_coarse cells per length, in uniaxial strain, between
    hexahedra of edge H and particles H / @p ratio apart. */
Crossing cross(const int ratio, const int n_coarse, const bool from_particles)
{
  const double length = n_coarse * coarse,
               period = length / elastic()->sound_speed();
  const double before = 3. * length, behind = 4.5 * length;
  World world;
  BoxSpecification box;
  box.cell_size = coarse;
  const double cells = from_particles ? behind : before,
               cloud = from_particles ? before : behind;
  box.size = {{cells, coarse, coarse}};
  box.center = {{-0.5 * cells, 0., 0.}};
  FemOptions fem;
  fem.bulk_viscosity_linear = fem.bulk_viscosity_quadratic = 0.;
  fem.symmetry_boundary_ids = {2, 3, 4, 5};
  SpgOptions spg;
  spg.bulk_viscosity_linear = spg.bulk_viscosity_quadratic = 0.;
  spg.symmetry_faces = 4 + 8 + 16 + 32;
  const double far = 1e3; // no end there
  world.bodies.push_back(std::make_unique<Driven<FemBody>>(
      from_particles ? far : -before, period, "cells", 0, make_graded_box(box),
      elastic(), fem));
  world.bodies.push_back(std::make_unique<Driven<SpgBody>>(
      from_particles ? before : far, period, "particles", 1,
      make_box_cloud({{0.5 * cloud, 0., 0.}}, {{cloud, coarse, coarse}},
                     coarse / ratio),
      elastic(), spg));
  world.couplings.push_back(std::make_unique<Tie>("tie", world.pointers(), 1, 0,
                                                  0.05, MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
  while (world.stepper.time() < 2. * period)
    world.advance(0.9);
  const double sent = world.total_energy();
  // The slowest part has crossed, and no reflection has come back twice.
  while (world.stepper.time() <
         1.4 * (2. * length + before) / elastic()->sound_speed())
    world.advance(0.9);
  return {energy_of(*world.bodies[from_particles]) / sent,
          1. - world.total_energy() / sent, world.ledger().tie.value() / sent};
}

void add_checks(std::vector<Check> &checks, const int ratio, const int n_coarse,
                const bool is_target)
{
  for (const bool from_particles : {false, true})
  {
    const Crossing c = cross(ratio, n_coarse, from_particles);
    const std::string where =
        "1:" + std::to_string(ratio) + ", " + std::to_string(n_coarse) +
        (from_particles ? " cells, from particles: " : " cells, from cells: ");
    checks.push_back(
        {where + "reflected energy", 0.01, c.reflected, 0., "1",
         "target, wavelength in cells",
         is_target ? Check::Kind::at_most : Check::Kind::reported});
    checks.push_back({where + "lost energy", 0., c.lost, 0.01, "1",
                      "energy balance",
                      is_target ? Check::Kind::near : Check::Kind::reported});
    checks.push_back({where + "work of the tie over the energy", 0., c.tie_work,
                      1e-12, "1", "the tie does no work"});
  }
}

std::vector<Check> pulse()
{
  std::vector<Check> checks;
  add_checks(checks, 2, 10, true);
  return checks;
}

std::vector<Check> pulse_table()
{
  std::vector<Check> checks;
  for (const int ratio : {1, 2, 4, 10})
    for (const int n_coarse : {5, 10, 20})
      if (ratio < 10 || n_coarse < 20) // 10^5 particles and an hour
        add_checks(checks, ratio, n_coarse, ratio <= 2 && n_coarse >= 10);
  return checks;
}

/** What a linear displacement leaves at a tie: error of the followers, spread
    of the stress, force on the nodes of the interface over its largest. */
struct Patch
{
  double follower, stress, force;
};

/** Cells of edge @p cell and particles at 1 mm on either side of an interface
    that is bent by @p sag at 6 mm from its middle. */
Patch linear_patch(const double cell, const double sag)
{
  const auto bend = [&](std::array<double, 3> &p)
  { p[0] += sag * (p[1] * p[1] + 0.5 * p[2] * p[2]) / 36e-6; };
  World world;
  const unsigned int n = std::lround(6e-3 / cell);
  const HexMesh mesh = mapped_block(
      {{{n, 2 * n, 2 * n}}, {{-6e-3, -6e-3, -6e-3}}, {{0., 6e-3, 6e-3}}},
      [&](MeshPoint p)
      {
        bend(p);
        return p;
      });
  ParticleCloud cloud =
      make_box_cloud({{3e-3, 0., 0.}}, {{6e-3, 12e-3, 12e-3}}, 1e-3);
  for (auto &p : cloud.position)
    bend(p);
  world.bodies.push_back(
      std::make_unique<FemBody>("cells", 0, mesh, elastic(), FemOptions()));
  world.bodies.push_back(std::make_unique<SpgBody>("particles", 1, cloud,
                                                   elastic(), SpgOptions()));
  world.couplings.push_back(std::make_unique<Tie>("tie", world.pointers(), 1, 0,
                                                  0.2, MPI_COMM_WORLD));
  world.distribute();
  const auto field = [](const Vec x)
  {
    return vec(1. + 300. * x[0] - 20. * x[1], 200. * x[1] + 5. * x[2],
               -7. * x[1] + 20. * x[0]);
  };
  for (auto &body : world.bodies)
  {
    NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.size(); ++i)
      n.velocity[i] = field(n.reference_position[i]);
  }
  world.couplings[0]->impose_kinematics();
  NodalState &followers = world.bodies[1]->nodes();
  Patch patch{};
  double scale = 0.;
  for (std::size_t i = 0; i < followers.n_owned; ++i)
  {
    const Vec v = field(followers.reference_position[i]);
    scale = std::max(scale, 300. * 1e-3);
    patch.follower =
        std::max(patch.follower, norm(followers.velocity[i] - v) / scale);
  }
  const double dt = 1e-6; // strains of 3e-4 in one step
  for (auto &body : world.bodies)
  {
    NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.size(); ++i)
      n.position[i] += dt * n.velocity[i];
    body->update_ghosts();
    body->compute_forces(dt, dt);
  }
  const auto &particles = static_cast<const SpgBody &>(*world.bodies[1]);
  const auto &cells = static_cast<const FemBody &>(*world.bodies[0]);
  for (int c = 0; c < 6; ++c)
    for (std::size_t i = 0; i < followers.n_owned; ++i)
      patch.stress = std::max(
          patch.stress, std::abs(particles.stress(c, i) / cells.stress(0, 0) -
                                 cells.stress(c, 0) / cells.stress(0, 0)));
  // Away from the rim, where the free sides pull.
  NodalState &leads = world.bodies[0]->nodes();
  double largest = 0.;
  const auto is_inside = [&](const Vec X)
  { return std::abs(X[1]) < 3.5e-3 && std::abs(X[2]) < 3.5e-3; };
  std::vector<char> on_tie(leads.n_owned, 0);
  for (std::size_t i = 0; i < leads.n_owned; ++i)
    on_tie[i] = leads.inertia[i] > leads.lumped_mass[i];
  for (std::size_t i = 0; i < leads.n_owned; ++i)
    if (on_tie[i] && is_inside(leads.reference_position[i]))
      largest = std::max(largest, norm(leads.force[i]));
  world.couplings[0]->add_forces(dt);
  for (std::size_t i = 0; i < leads.n_owned; ++i)
    if (on_tie[i] && is_inside(leads.reference_position[i]))
      patch.force = std::max(patch.force, norm(leads.force[i]) / largest);
  return patch;
}

std::vector<Check> linear()
{
  std::vector<Check> checks;
  for (const double cell : {1e-3, 1.5e-3, 2e-3, 3e-3})
    for (const double sag : {0., 0.5e-3})
    {
      const Patch p = linear_patch(cell, sag);
      char where[80];
      std::snprintf(where, sizeof(where), "1:%.1f, %s: ", cell / 1e-3,
                    sag > 0. ? "curved" : "flat");
      checks.push_back({std::string(where) + "motion of followers", 0.,
                        p.follower, 1e-12, "1", "linear field, per spacing"});
      checks.push_back({std::string(where) + "stress of particles", 0.,
                        p.stress, 1e-9, "1", "uniform stress"});
      // Followers at the corners of the faces sum to the exact nodal forces.
      const bool is_nested = sag == 0. && (cell == 1e-3 || cell == 2e-3);
      checks.push_back({std::string(where) + "force left at the interface", 0.,
                        p.force, 1e-9, "1", "uniform stress: zero",
                        is_nested ? Check::Kind::near : Check::Kind::reported});
    }
  return checks;
}

/** A quarter of a pipe around the z axis, 4 mm long, with @p n_around cells
    along the arc and @p n_along along z. */
HexMesh pipe(const double inner, const double outer, const int n_around,
             const int n_along)
{
  return mapped_block(
      {{{2, unsigned(n_around), unsigned(n_along)}},
       {{inner, 0., 0.}},
       {{outer, M_PI_2, 4e-3}}},
      [](const MeshPoint &x) {
        return MeshPoint{{x[0] * std::cos(x[1]), x[0] * std::sin(x[1]), x[2]}};
      });
}

struct Pipes
{
  double follower = 0., interface_motion = 0.; // error over the largest; [m]
  double least_mass = 1.; // that a leader keeps, over its own
  double step = 0.;       // of the tie over the bodies'
  double linear = 0., angular = 0., tie_work = 0., energy = 0.; // changes
  double n_tied = 0.;
};

/** Two pipes in each other, meshed with 5 and 8 cells over the quarter, turn
   and stretch: nodes of the follower stand off the leader's facets by up to
   0.07 mm of 2 mm. */
Pipes turn(const HexMesh &leader, const HexMesh &follower)
{
  constexpr double R = 6e-3, largest = 20e3 * R;
  World world;
  FemOptions options;
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  options.hourglass = "stiffness";
  world.bodies.push_back(
      std::make_unique<FemBody>("leader", 0, leader, elastic(), options));
  world.bodies.push_back(
      std::make_unique<FemBody>("follower", 1, follower, elastic(), options));
  world.couplings.push_back(std::make_unique<Tie>("tie", world.pointers(), 1, 0,
                                                  0.2, MPI_COMM_WORLD));
  world.distribute();
  const auto field = [](const Vec x)
  {
    return vec(10. + 3000. * x[0] - 20e3 * x[1] + 900. * x[2],
               18e3 * x[0] - 2000. * x[1] + 500. * x[2],
               -700. * x[1] + 2000. * x[0] + 1000. * x[2]);
  };
  double mass = 0.;
  for (auto &body : world.bodies)
  {
    mass += body->measure().mass;
    NodalState &n = body->nodes();
    for (std::size_t i = 0; i < n.size(); ++i)
      n.velocity[i] = field(n.reference_position[i]);
  }
  world.couplings[0]->impose_kinematics();
  const NodalState &followers = world.bodies[1]->nodes(),
                   &leads = world.bodies[0]->nodes();
  Pipes result;
  result.n_tied = world.couplings[0]->measure()[0].value;
  for (std::size_t i = 0; i < followers.n_owned; ++i)
    result.follower =
        std::max(result.follower, norm(followers.velocity[i] -
                                       field(followers.reference_position[i])) /
                                      largest);
  for (std::size_t i = 0; i < leads.n_owned; ++i)
    result.least_mass =
        std::min(result.least_mass, leads.inertia[i] / leads.lumped_mass[i]);

  world.stepper.initialize();
  result.step = std::min(1., world.couplings[0]->stable_step().dt /
                                 std::min(world.bodies[0]->stable_step().dt,
                                          world.bodies[1]->stable_step().dt));
  const double energy = world.total_energy();
  const auto before = world.momenta();
  while (world.stepper.time() < 60e-6)
  {
    world.advance(1.); // at the limit
    result.energy =
        std::max(result.energy, std::abs(world.total_energy() / energy - 1.));
    for (std::size_t i = 0; i < followers.n_owned; ++i)
      if (followers.is_follower(i))
        result.interface_motion = std::max(
            result.interface_motion,
            norm(followers.position[i] - followers.reference_position[i]));
  }
  const auto after = world.momenta();
  for (int d = 0; d < 3; ++d)
  {
    const double p = mass * largest;
    result.linear = std::max(result.linear, std::abs(after[d] - before[d]) / p);
    result.angular = std::max(result.angular,
                              std::abs(after[3 + d] - before[3 + d]) / (p * R));
  }
  result.tie_work = world.ledger().tie.value() / energy;
  return result;
}

std::vector<Check> cylinder()
{
  const double R = 6e-3, in = 4e-3, out = 8e-3;
  std::vector<Check> checks;
  for (const bool leader_inside : {true, false})
  {
    // Nodes stand outside of the leader's cells, or in them.
    const std::string where =
        leader_inside ? "leader inside: " : "leader outside: ";
    const Pipes p =
        turn(leader_inside ? pipe(in, R, 5, 3) : pipe(R, out, 5, 3),
             leader_inside ? pipe(R, out, 8, 4) : pipe(in, R, 8, 4));
    checks.push_back(
        {where + "tied nodes", 45., p.n_tied, 0., "1", "9 x 5 on the arc"});
    checks.push_back({where + "motion of followers", 0., p.follower, 1e-12, "1",
                      "linear field, over its largest"});
    checks.push_back(
        {where + "momentum, change", 0., p.linear, 1e-12, "1", "conservation"});
    checks.push_back({where + "angular momentum, change", 0., p.angular, 1e-12,
                      "1", "conservation"});
    checks.push_back({where + "work of the tie over the energy", 0., p.tie_work,
                      1e-12, "1", "the tie does no work"});
    checks.push_back({where + "energy, largest change at the stable step", 0.,
                      p.energy, 1e-3, "1", "conservation"});
    checks.push_back({where + "motion of the interface", 1e-3,
                      p.interface_motion, 0., "m", "it moves far",
                      Check::Kind::at_least});
    checks.push_back({where + "least part of its mass that a leader keeps", 0.9,
                      p.least_mass, 0., "1", "stability",
                      Check::Kind::at_least});
    checks.push_back({where + "stable step of the tie over the bodies'", 0.9,
                      p.step, 0., "1", "stability", Check::Kind::at_least});
  }
  // Behind a thin layer of cells the heavy nodes of thick ones would leave no
  // mass: they go to the faces.
  const Pipes thin = turn(pipe(R - 0.6e-3, R, 5, 3), pipe(R, 2. * R, 8, 4));
  checks.push_back({"thin leader: least part of its mass that a leader keeps",
                    1., thin.least_mass, 0., "1", "tied to the faces"});
  checks.push_back({"thin leader: momentum, change", 0., thin.linear, 1e-12,
                    "1", "conservation"});
  checks.push_back({"thin leader: energy, largest change at the stable step",
                    0., thin.energy, 1e-3, "1", "conservation"});
  checks.push_back({"thin leader: motion of followers", 0., thin.follower, 0.,
                    "1", "gradient times distance", Check::Kind::reported});
  return checks;
}

const RegisterProblem a({"tie-pulse",
                         "energy that a tie of ratio 1:2 reflects and loses",
                         "quick", pulse}),
    b({"tie-linear", "linear field across flat and curved ties", "quick",
       linear}),
    d({"tie-cylinder", "two pipes in each other, tied, not conforming", "quick",
       cylinder}),
    c({"tie-pulse-table",
       "reflected and lost energy by ratio of spacings and wavelength", "long",
       pulse_table});
} // namespace
} // namespace sabot
