#include "sabot/bodies/spg/spg_body.h"
#include "sabot/kernels/kernel_function.h"

#include <algorithm>

namespace sabot
{
namespace
{
/** Add @p part to the normal components. */
void add_mean(double s[6], const double part)
{
  for (int c = 0; c < 3; ++c)
    s[c] += part;
}

double mean(const double s[6])
{
  return (s[0] + s[1] + s[2]) / 3.;
}
} // namespace

void SpgBody::update_material(const MaterialBatch &step,
                              const std::size_t begin)
{
  const std::size_t m = step.n;
  const char *const lost = &weak[begin];
  if (std::none_of(lost, lost + m, [](const char w) { return w; }))
  {
    material->update(step);
    return;
  }
  if (material->needs_deformation_gradient())
  {
    // The stress follows F, not the strain increment; nothing flows.
    material->update(step);
    for (std::size_t k = 0; k < m; ++k)
      if (lost[k])
      {
        double s[6];
        for (int c = 0; c < 6; ++c)
          s[c] = step.stress[c][k];
        cut_tension(s);
        for (int c = 0; c < 6; ++c)
          step.stress[c][k] = s[c];
      }
    return;
  }
  for (int c = 0; c < 6; ++c)
    std::copy_n(step.stress[c], m, batch.old_stress[c]);
  old_states.resize(points.n_rows() * batch_size);
  for (std::size_t s = 0; s < points.n_rows(); ++s)
    std::copy_n(step.states[s], m, &old_states[s * batch_size]);
  material->update(step);
  if (!open_cracks(step, begin))
    return;

  // Once more, without what opened the cracks; equal for the other points.
  for (int c = 0; c < 6; ++c)
    std::copy_n(batch.old_stress[c], m, step.stress[c]);
  for (std::size_t s = 0; s < points.n_rows(); ++s)
    std::copy_n(&old_states[s * batch_size], m, step.states[s]);
  MaterialBatch rest = step;
  for (int c = 0; c < 6; ++c)
    rest.strain_increment[c] = batch.uncracked_strain[c];
  material->update(rest);
  for (std::size_t k = 0; k < m; ++k)
  {
    if (!batch.is_cracked[k])
      continue;
    // The mean is what leaves no tension across the crack, or the pressure.
    double s[6];
    for (int c = 0; c < 6; ++c)
      s[c] = step.stress[c][k];
    const double excess = largest_principal(s);
    if (excess > 0.)
      add_mean(s, -excess);
    double loss = 0.;
    for (int c = 0; c < 6; ++c)
    {
      step.stress[c][k] = s[c];
      loss += (c < 3 ? 1. : 2.) * s[c] *
              (step.strain_increment[c][k] - batch.uncracked_strain[c][k]);
    }
    failure_loss[begin + k] += 2. * batch.half_volume[k] * loss;
  }
}

bool SpgBody::open_cracks(const MaterialBatch &points, const std::size_t begin)
{
  // A crack beside the particle transmits no tension: where the trial stress
  // has any, cracks open by the strain that takes it away, before anything
  // flows. The volume is the pressure's: only the deviator is left to strain.
  const double two_G = 2. * material->shear_modulus();
  bool any = false;
  for (std::size_t k = 0; k < points.n; ++k)
  {
    double strain[6], trial[6];
    for (int c = 0; c < 6; ++c)
    {
      batch.uncracked_strain[c][k] = strain[c] = points.strain_increment[c][k];
      trial[c] = batch.old_stress[c][k];
    }
    batch.is_cracked[k] = false;
    if (!weak[begin + k])
      continue;
    const double new_mean =
        (points.stress[0][k] + points.stress[1][k] + points.stress[2][k]) / 3.;
    add_mean(trial, new_mean - mean(trial) - two_G * mean(strain));
    for (int c = 0; c < 6; ++c)
      trial[c] += two_G * strain[c];
    double held[6];
    std::copy_n(trial, 6, held);
    cut_tension(held);
    if (std::equal(held, held + 6, trial))
      continue;
    batch.is_cracked[k] = any = true;
    const double change = mean(held) - mean(trial);
    for (int c = 0; c < 6; ++c)
      batch.uncracked_strain[c][k] +=
          (held[c] - trial[c] - (c < 3 ? change : 0.)) / two_G;
  }
  return any;
}
} // namespace sabot
