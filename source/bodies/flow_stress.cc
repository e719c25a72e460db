// The flow stress of any law, by what its return makes of trial stresses.
#include "sabot/bodies/flow_stress.h"

#include "sabot/bodies/body.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
constexpr double accuracy = 1e-6;
constexpr int most_trials = 60;
/** A step slow enough for every law [s]. */
constexpr double at_rest = 1e12;

/** What is known of the flow stress Y of a point. */
struct Bracket
{
  double low = 0., high = 0.; // it bears low, not more than high
  double trial = 0., reach = 0.1;
  bool is_done = false;

  void learn(const double theta)
  {
    // What flows at a trial stress hardens to Y + H d, 3 G d = gain: within a
    // tenth of the gain but where a power law starts.
    const double width = high - low, gain = (1. - theta) * trial;
    if (theta >= 1.)
      low = trial;
    else
      high = theta * trial;
    is_done = high - low <= accuracy * high;
    if (low == 0. && gain > 0.01 * high)
      trial = high;
    else if (low == 0.)
    {
      trial = std::max(0.5 * high, high - reach * gain);
      reach *= 8.;
    }
    else if (high - low > 0.5 * width)
      trial = 0.5 * (low + high);
    else
      trial =
          theta >= 1. ? high : std::max(0.5 * (low + high), high - 0.1 * gain);
  }
};

/** A batch of copies of points at rest, which a law may update. */
struct Copies
{
  Copies(const std::size_t n_states, const std::size_t n,
         const double *jacobian)
      : state(n_states * max_batch_points)
  {
    for (std::size_t s = 0; s < n_states; ++s)
      rows.push_back(&state[s * max_batch_points]);
    batch.n = n;
    batch.dt = at_rest;
    for (int c = 0; c < n_symmetric; ++c)
    {
      batch.strain_increment[c] = no_strain;
      batch.stress[c] = stress[c];
    }
    batch.jacobian = jacobian;
    batch.states = rows.data();
    batch.extra_square = extra;
    batch.return_factor = theta;
    batch.plastic_work = work;
    batch.viscous_pressure = no_strain;
    batch.stiffening = stiffening;
    for (int c = 0; c < 9; ++c)
      batch.deformation_gradient[c] = gradient[c % 4 == 0];
    for (std::size_t k = 0; k < n; ++k)
    {
      gradient[0][k] = 0.;
      gradient[1][k] = std::cbrt(jacobian[k]);
    }
  }
  Copies(const Copies &) = delete;
  Copies &operator=(const Copies &) = delete;

  const double no_strain[max_batch_points] = {};
  double stress[n_symmetric][max_batch_points];
  double gradient[2][max_batch_points]; // off and on the diagonal
  double extra[max_batch_points], theta[max_batch_points];
  double work[max_batch_points], stiffening[max_batch_points];
  std::vector<double> state;
  std::vector<double *> rows; // of state, [n_states]
  MaterialBatch batch;
};
} // namespace

FlowStressProbe::FlowStressProbe(const Material &material) : material(material)
{
  for (const StateVariable &variable : material.state_variables())
    is_tensor.insert(is_tensor.end(), variable.is_tensor ? n_symmetric : 1,
                     variable.is_tensor);
}

std::vector<double> FlowStressProbe::flow_stress() const
{
  std::vector<double> result(
      pressures.size(), material.initial_yield_stress().value_or(never_yields));
  for (std::size_t begin = 0; begin < result.size(); begin += max_batch_points)
    flow_stress_of_batch(begin,
                         std::min(max_batch_points, result.size() - begin),
                         &result[begin]);
  return result;
}

void FlowStressProbe::flow_stress_of_batch(const std::size_t begin,
                                           const std::size_t n,
                                           double *const result) const
{
  const std::size_t n_states = is_tensor.size();
  Copies copies(n_states, n, &jacobians[begin]);
  Bracket brackets[max_batch_points];
  for (std::size_t k = 0; k < n; ++k)
    brackets[k].high = brackets[k].trial = material.shear_modulus();
  for (int trial = 0; trial < most_trials; ++trial)
  {
    // All the stress is beside the deviator, so that nothing has a direction.
    for (std::size_t k = 0; k < n; ++k)
    {
      for (int c = 0; c < n_symmetric; ++c)
        copies.stress[c][k] = c < 3 ? -pressures[begin + k] : 0.;
      for (std::size_t s = 0; s < n_states; ++s)
        copies.rows[s][k] = states[(begin + k) * n_states + s];
      copies.extra[k] = brackets[k].trial * brackets[k].trial;
      copies.theta[k] = copies.stiffening[k] = 1.;
    }
    material.update(copies.batch);
    bool all_done = true;
    for (std::size_t k = 0; k < n; ++k)
    {
      Bracket &bracket = brackets[k];
      if (!bracket.is_done)
        bracket.learn(copies.theta[k]);
      all_done = all_done && bracket.is_done;
    }
    if (all_done)
      break;
  }
  // Beyond the modulus: never.
  for (std::size_t k = 0; k < n; ++k)
    if (brackets[k].low < material.shear_modulus())
      result[k] = brackets[k].high;
}
} // namespace sabot
