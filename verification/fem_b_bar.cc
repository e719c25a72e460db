// Hexahedra with a mean dilatation: patch test, eigenmodes, bending.
#include "sabot/materials/laws.h"
#include "verification/linear_algebra.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
constexpr double young = 1e9;

HexMesh box(const std::array<double, 3> &size, const double h,
            const double distortion = 0.)
{
  BoxSpecification b;
  b.size = size;
  b.cell_size = h;
  HexMesh mesh = make_graded_box(b);
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-distortion * h,
                                                 distortion * h);
  for (auto &node : mesh.nodes)
    for (double &x : node)
      x += uniform(generator);
  return mesh;
}

FemBody &add(World &world, HexMesh mesh, const double nu,
             const std::string &integration)
{
  FemOptions options;
  options.integration = integration;
  options.hourglass = "stiffness";
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 0, std::move(mesh),
      std::make_shared<Elastic>(ElasticConstants{1000., young, nu}), options));
  world.distribute();
  return static_cast<FemBody &>(*world.bodies[0]);
}

/** Stiffness matrix by central differences of the forces; every displacement
    is taken back, so the stress returns to zero. */
Eigen::MatrixXd stiffness(FemBody &body, const double step)
{
  NodalState &n = body.nodes();
  const std::size_t size = 3 * n.size();
  Eigen::MatrixXd K(size, size);
  const auto move_by = [&](const std::size_t j, const double u)
  {
    n.position[j / 3][j % 3] = n.reference_position[j / 3][j % 3] + u;
    body.compute_forces(0., 1.);
  };
  for (std::size_t j = 0; j < size; ++j)
    for (const double sign : {1., -1.})
    {
      move_by(j, sign * step);
      for (std::size_t i = 0; i < size; ++i)
      {
        const double part = -n.force[i / 3][i % 3] / (2. * step) * sign;
        if (sign > 0.)
          K(i, j) = part;
        else
          K(i, j) += part;
      }
      move_by(j, 0.);
    }
  return 0.5 * (K + K.transpose());
}

std::vector<Check> modes()
{
  std::vector<Check> checks;
  for (const double distortion : {0., 0.15})
  {
    World world;
    FemBody &body =
        add(world, box({{1., 1., 1.}}, 1., distortion), 0.3, "B-bar");
    const Eigen::VectorXd values = symmetric_eigenvalues(stiffness(body, 1e-6));
    int n_zero = 0;
    for (int i = 0; i < values.size(); ++i)
      n_zero += std::abs(values[i]) < 1e-5 * values[values.size() - 1];
    const std::string shape = distortion > 0. ? ", distorted" : ", cube";
    checks.push_back({"modes without energy" + shape, 6., double(n_zero), 0.,
                      "1", "rigid motions only"});
    checks.push_back({"next eigenvalue over E L" + shape, 0.01,
                      values[6] / young, 0., "1", "stiff against hourglassing",
                      Check::Kind::at_least});
    // omega_max^2 = largest eigenvalue of K over the lumped mass at least.
    double lightest = 1e300;
    for (const double m : body.nodes().lumped_mass)
      lightest = std::min(lightest, m);
    checks.push_back(
        {"stable step over 2/omega of the lightest node" + shape, 1.,
         body.stable_step().dt /
             (2. / std::sqrt(values[values.size() - 1] / lightest)),
         1e-6, "1", "a bound of the largest frequency", Check::Kind::at_most});
  }
  return checks;
}

std::vector<Check> patch()
{
  World world;
  FemBody &body = add(world, box({{3., 3., 3.}}, 1., 0.15), 0.3, "B-bar");
  NodalState &n = body.nodes();
  const Mat A = {{vec(1.002, 0.001, -0.002), vec(0.003, 0.999, 0.001),
                  vec(-0.001, 0.002, 1.001)}};
  for (std::size_t i = 0; i < n.size(); ++i)
    n.position[i] = A * n.reference_position[i];
  body.compute_forces(0., 1.);
  double spread = 0., force = 0.;
  for (std::size_t e = 0; e < body.n_local_cells(); ++e)
    for (int c = 0; c < 6; ++c)
      spread =
          std::max(spread, std::abs(body.stress(c, e) - body.stress(c, 0)));
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i];
    if (std::abs(X[0]) < 1. && std::abs(X[1]) < 1. && std::abs(X[2]) < 1.)
      force = std::max(force, norm(n.force[i]));
  }
  const double scale = 2e-3 * young;
  return {{"stress, spread over 0.002 E", 0., spread / scale, 1e-12, "1",
           "uniform strain"},
          {"force on inner nodes over 0.002 E h^2", 0., force / scale, 1e-12,
           "1", "equilibrium"}};
}

/** Tip deflection of a cantilever 8 x 2 x 1, two cells per unit. */
double deflection(const double nu, const std::string &integration)
{
  World world;
  FemBody &body = add(world, box({{8., 2., 1.}}, 0.5), nu, integration);
  const NodalState &n = body.nodes();
  Eigen::MatrixXd K = stiffness(body, 1e-6);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(K.rows());
  double tip_nodes = 0.;
  for (std::size_t i = 0; i < n.size(); ++i)
    tip_nodes += n.reference_position[i][0] > 4. - 1e-9;
  for (std::size_t i = 0; i < n.size(); ++i)
  {
    const Vec X = n.reference_position[i];
    if (X[0] > 4. - 1e-9)
      load[3 * i + 1] = 1. / tip_nodes;
    if (X[0] < -4. + 1e-9)
      for (int d = 0; d < 3; ++d)
        K(3 * i + d, 3 * i + d) += 1e6 * young;
  }
  const Eigen::VectorXd u = solve_symmetric(K, load);
  double mean = 0.;
  for (std::size_t i = 0; i < n.size(); ++i)
    if (n.reference_position[i][0] > 4. - 1e-9)
      mean += u[3 * i + 1] / tip_nodes;
  return mean;
}

std::vector<Check> bending()
{
  // P L^3/(3 E I) + P L/(5/6 G A), I = 1 * 2^3/12.
  const auto theory = [](const double nu)
  {
    return 512. / (3. * young * 8. / 12.) +
           8. / (5. / 6. * young / (2. * (1. + nu)) * 2.);
  };
  const double stiff = deflection(0.3, "B-bar") / theory(0.3),
               soft = deflection(0.4999, "B-bar") / theory(0.4999);
  return {{"tip deflection over beam theory, nu = 0.3", 1., stiff, 0.1, "1",
           "Timoshenko beam; four cells over the height"},
          {"tip deflection over beam theory, nu = 0.4999", 1., soft, 0.1, "1",
           "Timoshenko beam"},
          {"nu = 0.4999 against 0.3", 1., soft / stiff, 0.05, "1",
           "no volumetric locking"}};
}

const RegisterProblem a({"fem-b-bar-modes", "eigenmodes of a B-bar cell",
                         "quick", modes}),
    b({"fem-b-bar-patch", "linear field on distorted B-bar cells", "quick",
       patch}),
    c({"fem-b-bar-bending", "bending of a nearly incompressible beam", "quick",
       bending});
} // namespace
} // namespace sabot
