// Radial return for linear and tabulated hardening.
#include "sabot/base/registry.h"
#include "sabot/kernels/pack_math.h"
#include "sabot/materials/laws.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
constexpr double smallest_stress = 1e-300; // so that nothing divides by zero
} // namespace

HardeningPlasticity::HardeningPlasticity(const ElasticConstants &elastic,
                                         const HardeningParameters &p,
                                         const Eos &eos)
    : ElasticBase(elastic, eos), isotropic_fraction(p.isotropic_fraction)
{
  if (p.table_strain.empty())
    pieces = {{0., p.yield_stress, p.hardening_modulus}};
  for (std::size_t i = 0; i < p.table_strain.size(); ++i)
    pieces.push_back({p.table_strain[i], p.table_stress[i],
                      i + 1 == p.table_strain.size()
                          ? 0.
                          : (p.table_stress[i + 1] - p.table_stress[i]) /
                                (p.table_strain[i + 1] - p.table_strain[i])});
}

std::vector<StateVariable> HardeningPlasticity::law_variables() const
{
  std::vector<StateVariable> variables = {
      {"effective plastic strain", 0., false}};
  if (isotropic_fraction < 1.)
    variables.push_back({"back stress", 0., true});
  return variables;
}

std::size_t HardeningPlasticity::piece_at(const double eps) const
{
  std::size_t i = 0;
  while (i + 1 < pieces.size() && eps >= pieces[i + 1].strain)
    ++i;
  return i;
}

double HardeningPlasticity::increment(const double q, const double eps,
                                      double &hardening) const
{
  const double initial = pieces[0].stress;
  std::size_t i = piece_at(eps);
  const double old =
      pieces[i].stress + pieces[i].slope * (eps - pieces[i].strain);
  hardening = 0.;
  // q = 3 G d + Y(eps + d) - (1 - beta)(Y(eps) - Y(0)).
  const double target = q + (1. - isotropic_fraction) * (old - initial);
  if (!(target > old))
    return 0.;
  // The first piece whose end needs more than the target holds the root.
  while (i + 1 < pieces.size() &&
         3. * G * (pieces[i + 1].strain - eps) + pieces[i + 1].stress < target)
    ++i;
  const Piece &piece = pieces[i];
  const double d =
      (target - piece.stress - piece.slope * (eps - piece.strain)) /
      (3. * G + piece.slope);
  hardening = piece.stress + piece.slope * (eps + d - piece.strain) - old;
  return d;
}

template <bool kinematic>
void HardeningPlasticity::relative_stress(const MaterialBatch &b,
                                          const std::size_t k,
                                          WidePack xi[6]) const
{
  load_wide(b.stress, k, xi);
  for (int c = 0; kinematic && c < 6; ++c)
    xi[c] -= load_wide(&b.state(1 + c)[k]);
}

template <bool kinematic>
void HardeningPlasticity::return_deviator(const MaterialBatch &b) const
{
  double *const eps = b.state(0);
  double q[max_batch_points], d[max_batch_points] = {},
                              moving[max_batch_points] = {};
  WidePack xi[6]; // deviator relative to the back stress
  for (std::size_t k = 0; k < b.n; k += n_wide)
  {
    relative_stress<kinematic>(b, k, xi);
    store_wide(&q[k],
               pack_sqrt(1.5 * square_of(xi) + load_wide(&b.extra_square[k])));
    store_wide(&b.return_factor[k], splat<WidePack>(1.));
    store_wide(&b.plastic_work[k], WidePack{});
  }
  bool any = false;
  for (std::size_t k = 0; k < b.n; ++k)
    // About the back stress no yield stress is below the initial one.
    if (q[k] > pieces[0].stress)
    {
      double hardening;
      d[k] = increment(q[k], eps[k], hardening);
      moving[k] = d[k] > 0. ? (1. - isotropic_fraction) * hardening / q[k] : 0.;
      any |= d[k] > 0.;
    }
  for (std::size_t k = 0; any && k < b.n; k += n_wide)
  {
    relative_stress<kinematic>(b, k, xi);
    const WidePack increment = load_wide(&d[k]),
                   scale = 1.5 * increment /
                           pack_max(load_wide(&q[k]),
                                    splat<WidePack>(smallest_stress));
    WidePack s[6];
    load_wide(b.stress, k, s);
    for (int c = 0; c < 6; ++c)
    {
      s[c] -= 2. * G * scale * xi[c];
      if (kinematic)
        store_wide(&b.state(1 + c)[k], load_wide(&b.state(1 + c)[k]) +
                                           load_wide(&moving[k]) * xi[c]);
    }
    store_wide(b.stress, k, s);
    store_wide(&eps[k], load_wide(&eps[k]) + increment);
    // With the stress at the end of the step.
    store_wide(&b.plastic_work[k],
               scale * (s[0] * xi[0] + s[1] * xi[1] + s[2] * xi[2] +
                        2. * (s[3] * xi[3] + s[4] * xi[4] + s[5] * xi[5])));
    store_wide(&b.return_factor[k], 1. - 2. * G * scale);
  }
}

