// Mie-Gruneisen pressure against Rankine-Hugoniot and the isentrope.
#include "point.h"
#include "sabot/materials/mie_gruneisen.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

namespace
{
using namespace sabot;

// Almost a fluid, so that pressure is all there is.
ElasticConstants fluid()
{
  return {aluminum().density, 1e3, 0.49};
}

const MieGruneisenParameters &shock_data()
{
  static const auto data = mie_gruneisen_parameters("al6061-t6-eos");
  return data;
}

std::shared_ptr<const EquationOfState> mie_gruneisen()
{
  return std::make_shared<MieGruneisen>(shock_data());
}

/** rho_0 c_0^2 [Pa]. */
double bulk_modulus(const MieGruneisenParameters &p)
{
  return p.density * p.sound_speed * p.sound_speed;
}

double hugoniot(const double eta)
{
  const MieGruneisenParameters &p = shock_data();
  const double D = 1. - p.shock_slope * eta;
  return bulk_modulus(p) * eta / (D * D);
}

double pressure(const Point &point)
{
  return -(point.stress[0] + point.stress[1] + point.stress[2]) / 3.;
}

/** Uniaxial strain to volume ratio @p J in @p n equal parts of J; @p q gives
    the viscous pressure from the mean J. */
template <typename Viscosity>
void strain(Point &point, const double J, const int n, const Viscosity &q)
{
  const double start = point.jacobian, part = (J - start) / n;
  for (int i = 0; i < n; ++i)
  {
    const double mid = start + (i + 0.5) * part;
    point.viscous_pressure = q(mid);
    point.step({part / mid, 0, 0, 0, 0, 0}, {0, 0, 0}, 1e-9);
  }
}

const auto no_viscosity = [](double) { return 0.; };

TEST(MieGruneisen, along_the_rayleigh_line_ends_on_the_hugoniot)
{
  // A steady shock: p + q is linear in the volume; its end has p = p_H and
  // e = p_H eta/(2 rho_0) whatever Gamma (Rankine and Hugoniot).
  const Elastic law(fluid(), mie_gruneisen());
  for (const double eta : {0.02, 0.1, 0.3})
  {
    Point point(law);
    const double end = hugoniot(eta);
    strain(point, 1. - eta, 4000,
           [&](const double J)
           { return end * (1. - J) / eta - pressure(point); });
    EXPECT_NEAR(pressure(point), end, 1e-3 * end);
    EXPECT_NEAR(point.state[0], end * eta / (2. * aluminum().density),
                1e-3 * end * eta / (2. * aluminum().density));
  }
}

TEST(MieGruneisen, compression_and_release_are_an_isentrope)
{
  // de = -p dv, by RK4 with 100 times the steps.
  const Elastic law(fluid(), mie_gruneisen());
  const MieGruneisenParameters &data = shock_data();
  const double rho = data.density;
  const auto p_of = [&](const double J, const double e)
  {
    const double eta = 1. - J;
    const double cold = eta > 0.
                            ? hugoniot(eta) * (1. - 0.5 * data.gruneisen * eta)
                            : bulk_modulus(data) * (1. / J - 1.);
    return cold + data.gruneisen * rho * e;
  };
  const auto isentrope = [&](double J, double e, const double end)
  {
    const int n = 40000;
    const double h = (end - J) / n;
    for (int i = 0; i < n; ++i, J += h)
    {
      const auto f = [&](const double v, const double u)
      { return -p_of(v, u) / rho; };
      const double a = f(J, e), b = f(J + 0.5 * h, e + 0.5 * h * a),
                   c = f(J + 0.5 * h, e + 0.5 * h * b), d = f(J + h, e + h * c);
      e += h / 6. * (a + 2. * b + 2. * c + d);
    }
    return e;
  };
  Point point(law);
  strain(point, 0.8, 400, no_viscosity);
  const double e = isentrope(1., 0., 0.8);
  EXPECT_NEAR(point.state[0], e, 1e-4 * e);
  EXPECT_NEAR(pressure(point), p_of(0.8, e), 1e-4 * pressure(point));
  strain(point, 1., 400, no_viscosity);
  EXPECT_NEAR(point.state[0], 0., 1e-4 * e);
  EXPECT_NEAR(pressure(point), 0., 1e-4 * p_of(0.8, e));

  // Release from a shock: hotter, so the volume at zero pressure is larger.
  Point shocked(law);
  const double eta = 0.2, end = hugoniot(eta);
  strain(shocked, 1. - eta, 20000,
         [&](const double J)
         { return end * (1. - J) / eta - pressure(shocked); });
  strain(shocked, 1.02, 800, no_viscosity);
  const double left =
      isentrope(1. - eta, end * eta / (2. * aluminum().density), 1.02);
  EXPECT_NEAR(shocked.state[0], left, 1e-3 * left);
  EXPECT_GT(left, 0.);
}

TEST(MieGruneisen, stiffening_is_the_slope_of_the_isentrope)
{
  MieGruneisenParameters corrected = shock_data();
  corrected.volume_correction = 0.48;
  const Elastic law(fluid(), std::make_shared<MieGruneisen>(corrected));
  for (const double J : {1.05, 0.98, 0.8, 0.6})
  {
    Point point(law);
    strain(point, J, 2000, no_viscosity);
    const double modulus = point.stiffening, before = pressure(point);
    const double change = -1e-5;
    strain(point, J + change, 1, no_viscosity);
    const double slope = -J * (pressure(point) - before) / change;
    const double expected = slope / bulk_modulus(corrected);
    EXPECT_NEAR(modulus, expected, 1e-3 * expected) << J;
  }
}

TEST(MieGruneisen, extreme_volumes_keep_numbers)
{
  const Elastic law(fluid(), mie_gruneisen());
  Point point(law);
  double last = 0.;
  for (const double J : {0.5, 0.27, 0.2, 0.1})
  {
    strain(point, J, 100, no_viscosity);
    EXPECT_TRUE(std::isfinite(pressure(point)));
    EXPECT_GT(pressure(point), last);
    EXPECT_GT(point.stiffening, 1.);
    last = pressure(point);
  }
  Point torn(law);
  strain(torn, 10., 1000, no_viscosity);
  EXPECT_TRUE(std::isfinite(pressure(torn)));
}

TEST(MieGruneisen, energy_counts_the_work_of_the_deviator)
{
  // Pure shear: no volume change, rho_0 e is the work.
  const HardeningPlasticity law(
      aluminum(), {aluminum_yield_stress(), 150e6, 1.}, mie_gruneisen());
  Point point(law);
  for (int i = 0; i < 1000; ++i)
    point.step({0, 0, 0, 1e-4, 0, 0}, {0, 0, 0}, 1e-9);
  EXPECT_EQ(law.state_variables()[0].name, "specific internal energy");
  // det F departs from 1 by the squares of the strain increments.
  EXPECT_NEAR(aluminum().density * point.state[0], point.energy,
              1e-3 * point.energy);
  EXPECT_NEAR(pressure(point), shock_data().gruneisen * point.energy,
              1e-2 * pressure(point));
}
} // namespace
