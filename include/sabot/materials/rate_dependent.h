#ifndef sabot_materials_rate_dependent_h
#define sabot_materials_rate_dependent_h

#include "sabot/materials/elastic_base.h"

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
 * J2 plasticity with a flow stress that depends on strain, rate, temperature
 * and pressure, the latter two as of the start of the step. Implicit in strain
 * and rate: with the trial q = sqrt(3/2 s:s + extra_square), the increment d of
 * the effective plastic strain is the root of
 *
 *   q - 3 G d - sigma_y(eps + d, d/dt) = 0
 *
 * by safeguarded Newton on the yielding points; then s is scaled by
 * theta = 1 - 3 G d/q. States: "effective plastic strain", "temperature".
 *
 * The left side falls with d, as sigma_y does not: there is one root, between 0
 * and q/(3 G), and Newton's steps are taken while they stay within the bracket
 * that is known to hold it, else halved. Where sigma_y has a power of eps, the
 * first guess leaves the slope at eps = 0 out, which has no bound.
 *
 * A new law of this kind is a Flow, its entries and a registration, as in
 * source/materials/zerilli_armstrong.cc. The template is instantiated there,
 * with the Flow inlined into the loop over points.
 *
 * A Flow has
 *   Point at(T, p, J)             what stays fixed during the return,
 *   lower_bound(Point)            a stress no yield stress is below [Pa],
 *   stress(Point, eps, rate, dt, slope&)  flow stress [Pa], never negative and
 *                                 not falling with eps at fixed dt; slope is
 *                                 its derivative with eps, the rate's included,
 *   constant_shear_modulus        whether shear_factor(Point) is 1 always,
 *   shear_factor(Point)           G over its value at rest, at least 0.
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
  /**
   * The root d > 0 for a trial @p q [Pa] above @p yield, to 1e-12 of q or what
   * follows from quadratic convergence; @p yield, @p slope: flow stress and its
   * slope at @p eps and rate 0.
   * At most a hundred iterations; the bracket at least halves wherever Newton's
   * step leaves it. @p point: what at() made of T, p and J; @p shear_modulus
   * [Pa] of the start of the step, positive; @p dt [s].
   */
  double increment(const typename Flow::Point &point, const double q,
                   const double shear_modulus, const double eps,
                   const double dt, const double yield, double slope) const;
};

template <typename Flow>
double RateDependentPlasticity<Flow>::increment(
    const typename Flow::Point &point, const double q,
    const double shear_modulus, const double eps, const double dt,
    const double yield, double slope) const
{
  // Root of q - 3 G d - sigma_y(eps + d, d/dt), decreasing in d: Newton inside
  // a bracket that always holds the root.
  const double three_G = 3. * shear_modulus;
  double low = 0., high = q / three_G;
  // Power laws have no useful slope at strain 0.
  double d = (q - yield) / (three_G + (eps > 1e-8 ? slope : 0.));
  for (int iteration = 0; iteration < 100; ++iteration)
  {
    const double f =
        q - three_G * d - flow.stress(point, eps + d, d / dt, dt, slope);
    (f > 0. ? low : high) = d;
    if (std::abs(f) <= 1e-12 * q || high - low <= 1e-15 * high)
      break;
    const double next = d + f / (three_G + slope), change = std::abs(next - d);
    const bool trusted = next > low && next < high;
    // Convergence is quadratic: what remains is below 1e-8 of the stress.
    const bool done = trusted && change <= 1e-4 * d;
    d = trusted ? next : 0.5 * (low + high);
    if (done)
      break;
  }
  return d;
}

// One loop over the points with everything inlined: the trial deviator, the
// yield condition, and for the few points that yield the return.
template <typename Flow>
void RateDependentPlasticity<Flow>::update_deviator(const MaterialBatch &b,
                                                    Scratch &) const
{
  constexpr bool constant_G = Flow::constant_shear_modulus;
  double *const eps = b.state(0), *const temperature = b.state(1);
  const double heating =
      thermal.taylor_quinney / (density() * thermal.specific_heat);
  double pressure[max_batch_points];
  for (std::size_t k = 0; k < b.n; ++k)
    pressure[k] = -(b.stress[0][k] + b.stress[1][k] + b.stress[2][k]) / 3.;
  if (constant_G)
    trial_deviator(b);
  for (std::size_t k = 0; k < b.n; ++k)
  {
    const typename Flow::Point point =
        flow.at(temperature[k], pressure[k], b.jacobian[k]);
    double modulus = G;
    if (!constant_G)
    {
      modulus *= flow.shear_factor(point);
      const double *const *const e = b.strain_increment;
      const double trace = (e[0][k] + e[1][k] + e[2][k]) / 3.;
      for (int c = 0; c < 3; ++c)
        b.stress[c][k] += 2. * modulus * (e[c][k] - trace) + pressure[k];
      for (int c = 3; c < 6; ++c)
        b.stress[c][k] += 2. * modulus * e[c][k];
    }
    const double x = b.stress[0][k], y = b.stress[1][k], z = b.stress[2][k],
                 xy = b.stress[3][k], yz = b.stress[4][k], xz = b.stress[5][k];
    const double q = std::sqrt(
        1.5 * (x * x + y * y + z * z + 2. * (xy * xy + yz * yz + xz * xz)) +
        b.extra_square[k]);
    b.return_factor[k] = 1.;
    b.plastic_work[k] = 0.;
    // The power laws are for points that may yield.
    if (q <= flow.lower_bound(point))
      continue;
    double slope;
    const double yield = flow.stress(point, eps[k], 0., b.dt, slope);
    if (q <= yield)
      continue;
    // Without shear modulus there is nothing but to let go.
    const double d =
        modulus > 0. ? increment(point, q, modulus, eps[k], b.dt, yield, slope)
                     : 0.;
    const double theta =
        modulus > 0. ? std::max(0., 1. - 3. * modulus * d / q) : 0.;
    for (int c = 0; c < 6; ++c)
      b.stress[c][k] *= theta;
    const double work = theta * q * d;
    eps[k] += d;
    temperature[k] += heating * work;
    b.return_factor[k] = theta;
    b.plastic_work[k] = work;
  }
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
  for (std::size_t k = 0; k < b.n; ++k)
  {
    const double pressure =
        -(b.stress[0][k] + b.stress[1][k] + b.stress[2][k]) / 3.;
    const double factor =
        flow.shear_factor(flow.at(temperature[k], pressure, b.jacobian[k]));
    const double bulk =
        eos->stiffens() ? b.stiffening[k] * rest - 4. / 3. * G : K;
    // One factor for both moduli: the larger.
    b.stiffening[k] = std::max({1., bulk / K, factor});
  }
}
} // namespace sabot

#endif
