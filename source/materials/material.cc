#include "sabot/materials/material.h"

#include <cmath>

namespace sabot
{
double Material::sound_speed() const
{
  return std::sqrt((bulk_modulus() + 4. / 3. * shear_modulus()) / density());
}
} // namespace sabot
