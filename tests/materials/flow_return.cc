// The return of whole batches: right at every point, whatever else is in the
// batch, and the same for a Flow that is written point by point.
#include "sabot/materials/laws.h"
#include "verification/law_arrays.h"
#include "verification/metals.h"

#include <gtest/gtest.h>

#include <random>

namespace
{
using namespace sabot;

/** Points from far below yield to far above it, at rest and hardened, cold and
    molten. */
struct Points : LawArrays
{
  explicit Points(const std::size_t n, const unsigned int seed = 1) : n(n)
  {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> unit(0., 1.);
    for (std::size_t k = 0; k < n; ++k)
    {
      const double size = std::pow(10., -9. + 8. * unit(generator)),
                   bound = std::pow(10., 7. + 2. * unit(generator));
      for (int c = 0; c < 6; ++c)
      {
        stress[c][k] = bound * (unit(generator) - 0.5);
        strain[c][k] = size * (unit(generator) - 0.5);
      }
      jacobian[k] = 0.7 + 0.5 * unit(generator);
      eps[k] = unit(generator) < 0.2 ? 0. : std::pow(unit(generator), 3.);
      temperature[k] = 250. + 800. * unit(generator);
      extra[k] = unit(generator) < 0.5 ? 0. : bound * bound;
    }
  }
  /** One of them alone. */
  Points(const Points &all, const std::size_t k) : n(1)
  {
    for (int c = 0; c < 6; ++c)
    {
      stress[c][0] = all.stress[c][k];
      strain[c][0] = all.strain[c][k];
    }
    jacobian[0] = all.jacobian[k];
    eps[0] = all.eps[k];
    temperature[0] = all.temperature[k];
    extra[0] = all.extra[k];
  }
  void update(const Material &law, const double dt)
  {
    std::vector<double *> states;
    std::size_t n_other = 0;
    for (const StateVariable &v : law.state_variables())
      for (int c = 0; c < (v.is_tensor ? 6 : 1); ++c)
        states.push_back(v.name == "effective plastic strain" ? eps
                         : v.name == "temperature"            ? temperature
                                                   : other[n_other++]);
    // Simple shear and stretch, as good as any.
    for (int c = 0; c < 9; ++c)
      for (std::size_t k = 0; k < n; ++k)
        F[c][k] = c % 4 == 0 ? jacobian[k] : strain[c % 6][k];
    law.update(batch(law, n, dt, states.data()));
  }

