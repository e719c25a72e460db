// Mie-Grueneisen pressure from shock data.
#include "sabot/materials/mie_gruneisen.h"

#include "sabot/base/output_fields.h"
#include "sabot/base/registry.h"
#include "sabot/kernels/pack_math.h"
#include "sabot/materials/elastic_base.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sabot
{
void MieGruneisen::begin(const MaterialBatch &b, Start &start) const
{
  for (std::size_t k = 0; k < b.n; k += n_wide)
  {
    WidePack s[6], e[6];
    load_wide(b.stress, k, s);
    load_wide(b.strain_increment, k, e);
    store_wide(&start.pressure[k], -make_deviator(s));
    store_wide(&start.deviatoric_work[k],
               0.5 * (s[0] * e[0] + s[1] * e[1] + s[2] * e[2] +
                      2. * (s[3] * e[3] + s[4] * e[4] + s[5] * e[5])));
  }
}

namespace
{
/** What a pack of points needs from the start of the step and has of it. */
struct PointsOfPack
{
  WidePack J, change, work; // change of J, work [J per m^3 of V_0]
};

/** From the batch, s the new deviator and p the old pressure:
    work = J_mid (s_old + s) : d_eps/2 - (p/2 + q) change. */
PointsOfPack points_of(const MaterialBatch &b,
                       const EquationOfState::Start &start, const std::size_t k)
{
  WidePack s[n_symmetric], d[n_symmetric];
  for (int c = 0; c < n_symmetric; ++c)
  {
    s[c] = load_wide(&b.stress[c][k]);
    d[c] = load_wide(&b.strain_increment[c][k]);
  }
  PointsOfPack points;
  points.J = load_wide(&b.jacobian[k]);
  const WidePack trace = d[0] + d[1] + d[2];
  const WidePack mid = points.J / (1. + 0.5 * trace); // at mid step over V_0
  points.change = mid * trace;
  const WidePack viscous =
      b.viscous_pressure ? load_wide(&b.viscous_pressure[k]) : WidePack{};
  points.work = mid * (load_wide(&start.deviatoric_work[k]) +
                       0.5 * (s[0] * d[0] + s[1] * d[1] + s[2] * d[2]) +
                       s[3] * d[3] + s[4] * d[4] + s[5] * d[5]) -
                (0.5 * load_wide(&start.pressure[k]) + viscous) * points.change;
  return points;
}
} // namespace

void MieGruneisen::finish(const MaterialBatch &b, const Start &start,
                          const double shear_modulus) const
{
  double *const energy = b.state(0);
  const double K = bulk_modulus(), shear = 4. / 3. * shear_modulus;
  const WidePack zero = {}, one = splat<WidePack>(1.),
                 largest = splat<WidePack>(0.9 / std::max(1., p.shock_slope));
  for (std::size_t k = 0; k < b.n; k += n_wide)
  {
    const PointsOfPack points = points_of(b, start, k);
    const WidePack J = points.J, change = points.change;
    // eta, or its bound, where the curve goes on along its tangent.
    const WidePack eta = pack_min(1. - J, largest), beyond = 1. - J - eta;
    const WidePack mu = eta / (1. - eta);
    const WidePack g = p.gruneisen + p.volume_correction * mu;
    const WidePack D = 1. / (1. - p.shock_slope * pack_max(eta, zero));
    const WidePack tangent = K * (1. + p.shock_slope * eta) * (D * D * D);
    const WidePack hugoniot = K * eta * (D * D) + tangent * beyond;
    const WidePack cold = eta > zero ? hugoniot * (1. - 0.5 * g * eta) : K * mu;
    const WidePack e = p.density * load_wide(&energy[k]) + points.work;
    const WidePack pressure =
        (cold + g * e) / pack_max(1. + 0.5 * g * change, splat<WidePack>(0.1));
    const WidePack e_new = e - 0.5 * pressure * change;
    store_wide(&energy[k], e_new * (1. / p.density));
    for (int c = 0; c < 3; ++c)
      store_wide(&b.stress[c][k], load_wide(&b.stress[c][k]) - pressure);

    if (!b.stiffening)
      continue;
    // Isentropic modulus J (dp/d eta at constant e + g p).
    const WidePack inside = beyond > zero ? zero : one, square = 1. / (J * J),
                   g_slope = inside * p.volume_correction * square;
    const WidePack slope =
        eta > zero ? tangent * (1. - 0.5 * g * eta) -
                         0.5 * inside * hugoniot * (g + g_slope * eta)
                   : K * square;
    const WidePack modulus = J * (slope + g_slope * e_new + g * pressure);
    store_wide(&b.stiffening[k], (modulus + shear) * (1. / (K + shear)));
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
