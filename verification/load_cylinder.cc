// A thick cylinder under internal pressure: Lame's solution in plane strain.
#include "sabot/geometry/mesh_extraction.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>

namespace sabot
{
namespace
{
constexpr double inner = 10e-3, outer = 20e-3, pressure = 1e6;

/** A quarter of a ring about z, @p n cells thick and one high. Boundary ids: 0
    inner, 1 outer face, 2 to 5 planes of symmetry. */
HexMesh make_ring(const unsigned int n)
{
  dealii::Triangulation<3> mesh;
  const double height = (outer - inner) / n;
  dealii::GridGenerator::subdivided_hyper_rectangle(
      mesh, {n, 2 * n, 1}, dealii::Point<3>(inner, 0., 0.),
      dealii::Point<3>(outer, 0.5 * M_PI, height), true);
  dealii::GridTools::transform(
      [](const dealii::Point<3> &p)
      {
        return dealii::Point<3>(p[0] * std::cos(p[1]), p[0] * std::sin(p[1]),
                                p[2]);
      },
      mesh);
  return extract_mesh(mesh);
}

/** Mean radial displacement of the nodes at a radius of the start [m]. */
double displacement(const Body &body, const double radius)
{
  const NodalState &n = body.nodes();
  double sum = 0.;
  int count = 0;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i], x = n.position[i];
    if (std::abs(std::hypot(X[0], X[1]) - radius) > 1e-6)
      continue;
    sum += std::hypot(x[0], x[1]) - radius;
    ++count;
  }
  return sum / count;
}

struct Settled
{
  double inner, outer; // radial displacement [m]
  /** Root of the mean square error of the hoop stress in the middle of cells
      [Pa]; 0 for particles. */
  double stress_error;
};

double lame_hoop_stress(const double r)
{
  return pressure / (outer * outer / (inner * inner) - 1.) *
         (1. + outer * outer / (r * r));
}

/** Hoop stresses in the middle of the cells [Pa]. */
std::vector<double> hoop_stresses(const FemBody &body)
{
  std::vector<double> stresses;
  const std::vector<MaterialSite> sites = body.material_sites();
  for (std::size_t e = 0; e < sites.size(); ++e)
  {
    const auto &x = sites[e].reference_position;
    const double angle = std::atan2(x[1], x[0]), c = std::cos(angle),
                 s = std::sin(angle);
    stresses.push_back(s * s * body.stress(0, e) + c * c * body.stress(1, e) -
                       2. * s * c * body.stress(3, e));
  }
  return stresses;
}

/** Raised so slowly that the ring hardly swings, then averaged over some
    periods. */
Settled settle(World &world)
{
  // The ring's breathing takes about 2 pi r/c = 17 us.
  const double ramp = 300e-6, end = 370e-6;
  std::string times, factors;
  for (int k = 0; k <= 60; ++k)
  {
    const char *const comma = k == 0 ? "" : ", ";
    times += comma + std::to_string(1e6 * ramp * k / 60.) + " us";
    factors += comma + std::to_string(0.5 - 0.5 * std::cos(M_PI * k / 60.));
  }
  // Strains of 4e-5: small against what is compared.
  world.add_load("pressure", {{"Body", "ring"},
                              {"Faces", "0"},
                              {"Pressure", "1 MPa"},
                              {"Course", "table"},
                              {"Times", times},
                              {"Factors", factors}});
  world.distribute();
  world.stepper.initialize();
  const auto *const ring = dynamic_cast<const FemBody *>(world.bodies[0].get());
  Settled mean{0., 0., 0.};
  double weight = 0.;
  std::vector<double> hoop(ring ? ring->material_sites().size() : 0, 0.);
  while (world.stepper.time() < end)
  {
    const double dt = world.advance(0.9);
    if (world.stepper.time() < ramp)
      continue;
    mean.inner += dt * displacement(*world.bodies[0], inner);
    mean.outer += dt * displacement(*world.bodies[0], outer);
    weight += dt;
    if (!ring)
      continue;
    const std::vector<double> now = hoop_stresses(*ring);
    for (std::size_t e = 0; e < hoop.size(); ++e)
      hoop[e] += dt * now[e];
  }
  for (std::size_t e = 0; e < hoop.size(); ++e)
  {
    const auto x = ring->material_sites()[e].reference_position;
    mean.stress_error += std::pow(
        hoop[e] / weight - lame_hoop_stress(std::hypot(x[0], x[1])), 2);
  }
  if (ring)
    mean.stress_error = std::sqrt(mean.stress_error / hoop.size());
  mean.inner /= weight;
  mean.outer /= weight;
  return mean;
}

double lame_displacement(const double r)
{
  const double E = aluminum().young_modulus, nu = 0.33;
  return (1. + nu) / E * pressure / (outer * outer / (inner * inner) - 1.) *
         ((1. - 2. * nu) * r + outer * outer / r);
}

std::vector<Check> pressurized_cylinder()
{
  const std::string source = "Lame, plane strain";
  std::vector<Check> checks;
  Settled settled[3];
  const unsigned int n_cells[3] = {4, 8, 16};
  for (int k = 0; k < 3; ++k)
  {
    World world;
    FemOptions options;
    options.symmetry_boundary_ids = {2, 3, 4, 5};
    world.bodies.push_back(std::make_unique<FemBody>(
        "ring", 0, make_ring(n_cells[k]), elastic(0.33), options));
    settled[k] = settle(world);
    checks.push_back({std::to_string(n_cells[k]) +
                          " cells: error of the hoop stress over the pressure",
                      0., settled[k].stress_error / pressure, 0., "1", source,
                      Check::Kind::reported});
  }
  checks.push_back({"16 cells: that error", 0.,
                    settled[2].stress_error / pressure, 5e-4, "1", source});
  checks.push_back({"error of 8 over that of 16 cells", 3.5,
                    settled[1].stress_error / settled[2].stress_error, 0., "1",
                    "4 of second order", Check::Kind::at_least});
  checks.push_back({"16 cells: inner displacement over Lame's", 1.,
                    settled[2].inner / lame_displacement(inner), 2e-3, "1",
                    source});
  checks.push_back({"16 cells: outer displacement over Lame's", 1.,
                    settled[2].outer / lame_displacement(outer), 2e-3, "1",
                    source});
  World world;
  SpgOptions options;
  options.symmetry_faces = 0b111100;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "ring", 0, make_mesh_cloud(make_ring(8)), elastic(0.33), options));
  const Settled particles = settle(world);
  checks.push_back({"particles: inner displacement over Lame's", 1.,
                    particles.inner / lame_displacement(inner), 0.02, "1",
                    source});
  checks.push_back({"particles: outer displacement over Lame's", 1.,
                    particles.outer / lame_displacement(outer), 0.02, "1",
                    source});
  return checks;
}

const RegisterProblem registered({"load-pressurized-cylinder",
                                  "Lame's cylinder under internal pressure",
                                  "quick", pressurized_cylinder});
} // namespace
} // namespace sabot
