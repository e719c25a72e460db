// Spectra of a free block of particles against Rayleigh-Ritz.
#include "sabot/base/choice.h"
#include "verification/free_block.h"
#include "verification/linear_algebra.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
struct Modes
{
  Eigen::VectorXd omega; // [rad/s], ascending
  double sawtooth[3];    // Rayleigh quotients of x, xy, xyz [c^2/h^2]
  double largest_h_over_c;
  double asymmetry; // of the stiffness, relative
};

/** Stiffness of a free block by central differences of the production force
    loop, and its spectrum. */
Modes modes_of(SpgOptions options, const double nu, const int n,
               const double perturbation)
{
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  const double h = 1e-3;
  World world;
  const double L = (n - 1) * h;
  // Faces stay plane: the exact answer is that of a cube.
  ParticleCloud cloud = make_box_cloud({{0, 0, 0}}, {{L, L, L}}, h);
  const ParticleCloud moved = perturbed_cloud({{L, L, L}}, h, perturbation);
  for (std::size_t i = 0; i < cloud.position.size(); ++i)
    for (int d = 0; d < 3; ++d)
      if (!(cloud.on_face[i] >> (2 * d) & 3))
        cloud.position[i][d] = moved.position[i][d];
  const std::vector<std::array<double, 3>> lattice =
      make_box_cloud({{0, 0, 0}}, {{L, L, L}}, h).position;
  const auto material = elastic(nu);
  world.bodies.push_back(
      std::make_unique<SpgBody>("block", 0, cloud, material, options));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &nodes = body.nodes();
  const int size = 3 * nodes.n_owned;
  Eigen::MatrixXd K(size, size);
  const double delta = 1e-7 * h, dt = 1e-9;
  const auto forces = [&](Eigen::VectorXd &f)
  {
    body.update_ghosts();
    body.compute_forces(0., dt);
    for (int i = 0; i < size; ++i)
      f[i] = nodes.force[i / 3][i % 3];
  };
  Eigen::VectorXd plus(size), minus(size), zero(size);
  for (int i = 0; i < size; ++i)
  {
    double &x = reinterpret_cast<double *>(&nodes.position[i / 3])[i % 3];
    const double x0 = x;
    x = x0 + delta;
    forces(plus);
    x = x0 - delta;
    forces(minus);
    x = x0;
    forces(zero);
    K.col(i) = -(plus - minus) / (2. * delta);
  }
  Modes m;
  m.asymmetry = (K - K.transpose()).norm() / K.norm();
  Eigen::VectorXd mass(size);
  for (int i = 0; i < size; ++i)
    mass[i] = nodes.lumped_mass[i / 3];

  const double c = material->sound_speed();
  for (int pattern = 0; pattern < 3; ++pattern)
  {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(size);
    for (int i = 0; i < size / 3; ++i)
    {
      double value = 1.;
      for (int d = 0; d < 3; ++d)
      {
        const double x = lattice[nodes.global_id[i]][d];
        const int index = std::lround((x + 0.5 * L) / h);
        value *= std::pow(std::cos(M_PI * x / (L + h)), 2);
        if (d <= pattern && index % 2)
          value = -value;
      }
      u[3 * i] = value;
    }
    m.sawtooth[pattern] =
        u.dot(K * u) / u.dot(mass.asDiagonal() * u) / (c * c / (h * h));
  }
  const Eigen::VectorXd root = mass.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd A =
      root.asDiagonal() * (0.5 * (K + K.transpose())) * root.asDiagonal();
  m.omega = symmetric_eigenvalues(A).cwiseMax(0.).cwiseSqrt();
  m.largest_h_over_c = m.omega[size - 1] * h / c;
  return m;
}

struct Form
{
  std::string name;
  SpgOptions options;
};

std::vector<double> exact_frequencies(const double nu, const int n)
{
  const auto material = elastic(nu);
  const double mu = material->shear_modulus();
  return free_cube_frequencies((n - 1) * 1e-3, material->density(),
                               material->bulk_modulus() - 2. / 3. * mu, mu, 10);
}

