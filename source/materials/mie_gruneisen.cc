// Mie-Grueneisen pressure from shock data.
#include "sabot/materials/mie_gruneisen.h"

#include "sabot/base/output_fields.h"
#include "sabot/base/registry.h"
#include "sabot/materials/elastic_base.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sabot
{
void MieGruneisen::begin(const MaterialBatch &b, Start &start) const
{
  const double *const *const e = b.strain_increment;
  double *const *const s = b.stress;
  for (std::size_t k = 0; k < b.n; ++k)
  {
    const double mean = (s[0][k] + s[1][k] + s[2][k]) / 3.;
    start.pressure[k] = -mean;
    start.deviatoric_work[k] =
        0.5 *
        ((s[0][k] - mean) * e[0][k] + (s[1][k] - mean) * e[1][k] +
         (s[2][k] - mean) * e[2][k] +
         2. * (s[3][k] * e[3][k] + s[4][k] * e[4][k] + s[5][k] * e[5][k]));
  }
}

void MieGruneisen::finish(const MaterialBatch &b, const Start &start,
                          const double shear_modulus) const
{
  const double *const *const d = b.strain_increment;
  double *const *const s = b.stress;
  double *const energy = b.state(0);
  const double K = bulk_modulus(), rest = K + 4. / 3. * shear_modulus;
  const double largest = 0.9 / std::max(1., p.shock_slope);
  for (std::size_t k = 0; k < b.n; ++k)
  {
    const double J = b.jacobian[k];
    // eta, or its bound, where the curve goes on along its tangent.
    const double eta = std::min(1. - J, largest), beyond = 1. - J - eta;
    const double mu = eta / (1. - eta);
    const double g = p.gruneisen + p.volume_correction * mu;
    const double D = 1. - p.shock_slope * std::max(eta, 0.);
    const double tangent = K * (1. + p.shock_slope * eta) / (D * D * D);
    const double hugoniot = K * eta / (D * D) + tangent * beyond;
    const double cold = eta > 0. ? hugoniot * (1. - 0.5 * g * eta) : K * mu;

    const double trace = d[0][k] + d[1][k] + d[2][k];
    const double mid = J / (1. + 0.5 * trace); // volume at mid step over V_0
    const double change = mid * trace;
    const double viscous = b.viscous_pressure ? b.viscous_pressure[k] : 0.;
    const double work =
        mid *
            (start.deviatoric_work[k] +
             0.5 * (s[0][k] * d[0][k] + s[1][k] * d[1][k] + s[2][k] * d[2][k]) +
             s[3][k] * d[3][k] + s[4][k] * d[4][k] + s[5][k] * d[5][k]) -
        (0.5 * start.pressure[k] + viscous) * change; // [J per m^3 of V_0]
    const double e = p.density * energy[k] + work;
    const double pressure =
        (cold + g * e) / std::max(1. + 0.5 * g * change, 0.1);
    energy[k] = (e - 0.5 * pressure * change) / p.density;
    for (int c = 0; c < 3; ++c)
      s[c][k] -= pressure;

    if (b.stiffening)
    {
      // Isentropic modulus J (dp/d eta at constant e + g p).
      const double inside = beyond > 0. ? 0. : 1.;
      const double g_slope = inside * p.volume_correction / (J * J);
      const double slope =
          eta > 0. ? tangent * (1. - 0.5 * g * eta) -
                         0.5 * inside * hugoniot * (g + g_slope * eta)
                   : K / (J * J);
      const double modulus =
          J * (slope + g_slope * p.density * energy[k] + g * pressure);
      b.stiffening[k] = (modulus + 4. / 3. * shear_modulus) / rest;
    }
  }
}

namespace
{
void declare(Parameters &prm)
{
  prm.declare_entry("Sound speed", "0", quantity(Dimension::velocity, 0., 2e4),
                    "c0 of Us = c0 + s up.");
  prm.declare_entry("Shock slope", "1.5", quantity(Dimension::none, 0., 10.),
                    "s of Us = c0 + s up.");
  prm.declare_entry("Gruneisen coefficient", "2",
                    quantity(Dimension::none, 0., 10.), "Gamma0.");
  prm.declare_entry("Volume correction", "0",
                    quantity(Dimension::none, -10., 10.),
                    "a: Gamma times density is (Gamma0 + a (rho/rho0 - 1)) "
                    "rho0.");
}

std::shared_ptr<const EquationOfState> make(const Parameters &prm,
                                            const std::string &path,
                                            const ElasticConstants &elastic,
                                            std::vector<std::string> &warnings)
{
  MieGruneisenParameters p;
  p.density = elastic.density;
  p.sound_speed = get_quantity(prm, "Sound speed");
  p.shock_slope = get_quantity(prm, "Shock slope");
  p.gruneisen = get_quantity(prm, "Gruneisen coefficient");
  p.volume_correction = get_quantity(prm, "Volume correction");
  if (p.sound_speed < 100.)
    throw InputError(path + "/Sound speed",
                     "must be set to the c0 of the shock data, at least "
                     "100 m/s, for example 5386 m/s");
  const auto eos = std::make_shared<MieGruneisen>(p);
  const double K = elastic.bulk_modulus(), shock = eos->bulk_modulus();
  if (std::abs(shock - K) > 0.15 * K)
  {
    char text[200];
    std::snprintf(text, sizeof(text),
                  ": rho c0^2 = %.4g GPa of the equation of state differs by "
                  "%.0f %% from the bulk modulus %.4g GPa of the elastic "
                  "constants; the former is used",
                  shock * 1e-9, 100. * std::abs(shock - K) / K, K * 1e-9);
    warnings.push_back(path + text);
  }
  return eos;
}

const DescribeField
    described({"specific internal energy", "J/kg", 1,
               "cells, particles with this equation of state",
               "Of Mie-Gruneisen, over the initial state, deviatoric and "
               "viscous work included."});

const Registry<EquationOfState>::Add registered(
    {"Mie-Gruneisen",
     "from shock data; Young's modulus and Poisson's ratio then give the shear "
     "modulus only.",
     declare, make});
} // namespace
} // namespace sabot