  std::size_t n;
  double eps[max_batch_points], temperature[max_batch_points];
  double other[7][max_batch_points] = {}; // back stress, energy, damage
};

JohnsonCookParameters johnson_cook(const double m)
{
  JohnsonCookParameters p = johnson_cook_parameters("al6061-t6");
  p.C = 0.015;
  p.m = m;
  return p;
}
ZerilliArmstrongParameters zerilli()
{
  ZerilliArmstrongParameters p;
  p.C0 = 65e6;
  p.C1 = 1033e6;
  p.C2 = 890e6;
  p.C3 = 0.0028;
  p.C4 = 0.000115;
  p.C5 = 266e6;
  p.n = 0.289;
  p.melt_temperature = 900.;
  return p;
}
SteinbergGuinanParameters steinberg()
{
  SteinbergGuinanParameters p;
  p.yield_stress = 290e6;
  p.largest_yield_stress = 680e6;
  p.beta = 125.;
  p.n = 0.1;
  p.pressure_coefficient = 6.5e-11;
  p.temperature_coefficient = 6.2e-4;
  p.melt_temperature = 1220.;
  return p;
}

TEST(FlowReturn, metal_melts_where_the_law_says)
{
  // Near its melting curve, by both signs of the power of J: nothing is left
  // from it on, and what is left below is that of the formula.
  for (const double gruneisen : {1., 2., 3.})
  {
    SteinbergGuinanParameters p = steinberg();
    p.gruneisen = gruneisen;
    p.temperature_coefficient = 1e-4;
    const SteinbergGuinanFlow flow{p};
    for (double J = 0.5; J < 1.6; J += 0.01)
      for (const double part : {0.1, 0.5, 0.9, 0.999999, 1.000001, 1.1, 2.})
      {
        const double T = part * flow.melt_temperature(J), pressure = 1e9;
        const auto at = flow.at(splat<WidePack>(T), splat<WidePack>(pressure),
                                splat<WidePack>(J));
        const double left =
            1. + 6.5e-11 * pressure * std::cbrt(J) - 1e-4 * (T - 300.);
        const double expected = part < 1. ? std::max(0., left) : 0.;
        ASSERT_NEAR(at.factor[0], expected, 1e-12) << J << " " << part;
        ASSERT_EQ(at.factor[0] == 0., expected == 0.) << J << " " << part;
      }
  }
}

/** Where a point yielded: q - 3 G d = sigma_y(eps + d, d/dt), with what holds
    at the start of the step. */
template <typename Flow>
void expect_roots(const Flow &flow)
{
  const RateDependentPlasticity<Flow> law(aluminum(), flow, {}, {});
  std::size_t n_yielding = 0, n_elastic = 0;
  for (unsigned int seed = 1; seed <= 40; ++seed)
  {
    const double dt = std::pow(10., -10. + seed % 10);
    const Points before(max_batch_points, seed);
    Points after = before;
    after.update(law, dt);
    for (std::size_t k = 0; k < after.n; ++k)
    {
      double s[6], square = 0.;
      const double *const b = &before.stress[0][k];
      const double pressure =
                       -(b[0] + before.stress[1][k] + before.stress[2][k]) / 3.,
                   trace = (before.strain[0][k] + before.strain[1][k] +
                            before.strain[2][k]) /
                           3.;
      const auto at =
          flow.at(before.temperature[k], pressure, before.jacobian[k]);
      const double G = law.shear_modulus() * flow.shear_factor(at);
      for (int c = 0; c < 6; ++c)
      {
        s[c] = before.stress[c][k] + (c < 3 ? pressure - 2. * G * trace : 0.) +
               2. * G * before.strain[c][k];
        square += (c < 3 ? 1.5 : 3.) * s[c] * s[c];
      }
      const double q = std::sqrt(square + before.extra[k]),
                   // eps + d is too round for the smallest ones
          d = after.work[k] > 0. ? after.work[k] / (after.factor[k] * q)
                                 : after.eps[k] - before.eps[k];
      double slope;
      const double yield = flow.stress(at, before.eps[k], 0., dt, slope);
      if (std::abs(q - yield) < 1e-9 * q || !(G > 0.))
        continue;
      EXPECT_EQ(d > 0. || after.factor[k]<1., q> yield) << k << " " << seed;
      if (!(q > yield))
      {
        ++n_elastic;
        continue;
      }
      ++n_yielding;
      EXPECT_NEAR(q - 3. * G * d,
                  flow.stress(at, before.eps[k] + d, d / dt, dt, slope),
                  2e-8 * q)
          << "eps " << before.eps[k] << " d " << d << " dt " << dt;
      EXPECT_NEAR(after.eps[k], before.eps[k] + d, 1e-14);
      EXPECT_NEAR(after.factor[k], 1. - 3. * G * d / q, 1e-7);
    }
  }
  EXPECT_GT(n_yielding, 500u);
  EXPECT_GT(n_elastic, 20u);
}

TEST(FlowReturn, finds_the_root_at_every_point)
{
  expect_roots(JohnsonCookFlow{johnson_cook(1.34)});
  expect_roots(JohnsonCookFlow{johnson_cook(0.7)});
  expect_roots(ZerilliArmstrongFlow<false>{zerilli()});
  expect_roots(ZerilliArmstrongFlow<true>{zerilli()});
  expect_roots(SteinbergGuinanFlow{steinberg()});
}

void expect_no_neighbors(const std::string &name, const Material &law)
{
  SCOPED_TRACE(name);
  for (const std::size_t n : {1, 5, 8, 31, 64})
  {
    const Points before(n, n);
    Points together = before;
    together.update(law, 1e-7);
    for (std::size_t k = 0; k < n; ++k)
    {
      Points alone(before, k);
      alone.update(law, 1e-7);
      for (int c = 0; c < 6; ++c)
        EXPECT_EQ(alone.stress[c][0], together.stress[c][k]);
      EXPECT_EQ(alone.eps[0], together.eps[k]);
      EXPECT_EQ(alone.temperature[0], together.temperature[k]);
      EXPECT_EQ(alone.factor[0], together.factor[k]);
      EXPECT_EQ(alone.work[0], together.work[k]);
      for (int row = 0; row < 7; ++row)
        EXPECT_EQ(alone.other[row][0], together.other[row][k]);
      if (law.stiffens())
      {
        EXPECT_EQ(alone.stiffening[0], together.stiffening[k]);
      }
    }
  }
}

template <typename Law, typename Parameters>
void expect_no_neighbors(const std::string &name, const Parameters &parameters)
{
  for (const bool shocks : {false, true})
    expect_no_neighbors(
        name, Law(aluminum(), parameters,
                  shocks ? std::make_shared<MieGruneisen>(
                               mie_gruneisen_parameters("al6061-t6-eos"))
                         : ElasticBase::Eos()));
}

TEST(FlowReturn, a_point_does_not_see_its_batch)
{
  JohnsonCookParameters damaged = johnson_cook(1.34);
  damaged.has_damage = true;
  damaged.D[0] = 0.1;
  damaged.D[1] = 0.5;
  damaged.D[2] = -1.5;
  damaged.D[3] = 0.02;
  HardeningParameters table;
  table.table_strain = {0., 0.01, 0.1, 10.};
  table.table_stress = {3e8, 3.5e8, 4e8, 9e8};
  expect_no_neighbors<JohnsonCook>("Johnson-Cook", damaged);
  expect_no_neighbors<HardeningPlasticity>("isotropic",
                                           HardeningParameters{3e8, 1e9, 1.});
  expect_no_neighbors<HardeningPlasticity>("mixed",
                                           HardeningParameters{3e8, 1e9, 0.3});
  expect_no_neighbors<HardeningPlasticity>("table", table);
  const ThermalParameters thermal;
  expect_no_neighbors("bcc",
                      ZerilliArmstrongBcc(aluminum(),
                                          ZerilliArmstrongFlow<true>{zerilli()},
                                          thermal, {}));
  expect_no_neighbors("Steinberg-Guinan",
                      SteinbergGuinan(aluminum(),
                                      SteinbergGuinanFlow{steinberg()}, thermal,
                                      {}));
  expect_no_neighbors("elastic", Elastic(aluminum()));
  expect_no_neighbors("neo-Hookean", NeoHookean(aluminum()));
}

/** Ludwik's law with the rate of Cowper and Symonds, as one writes it down. */
struct PlainFlow
{
  static constexpr bool constant_shear_modulus = true;
  struct Point
  {
    double softening;
  };
  Point at(const double T, const double, const double) const
  {
    return {T < 900. ? 1. - T / 900. : 0.};
  }
  double lower_bound(const Point &point) const { return point.softening * A; }
  double stress(const Point &point, const double eps, const double rate,
                const double dt, double &slope) const
  {
    const double safe = std::max(eps, 1e-14), h = B * std::pow(safe, n);
    const double fast = std::pow(rate / 4e4, 0.25);
    slope = point.softening *
            (n * h / safe * (1. + fast) +
             (rate > 0. ? (A + h) * 0.25 * fast / (rate * dt) : 0.));
    return point.softening * (A + h) * (1. + fast);
  }
  double shear_factor(const Point &) const { return 1.; }

  double A = 324e6, B = 114e6, n = 0.42;
};

TEST(FlowReturn, a_flow_may_be_written_point_by_point)
{
  expect_roots(OneByOne<PlainFlow>{PlainFlow()});
  expect_no_neighbors(
      "one by one", RateDependentPlasticity<OneByOne<PlainFlow>>(
                        aluminum(), OneByOne<PlainFlow>{PlainFlow()}, {}, {}));
}
} // namespace
