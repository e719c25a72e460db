// The neo-Hookean law.
#include "sabot/base/registry.h"
#include "sabot/kernels/pack_math.h"
#include "sabot/materials/laws.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Components of F F^T of point @p k. */
inline void left_cauchy_green(const double *const *F, const std::size_t k,
                              double b[6])
{
  constexpr int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int c = 0; c < 6; ++c)
    b[c] = F[3 * row[c]][k] * F[3 * column[c]][k] +
           F[3 * row[c] + 1][k] * F[3 * column[c] + 1][k] +
           F[3 * row[c] + 2][k] * F[3 * column[c] + 2][k];
}
} // namespace

void NeoHookean::update_deviator(const MaterialBatch &batch,
                                 Scratch &shear_ratio) const
{
  double factors[max_batch_points]; // J^(-5/3)
  by_packs(batch.n, batch.jacobian, factors,
           [](const WidePack J) { return pack_power(J, -5. / 3.); });
#pragma GCC ivdep // arrays do not overlap
  for (std::size_t k = 0; k < batch.n; ++k)
  {
    double b[6];
    left_cauchy_green(batch.deformation_gradient, k, b);
    const double factor = factors[k], mean = (b[0] + b[1] + b[2]) / 3.;
    for (int c = 0; c < 6; ++c)
      batch.stress[c][k] = G * factor * (c < 3 ? b[c] - mean : b[c]);
    batch.return_factor[k] = 1.;
    batch.plastic_work[k] = 0.;
    // The shear stiffness grows with the largest eigenvalue of b, which the
    // row sums bound (Gershgorin).
    const double xy = std::abs(b[3]), yz = std::abs(b[4]), xz = std::abs(b[5]);
    shear_ratio[k] =
        factor * std::max({b[0] + xy + xz, b[1] + xy + yz, b[2] + yz + xz});
  }
}

void NeoHookean::after_pressure(const MaterialBatch &batch,
                                const Scratch &shear_ratio) const
{
  if (!batch.stiffening)
    return;
  const double K = bulk_modulus(), shear = 4. / 3. * G;
  const bool has_bulk = eos->stiffens();
  for (std::size_t k = 0; k < batch.n; ++k)
  {
    const double bulk =
        has_bulk ? batch.stiffening[k] * (K + shear) - shear : K;
    // The body scales both moduli by one factor: the larger.
    batch.stiffening[k] = std::max({1., shear_ratio[k], bulk / K});
  }
}

namespace
{
const Registry<Material>::Add registered(
    {"Neo-Hookean", "hyperelastic, for finite elastic strain.", nullptr,
     [](const Parameters &, const std::string &,
        const ElasticConstants &elastic, const ElasticBase::Eos &eos)
     { return std::make_unique<NeoHookean>(elastic, eos); }});
} // namespace
} // namespace sabot
