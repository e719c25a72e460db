#ifndef sabot_materials_rate_dependent_h
#define sabot_materials_rate_dependent_h

#include "sabot/materials/elastic_base.h"
#include "sabot/materials/flow_return.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
/**
 * Adiabatic heating, dT = eta sigma_eq d_eps/(rho_0 c_p), with the stress at
 * the end of the step, and thermal expansion p += 3 K alpha (T - T_0), with
 * which the volume is free of pressure at J = exp(3 alpha (T - T_0)).
 */
struct ThermalParameters
{
  /**
   * T_0, at which the thermal pressure is zero and the state "temperature"
   * starts.
   */
  double initial_temperature = 294.; // [K]
  /** c_p per mass; with rho_0 it divides the plastic work that becomes heat. */
  double specific_heat = 1000.; // [J/kg/K]
  /**
   * Share of plastic work that becomes heat at once, the rest being stored in
   * the lattice (G. I. Taylor and H. Quinney, Proc. R. Soc. A 143 (1934) 307).
   */
  double taylor_quinney = 0.9; // eta; 0 switches heating off
  /**
   * The law itself is adiabatic: conduction between points is the body's to do,
   * with specific_heat() and conductivity() of the material.
   */
  double conductivity = 0.; // [W/m/K], for bodies that conduct
  /**
   * Refused beside an equation of state with a thermal pressure of its own, as
   * it would count twice.
   */
  double expansion = 0.; // linear, [1/K]; p += 3 K alpha (T - T_0)

  /** The entries of the present subsection; @p initial_temperature is the
      default of that, with its unit. */
  static void declare_parameters(Parameters &prm,
                                 const std::string &initial_temperature);
  /** @p path of the law; refuses expansion beside an equation of state that
      has a thermal pressure of its own. */
  static ThermalParameters parse(const Parameters &prm, const std::string &path,
                                 const EquationOfState &eos);
};

/**
 * A Flow that is written for double alone, point by point: for laws in which
 * packs are not worth their pains. @p Scalar has at(), lower_bound(), stress()
 * and shear_factor() of doubles and a plain struct Point.
 */
template <typename Scalar>
struct OneByOne
{
  static constexpr bool constant_shear_modulus = Scalar::constant_shear_modulus;
  template <typename Number>
  struct Point
  {
    typename Scalar::Point lane[sizeof(Number) / sizeof(double)];
  };
  Scalar flow;

  template <typename Number>
  Point<Number> at(const Number T, const Number p, const Number J) const
  {
    Point<Number> point;
    for_lanes<Number>(
        [&](const std::size_t i)
        { point.lane[i] = flow.at(of(T, i), of(p, i), of(J, i)); });
    return point;
  }
  template <typename Number>
  Number lower_bound(const Point<Number> &point) const
  {
    Number bound;
    for_lanes<Number>([&](const std::size_t i)
                      { set(bound, i, flow.lower_bound(point.lane[i])); });
    return bound;
  }
  double smallest_stress(const double) const { return 0.; }
  template <typename Number>
  Number stress(const Point<Number> &point, const Number eps, const Number rate,
                const double dt, Number &slope) const
  {
    Number stress;
    for_lanes<Number>(
        [&](const std::size_t i)
        {
          double s;
          set(stress, i,
              flow.stress(point.lane[i], of(eps, i), of(rate, i), dt, s));
          set(slope, i, s);
        });
    return stress;
  }
  template <typename Number>
  Number shear_factor(const Point<Number> &point) const
  {
    Number factor;
    for_lanes<Number>([&](const std::size_t i)
                      { set(factor, i, flow.shear_factor(point.lane[i])); });
    return factor;
  }

private:
  template <typename Number, typename Function>
  static void for_lanes(const Function &function)
  {
    for (std::size_t i = 0; i < sizeof(Number) / sizeof(double); ++i)
      function(i);
  }
  template <typename Number>
  static double of(const Number &a, const std::size_t i)
  {
    return reinterpret_cast<const double *>(&a)[i];
  }
  template <typename Number>
  static void set(Number &a, const std::size_t i, const double value)
  {
    reinterpret_cast<double *>(&a)[i] = value;
  }
};

