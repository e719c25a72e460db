// No stabilization: direct nodal integration as it is, for comparison.
#include "sabot/base/registry.h"
#include "sabot/bodies/spg/crack_forces.h"
#include "sabot/bodies/spg/linearized_body.h"
#include "sabot/bodies/spg/spg_step.h"
#include "sabot/bodies/spg/stabilization/unstabilized.h"

namespace sabot
{
void Unstabilized::compute_forces(SpgParts &body, const double dt)
{
  run_spg_step(body, *this, dt);
}

bool Unstabilized::renew_forces(SpgParts &body, const CrackedParticles &cracked)
{
  renew_crack_forces(body, *this, cracked);
  return true;
}

void Unstabilized::apply_linearized(const SpgParts &body,
                                    const AlignedVector<Vec> &motion,
                                    AlignedVector<Vec> &force)
{
  apply_linearized_body(body, *this, motion, force);
}

namespace
{
const Registry<Stabilization>::Add
    registered({"none", "sawtooth modes cost nothing.", nullptr,
                [](const Parameters &, const std::string &)
                { return [] { return std::make_unique<Unstabilized>(); }; }});
} // namespace
} // namespace sabot
