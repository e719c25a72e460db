// What a particle that lost a direction just now cannot bear.
#include "sabot/bodies/spg/failure/release_stress.h"

#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/failure/residual_strength.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_parts.h"

namespace sabot
{
void release_stress(SpgParts &body, const std::size_t i)
{
  const double K = body.points.law().bulk_modulus(),
               G = body.points.law().shear_modulus();
  const auto elastic_energy = [&](const double s[6])
  {
    const double mean = (s[0] + s[1] + s[2]) / 3.;
    double square = 0.;
    for (int c = 0; c < 3; ++c)
      square += (s[c] - mean) * (s[c] - mean) + 2. * s[3 + c] * s[3 + c];
    return mean * mean / (2. * K) + square / (4. * G);
  };
  double s[6];
  for (int c = 0; c < 6; ++c)
    s[c] = body.points.stress_row(c)[i];
  const double before = elastic_energy(s);
  body.residual_strength.release(s);
  for (int c = 0; c < 6; ++c)
    body.points.stress_row(c)[i] = s[c];
  const ParticleFields &fields = body.fields;
  const double V = fields.kernel_reference_volume[i] *
                   determinant(fields.incremental_deformation_gradient[i]);
  body.failure.loss[i] += V * (before - elastic_energy(s));
}
} // namespace sabot