/**
 * J2 plasticity with a flow stress that depends on strain, rate, temperature
 * and pressure, the latter two as of the start of the step. Implicit in strain
 * and rate: with the trial q = sqrt(3/2 s:s + extra_square), the increment d of
 * the effective plastic strain is the root of
 *
 *   q - 3 G d - sigma_y(eps + d, d/dt) = 0
 *
 * by safeguarded Newton on the yielding points (FlowReturn); then s is scaled
 * by theta = 1 - 3 G d/q. States: "effective plastic strain", "temperature".
 *
 * A new law of this kind is a Flow, its entries and a registration, as in
 * source/materials/zerilli_armstrong.cc. The template is instantiated there,
 * with the Flow inlined into the loop over points.
 *
 * A Flow has, with Number double or a pack of points (kernels/pack_math.h),
 *   Point<Number> at(T, p, J)     what stays fixed during the return,
 *   lower_bound(Point)            a stress no yield stress is below [Pa],
 *   stress(Point, eps, rate, dt, slope&)  flow stress [Pa], never negative and
 *                                 not falling with eps at fixed dt; slope is
 *                                 its derivative with eps, the rate's included,
 *   shear_factor(Point)           G over its value at rest, at least 0,
 *   smallest_stress(T)            of a double, without powers: not above
 *                                 lower_bound() at any pressure and volume; 0
 *                                 where the Flow cannot say;
 *                                 not asked of one with a modulus that moves,
 *   constant_shear_modulus        whether shear_factor(Point) is 1 always.
 * One that is written for double alone, with Point a plain struct and without
 * smallest_stress(), is used as OneByOne<Flow>, at the price of scalar code.
 */
template <typename Flow>
class RateDependentPlasticity : public ElasticBase
{
public:
  /**
   * Values are taken as they come: the laws' parse functions have checked them
   * and throw InputError by the entry. @p eos may be null, for p = -K ln J.
   */
  RateDependentPlasticity(const ElasticConstants &elastic, const Flow &flow,
                          const ThermalParameters &thermal, const Eos &eos)
      : ElasticBase(elastic, eos), flow(flow), thermal(thermal)
  {
  }
  // Of the state "temperature".
  double specific_heat() const override { return thermal.specific_heat; }
  double conductivity() const override { return thermal.conductivity; }
  /**
   * The flow stress at strain and rate 0, at the initial temperature.
   * Where the law has an effect of rate this is its slow limit [Pa].
   */
  std::optional<double> initial_yield_stress() const override
  {
    double slope;
    return flow.stress(flow.at(thermal.initial_temperature, 0., 1.), 0., 0., 1.,
                       slope);
  }
  /** With a shear modulus that follows the pressure, or an equation of state
      that does. */
  bool stiffens() const override
  {
    return !Flow::constant_shear_modulus || eos->stiffens();
  }

protected:
  /**
   * Scalars both: the effective plastic strain, integral of sqrt(2/3 D_p : D_p)
   * dt, and T [K]. Laws that derive from this one append theirs.
   */
  std::vector<StateVariable> law_variables() const override
  {
    return {{"effective plastic strain", 0., false},
            {"temperature", thermal.initial_temperature, false}};
  }
  /**
   * Pressure of the start is -tr(sigma)/3 of the old stress; G follows it where
   * the Flow says so. Per point: trial s + 2 G dev(d_eps), q from it and
   * extra_square, and where q is above sigma_y(eps, 0) the return
   *   s <- theta s,  theta = max(0, 1 - 3 G d/q),
   *   work = theta q d [J/m^3],  dT = eta work/(rho_0 c_p).
   * Where G = 0 (melt) nothing of s stays. lower_bound() saves the powers of
   * the flow stress for points far from yield.
   */
  void update_deviator(const MaterialBatch &batch,
                       Scratch &scratch) const override;
  /**
   * Takes the thermal pressure 3 K alpha (T - T_0) off the normal stresses, and
   * where G may move and the body asks for `stiffening` writes the largest of
   * 1, the bulk modulus of now over that at rest and G/G_0, one factor for K +
   * 4/3 G.
   */
  void after_pressure(const MaterialBatch &batch,
                      const Scratch &scratch) const override;

  const Flow flow;
  const ThermalParameters thermal;

private:
  /** The trial deviator of all points with the modulus of each, the square of
      q [Pa^2] and 2/3 of that of the deviatoric strain increment; nothing has
      yielded. */

  void make_trial(const MaterialBatch &batch, const double *modulus,
                  double *square, double *strain_square) const;
  /** G_0 shear_factor() per point at @p pressure [Pa], and unless null a
      stress that no yield stress is below [Pa]. */
  void find_modulus(const MaterialBatch &batch, const double *pressure,
                    double *modulus, double *bound) const;
};

