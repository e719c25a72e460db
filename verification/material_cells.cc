// One cell of every law in uniaxial stress against the integrated law.
#include "sabot/materials/laws.h"
#include "verification/driven.h"
#include "verification/problem.h"

#include <functional>

namespace sabot
{
namespace
{
/** A cell of 10 um in uniaxial stress: its ends move at the true strain rate
    rate(t), its sides are free and damped, so that it does not ring. */
class Specimen
{
public:
  Specimen(std::shared_ptr<const Material> law,
           const std::function<double(double)> &rate)
  {
    FemOptions options;
    // Viscosity is a stress of its own here.
    options.bulk_viscosity_linear = options.bulk_viscosity_quadratic = 0.;
    world.bodies.push_back(std::make_unique<DrivenFemBody>(
        "cell", 0, make_bar(0., 1, 10e-6), std::move(law), options,
        [rate](NodalState &n, const double t)
        {
          for (std::size_t i = 0; i < n.size(); ++i)
            n.velocity[i] =
                vec(rate(t) * n.position[i][0], 0.99 * n.velocity[i][1],
                    0.99 * n.velocity[i][2]);
        }));
    world.distribute();
    world.stepper.initialize();
  }
  void run_to(const double end)
  {
    while (world.stepper.time() < end)
      world.advance(0.5);
  }
  double time() const { return world.stepper.time(); }
  double strain() const
  {
    return std::log((cell().measure().high[0] - cell().measure().low[0]) /
                    10e-6);
  }
  double stress(const int c) const { return cell().stress(c, 0); }
  double state(const std::string &name) const
  {
    return cell().cell_state(name)[0];
  }

private:
  const FemBody &cell() const
  {
    return static_cast<const FemBody &>(*world.bodies[0]);
  }
  World world;
};

/** What the laws of the flow stress need in the reference integration. */
struct Point
{
  double eps, rate, T, pressure, J;
};
struct Flow
{
  std::function<double(const Point &)> stress;
  std::function<double(const Point &)> shear_factor; // G/G_0
};

/** Uniaxial stress by fine explicit steps; the flow rule is inverted by
    bisection in each. @return stress, plastic strain, temperature. */
std::array<double, 3> integrate(const ElasticConstants &c, const Flow &flow,
                                const double T0, const double specific_heat,
                                const double strain, const double rate)
{
  const int n = 200000;
  const double d_strain = strain / n, dt = d_strain / rate;
  double sigma = 0., eps = 0., T = T0, log_J = 0.;
  for (int i = 0; i < n; ++i)
  {
    Point point{eps, 0., T, -sigma / 3., std::exp(log_J)};
    const double K = c.bulk_modulus(),
                 G = c.shear_modulus() * flow.shear_factor(point),
                 young = 9. * K * G / (3. * K + G);
    const double trial = sigma + young * d_strain;
    const auto at = [&](const double d)
    {
      Point there = point;
      there.eps = eps + d;
      there.rate = d / dt;
      return flow.stress(there);
    };
    const double old = sigma;
    sigma = trial;
    if (trial > at(0.))
    {
      double low = 0., high = d_strain;
      for (int k = 0; k < 40; ++k)
      {
        const double d = 0.5 * (low + high);
        (trial - young * d > at(d) ? low : high) = d;
      }
      sigma = trial - young * low;
      eps += low;
      T += 0.9 * sigma * low / (c.density * specific_heat);
    }
    log_J += (sigma - old) / (3. * K);
  }
  return {{sigma, eps, T}};
}

void compare(std::vector<Check> &checks, const std::string &who,
             std::shared_ptr<const Material> law, const ElasticConstants &c,
             const Flow &flow, const double T0, const double specific_heat,
             const double rate)
{
  Specimen specimen(std::move(law), [rate](double) { return rate; });
  specimen.run_to(0.15 / rate);
  const auto exact =
      integrate(c, flow, T0, specific_heat, specimen.strain(), rate);
  const std::string source = "law integrated in 2e5 steps";
  checks.push_back({who + ": axial stress", exact[0], specimen.stress(0),
                    2e-3 * exact[0], "Pa", source});
  checks.push_back({who + ": lateral stress", 0., specimen.stress(1),
                    2e-3 * exact[0], "Pa", source});
  checks.push_back({who + ": plastic strain", exact[1],
                    specimen.state("effective plastic strain"), 2e-3 * exact[1],
                    "1", source});
  checks.push_back({who + ": temperature rise", exact[2] - T0,
                    specimen.state("temperature") - T0, 5e-3 * (exact[2] - T0),
                    "K", source});
}

constexpr double rate = 1e4; // [1/s]

double one(const Point &)
{
  return 1.;
}

void zerilli_fcc(std::vector<Check> &checks)
{
  const char *const copper = "copper-ofhc-zerilli";
  const auto entry = [&](const std::string &e)
  { return metal_entry(copper, "Zerilli-Armstrong fcc/" + e); };
  ZerilliArmstrongParameters p;
  p.C0 = entry("C0");
  p.C2 = entry("C2");
  p.C3 = entry("C3");
  p.C4 = entry("C4");
  compare(checks, "Zerilli-Armstrong fcc", metal(copper),
          elastic_constants(copper),
          {[p](const Point &x)
           {
             const double r = std::max(x.rate, 1e-12);
             return p.C0 + p.C2 * std::sqrt(x.eps) *
                               std::exp(-p.C3 * x.T + p.C4 * x.T * std::log(r));
           },
           one},
          entry("Initial temperature"), entry("Specific heat"), rate);
}

void zerilli_bcc(std::vector<Check> &checks)
{
  // Iron of Zerilli and Armstrong 1987, which prm/materials has not.
  const double T0 = 294., heat = 452.;
  const ElasticConstants &c = elastic_constants("iron-armco");
  ZerilliArmstrongParameters p;
  p.is_bcc = true;
  p.C0 = 65e6;
  p.C1 = 1033e6;
  p.C3 = 0.00698;
  p.C4 = 0.000415;
  p.C5 = 266e6;
  p.n = 0.289;
  p.melt_temperature = 1811.;
  compare(checks, "Zerilli-Armstrong bcc",
          std::make_shared<ZerilliArmstrongBcc>(
              c, ZerilliArmstrongFlow<true>{p},
              ThermalParameters{T0, heat, 0.9}, nullptr),
          c,
          {[p](const Point &x)
           {
             const double r = std::max(x.rate, 1e-12);
             return p.C0 +
                    p.C1 * std::exp(-p.C3 * x.T + p.C4 * x.T * std::log(r)) +
                    p.C5 * std::pow(std::max(x.eps, 1e-14), p.n);
           },
           one},
          T0, heat, rate);
}

void steinberg(std::vector<Check> &checks)
{
  // No rate effect; the shock data is another problem's.
  const char *const aluminum = "al6061-t6-steinberg";
  const auto entry = [&](const std::string &e)
  { return metal_entry(aluminum, "Steinberg-Guinan/" + e); };
  SteinbergGuinanParameters p;
  p.yield_stress = entry("Initial yield stress");
  p.largest_yield_stress = entry("Largest yield stress");
  p.beta = entry("Hardening coefficient");
  p.n = entry("Hardening exponent");
  p.pressure_coefficient = entry("Pressure coefficient");
  p.temperature_coefficient = entry("Temperature coefficient");
  p.reference_temperature = entry("Reference temperature");
  const auto factor = [p](const Point &x)
  {
    return 1. + p.pressure_coefficient * x.pressure * std::cbrt(x.J) -
           p.temperature_coefficient * (x.T - p.reference_temperature);
  };
  compare(checks, "Steinberg-Guinan",
          metal(aluminum, {"Equation of state=Bulk modulus"}),
          elastic_constants(aluminum),
          {[p, factor](const Point &x)
           {
             return std::min(p.yield_stress *
                                 std::pow(1. + p.beta * x.eps, p.n),
                             p.largest_yield_stress) *
                    factor(x);
           },
           factor},
          entry("Initial temperature"), entry("Specific heat"), rate);
}

/** Tension by 5 %, then compression, by half isotropic hardening. */
void mixed_hardening(std::vector<Check> &checks)
{
  const ElasticConstants &c = aluminum();
  const double Y = aluminum_yield_stress(), H = 1.5e9, beta = 0.5, rate = 1e4,
               turn = 0.05 / rate;
  Specimen specimen(hardening_aluminum(Y, H, beta),
                    [=](const double t) { return t < turn ? rate : -rate; });
  specimen.run_to(turn);
  // sigma = Y + H eps, strain = sigma/E + eps.
  const double E = c.young_modulus, e = specimen.strain();
  const double eps = (e - Y / E) / (1. + H / E), stress = Y + H * eps;
  checks.push_back({"mixed hardening: stress in tension", stress,
                    specimen.stress(0), 2e-3 * stress, "Pa", "Y + H eps"});
  specimen.run_to(1.6 * turn);
  // Reversed: xi = sigma - alpha reaches -(Y + beta H eps), alpha =
  // (1 - beta) H eps; from there on -H per plastic strain.
  const double reversal = (1. - 2. * beta) * H * eps - Y,
               back = specimen.strain(),
               strain_at = e + (reversal - stress) / E,
               more = (strain_at - back) / (1. + H / E),
               exact = reversal - H * more;
  checks.push_back({"mixed hardening: stress after reversal", exact,
                    specimen.stress(0), 2e-3 * std::abs(exact), "Pa",
                    "(1 - 2 beta) H eps - Y - H d_eps"});
  checks.push_back({"mixed hardening: plastic strain", eps + more,
                    specimen.state("effective plastic strain"),
                    2e-3 * (eps + more), "1", "closed form"});
}

void table(std::vector<Check> &checks)
{
  const ElasticConstants &c = aluminum();
  HardeningParameters p;
  p.table_strain = {0., 0.02, 0.06, 0.2};
  p.table_stress = {300e6, 360e6, 400e6, 430e6};
  const double rate = 1e4;
  Specimen specimen(std::make_shared<HardeningPlasticity>(c, p),
                    [=](double) { return rate; });
  specimen.run_to(0.1 / rate);
  // On the third piece: sigma = 400 MPa + slope (eps - 0.06).
  const double slope = 30e6 / 0.14, e = specimen.strain(),
               eps = (e - (400e6 - slope * 0.06) / c.young_modulus) /
                     (1. + slope / c.young_modulus),
               exact = 400e6 + slope * (eps - 0.06);
  checks.push_back({"tabulated hardening: stress on the third piece", exact,
                    specimen.stress(0), 2e-3 * exact, "Pa", "closed form"});
  checks.push_back({"tabulated hardening: plastic strain", eps,
                    specimen.state("effective plastic strain"), 2e-3 * eps, "1",
                    "closed form"});
}

void rubber(std::vector<Check> &checks)
{
  const ElasticConstants c{1100., 17e6, 0.45};
  const double K = c.bulk_modulus(), G = c.shear_modulus(), rate = 1e3;
  Specimen specimen(std::make_shared<NeoHookean>(c),
                    [=](double) { return rate; });
  for (const double strain : {0.2, 0.4})
  {
    specimen.run_to(strain / rate);
    const double a = std::exp(specimen.strain());
    // Lateral stretch b: sigma_yy = K ln J + G J^(-5/3) (b^2 - a^2)/3 = 0.
    double low = 0.5, high = 1.;
    for (int i = 0; i < 100; ++i)
    {
      const double b = 0.5 * (low + high), J = a * b * b;
      const double lateral =
          K * std::log(J) + G * std::pow(J, -5. / 3.) * (b * b - a * a) / 3.;
      (lateral < 0. ? low : high) = b;
    }
    const double J = a * low * low;
    const double exact = K * std::log(J) + G * std::pow(J, -5. / 3.) * 2. / 3. *
                                               (a * a - low * low);
    checks.push_back({"neo-Hookean, log. strain " +
                          std::to_string(strain).substr(0, 3) + ": stress",
                      exact, specimen.stress(0), 2e-3 * exact, "Pa",
                      "uniaxial stress, closed form"});
  }
}

std::vector<Check> laws()
{
  std::vector<Check> checks;
  zerilli_fcc(checks);
  zerilli_bcc(checks);
  steinberg(checks);
  mixed_hardening(checks);
  table(checks);
  rubber(checks);
  return checks;
}

const RegisterProblem registered({"material-cells",
                                  "one cell of every law in uniaxial stress",
                                  "quick", laws});
} // namespace
} // namespace sabot
