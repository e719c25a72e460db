// Failed metal carries compression: no tension across the cracks beside it,
// else the law.
#include "sabot/base/registry.h"
#include "sabot/bodies/spg/failure/residual_strength.h"
#include "sabot/kernels/kernel_function.h"
#include "sabot/kernels/principal.h"

#include <algorithm>

namespace sabot
{
namespace
{
/**
 * A crack beside a particle transmits no tension: where the trial stress has
 * any, cracks open by the strain that takes it away, before anything flows. The
 * volume is the pressure's: only the deviator is left to strain. What opened
 * cracks did work that is let go. Laws whose stress follows F instead of the
 * strain increment have the tension cut off.
 */
class Compression : public ResidualStrength
{
public:
  void update(const Material &law, const MaterialBatch &points,
              const FailedPoints &failed) override;
  void release(double stress[n_symmetric]) const override
  {
    cut_tension(stress);
  }

private:
  /** Keep stress and states of the batch, or give them back. */
  void save(const MaterialBatch &points);
  void restore(const MaterialBatch &points) const;
  /** Set uncracked_strain and is_cracked; false where no crack opens. */
  bool open_cracks(const double shear_modulus, const MaterialBatch &points,
                   const char *is_failed);
  /** The stress across cracks, and the energy that opening them took. */
  void close_tension(const MaterialBatch &points, const FailedPoints &failed);

  double old_stress[n_symmetric][max_batch_points];
  double uncracked_strain[n_symmetric][max_batch_points];
  bool is_cracked[max_batch_points];
  std::vector<double> old_states; // [row][max_batch_points]
  std::size_t n_rows = 0;
};

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

void Compression::update(const Material &law, const MaterialBatch &points,
                         const FailedPoints &failed)
{
  if (law.needs_deformation_gradient())
  {
    // The stress follows F, not the strain increment; nothing flows.
    law.update(points);
    for (std::size_t k = 0; k < points.n; ++k)
      if (failed.is_failed[k])
      {
        double s[6];
        for (int c = 0; c < 6; ++c)
          s[c] = points.stress[c][k];
        cut_tension(s);
        for (int c = 0; c < 6; ++c)
          points.stress[c][k] = s[c];
      }
    return;
  }
  if (old_states.empty())
  {
    n_rows = 0;
    for (const StateVariable &variable : law.state_variables())
      n_rows += variable.is_tensor ? n_symmetric : 1;
    old_states.resize(n_rows * max_batch_points);
  }
  save(points);
  law.update(points);
  if (!open_cracks(law.shear_modulus(), points, failed.is_failed))
    return;
  // Once more, without what opened the cracks; equal for the other points.
  restore(points);
  MaterialBatch rest = points;
  for (int c = 0; c < 6; ++c)
    rest.strain_increment[c] = uncracked_strain[c];
  law.update(rest);
  close_tension(points, failed);
}

void Compression::save(const MaterialBatch &points)
{
  for (int c = 0; c < 6; ++c)
    std::copy_n(points.stress[c], points.n, old_stress[c]);
  for (std::size_t s = 0; s < n_rows; ++s)
    std::copy_n(points.states[s], points.n, &old_states[s * max_batch_points]);
}

void Compression::restore(const MaterialBatch &points) const
{
  for (int c = 0; c < 6; ++c)
    std::copy_n(old_stress[c], points.n, points.stress[c]);
  for (std::size_t s = 0; s < n_rows; ++s)
    std::copy_n(&old_states[s * max_batch_points], points.n, points.states[s]);
}

void Compression::close_tension(const MaterialBatch &points,
                                const FailedPoints &failed)
{
  for (std::size_t k = 0; k < points.n; ++k)
  {
    if (!is_cracked[k])
      continue;
    // The mean is what leaves no tension across the crack, or the pressure.
    double s[6];
    for (int c = 0; c < 6; ++c)
      s[c] = points.stress[c][k];
    const double excess = largest_principal(s);
    if (excess > 0.)
      add_mean(s, -excess);
    double loss = 0.;
    for (int c = 0; c < 6; ++c)
    {
      points.stress[c][k] = s[c];
      loss += (c < 3 ? 1. : 2.) * s[c] *
              (points.strain_increment[c][k] - uncracked_strain[c][k]);
    }
    failed.loss[k] += 2. * failed.half_volume[k] * loss;
  }
}

bool Compression::open_cracks(const double shear_modulus,
                              const MaterialBatch &points,
                              const char *const is_failed)
{
  const double two_G = 2. * shear_modulus;
  bool any = false;
  for (std::size_t k = 0; k < points.n; ++k)
  {
    double strain[6], trial[6];
    for (int c = 0; c < 6; ++c)
    {
      uncracked_strain[c][k] = strain[c] = points.strain_increment[c][k];
      trial[c] = old_stress[c][k];
    }
    is_cracked[k] = false;
    if (!is_failed[k])
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
    is_cracked[k] = any = true;
    const double change = mean(held) - mean(trial);
    for (int c = 0; c < 6; ++c)
      uncracked_strain[c][k] +=
          (held[c] - trial[c] - (c < 3 ? change : 0.)) / two_G;
  }
  return any;
}

const Registry<ResidualStrength>::Add registered(
    {"compression",
     "the law, but no tension across the cracks that open beside a particle.",
     nullptr, [](const Parameters &, const std::string &) {
       return [] { return std::make_unique<Compression>(); };
     }});
} // namespace
} // namespace sabot
