// Patch test of a perturbed cloud of particles.
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
/** A linear displacement on a perturbed cloud: uniform stress, no force inside,
    for any approximation and stabilization. */
std::vector<Check> spg_patch()
{
  World world;
  const double h = 1e-3;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, perturbed_cloud({{7e-3, 7e-3, 7e-3}}, h, 0.2), elastic(),
      SpgOptions()));
  world.distribute();
  auto &body = static_cast<SpgBody &>(*world.bodies[0]);
  Mat A = Mat::identity();
  A.row[0] += vec(1e-3, 2e-3, -1e-3);
  A.row[1] += vec(-2e-3, 0.5e-3, 1e-3);
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.size(); ++i)
    n.position[i] = A * n.reference_position[i];
  body.update_ghosts();
  body.compute_forces(0., 1e-8);
  double gradient_error = 0., largest[6], smallest[6];
  for (int c = 0; c < 6; ++c)
    largest[c] = smallest[c] = body.stress(c, 0);
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Mat F = body.rooms().fields.deformation_gradient(i);
    for (int c = 0; c < 3; ++c)
      gradient_error = std::max(gradient_error, norm(F.row[c] - A.row[c]));
    for (int c = 0; c < 6; ++c)
    {
      largest[c] = std::max(largest[c], body.stress(c, i));
      smallest[c] = std::min(smallest[c], body.stress(c, i));
    }
  }
  double spread = 0., size = 0.;
  for (int c = 0; c < 6; ++c)
  {
    spread = std::max(spread, largest[c] - smallest[c]);
    size = std::max(size, std::abs(largest[c]));
  }
  return {{"deformation gradient, largest error", 0., gradient_error, 1e-12,
           "1", "linear completeness"},
          {"stress, largest relative spread", 0., spread / size, 1e-10, "1",
           "uniform strain"}};
}

const RegisterProblem registered({"spg-patch",
                                  "linear field on a perturbed cloud", "quick",
                                  spg_patch});
} // namespace
} // namespace sabot
