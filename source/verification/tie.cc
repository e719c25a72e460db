#include "sabot/couplings/tie.h"
#include "sabot/geometry/mesh_extraction.h"
#include "sabot/verification/problem.h"
#include "sabot/verification/world.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

namespace sabot
{
namespace
{
constexpr double rho = 2700., E = 68.9e9, nu = 0.33;
const double wave_speed =
    std::sqrt(E * (1. - nu) / ((1. + nu) * (1. - 2. * nu) * rho));
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
  return e.kinetic.value() + e.internal.value() + e.stabilization.value() +
         e.hourglass.value();
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
  const double length = n_coarse * coarse, period = length / wave_speed;
  const double before = 3. * length, behind = 4.5 * length;
  World world;
  BoxSpecification box;
  box.cell_size = coarse;
  const double cells = from_particles ? behind : before,
               cloud = from_particles ? before : behind;
  box.size = {{cells, coarse, coarse}};
  box.centre = {{-0.5 * cells, 0., 0.}};
  FemOptions fem;
  fem.bulk_viscosity_linear = fem.bulk_viscosity_quadratic = 0.;
  fem.symmetry_boundary_ids = {2, 3, 4, 5};
  SpgOptions spg;
  spg.bulk_viscosity_linear = spg.bulk_viscosity_quadratic = 0.;
  spg.symmetry_faces = 4 + 8 + 16 + 32;
  const double far = 1e3; // no end there
  world.bodies.push_back(std::make_unique<Driven<FemBody>>(
      from_particles ? far : -before, period, "cells", 0, make_graded_box(box),
      elastic(nu), fem));
  world.bodies.push_back(std::make_unique<Driven<SpgBody>>(
      from_particles ? before : far, period, "particles", 1,
      make_box_cloud({{0.5 * cloud, 0., 0.}}, {{cloud, coarse, coarse}},
                     coarse / ratio),
      elastic(nu), spg));
  world.couplings.push_back(std::make_unique<Tie>("tie", world.pointers(), 1, 0,
                                                  0.05, MPI_COMM_WORLD));
  world.distribute();
  world.integrator.initialize();
  while (world.integrator.time < 2. * period)
    world.advance(0.9);
  const double sent = world.total_energy();
  // The slowest part has crossed, and no reflection has come back twice.
  while (world.integrator.time < 1.4 * (2. * length + before) / wave_speed)
    world.advance(0.9);
  EnergyLedger ledger;
  world.couplings[0]->add_energies(ledger);
  return {energy_of(*world.bodies[from_particles]) / sent,
          1. - world.total_energy() / sent, ledger.tie.value() / sent};
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
  dealii::Triangulation<3> grid;
  const unsigned int n = std::lround(6e-3 / cell);
  dealii::GridGenerator::subdivided_hyper_rectangle(
      grid, {n, 2 * n, 2 * n}, {-6e-3, -6e-3, -6e-3}, {0., 6e-3, 6e-3});
  dealii::GridTools::transform(
      [&](const dealii::Point<3> &x)
      {
        std::array<double, 3> p{{x[0], x[1], x[2]}};
        bend(p);
        return dealii::Point<3>(p[0], p[1], p[2]);
      },
      grid);
  const HexMesh mesh = extract_mesh(grid);
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
      // A bent interface is curved for the particles, faceted for the cells:
      // exact where they share their nodes.
      const bool is_exact = sag == 0. || cell == 1e-3;
      const auto kind = is_exact ? Check::Kind::near : Check::Kind::reported;
      checks.push_back({std::string(where) + "motion of followers", 0.,
                        p.follower, 1e-12, "1", "linear field, per spacing",
                        kind});
      checks.push_back({std::string(where) + "stress of particles", 0.,
                        p.stress, 1e-9, "1", "uniform stress", kind});
      // Followers at the corners of the faces sum to the exact nodal forces.
      const bool is_nested = sag == 0. && (cell == 1e-3 || cell == 2e-3);
      checks.push_back({std::string(where) + "force left at the interface", 0.,
                        p.force, 1e-9, "1", "uniform stress: zero",
                        is_nested ? Check::Kind::near : Check::Kind::reported});
    }
  return checks;
}

const RegisterProblem a({"tie-pulse",
                         "energy that a tie of ratio 1:2 reflects and loses",
                         "quick", pulse}),
    b({"tie-linear", "linear field across flat and curved ties", "quick",
       linear}),
    c({"tie-pulse-table",
       "reflected and lost energy by ratio of spacings and wavelength", "long",
       pulse_table});
} // namespace
} // namespace sabot
