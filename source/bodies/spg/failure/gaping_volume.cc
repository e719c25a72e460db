// The largest volume of failed metal that bears nothing.
#include "sabot/bodies/spg/failure/gaping_volume.h"

#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/failure/residual_strength.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_options.h"
#include "sabot/bodies/spg/spg_parts.h"

#include <cmath>

namespace sabot
{
bool gapes(const SpgParts &body, const std::size_t i)
{
  if (!body.failure.is_failed[i] || !body.residual_strength.bears_no_tension())
    return false;
  const Mat stress = body.points.total_stress(i, 0.);
  for (const Vec row : stress.row)
    if (row[0] != 0. || row[1] != 0. || row[2] != 0.)
      return false;
  return true;
}

void bound_gaping_volumes(SpgParts &body)
{
  if (!body.options.can_fail() || !body.residual_strength.bears_no_tension())
    return;
  const double most = 4. / 3. * M_PI * std::pow(body.kernel.support(), 3);
  ParticleFields &fields = body.fields;
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
  {
    const double ratio =
        most * fields.reference_volume[i] / fields.kernel_reference_volume[i];
    if (ratio >= 1. || !gapes(body, i))
      continue;
    fields.kernel_reference_volume[i] *= ratio;
    fields.kernel_reference_deformation_gradient[i] =
        std::cbrt(ratio) * fields.kernel_reference_deformation_gradient[i];
  }
}
} // namespace sabot
