#ifndef benchmarks_law_batch_h
#define benchmarks_law_batch_h

#include "sabot/kernels/stress_update.h"
#include "sabot/materials/material.h"

#include <cmath>
#include <vector>

namespace sabot
{
/** A full batch of points for an update by @p law, of sheared and slightly
    compressed metal: each update shears on by @p amount and a little more, in
    1e-8 s. */
class LawBatch
{
public:
  static constexpr std::size_t n = max_batch_points;

  explicit LawBatch(const Material &law, const double amount = 5e-4)
  {
    for (const StateVariable &v : law.state_variables())
      for (int c = 0; c < (v.is_tensor ? 6 : 1); ++c)
        states.emplace_back(n, v.initial_value);
    for (auto &s : states)
      views.push_back(s.data());
    initial = states;
    batch.n = n;
    batch.dt = 1e-8;
    for (int c = 0; c < 6; ++c)
    {
      batch.stress[c] = stress[c];
      batch.strain_increment[c] = strain[c];
    }
    batch.jacobian = jacobian;
    batch.states = views.data();
    batch.extra_square = extra;
    batch.return_factor = factor;
    batch.plastic_work = work;
    batch.viscous_pressure = viscous;
    if (law.needs_deformation_gradient())
      for (int c = 0; c < 9; ++c)
        batch.deformation_gradient[c] = F[c];
    if (law.stiffens())
      batch.stiffening = stiffening;
    for (std::size_t k = 0; k < n; ++k)
    {
      jacobian[k] = 0.99 + 1e-4 * k;
      strain[3][k] = amount * (1. + 2e-3 * k);
      F[0][k] = F[4][k] = F[8][k] = std::cbrt(jacobian[k]);
    }
  }
  LawBatch(const LawBatch &) = delete;

  /** States as at the start; stress stays. Assignment keeps the buffers that
      the views point to. */
  void restart() { states = initial; }

  MaterialBatch batch;

private:
  double stress[6][n] = {}, strain[6][n] = {}, jacobian[n], extra[n] = {},
         factor[n], work[n], viscous[n] = {}, stiffening[n], F[9][n] = {};
  std::vector<std::vector<double>> states, initial;
  std::vector<double *> views;
};
} // namespace sabot

#endif
