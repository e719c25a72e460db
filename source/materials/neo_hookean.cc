// The neo-Hookean law.
#include "sabot/base/registry.h"
#include "sabot/kernels/pack_math.h"
#include "sabot/materials/laws.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
void NeoHookean::update_deviator(const MaterialBatch &batch,
                                 Scratch &shear_ratio) const
{
  constexpr int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
  for (std::size_t k = 0; k < batch.n; k += n_wide)
  {
    WidePack F[9], b[6]; // b = F F^T
    for (int c = 0; c < 9; ++c)
      F[c] = load_wide(&batch.deformation_gradient[c][k]);
    for (int c = 0; c < 6; ++c)
    {
      const WidePack *const f = &F[3 * row[c]], *const g = &F[3 * column[c]];
      b[c] = f[0] * g[0] + f[1] * g[1] + f[2] * g[2];
    }
    const WidePack factor = pack_power(load_wide(&batch.jacobian[k]), -5. / 3.);
    // The shear stiffness grows with the largest eigenvalue of b, which the
    // row sums bound (Gershgorin).
    const WidePack xy = pack_max(b[3], -b[3]), yz = pack_max(b[4], -b[4]),
                   xz = pack_max(b[5], -b[5]);
    store_wide(&shear_ratio[k],
               factor * pack_max(pack_max(b[0] + xy + xz, b[1] + xy + yz),
                                 b[2] + yz + xz));
    make_deviator(b);
    for (int c = 0; c < 6; ++c)
      store_wide(&batch.stress[c][k], G * factor * b[c]);
    store_wide(&batch.return_factor[k], splat<WidePack>(1.));
    store_wide(&batch.plastic_work[k], WidePack{});
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
