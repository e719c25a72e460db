#include "sabot/materials/laws.h"

#include <algorithm>

namespace sabot
{
void Elastic::update(const MaterialBatch &batch) const
{
  trial_stress(batch);
  std::fill_n(batch.return_factor, batch.n, 1.);
  std::fill_n(batch.plastic_work, batch.n, 0.);
}

namespace
{
const RegisterMaterial registered(
    {"Elastic", "hypoelastic, Jaumann rate, pressure -K ln J.",
     [](dealii::ParameterHandler &) {},
     [](dealii::ParameterHandler &prm, const std::string &path) {
       return std::make_unique<Elastic>(ElasticConstants::parse(prm, path));
     }});
} // namespace
} // namespace sabot
