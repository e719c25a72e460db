#ifndef benchmarks_law_batch_h
#define benchmarks_law_batch_h

#include "verification/law_arrays.h"

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
  static constexpr std::size_t n = LawArrays::most;

  explicit LawBatch(const Material &law, const double amount = 5e-4)
  {
    for (const StateVariable &v : law.state_variables())
      for (int c = 0; c < (v.is_tensor ? 6 : 1); ++c)
        states.emplace_back(n, v.initial_value);
    for (auto &s : states)
      views.push_back(s.data());
    initial = states;
    batch = arrays.batch(law, n, 1e-8, views.data());
    for (std::size_t k = 0; k < n; ++k)
    {
      arrays.jacobian[k] = 0.99 + 1e-4 * k;
      arrays.strain[3][k] = amount * (1. + 2e-3 * k);
      for (const int c : {0, 4, 8})
        arrays.F[c][k] = std::cbrt(arrays.jacobian[k]);
    }
  }
  LawBatch(const LawBatch &) = delete;

  /** States as at the start; stress stays. Assignment keeps the buffers that
      the views point to. */
  void restart() { states = initial; }

  MaterialBatch batch;

private:
  LawArrays arrays;
  std::vector<std::vector<double>> states, initial;
  std::vector<double *> views;
};
} // namespace sabot

#endif
