// The averaged measure of failure against the exact profile of the gradient
// form.
#include "verification/problem.h"
#include "verification/world.h"

#include <cmath>

namespace sabot
{
namespace
{
/** How far beyond x = 0 metal crumbles when half a bar (x < 0) has a strain of
   1 and all is stretched: where m_bar has fallen to the critical value. */
double front(const double h, const std::optional<double> &length,
             const double critical)
{
  World world;
  SpgOptions options;
  options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
  options.failure_check_interval = 1;
  options.set_critical_plastic_strain(critical);
  options.nonlocal_length = length;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "bar", 0, make_box_cloud({{0., 0., 0.}}, {{40e-3, 3e-3, 3e-3}}, h),
      hardening_aluminum(), options));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i];
    // A particle at x = 0 stands for both sides.
    body.rooms().points.state("effective plastic strain")[i] =
        std::abs(X[0]) < 0.1 * h ? 0.5
        : X[0] < 0.              ? 1.
                                 : 0.;
    n.position[i] = 1.0001 * X;
  }
  body.update_ghosts();
  body.compute_forces(0., 1e-9);
  body.update_topology(1, 0.);
  double last = -1.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
    if (body.rooms().failure.has_crumbled(i))
      last = std::max(last, n.reference_position[i][0]);
  return last;
}

std::vector<Check> nonlocal()
{
  std::vector<Check> checks;
  for (const double h : {1e-3, 0.5e-3})
    for (const double length : {2e-3, 4e-3})
      for (const double critical : {0.1, 0.2, 0.4})
      {
        char text[80];
        std::snprintf(text, sizeof(text),
                      "%g mm, length %g mm, critical %g: front", 1e3 * h,
                      1e3 * length, critical);
        // 1/2 exp(-x/l) = critical; the last particle is up to h before it.
        const double exact = length * std::log(0.5 / critical),
                     got = front(h, length, critical);
        checks.push_back(
            {text, exact - 0.5 * h, got, 0.6 * h, "m", "l ln(1/(2 critical))"});
      }
  checks.push_back({"1 mm, no length, critical 0.4: front", 0.,
                    front(1e-3, std::nullopt, 0.4), 1e-6, "m",
                    "where the strain is"});
  return checks;
}

const RegisterProblem a({"spg-nonlocal",
                         "how far an averaged measure of failure reaches",
                         "quick", nonlocal});
} // namespace
} // namespace sabot