/** Checks of one form; @p judged: with verdicts, else measurements. */
void add_checks(std::vector<Check> &checks, const Form &form, const double nu,
                const int n, const double perturbation, const bool judged)
{
  const std::vector<double> exact = exact_frequencies(nu, n);
  const Modes m = modes_of(form.options, nu, n, perturbation);
  const auto kind = [&](const Check::Kind k)
  { return judged ? k : Check::Kind::reported; };
  char where[64];
  std::snprintf(where, sizeof(where), "%s, nu %g, %gh: ", form.name.c_str(), nu,
                perturbation);
  const std::string source = "Rayleigh-Ritz of the free cube";
  const int n_low = 12; // elastic modes compared
  double low = 1e300, high = 0.;
  for (int i = 6; i < 6 + n_low; ++i)
  {
    low = std::min(low, m.omega[i] / exact[i]);
    high = std::max(high, m.omega[i] / exact[i]);
  }
  checks.push_back({where + std::string("lowest f/exact of 12"), 1., low, 0.05,
                    "1", source, kind(Check::Kind::near)});
  checks.push_back({where + std::string("highest f/exact of 12"), 1., high,
                    0.05, "1", source, kind(Check::Kind::near)});
  const double limit = exact[66];
  const int below = (m.omega.array() < limit).count();
  checks.push_back({where + std::string("modes below the 67th exact"), 67.5,
                    double(below), 7.5, "1", source, kind(Check::Kind::near)});
  const char *const patterns[] = {"x", "xy", "xyz"};
  for (int p = 0; p < 3; ++p)
    checks.push_back({where + std::string("sawtooth ") + patterns[p], 1.5,
                      m.sawtooth[p], 0., "c2/h2", "4 for lumped hexahedra",
                      kind(Check::Kind::at_least)});
  checks.push_back({where + std::string("largest frequency"), 0.,
                    m.largest_h_over_c, 0., "c/h", "", Check::Kind::reported});
  checks.push_back({where + std::string("stiffness asymmetry"), 0., m.asymmetry,
                    1e-6, "1", "conservative forces", Check::Kind::near});
}

SpgOptions convex(const std::string &s)
{
  SpgOptions o;
  o.approximation = SpgOptions::Approximation::convex_exponential;
  o.kernel_shape = SpgOptions::KernelShape::tensor;
  o.normalized_support = 1.5;
  o.stabilization = choose<Stabilization>(s);
  return o;
}

SpgOptions least_squares(const std::string &s)
{
  SpgOptions o;
  o.stabilization = choose<Stabilization>(s);
  return o;
}

std::vector<Check> spg_modes_default()
{
  std::vector<Check> checks;
  add_checks(checks, {"default", SpgOptions()}, 0.33, 7, 0.2, true);
  add_checks(checks, {"none", least_squares("none")}, 0.33, 5, 0.2, false);
  return checks;
}

std::vector<Check> spg_modes()
{
  std::vector<Check> checks;
  for (const double perturbation : {0., 0.2})
  {
    // On the uniform lattice the default misses two of the bounds by little
    // (doc/theory-spg.md): measured, not judged.
    add_checks(checks, {"default", SpgOptions()}, 0.33, 7, perturbation,
               perturbation > 0.);
    SpgOptions wide = convex("bond residual");
    wide.normalized_support = 1.8;
    add_checks(checks, {"convex 1.8, bond residual", wide}, 0.33, 7,
               perturbation, true);
    add_checks(checks, {"LS, none", least_squares("none")}, 0.33, 7,
               perturbation, false);
    add_checks(checks, {"convex 1.5, bond residual", convex("bond residual")},
               0.33, 7, perturbation, false);
    add_checks(checks,
               {"convex 1.5, second gradient", convex("second gradient")}, 0.33,
               7, perturbation, false);
    add_checks(checks, {"convex 1.5, none", convex("none")}, 0.33, 7,
               perturbation, false);
  }
  return checks;
}

std::vector<Check> spg_incompressible()
{
  // Without locking the ratios stay near one; the second gradient form, which
  // contains the bulk modulus, locks.
  std::vector<Check> checks;
  for (const auto &form :
       {Form{"default", SpgOptions()},
        Form{"convex 1.5, second gradient", convex("second gradient")}})
  {
    const std::vector<double> exact = exact_frequencies(0.4999, 7);
    const Modes m = modes_of(form.options, 0.4999, 7, 0.2);
    double low = 1e300, high = 0.;
    for (int i = 6; i < 18; ++i)
    {
      low = std::min(low, m.omega[i] / exact[i]);
      high = std::max(high, m.omega[i] / exact[i]);
    }
    const bool is_default = form.name == "default";
    const auto kind = is_default ? Check::Kind::near : Check::Kind::reported;
    checks.push_back({form.name + ": lowest f/exact of 12", 1., low, 0.07, "1",
                      "Rayleigh-Ritz, nu 0.4999", kind});
    checks.push_back({form.name + ": highest f/exact of 12", 1., high, 0.07,
                      "1", "Rayleigh-Ritz, nu 0.4999", kind});
  }
  return checks;
}

const RegisterProblem
    quick({"spg-modes-default",
           "spectrum of a free block, default and unstabilized", "quick",
           spg_modes_default}),
    all({"spg-modes", "spectrum of a free block, all stabilizations", "long",
         spg_modes}),
    locking({"spg-incompressible", "frequencies of a block at nu 0.4999",
             "long", spg_incompressible});
} // namespace
} // namespace sabot
