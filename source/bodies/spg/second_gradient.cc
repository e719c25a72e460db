#include "sabot/bodies/spg/second_gradient.h"

#include "sabot/kernels/stress_update.h"

namespace sabot
{
SecondGradient::SecondGradient(const double bulk_modulus,
                               const double shear_modulus,
                               const std::size_t n_owned)
    : work(n_owned, 0.), K(bulk_modulus), G(shear_modulus),
      higher_gradient(3 * n_owned, Mat::zero()),
      stress(3 * n_owned, Mat::zero())
{
}

void SecondGradient::restart()
{
  // sum dX (x) b^k = 0: first-order functions reproduce linear fields.
  std::fill(higher_gradient.begin(), higher_gradient.end(), Mat::zero());
}

namespace
{
Mat symmetric(const Mat &a)
{
  return 0.5 * (a + transpose(a));
}

double contract(const Mat &a, const Mat &b)
{
  return dot(a.row[0], b.row[0]) + dot(a.row[1], b.row[1]) +
         dot(a.row[2], b.row[2]);
}

/** R s R^T with the Hughes-Winget rotation of the spin of @p l. */
Mat rotated(const Mat &s, const Mat &l)
{
  const double spin_of[3] = {0.5 * (l(0, 1) - l(1, 0)),
                             0.5 * (l(1, 2) - l(2, 1)),
                             0.5 * (l(0, 2) - l(2, 0))};
  const double *const spin[3] = {&spin_of[0], &spin_of[1], &spin_of[2]};
  double t[6] = {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
  double *const views[6] = {&t[0], &t[1], &t[2], &t[3], &t[4], &t[5]};
  rotate_symmetric(1, spin, views);
  return {
      {vec(t[0], t[3], t[5]), vec(t[3], t[1], t[4]), vec(t[5], t[4], t[2])}};
}
} // namespace

double SecondGradient::trial(const std::size_t i, const BondList &bonds,
                             const Vec *const x, const Mat &l,
                             const Mat &F_inverse)
{
  Mat now[3] = {Mat::zero(), Mat::zero(), Mat::zero()};
  for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
  {
    const Vec dx = x[bonds.neighbor[b]] - x[i];
    for (int k = 0; k < 3; ++k)
      add_outer(now[k], dx, bond_gradient[b].row[k]);
  }
  double square = 0.;
  for (int k = 0; k < 3; ++k)
  {
    Mat &F_k = higher_gradient[3 * i + k];
    const Mat mean = 0.5 * (F_k + now[k]);
    strain[k] = symmetric((now[k] - F_k) * F_inverse - l * (mean * F_inverse));
    F_k = now[k];
    spatial[k] = F_k * F_inverse;
    Mat &s = stress[3 * i + k];
    s = old_stress[k] = rotated(s, l);
    const double volumetric = (K - 2. / 3. * G) * trace(strain[k]);
    s = s + 2. * G * strain[k] + volumetric * Mat::identity();
    const double mean_stress = trace(s) / 3.;
    square += 1.5 * (contract(s, s) - 3. * mean_stress * mean_stress);
  }
  return square;
}

Mat SecondGradient::finish(const std::size_t i, const double theta,
                           const double volume, const Mat &F_inverse_transposed)
{
  Mat own = Mat::zero();
  for (int k = 0; k < 3; ++k)
  {
    Mat &s = stress[3 * i + k];
    const double mean_stress = trace(s) / 3.;
    s = theta * s + (1. - theta) * mean_stress * Mat::identity();
    work[i] += 0.5 * volume * contract(old_stress[k] + s, strain[k]);
    generalized_stress[i].columns[k] =
        transpose(volume * (s * F_inverse_transposed));
    own = own - volume * (s * transpose(spatial[k]));
  }
  return own;
}

void SecondGradient::gather(const BondList &bonds,
                            const GhostExchange &exchange,
                            const std::size_t n_owned, Vec *const force)
{
  exchange.update(generalized_stress.data());
  for (std::size_t i = 0; i < n_owned; ++i)
  {
    Vec f = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      for (int k = 0; k < 3; ++k)
        f += multiply_columns(generalized_stress[i].columns[k],
                              bond_gradient[b].row[k]) -
             multiply_columns(generalized_stress[bonds.neighbor[b]].columns[k],
                              bond_gradient[bonds.reverse[b]].row[k]);
    f[3] = 0.;
    force[i] += f;
  }
}
} // namespace sabot
