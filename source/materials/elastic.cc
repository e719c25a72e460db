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
const RegisterMaterial
    registered({"Elastic", "hypoelastic, objective rate of the body.", nullptr,
                [](Parameters &, const std::string &,
                   const ElasticConstants &elastic, const ElasticBase::Eos &eos)
                { return std::make_unique<Elastic>(elastic, eos); }});
} // namespace
} // namespace sabot
