// The elastic law.
#include "sabot/base/registry.h"
#include "sabot/materials/laws.h"

#include <algorithm>

namespace sabot
{
void Elastic::update_deviator(const MaterialBatch &batch, Scratch &) const
{
  trial_deviator(batch);
  std::fill_n(batch.return_factor, batch.n, 1.);
  std::fill_n(batch.plastic_work, batch.n, 0.);
}

namespace
{
const Registry<Material>::Add
    registered({"Elastic", "hypoelastic, objective rate of the body.", nullptr,
                [](const Parameters &, const std::string &,
                   const ElasticConstants &elastic, const ElasticBase::Eos &eos)
                { return std::make_unique<Elastic>(elastic, eos); }});
} // namespace
} // namespace sabot
