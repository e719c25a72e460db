// Failed metal is a heap of pieces: pressure and the friction between them.
#include "sabot/base/registry.h"
#include "sabot/bodies/spg/failure/repeated_update.h"
#include "sabot/bodies/spg/failure/residual_strength.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Above, pieces in triaxial compression, -p + 2/3 q across, would pull. */
constexpr double largest_slope = 1.5;

/** M of the stabilization at least, that of mu = 0.1: without any, the
   particles of frictionless pieces fall into disorder, and their volume with
   it. */
const double least_slope = std::sqrt(3.) * 0.1;

/**
 * Pieces of metal bear a pressure p > 0 as sound metal does, no tension, and
 * under it the friction mu of their surfaces,
 *
 *   q = sqrt(3/2 s : s + stabilization) <= min(sigma_y, M p),  M = sqrt(3) mu,
 *
 * which is the shear stress mu p where the three normal stresses are equal, as
 * they become in a layer that is sheared on. Sliding keeps the volume. What of
 * the strain is sliding, (1 - M p/q_trial) s_trial/(2 G), the law does not see:
 * it does not harden the metal. Its work q d_eps is heat.
 *
 * Cohesion is gone where the metal itself has failed, not beside it: there a
 * crack passes sound metal, which bears what it bears along the crack. Crumbled
 * metal stays a continuum (joins_crumbled()): as loose particles it would lose
 * a third of its volume, and all pressure meanwhile (rubble-shear-box).
 */
class Friction : public ResidualStrength
{
public:
  bool has_failed(const ParticleDamage &damage) const override
  {
    return damage.lost_direction || damage.has_crumbled;
  }
  void set_internal_friction(const double coefficient) override
  {
    slope = std::min(largest_slope, std::sqrt(3.) * coefficient);
  }
  bool joins_crumbled() const override { return true; }
  bool has_friction() const override { return true; }
  bool bears_no_tension() const override { return true; }
  void update(const Material &law, const MaterialBatch &points,
              const FailedPoints &failed) override;
  void release(double stress[n_symmetric]) const override;

private:
  /** Share of the trial deviator that pieces bear, and what is left of the
      strain; false where all bear all. */
  bool slide(const double shear_modulus, const MaterialBatch &points,
             const char *is_failed);
  /** Stress and return factor of what slid, and its heat. */
  void finish(const Material &law, const MaterialBatch &points,
              const FailedPoints &failed);
  /** Where the stress follows F instead of increments: it is cut. */
  void scale(const MaterialBatch &points, const char *is_failed) const;

  double slope = 0.; // M
  RepeatedUpdate updates;
  double rest[n_symmetric][max_batch_points]; // strain of the pieces
  double extra[max_batch_points];             // their extra square [Pa^2]
  double share[max_batch_points];             // of the trial deviator borne
  double share_of_extra[max_batch_points];    // the same of the stabilization
  double sliding[max_batch_points];           // effective strain
};

/** 3/2 s : s of the deviator of a stress. */
double mises_square(const double s[n_symmetric])
{
  const double m = mean_part(s);
  double square = 0.;
  for (int c = 0; c < 3; ++c)
    square += (s[c] - m) * (s[c] - m) + 2. * s[c + 3] * s[c + 3];
  return 1.5 * square;
}

void Friction::update(const Material &law, const MaterialBatch &points,
                      const FailedPoints &failed)
{
  updates.first(law, points); // for the pressure
  if (law.needs_deformation_gradient())
    return scale(points, failed.is_failed);
  if (!slide(law.shear_modulus(), points, failed.is_failed))
    return;
  updates.again(law, points, rest, extra);
  finish(law, points, failed);
}

