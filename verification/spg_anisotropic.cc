// Whether the stabilization sees the sawtooth of a cloud whose spacing differs
// by axis, as that of a cloud that has been flattened does.
#include "verification/problem.h"
#include "verification/world.h"

#include <cmath>
#include <cstdio>

namespace sabot
{
namespace
{
/** Rayleigh quotient of the windowed sawtooth along @p axis with the motion
    along @p along in a block of 9 particles per edge, spacing @p h
    [c^2/h_axis^2]. */
double sawtooth(const std::array<double, 3> &h, const int axis, const int along)
{
  constexpr int n = 9;
  SpgOptions options;
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  const auto material = elastic(0.33);
  std::array<double, 3> L;
  for (int d = 0; d < 3; ++d)
    L[d] = (n - 1) * h[d];
  World world;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, make_box_cloud({{0, 0, 0}}, L, h), material, options));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &nodes = body.nodes();
  const double amplitude = 1e-7 * h[axis];
  std::vector<double> u(nodes.n_owned);
  double norm = 0., work = 0.;
  const AlignedVector<Vec> start = nodes.position;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    u[i] = 1.;
    for (int d = 0; d < 3; ++d)
      u[i] *= std::pow(std::cos(M_PI * start[i][d] / (L[d] + h[d])), 2);
    if (std::lround((start[i][axis] + 0.5 * L[axis]) / h[axis]) % 2)
      u[i] = -u[i];
    norm += nodes.lumped_mass[i] * u[i] * u[i];
  }
  for (const double sign : {1., -1.})
  {
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      nodes.position[i] = start[i];
      nodes.position[i][along] += sign * amplitude * u[i];
    }
    body.update_ghosts();
    body.compute_forces(0., 1e-9);
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
      work -= sign * nodes.force[i][along] * u[i] / (2. * amplitude);
  }
  return work / norm * std::pow(h[axis] / material->sound_speed(), 2);
}

std::vector<Check> anisotropic()
{
  // The flatter the cloud, the more the sawtooth along the short axis is left
  // to the two bonds along it: e = 2 u in alpha mu V w |e|^2/(h^2 sum w) with
  // w = phi xi^2, of which these two have the part 0.1773 at the support 2,
  // makes 4 alpha 0.1773 mu/rho/h^2. All else only adds to it.
  const auto material = elastic(0.33);
  const double c = material->sound_speed(),
               least = 16. * 0.1773 * material->shear_modulus() /
                       (material->density() * c * c);
  std::vector<Check> checks;
  const char *const axes = "xyz";
  for (const double ratio : {1., 2., 5., 10.})
    for (const int axis : {0, 2})
      for (const int along : {0, 2})
      {
        const double h = 1e-3;
        char name[80];
        std::snprintf(name, sizeof(name),
                      "spacing %g:%g:1, sawtooth along %c, motion along %c",
                      ratio, ratio, axes[axis], axes[along]);
        checks.push_back({name, least,
                          sawtooth({{ratio * h, ratio * h, h}}, axis, along),
                          0.01, "c2/h2", "the axis's two bonds alone",
                          Check::Kind::at_least});
      }
  return checks;
}

const RegisterProblem registered(
    {"spg-anisotropic", "sawtooth of a block whose spacing differs by axis",
     "quick", anisotropic});
} // namespace
} // namespace sabot
