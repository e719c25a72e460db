#include "sabot/base/error.h"
#include "sabot/base/quantity.h"
#include "sabot/materials/laws.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
std::vector<StateVariable> JohnsonCook::state_variables() const
{
  return {{"effective plastic strain", "1", 0., false},
          {"temperature", "K", parameters.initial_temperature, false}};
}

double JohnsonCook::thermal_factor(const double temperature) const
{
  const double above = temperature - parameters.room_temperature;
  if (above <= 0.)
    return 1.;
  const double T =
      above / (parameters.melt_temperature - parameters.room_temperature);
  return T >= 1. ? 0. : 1. - std::pow(T, parameters.m);
}

double JohnsonCook::flow_stress(const double eps, const double rate,
                                const double thermal, const double dt,
                                double &slope) const
{
  const JohnsonCookParameters &p = parameters;
  const double safe = std::max(eps, 1e-14);
  const double hardening = p.B * std::pow(safe, p.n);
  const double relative = rate / p.reference_strain_rate;
  const double fast = relative > 1. ? 1. + p.C * std::log(relative) : 1.;
  const double fast_slope = relative > 1. ? p.C / (rate * dt) : 0.;
  slope = thermal *
          (p.n * hardening / safe * fast + (p.A + hardening) * fast_slope);
  return thermal * (p.A + hardening) * fast;
}

double JohnsonCook::plastic_increment(const double q, const double eps,
                                      const double thermal,
                                      const double dt) const
{
  // Root of q - 3 G d - sigma_y(eps + d, d/dt), decreasing in d: Newton inside
  // a bracket that always holds the root.
  double low = 0., high = q / (3. * G), slope;
  double d =
      std::min(high, (q - flow_stress(eps, 0., thermal, dt, slope)) / (3. * G));
  for (int iteration = 0; iteration < 60; ++iteration)
  {
    const double f =
        q - 3. * G * d - flow_stress(eps + d, d / dt, thermal, dt, slope);
    (f > 0. ? low : high) = d;
    if (std::abs(f) <= 1e-12 * q || high - low <= 1e-16 * high)
      break;
    const double next = d + f / (3. * G + slope);
    d = next > low && next < high ? next : 0.5 * (low + high);
  }
  return d;
}

void JohnsonCook::update(const MaterialBatch &b) const
{
  trial_stress(b);
  double *const eps = b.state(0), *const temperature = b.state(1);
  const double heating =
      parameters.taylor_quinney / (density() * parameters.specific_heat);
  for (std::size_t k = 0; k < b.n; ++k)
  {
    const double mean = (b.stress[0][k] + b.stress[1][k] + b.stress[2][k]) / 3.;
    const double x = b.stress[0][k] - mean, y = b.stress[1][k] - mean,
                 z = b.stress[2][k] - mean, xy = b.stress[3][k],
                 yz = b.stress[4][k], xz = b.stress[5][k];
    const double q = std::sqrt(
        1.5 * (x * x + y * y + z * z + 2. * (xy * xy + yz * yz + xz * xz)) +
        b.extra_square[k]);
    b.return_factor[k] = 1.;
    b.plastic_work[k] = 0.;
    const double thermal = thermal_factor(temperature[k]);
    // No point below the bare initial yield stress needs the power law.
    if (q <= thermal * parameters.A)
      continue;
    double slope;
    if (q <= flow_stress(eps[k], 0., thermal, b.dt, slope))
      continue;
    const double d = plastic_increment(q, eps[k], thermal, b.dt);
    const double theta = std::max(0., 1. - 3. * G * d / q);
    b.stress[0][k] = theta * x + mean;
    b.stress[1][k] = theta * y + mean;
    b.stress[2][k] = theta * z + mean;
    b.stress[3][k] = theta * xy;
    b.stress[4][k] = theta * yz;
    b.stress[5][k] = theta * xz;
    const double work = theta * q * d;
    eps[k] += d;
    temperature[k] += heating * work;
    b.return_factor[k] = theta;
    b.plastic_work[k] = work;
  }
}

namespace
{
const RegisterMaterial registered(
    {"Johnson-Cook",
     "strain, strain-rate and thermal softening with adiabatic heating.",
     [](dealii::ParameterHandler &prm)
     {
       const auto entry = [&](const std::string &name, const std::string &value,
                              const Dimension d, const double low,
                              const double high, const std::string &text)
       { prm.declare_entry(name, value, QuantityPattern(d, low, high), text); };
       entry("Initial yield stress", "0", Dimension::pressure, 0., 1e12, "A.");
       entry("Hardening modulus", "0", Dimension::pressure, 0., 1e12, "B.");
       entry("Hardening exponent", "1", Dimension::none, 0.001, 5., "n.");
       entry("Strain rate coefficient", "0", Dimension::none, 0., 1., "C.");
       entry("Thermal softening exponent", "1", Dimension::none, 0.01, 10.,
             "m.");
       entry("Reference strain rate", "1 1/s", Dimension::strain_rate, 1e-9,
             1e9, "Rate below which there is no rate effect.");
       entry("Room temperature", "294 K", Dimension::temperature, 0., 1e4,
             "Temperature below which there is no softening.");
       entry("Initial temperature", "294 K", Dimension::temperature, 0., 1e4,
             "Temperature at time 0.");
       entry("Melt temperature", "1000 K", Dimension::temperature, 1., 1e5,
             "Temperature at which the strength is gone.");
       entry("Specific heat", "1000 J/kg/K", Dimension::specific_heat, 1., 1e6,
             "At constant pressure.");
       entry("Taylor-Quinney fraction", "0.9", Dimension::none, 0., 1.,
             "Part of the plastic work that becomes heat; 0 switches adiabatic "
             "heating off.");
     },
     [](dealii::ParameterHandler &prm, const std::string &path)
     {
       const ElasticConstants elastic = ElasticConstants::parse(prm, path);
       prm.enter_subsection("Johnson-Cook");
       JohnsonCookParameters p;
       p.A = get_quantity(prm, "Initial yield stress");
       p.B = get_quantity(prm, "Hardening modulus");
       p.n = get_quantity(prm, "Hardening exponent");
       p.C = get_quantity(prm, "Strain rate coefficient");
       p.m = get_quantity(prm, "Thermal softening exponent");
       p.reference_strain_rate = get_quantity(prm, "Reference strain rate");
       p.room_temperature = get_quantity(prm, "Room temperature");
       p.initial_temperature = get_quantity(prm, "Initial temperature");
       p.melt_temperature = get_quantity(prm, "Melt temperature");
       p.specific_heat = get_quantity(prm, "Specific heat");
       p.taylor_quinney = get_quantity(prm, "Taylor-Quinney fraction");
       prm.leave_subsection();
       const std::string here = path + "/Johnson-Cook/";
       if (p.A <= 0.)
         throw InputError(here + "Initial yield stress",
                          "must be set to a positive stress, for example "
                          "324 MPa");
       if (p.melt_temperature <= p.room_temperature)
         throw InputError(here + "Melt temperature",
                          "must be above the room temperature");
       return std::make_unique<JohnsonCook>(elastic, p);
     }});
} // namespace
} // namespace sabot