bool Friction::slide(const double shear_modulus, const MaterialBatch &points,
                     const char *const is_failed)
{
  const double two_G = 2. * shear_modulus;
  bool any = false;
  for (std::size_t k = 0; k < points.n; ++k)
  {
    share[k] = 1.;
    sliding[k] = 0.;
    extra[k] = points.extra_square[k];
    double strain[n_symmetric], trial[n_symmetric];
    for (int c = 0; c < n_symmetric; ++c)
      strain[c] = rest[c][k] = points.strain_increment[c][k];
    if (!is_failed[k])
      continue;
    for (int c = 0; c < n_symmetric; ++c)
      trial[c] = updates.old_stress[c][k] + two_G * strain[c];
    add_mean_part(trial, -mean_part(trial));
    const double pressure =
        -(points.stress[0][k] + points.stress[1][k] + points.stress[2][k]) / 3.;
    const double q = std::sqrt(mises_square(trial) + extra[k]),
                 pressing = std::max(0., pressure);
    if (q <= slope * pressing && pressure >= 0.)
      continue;
    any = true;
    const auto borne = [&](const double M)
    { return q > 0. ? std::min(1., M * pressing / q) : 0.; };
    share[k] = borne(slope);
    share_of_extra[k] = borne(std::max(slope, least_slope));
    sliding[k] = (1. - share[k]) * q / (1.5 * two_G);
    extra[k] *= share_of_extra[k] * share_of_extra[k];
    for (int c = 0; c < n_symmetric; ++c)
      rest[c][k] -= (1. - share[k]) * trial[c] / two_G;
  }
  return any;
}

void Friction::finish(const Material &law, const MaterialBatch &points,
                      const FailedPoints &failed)
{
  for (std::size_t k = 0; k < points.n; ++k)
  {
    if (share[k] == 1. && sliding[k] == 0.)
      continue;
    double s[n_symmetric];
    for (int c = 0; c < n_symmetric; ++c)
      s[c] = points.stress[c][k];
    const double q =
        std::sqrt(mises_square(s) +
                  extra[k] * points.return_factor[k] * points.return_factor[k]);
    points.return_factor[k] *= share_of_extra[k];
    const double tension = std::max(0., mean_part(s));
    if (tension > 0.) // pieces part
      for (int c = 0; c < n_symmetric; ++c)
        points.stress[c][k] = 0.;
    const double heat = q * sliding[k]; // per current volume
    failed.friction_work[k] += 2. * failed.half_volume[k] * heat;
    updates.add_heat(law, points, k, heat, tension);
  }
}

void Friction::scale(const MaterialBatch &points,
                     const char *const is_failed) const
{
  for (std::size_t k = 0; k < points.n; ++k)
  {
    if (!is_failed[k])
      continue;
    double s[n_symmetric];
    for (int c = 0; c < n_symmetric; ++c)
      s[c] = points.stress[c][k];
    const double mean = mean_part(s), theta = points.return_factor[k],
                 q = std::sqrt(mises_square(s) +
                               theta * theta * points.extra_square[k]),
                 bearable = slope * std::max(0., -mean),
                 part = q > bearable ? bearable / q : 1.;
    points.return_factor[k] *= part;
    for (int c = 0; c < n_symmetric; ++c)
      points.stress[c][k] =
          part * s[c] + (c < 3 ? std::min(0., mean) - part * mean : 0.);
  }
}

void Friction::release(double stress[n_symmetric]) const
{
  const double pressure = -mean_part(stress);
  if (pressure <= 0.)
  {
    std::fill_n(stress, n_symmetric, 0.);
    return;
  }
  const double q = std::sqrt(mises_square(stress));
  if (q <= slope * pressure)
    return;
  const double part = slope * pressure / q;
  for (int c = 0; c < n_symmetric; ++c)
    stress[c] = part * stress[c] + (c < 3 ? (part - 1.) * pressure : 0.);
}

const Registry<ResidualStrength>::Add registered(
    {"friction",
     "pressure, and under it the friction between pieces, by the coefficient "
     "of the body's self-contact.",
     nullptr, [](const Parameters &, const std::string &) {
       return [] { return std::make_unique<Friction>(); };
     }});
} // namespace
} // namespace sabot