void HardeningPlasticity::update_deviator(const MaterialBatch &b,
                                          Scratch &) const
{
  trial_deviator(b);
  if (isotropic_fraction < 1.)
    return_deviator<true>(b);
  else
    return_deviator<false>(b);
}

namespace
{
HardeningParameters parse(const Parameters &prm, const std::string &path)
{
  HardeningParameters p;
  p.yield_stress = get_quantity(prm, "Yield stress");
  p.hardening_modulus = get_quantity(prm, "Hardening modulus");
  p.isotropic_fraction = get_quantity(prm, "Isotropic fraction");
  p.table_strain = get_quantities(prm, "Table of strains");
  p.table_stress = get_quantities(prm, "Table of stresses");
  const std::vector<double> &e = p.table_strain, &s = p.table_stress;
  const auto fail = [&](const std::string &entry, const std::string &message)
  { throw InputError(path + "/" + entry, message); };
  if (e.empty() && s.empty())
  {
    if (p.yield_stress <= 0.)
      fail("Yield stress", "must be set to a positive stress, for example "
                           "324 MPa");
    return p;
  }
  if (p.yield_stress != 0. || p.hardening_modulus != 0.)
    fail("Yield stress", "yield stress and hardening modulus are part of the "
                         "table; set either the table or these two");
  if (e.size() != s.size())
    fail("Table of stresses", "has " + std::to_string(s.size()) +
                                  " values, the strains have " +
                                  std::to_string(e.size()));
  if (e[0] != 0.)
    fail("Table of strains", "must start with 0, the initial yield");
  if (s[0] <= 0.)
    fail("Table of stresses", "must start with a positive stress");
  for (std::size_t i = 1; i < e.size(); ++i)
  {
    if (e[i] <= e[i - 1])
      fail("Table of strains", "must increase; value " + std::to_string(i + 1) +
                                   " is " + std::to_string(e[i]) + " after " +
                                   std::to_string(e[i - 1]));
    if (s[i] < s[i - 1])
      fail("Table of stresses", "must not decrease; value " +
                                    std::to_string(i + 1) + " is " +
                                    std::to_string(s[i]) + " Pa after " +
                                    std::to_string(s[i - 1]) + " Pa");
  }
  return p;
}

const Registry<Material>::Add registered(
    {"Hardening plasticity",
     "J2 plasticity with linear or tabulated isotropic, kinematic or mixed "
     "hardening.",
     [](Parameters &prm)
     {
       prm.declare_entry("Yield stress", "0",
                         quantity(Dimension::pressure, 0., 1e12),
                         "Initial yield stress.");
       prm.declare_entry("Hardening modulus", "0",
                         quantity(Dimension::pressure, 0., 1e12),
                         "Slope of stress against plastic strain.");
       prm.declare_entry("Isotropic fraction", "1",
                         quantity(Dimension::none, 0., 1.),
                         "1: isotropic hardening, 0: kinematic. Stress in "
                         "monotonic loading does not depend on it.");
       prm.declare_entry(
           "Table of strains", "",
           quantities(Dimension::none, 0, 1000, 0., 1e3),
           "Effective plastic strains of a piecewise linear hardening curve, "
           "from 0 on, in place of yield stress and modulus.");
       prm.declare_entry("Table of stresses", "",
                         quantities(Dimension::pressure, 0, 1000, 0., 1e12),
                         "Yield stresses at these strains, not decreasing; "
                         "constant beyond the last.");
     },
     [](const Parameters &prm, const std::string &path,
        const ElasticConstants &elastic, const ElasticBase::Eos &eos)
     {
       return std::make_unique<HardeningPlasticity>(elastic, parse(prm, path),
                                                    eos);
     }});
} // namespace
} // namespace sabot
