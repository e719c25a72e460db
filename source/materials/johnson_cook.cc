// Flow stress and fracture strain after Johnson and Cook.
#include "sabot/materials/johnson_cook.h"

#include "sabot/base/output_fields.h"
#include "sabot/base/registry.h"

namespace sabot
{
JohnsonCook::JohnsonCook(const ElasticConstants &elastic,
                         const JohnsonCookParameters &p, const Eos &eos)
    : RateDependentPlasticity(elastic, JohnsonCookFlow{p},
                              {p.initial_temperature, p.specific_heat,
                               p.taylor_quinney, p.conductivity,
                               p.thermal_expansion},
                              eos)
{
}

std::vector<StateVariable> JohnsonCook::law_variables() const
{
  auto variables = RateDependentPlasticity::law_variables();
  if (flow.p.has_damage)
    variables.push_back({"damage", 0., false});
  return variables;
}

std::optional<double>
JohnsonCook::slow_fracture_strain(const double triaxiality) const
{
  if (!flow.p.has_damage)
    return std::nullopt;
  return fracture_strain(triaxiality, flow.p.reference_strain_rate,
                         flow.p.initial_temperature);
}

void JohnsonCook::update_deviator(const MaterialBatch &b,
                                  Scratch &old_strain) const
{
  if (flow.p.has_damage)
    std::copy_n(b.state(0), b.n, old_strain);
  RateDependentPlasticity::update_deviator(b, old_strain);
}

namespace
{
/** d_eps/eps_f of the points of a pack at stress @p s, which becomes its
    deviator. Melted points have no von Mises stress: it counts as @p smallest
    at least [Pa], and the clamp takes the ratio. */
inline WidePack damage_increment(const JohnsonCookFlow &flow, WidePack s[6],
                                 const WidePack increment, const double dt,
                                 const WidePack temperature,
                                 const double smallest)
{
  const WidePack mean = make_deviator(s),
                 von_mises = pack_sqrt(1.5 * square_of(s)),
                 triaxiality =
                     mean / pack_max(von_mises, splat<WidePack>(smallest));
  return increment /
         flow.fracture_strain(triaxiality, increment / dt, temperature);
}
} // namespace

void JohnsonCook::after_pressure(const MaterialBatch &b,
                                 const Scratch &old_strain) const
{
  RateDependentPlasticity::after_pressure(b, old_strain);
  if (!flow.p.has_damage)
    return;
  const double *const eps = b.state(0), *const temperature = b.state(1);
  double *const damage = b.state(2);
  std::size_t flowing[max_batch_points + n_wide], n = 0;
  double d[max_batch_points + n_wide];
  for (std::size_t k = 0; k < b.n; ++k)
  {
    flowing[n] = k;
    d[n] = eps[k] - old_strain[k];
    n += d[n] > 0.;
  }
  const double smallest = 1e-12 * shear_modulus();
  const auto damage_of =
      [&](WidePack s[6], const double *const increment, const double *const T)
  {
    return damage_increment(flow, s, load_wide(increment), b.dt, load_wide(T),
                            smallest);
  };
  WidePack s[6];
  if (n == b.n)
  {
    for (std::size_t k = 0; k < n; k += n_wide)
    {
      load_wide(b.stress, k, s);
      store_wide(&damage[k],
                 load_wide(&damage[k]) + damage_of(s, &d[k], &temperature[k]));
    }
    return;
  }
  // Whole packs, filled up with the last point.
  double stress[6][max_batch_points], T[max_batch_points];
  for (std::size_t i = 0; i < (n + n_wide - 1) / n_wide * n_wide; ++i)
  {
    if (i >= n)
    {
      flowing[i] = flowing[n - 1];
      d[i] = d[n - 1];
    }
    for (int c = 0; c < 6; ++c)
      stress[c][i] = b.stress[c][flowing[i]];
    T[i] = temperature[flowing[i]];
  }
  for (std::size_t i = 0; i < n; i += n_wide)
  {
    for (int c = 0; c < 6; ++c)
      s[c] = load_wide(&stress[c][i]);
    store_wide(&d[i], damage_of(s, &d[i], &T[i]));
  }
  for (std::size_t i = 0; i < n; ++i)
    damage[flowing[i]] += d[i];
}

namespace
{
const char *const damage_names[5] = {"D1", "D2", "D3", "D4", "D5"};

void declare(Parameters &prm)
{
  const auto entry = [&](const std::string &name, const std::string &value,
                         const Dimension d, const double low, const double high,
                         const std::string &text)
  { prm.declare_entry(name, value, quantity(d, low, high), text); };
  entry("Initial yield stress", "0", Dimension::pressure, 0., 1e12, "A.");
  entry("Hardening modulus", "0", Dimension::pressure, 0., 1e12, "B.");
  entry("Hardening exponent", "1", Dimension::none, 0.001, 5., "n.");
  entry("Strain rate coefficient", "0", Dimension::none, 0., 1., "C.");
  entry("Thermal softening exponent", "1", Dimension::none, 0.01, 10., "m.");
  entry("Reference strain rate", "1 1/s", Dimension::strain_rate, 1e-9, 1e9,
        "Rate below which there is no rate effect.");
  entry("Room temperature", "294 K", Dimension::temperature, 0., 1e4,
        "Temperature below which there is no softening.");
  entry("Melt temperature", "1000 K", Dimension::temperature, 1., 1e5,
        "Temperature at which the strength is gone.");
  ThermalParameters::declare_parameters(prm, "294 K");
  prm.declare_entry("Damage", "false", boolean(),
                    "Whether to follow the fracture model of Johnson and Cook "
                    "1985 as the state \"damage\", 1 at fracture. It does not "
                    "change the stress.");
  for (const char *const name : damage_names)
    entry(name, "0", Dimension::none, -1e3, 1e3,
          "Fracture strain (D1 + D2 exp(D3 sigma*))(1 + D4 ln rate*)"
          "(1 + D5 T*), sigma* = mean over von Mises stress.");
  entry("Smallest fracture strain", "0.01", Dimension::none, 1e-6, 1.,
        "Lower bound of the fracture strain, which some sets make negative "
        "at high triaxiality.");
}

JohnsonCookParameters parse(const Parameters &prm, const std::string &path,
                            const EquationOfState &eos)
{
  JohnsonCookParameters p;
  p.A = get_quantity(prm, "Initial yield stress");
  p.B = get_quantity(prm, "Hardening modulus");
  p.n = get_quantity(prm, "Hardening exponent");
  p.C = get_quantity(prm, "Strain rate coefficient");
  p.m = get_quantity(prm, "Thermal softening exponent");
  p.reference_strain_rate = get_quantity(prm, "Reference strain rate");
  p.room_temperature = get_quantity(prm, "Room temperature");
  p.melt_temperature = get_quantity(prm, "Melt temperature");
  const ThermalParameters thermal = ThermalParameters::parse(prm, path, eos);
  p.initial_temperature = thermal.initial_temperature;
  p.specific_heat = thermal.specific_heat;
  p.taylor_quinney = thermal.taylor_quinney;
  p.conductivity = thermal.conductivity;
  p.thermal_expansion = thermal.expansion;
  p.has_damage = prm.get_bool("Damage");
  for (int i = 0; i < 5; ++i)
    p.D[i] = get_quantity(prm, damage_names[i]);
  p.smallest_fracture_strain = get_quantity(prm, "Smallest fracture strain");
  if (p.A <= 0.)
    throw InputError(path + "/Initial yield stress",
                     "must be set to a positive stress, for example "
                     "324 MPa");
  if (p.melt_temperature <= p.room_temperature)
    throw InputError(path + "/Melt temperature",
                     "must be above the room temperature");
  const double tension = p.D[0] + p.D[1] * std::exp(p.D[2] / 3.);
  if (p.has_damage && tension <= 0.)
    throw InputError(path + "/D1",
                     "D1 to D3 give a fracture strain of " +
                         std::to_string(tension) +
                         " in uniaxial tension (sigma* = 1/3); it must be "
                         "positive");
  return p;
}

const DescribeField
    described({"damage", "1", 1, "cells, particles of Johnson-Cook with damage",
               "Johnson and Cook 1985: 1 at fracture, beyond where "
               "nothing fails by it."});

const Registry<Material>::Add registered(
    {"Johnson-Cook",
     "strain, strain-rate and thermal softening with adiabatic heating, "
     "optional damage.",
     declare,
     [](const Parameters &prm, const std::string &path,
        const ElasticConstants &elastic, const ElasticBase::Eos &eos)
     {
       return std::make_unique<JohnsonCook>(elastic, parse(prm, path, *eos),
                                            eos);
     }});
} // namespace
} // namespace sabot
