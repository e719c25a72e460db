// One-point hexahedra: patch test and hourglass modes.
#include "sabot/materials/laws.h"
#include "verification/linear_algebra.h"
#include "verification/meshes.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
constexpr double young = 1e9, edge = 1.;

/** @p n cells of 1 m per edge about the origin, their nodes moved by up to
    @p distortion, those of the boundary as well. */
HexMesh distorted(const unsigned int n, const double distortion)
{
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-distortion, distortion);
  return mapped_cube(n, -0.5 * n * edge, 0.5 * n * edge,
                     [&](const MeshPoint &x)
                     {
                       // One after the other, so that the order is fixed.
                       MeshPoint moved = x;
                       for (double &coordinate : moved)
                         coordinate += uniform(generator);
                       return moved;
                     });
}

FemBody &add(World &world, const HexMesh &mesh, const FemOptions &options)
{
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 0, mesh,
      std::make_shared<Elastic>(ElasticConstants{1000., young, 0.3}), options));
  world.distribute();
  return static_cast<FemBody &>(*world.bodies[0]);
}

FemOptions inviscid(const std::string &control)
{
  FemOptions o;
  o.hourglass = control;
  o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
  return o;
}

std::vector<Check> patch()
{
  std::vector<Check> checks;
  for (const std::string control : {"viscous", "stiffness"})
  {
    World world;
    FemBody &body = add(world, distorted(4, 0.2), inviscid(control));
    NodalState &n = body.nodes();
    const Mat A = {{vec(1.002, 0.001, -0.002), vec(0.003, 0.999, 0.001),
                    vec(-0.001, 0.002, 1.001)}};
    for (std::size_t i = 0; i < n.size(); ++i)
    {
      n.position[i] = A * n.reference_position[i];
      n.velocity[i] = n.position[i] - n.reference_position[i];
    }
    body.compute_forces(0., 1.);
    double spread = 0., force = 0.;
    for (std::size_t e = 0; e < body.n_local_cells(); ++e)
      for (int c = 0; c < 6; ++c)
        spread =
            std::max(spread, std::abs(body.stress(c, e) - body.stress(c, 0)));
    int n_inside = 0;
    for (std::size_t i = 0; i < n.n_owned; ++i)
    {
      const Vec X = n.reference_position[i];
      if (std::abs(X[0]) < 1.5 && std::abs(X[1]) < 1.5 && std::abs(X[2]) < 1.5)
      {
        ++n_inside;
        force = std::max(force, norm(n.force[i]));
      }
    }
    const double scale = 2e-3 * young;
    const std::string who =
        control == "viscous" ? "viscous control: " : "stiffness control: ";
    checks.push_back({who + "inner nodes", 27., double(n_inside), 0., "1",
                      "a block of 4 cells per edge"});
    checks.push_back({who + "stress, spread over 0.002 E", 0., spread / scale,
                      1e-11, "1", "uniform strain"});
    checks.push_back({who + "force on inner nodes over 0.002 E h^2", 0.,
                      force / scale, 1e-11, "1", "equilibrium"});
    checks.push_back({who + "hourglass energy over 0.002^2 E h^3", 0.,
                      measure(body, "hourglass energy") / (scale * 2e-3), 1e-11,
                      "1", "a linear field has none"});
  }
  return checks;
}

/** Eigenvalues of the stiffness (of the damping with viscous control) of one
    cell, by central differences. */
Eigen::VectorXd spectrum(const HexMesh &mesh, const FemOptions &options,
                         const bool of_damping)
{
  World world;
  FemBody &body = add(world, mesh, options);
  NodalState &n = body.nodes();
  Eigen::MatrixXd K(24, 24);
  const double step = 1e-6;
  for (int j = 0; j < 24; ++j)
    for (const double sign : {1., -1.})
    {
      double &x = of_damping
                      ? reinterpret_cast<double *>(&n.velocity[j / 3])[j % 3]
                      : reinterpret_cast<double *>(&n.position[j / 3])[j % 3];
      const double x0 = x;
      x = x0 + sign * step;
      body.compute_forces(0., 1.);
      for (int i = 0; i < 24; ++i)
        K(i, j) = (sign > 0. ? 0. : K(i, j)) -
                  sign * n.force[i / 3][i % 3] / (2. * step);
      x = x0;
      body.compute_forces(0., 1.);
    }
  return symmetric_eigenvalues(0.5 * (K + K.transpose()));
}

int n_zero(const Eigen::VectorXd &values)
{
  int n = 0;
  for (int i = 0; i < values.size(); ++i)
    n += std::abs(values[i]) < 1e-6 * values[values.size() - 1];
  return n;
}

std::vector<Check> modes()
{
  std::vector<Check> checks;
  for (const double distortion : {0., 0.15})
  {
    const HexMesh cell = distorted(1, distortion);
    const std::string shape = distortion > 0. ? ", distorted" : ", cube";
    FemOptions none = inviscid("stiffness");
    none.hourglass_coefficient = 0.;
    checks.push_back({"modes without energy, no control" + shape, 18.,
                      double(n_zero(spectrum(cell, none, false))), 0., "1",
                      "6 rigid and 12 hourglass modes"});
    const Eigen::VectorXd held = spectrum(cell, inviscid("stiffness"), false);
    checks.push_back({"modes without energy, stiffness control" + shape, 6.,
                      double(n_zero(held)), 0., "1", "rigid motions only"});
    // gamma of the cube is h, |h|^2 = 8: eigenvalue k |h|^2 = kappa rho c^2 L.
    const double modulus = young * 0.7 / (1.3 * 0.4);
    if (distortion == 0.)
      checks.push_back({"eigenvalue of hourglass modes over kappa rho c^2 L",
                        1., held[6] / (0.1 * modulus * edge), 1e-6, "1",
                        "k |h|^2, k = kappa/8 rho c^2 L"});
    const Eigen::VectorXd damped = spectrum(cell, inviscid("viscous"), true);
    checks.push_back({"modes with damping, viscous control" + shape, 12.,
                      double(24 - n_zero(damped)), 0., "1",
                      "the hourglass modes and no other"});
  }
  return checks;
}

const RegisterProblem a({"fem-patch", "linear field on distorted cells",
                         "quick", patch}),
    b({"fem-hourglass", "modes of a one-point cell with and without control",
       "quick", modes});
} // namespace
} // namespace sabot
