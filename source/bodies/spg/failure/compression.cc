// Failed metal carries compression: no tension across the cracks beside it,
// else the law.
#include "sabot/base/registry.h"
#include "sabot/bodies/spg/failure/repeated_update.h"
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
  bool has_failed(const ParticleDamage &damage) const override
  {
    return damage.lost_direction;
  }
  void update(const Material &law, const MaterialBatch &points,
              const FailedPoints &failed) override;
  void release(double stress[n_symmetric]) const override
  {
    cut_tension(stress);
  }

private:
  /** Set uncracked_strain and is_cracked; false where no crack opens. */
  bool open_cracks(const double shear_modulus, const MaterialBatch &points,
                   const char *is_failed);
  /** The stress across cracks, and the energy that opening them took. */
  void close_tension(const Material &law, const MaterialBatch &points,
                     const FailedPoints &failed);

  RepeatedUpdate updates;
  double uncracked_strain[n_symmetric][max_batch_points];
  bool is_cracked[max_batch_points];
};

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
  updates.first(law, points);
  if (!open_cracks(law.shear_modulus(), points, failed.is_failed))
    return;
  // Once more, without what opened the cracks; equal for the other points.
  updates.again(law, points, uncracked_strain, points.extra_square);
  close_tension(law, points, failed);
}

void Compression::close_tension(const Material &law,
                                const MaterialBatch &points,
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
    {
      add_mean_part(s, -excess);
      updates.add_heat(law, points, k, 0., excess);
    }
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
      trial[c] = updates.old_stress[c][k];
    }
    is_cracked[k] = false;
    if (!is_failed[k])
      continue;
    const double new_mean =
        (points.stress[0][k] + points.stress[1][k] + points.stress[2][k]) / 3.;
    add_mean_part(trial,
                  new_mean - mean_part(trial) - two_G * mean_part(strain));
    for (int c = 0; c < 6; ++c)
      trial[c] += two_G * strain[c];
    double held[6];
    std::copy_n(trial, 6, held);
    cut_tension(held);
    if (std::equal(held, held + 6, trial))
      continue;
    is_cracked[k] = any = true;
    const double change = mean_part(held) - mean_part(trial);
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
