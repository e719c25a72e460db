// Pressure of a constant bulk modulus.
#include "sabot/materials/bulk_modulus.h"

#include "sabot/base/registry.h"
#include "sabot/kernels/pack_math.h"
#include "sabot/materials/elastic_base.h"

namespace sabot
{
void BulkModulus::finish(const MaterialBatch &b, const Start &,
                         const double) const
{
  for (std::size_t k = 0; k < b.n; k += n_wide)
  {
    const WidePack mean = K * pack_log(load_wide(&b.jacobian[k]));
    for (int c = 0; c < 3; ++c)
      store_wide(&b.stress[c][k], load_wide(&b.stress[c][k]) + mean);
  }
}

namespace
{
const Registry<EquationOfState>::Add registered(
    {"Bulk modulus", "pressure -K ln J with K of the elastic constants.",
     nullptr,
     [](const Parameters &, const std::string &,
        const ElasticConstants &elastic, std::vector<std::string> &)
     { return std::make_shared<BulkModulus>(elastic.bulk_modulus()); }});
} // namespace
} // namespace sabot
