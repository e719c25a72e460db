// Failed metal carries what the law says, as the paper has it.
#include "sabot/base/registry.h"
#include "sabot/bodies/spg/failure/residual_strength.h"

namespace sabot
{
namespace
{
/** Wu & Wu 2018 let failed bonds go and leave the stress of the particles
    alone: the law goes on unchanged. */
class Everything : public ResidualStrength
{
public:
  bool has_failed(const ParticleDamage &damage) const override
  {
    return damage.lost_direction;
  }
  void update(const Material &law, const MaterialBatch &points,
              const FailedPoints &) override
  {
    law.update(points);
  }
  void release(double *) const override {}
};

const Registry<ResidualStrength>::Add
    registered({"everything", "the law goes on unchanged, tension included.",
                nullptr, [](const Parameters &, const std::string &) {
                  return [] { return std::make_unique<Everything>(); };
                }});
} // namespace
} // namespace sabot
