// Stages of the SPG step that no form of stabilization changes: what it reads,
// and the material.
#include "sabot/bodies/spg/spg_step.h"

#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/failure/residual_strength.h"
#include "sabot/bodies/spg/spg_options.h"
#include "sabot/bodies/spg/stable_step.h"

namespace sabot
{
MotionViews motion_views(SpgParts &body, const double dt)
{
  ParticleFields &fields = body.fields;
  const Material &law = body.points.law();
  return {body.nodes.position.data(),
          fields.kernel_reference_position.data(),
          body.nodes.global_id.data(),
          body.bonds,
          body.approximation.shape_gradient.data(),
          body.approximation.moment_inverse.data(),
          fields.reference_volume.data(),
          fields.kernel_reference_volume.data(),
          fields.copies.empty() ? nullptr : fields.copies.data(),
          body.stable_step.data(),
          fields.stiffening.empty() ? nullptr : fields.stiffening.data(),
          body.points.viscous_pressure.data(),
          fields.incremental_deformation_gradient.data(),
          law.density(),
          law.sound_speed(),
          body.options.bulk_viscosity_linear,
          body.options.bulk_viscosity_quadratic,
          dt,
          body.name};
}

std::string describe_collapse(const MotionViews &in, const std::size_t i,
                              const double jacobian)
{
  const Vec x = in.position[i];
  return "body " + in.body_name + ", particle " +
         std::to_string(in.global_id[i]) + " at (" + std::to_string(x[0]) +
         ", " + std::to_string(x[1]) + ", " + std::to_string(x[2]) +
         ") m: incremental deformation gradient has determinant " +
         std::to_string(jacobian);
}

void update_stress(const ParticleRange &range, SpgParts &body, const double dt)
{
  StepWork &work = body.work;
  MaterialPoints &points = body.points;
  const Material &law = points.law();
  if (law.needs_deformation_gradient())
    for (std::size_t i = range.begin; i < range.end; ++i)
    {
      const Mat F = body.fields.deformation_gradient(i);
      for (int c = 0; c < 9; ++c)
        work.deformation_gradient[c][i - range.begin] = F(c / 3, c % 3);
    }
  PointStep step = work.views(range.begin, range.size(), dt);
  step.extra_square = work.extra_square;
  if (!body.fields.stiffening.empty())
    step.stiffening = &body.fields.stiffening[range.begin];

  const MaterialBatch batch = points.rotate(step);
  BondFailure &failure = body.failure;
  const char *const failed = &failure.is_failed[range.begin];
  if (std::none_of(failed, failed + range.size(),
                   [](const char f) { return f; }))
    law.update(batch);
  else
    body.residual_strength.update(
        law, batch,
        {failed, work.half_volume, &failure.loss[range.begin],
         failure.friction_work.empty() ? nullptr
                                       : &failure.friction_work[range.begin]});
  points.finish(step);
}
} // namespace sabot
