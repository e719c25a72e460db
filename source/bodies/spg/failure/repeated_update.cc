// A law's update of a batch, taken back and made again.
#include "sabot/bodies/spg/failure/repeated_update.h"

#include <algorithm>

namespace sabot
{
void RepeatedUpdate::first(const Material &law, const MaterialBatch &points)
{
  if (old_states.empty())
    find_rows(law);
  for (int c = 0; c < n_symmetric; ++c)
    std::copy_n(points.stress[c], points.n, old_stress[c]);
  for (std::size_t s = 0; s * max_batch_points < old_states.size(); ++s)
    std::copy_n(points.states[s], points.n, &old_states[s * max_batch_points]);
  law.update(points);
}

void RepeatedUpdate::again(const Material &law, const MaterialBatch &points,
                           const double (*const strain)[max_batch_points],
                           const double *const extra_square)
{
  for (int c = 0; c < n_symmetric; ++c)
    std::copy_n(old_stress[c], points.n, points.stress[c]);
  for (std::size_t s = 0; s * max_batch_points < old_states.size(); ++s)
    std::copy_n(&old_states[s * max_batch_points], points.n, points.states[s]);
  MaterialBatch rest = points;
  for (int c = 0; c < n_symmetric; ++c)
    rest.strain_increment[c] = strain[c];
  rest.extra_square = extra_square;
  law.update(rest);
}

void RepeatedUpdate::find_rows(const Material &law)
{
  std::size_t row = 0;
  for (const StateVariable &variable : law.state_variables())
  {
    if (variable.name == "temperature")
      temperature = row;
    else if (variable.name == "specific internal energy")
      energy = row;
    row += variable.is_tensor ? n_symmetric : 1;
  }
  old_states.resize(row * max_batch_points);
}

void RepeatedUpdate::add_heat(const Material &law, const MaterialBatch &points,
                              const std::size_t k, const double heat,
                              const double tension) const
{
  const double J = points.jacobian[k];
  if (temperature && law.specific_heat() > 0.)
    points.states[*temperature][k] +=
        heat * J / (law.density() * law.specific_heat());
  if (!energy)
    return;
  const double trace = points.strain_increment[0][k] +
                       points.strain_increment[1][k] +
                       points.strain_increment[2][k],
               mid = J / (1. + 0.5 * trace);
  points.states[*energy][k] +=
      (J * heat - 0.5 * mid * tension * trace) / law.density();
}
} // namespace sabot
