// Static bending of a nearly incompressible beam of particles.
#include "sabot/materials/laws.h"
#include "verification/linear_algebra.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
constexpr double young = 1e9;

/** Tip deflection of a cantilever 8 x 2 x 1 m of particles under a unit force:
    the stiffness matrix by central differences of the production force loop,
    then solved. */
double deflection(const double nu, const double spacing)
{
  SpgOptions options;
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  World world;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "beam", 0, make_box_cloud({{0, 0, 0}}, {{8., 2., 1.}}, spacing),
      std::make_shared<Elastic>(ElasticConstants{1000., young, nu}), options));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &n = body.nodes();
  const int size = 3 * n.n_owned;
  Eigen::MatrixXd K(size, size);
  Eigen::VectorXd plus(size), minus(size);
  const double delta = 1e-6;
  const auto forces = [&](Eigen::VectorXd *const f)
  {
    body.update_ghosts();
    body.compute_forces(0., 1.);
    if (f)
      for (int i = 0; i < size; ++i)
        (*f)[i] = n.force[i / 3][i % 3];
  };
  for (int j = 0; j < size; ++j)
  {
    double &x = reinterpret_cast<double *>(&n.position[j / 3])[j % 3];
    const double x0 = x;
    x = x0 + delta;
    forces(&plus);
    x = x0 - delta;
    forces(&minus);
    x = x0; // the stress goes back to zero
    forces(nullptr);
    K.col(j) = -(plus - minus) / (2. * delta);
  }
  K = 0.5 * (K + K.transpose()).eval();
  // The end's load by the particles' shares of the face.
  Eigen::VectorXd load = Eigen::VectorXd::Zero(size);
  double area = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (n.reference_position[i][0] > 4. - 1e-9)
      area += n.lumped_mass[i];
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i];
    if (X[0] > 4. - 1e-9)
      load[3 * i + 1] = n.lumped_mass[i] / area;
    if (X[0] < -4. + 1e-9)
      for (int d = 0; d < 3; ++d)
        K(3 * i + d, 3 * i + d) += 1e6 * young;
  }
  const Eigen::VectorXd u = solve_symmetric(K, load);
  return u.dot(load);
}

/** P L^3/(3 E I) + P L/(5/6 G A), I = 1 * 2^3/12. */
double beam_theory(const double nu)
{
  return 512. / (3. * young * 8. / 12.) +
         8. / (5. / 6. * young / (2. * (1. + nu)) * 2.);
}

std::vector<Check> bending()
{
  const auto ratio = [](const double nu, const double spacing)
  { return deflection(nu, spacing) / beam_theory(nu); };
  const double coarse = ratio(0.3, 1. / 2.), fine = ratio(0.3, 1. / 3.),
               soft_coarse = ratio(0.4999, 1. / 2.),
               soft_fine = ratio(0.4999, 1. / 3.);
  // Second order over a ratio of spacings of 1.5.
  const auto limit = [](const double c, const double f)
  { return f + (f - c) / (1.5 * 1.5 - 1.); };
  return {{"nu 0.3, 4 spacings over the height: deflection over theory", 1.,
           coarse, 0., "1", "Timoshenko beam", Check::Kind::reported},
          {"nu 0.3, 6 spacings: deflection over theory", 1., fine, 0.15, "1",
           "Timoshenko beam"},
          {"nu 0.3: extrapolated by second order", 1., limit(coarse, fine),
           0.05, "1", "Timoshenko beam"},
          {"nu 0.4999, 4 spacings: deflection over theory", 1., soft_coarse, 0.,
           "1", "Timoshenko beam", Check::Kind::reported},
          {"nu 0.4999, 6 spacings: deflection over theory", 1., soft_fine, 0.,
           "1", "Timoshenko beam", Check::Kind::reported},
          {"nu 0.4999: extrapolated by second order", 1.,
           limit(soft_coarse, soft_fine), 0.1, "1",
           "Timoshenko beam; the foot is held across, too"},
          {"nu 0.4999 against 0.3, 6 spacings", 1., soft_fine / fine, 0.1, "1",
           "no volumetric locking"}};
}

const RegisterProblem
    registered({"spg-bending",
                "static bending of a nearly incompressible beam of particles",
                "extremes long", bending});
} // namespace
} // namespace sabot
