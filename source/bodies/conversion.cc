// What cells hand to their nodes, and the energy that stresses hold.
#include "sabot/bodies/conversion.h"

#include <cmath>

namespace sabot
{
double elastic_energy_density(const std::array<double, n_symmetric> &stress,
                              const Material &law)
{
  const double mean = (stress[0] + stress[1] + stress[2]) / 3.;
  double square = 0.;
  for (int c = 0; c < 3; ++c)
    square += (stress[c] - mean) * (stress[c] - mean) +
              2. * stress[c + 3] * stress[c + 3];
  return mean * mean / (2. * law.bulk_modulus()) +
         square / (4. * law.shear_modulus());
}

Mat mean_gradient(const Mat &a, const double weight_a, const Mat &b,
                  const double weight_b, const double J)
{
  Mat mean;
  for (int d = 0; d < 3; ++d)
    mean.row[d] =
        (weight_a * a.row[d] + weight_b * b.row[d]) / (weight_a + weight_b);
  return std::cbrt(J / determinant(mean)) * mean;
}

void NodalMatter::add(const std::size_t k, const Entry &share,
                      const double *const share_states)
{
  Entry &sum = entries[k];
  const double V_0 = share.reference_volume, V = share.volume;
  sum.mass += share.mass;
  sum.reference_volume += V_0;
  sum.volume += V;
  sum.internal_energy += share.internal_energy;
  sum.plastic_work += share.plastic_work;
  sum.hourglass_energy += share.hourglass_energy;
  sum.elastic_energy += share.elastic_energy;
  sum.viscous_pressure += V * share.viscous_pressure;
  for (int d = 0; d < 3; ++d)
    sum.gradient.row[d] += V_0 * share.gradient.row[d];
  for (int c = 0; c < n_symmetric; ++c)
    sum.stress[c] += V * share.stress[c];
  for (std::size_t r = 0; r < n_rows; ++r)
    states[k * n_rows + r] += V_0 * share_states[r];
}

void NodalMatter::finish()
{
  for (std::size_t k = 0; k < entries.size(); ++k)
  {
    Entry &e = entries[k];
    e.viscous_pressure /= e.volume;
    for (double &s : e.stress)
      s /= e.volume;
    for (std::size_t r = 0; r < n_rows; ++r)
      states[k * n_rows + r] /= e.reference_volume;
    const double J = e.volume / e.reference_volume;
    e.gradient = std::cbrt(J / determinant(e.gradient)) * e.gradient;
  }
}
} // namespace sabot