template <typename Flow>
void RateDependentPlasticity<Flow>::find_modulus(const MaterialBatch &b,
                                                 const double *const pressure,
                                                 double *const modulus,
                                                 double *const bound) const
{
  const double *const temperature = b.state(1);
  if (Flow::constant_shear_modulus)
  {
    std::fill_n(modulus, b.n, G);
    for (std::size_t k = 0; bound != nullptr && k < b.n; ++k)
      bound[k] = flow.smallest_stress(temperature[k]);
    return;
  }
  for (std::size_t k = 0; k < b.n; k += n_wide)
  {
    const auto at = flow.at(load_wide(&temperature[k]), load_wide(&pressure[k]),
                            load_wide(&b.jacobian[k]));
    store_wide(&modulus[k], G * flow.shear_factor(at));
    if (bound != nullptr)
      store_wide(&bound[k], flow.lower_bound(at));
  }
}

template <typename Flow>
void RateDependentPlasticity<Flow>::make_trial(
    const MaterialBatch &b, const double *const modulus, double *const square,
    double *const strain_square) const
{
  for (std::size_t k = 0; k < b.n; k += n_wide)
  {
    WidePack s[6], e[6];
    load_wide(b.stress, k, s);
    load_wide(b.strain_increment, k, e);
    make_deviator(s);
    make_deviator(e);
    const WidePack two_G = 2. * load_wide(&modulus[k]);
    for (int c = 0; c < 6; ++c)
      s[c] += two_G * e[c];
    store_wide(b.stress, k, s);
    store_wide(&square[k], 1.5 * square_of(s) + load_wide(&b.extra_square[k]));
    store_wide(&strain_square[k], 2. / 3. * square_of(e));
    store_wide(&b.return_factor[k], splat<WidePack>(1.));
    store_wide(&b.plastic_work[k], WidePack{});
  }
}

// Whole batches: the trial deviator, the few points that may yield, their
// return, and the factors of all.
template <typename Flow>
void RateDependentPlasticity<Flow>::update_deviator(const MaterialBatch &b,
                                                    Scratch &) const
{
  double *const eps = b.state(0), *const temperature = b.state(1);
  double pressure[max_batch_points], modulus[max_batch_points],
      bound[max_batch_points], square[max_batch_points],
      strain_square[max_batch_points];
  for (std::size_t k = 0; k < b.n; ++k)
    pressure[k] = -(b.stress[0][k] + b.stress[1][k] + b.stress[2][k]) / 3.;
  find_modulus(b, pressure, modulus, bound);
  make_trial(b, modulus, square, strain_square);

  FlowReturn<Flow> points(flow, b.dt);
  for (std::size_t k = 0; k < b.n; ++k)
    points.ask(k, square[k], bound[k]);
  if (!points.find(
          {eps, temperature, pressure, b.jacobian, modulus, strain_square}))
    return;
  const double heating =
      thermal.taylor_quinney / (density() * thermal.specific_heat);
  for (std::size_t i = 0; i < points.n; ++i)
  {
    const std::size_t k = points.point[i];
    const double work = points.theta[i] * points.q[i] * points.increment[i];
    eps[k] += points.increment[i];
    temperature[k] += heating * work;
    b.return_factor[k] = points.theta[i];
    b.plastic_work[k] = work;
  }
#pragma GCC ivdep
  for (std::size_t k = 0; k < b.n; ++k)
    for (int c = 0; c < 6; ++c)
      b.stress[c][k] *= b.return_factor[k];
}

// Thermal expansion, and the stiffening of laws whose shear modulus moves.
template <typename Flow>
void RateDependentPlasticity<Flow>::after_pressure(const MaterialBatch &b,
                                                   const Scratch &) const
{
  const double K = bulk_modulus(), rest = K + 4. / 3. * G;
  const double *const temperature = b.state(1);
  if (thermal.expansion > 0.)
    for (std::size_t k = 0; k < b.n; ++k)
    {
      const double pressure = 3. * K * thermal.expansion *
                              (temperature[k] - thermal.initial_temperature);
      for (int c = 0; c < 3; ++c)
        b.stress[c][k] -= pressure;
    }
  if (Flow::constant_shear_modulus || !b.stiffening)
    return;
  double pressure[max_batch_points], modulus[max_batch_points];
  for (std::size_t k = 0; k < b.n; ++k)
    pressure[k] = -(b.stress[0][k] + b.stress[1][k] + b.stress[2][k]) / 3.;
  find_modulus(b, pressure, modulus, nullptr);
  const bool bulk_stiffens = eos->stiffens();
  for (std::size_t k = 0; k < b.n; ++k)
  {
    const double bulk =
        bulk_stiffens ? b.stiffening[k] * rest - 4. / 3. * G : K;
    // One factor for both moduli: the larger.
    b.stiffening[k] = std::max({1., bulk / K, modulus[k] / G});
  }
}
} // namespace sabot

#endif
