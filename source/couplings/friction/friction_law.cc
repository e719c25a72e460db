// What all laws of friction have in common.
#include "sabot/couplings/friction/friction_law.h"

namespace sabot
{
double FrictionLaw::internal_friction() const
{
  std::vector<double> friction(1);
  find_friction({{1.}, {0.}, {1.}}, friction);
  return friction[0];
}
} // namespace sabot
