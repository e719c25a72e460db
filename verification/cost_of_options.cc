#include "verification/balance.h"
#include "verification/problem.h"

#include <ctime>
#include <functional>

namespace sabot
{
namespace
{
/** Processor time of the force loop per item and step [ns]: the least of
    several runs, since others use the machine, too. @p topology: with what is
    done between steps. */
double cost(Body &body, const int n_steps, const bool topology)
{
  NodalState &n = body.nodes();
  constexpr double dt = 2e-8;
  double best = 1e300;
  unsigned int step = 0;
  for (int repeat = 0; repeat < 5; ++repeat)
  {
    double seconds = 0.;
    for (int s = 0; s < n_steps; ++s)
    {
      for (std::size_t i = 0; i < n.size(); ++i)
        n.position[i] += dt * n.velocity[i];
      ++step;
      const std::clock_t start = std::clock();
      body.compute_forces(step * dt, dt);
      if (topology)
        body.update_topology(step, step * dt);
      seconds += double(std::clock() - start) / CLOCKS_PER_SEC;
    }
    best = std::min(best, 1e9 * seconds / (n_steps * double(body.n_items())));
  }
  return best;
}

/** Stretch and shear at about 1e4 1/s: plastic after the first 0.5 us. */
void set_in_motion(Body &body, const double rate)
{
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.size(); ++i)
  {
    const Vec X = n.reference_position[i];
    n.velocity[i] = vec(-rate * X[0] + 0.3 * rate * X[1], 0.2 * rate * X[1],
                        0.1 * rate * X[2]);
  }
}

JohnsonCookParameters strength()
{
  JohnsonCookParameters p;
  p.A = 324e6;
  p.B = 114e6;
  p.n = 0.42;
  p.C = 0.002;
  p.m = 1.34;
  p.melt_temperature = 925.;
  p.specific_heat = 896.;
  return p;
}

std::shared_ptr<Material> johnson_cook(const JohnsonCookParameters &p,
                                       const bool shock = false)
{
  std::shared_ptr<const EquationOfState> eos;
  if (shock)
    eos = std::make_shared<MieGruneisen>(
        MieGruneisenParameters{2700., 5386., 1.339, 1.99, 0.});
  return std::make_shared<JohnsonCook>(ElasticConstants{2700., 68.9e9, 0.33}, p,
                                       eos);
}

double cells(const FemOptions &options, std::shared_ptr<const Material> law,
             const bool topology = false)
{
  World world;
  BoxSpecification b;
  b.size = {{16e-3, 16e-3, 16e-3}};
  b.cell_size = 1e-3;
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 0, make_graded_box(b), std::move(law), options));
  world.distribute();
  set_in_motion(*world.bodies[0], 1e4);
  world.integrator.initialize();
  return cost(*world.bodies[0], 40, topology);
}

double particles(const SpgOptions &options, std::shared_ptr<const Material> law,
                 const bool topology = false)
{
  World world;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "block", 0, make_box_cloud({{0, 0, 0}}, {{15e-3, 15e-3, 15e-3}}, 1e-3),
      std::move(law), options));
  world.distribute();
  set_in_motion(*world.bodies[0], 1e4);
  world.integrator.initialize();
  return cost(*world.bodies[0], 10, topology);
}

std::vector<Check> costs()
{
  std::vector<Check> checks;
  const auto measured = [&](const std::string &name, const double ns)
  {
    checks.push_back({name, 0., ns, 0., "ns",
                      "processor time per item and step",
                      Check::Kind::reported});
  };
  const auto plain = johnson_cook(strength());
  JohnsonCookParameters with_damage = strength(), cold = strength(),
                        expanding = strength(), conducting = strength();
  with_damage.has_damage = true;
  const double D[5] = {-0.77, 1.45, -0.47, 0., 1.6};
  std::copy(D, D + 5, with_damage.D);
  cold.taylor_quinney = 0.;
  expanding.thermal_expansion = 23e-6;
  conducting.conductivity = 167.;

  const FemOptions fem;
  measured("cells: all off", cells(fem, plain));
  measured("cells: Mie-Gruneisen", cells(fem, johnson_cook(strength(), true)));
  measured("cells: damage", cells(fem, johnson_cook(with_damage)));
  measured("cells: no heating", cells(fem, johnson_cook(cold)));
  measured("cells: thermal expansion", cells(fem, johnson_cook(expanding)));
  {
    FemOptions o = fem;
    o.objective_rate = FemOptions::ObjectiveRate::green_naghdi;
    measured("cells: Green-Naghdi rate", cells(o, plain));
    o = fem;
    o.hourglass = "stiffness";
    measured("cells: stiffness hourglass control", cells(o, plain));
    o = fem;
    o.hourglass_coefficient = 0.;
    measured("cells: hourglass coefficient 0", cells(o, plain));
    o = fem;
    o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
    measured("cells: no bulk viscosity", cells(o, plain));
    o = fem;
    o.integration = "B-bar";
    measured("cells: B-bar", cells(o, plain));
    // Between steps: erosion and conduction; off there is nothing to do.
    measured("cells, with what is between steps: all off",
             cells(fem, plain, true));
    o = fem;
    o.erosion_plastic_strain = 100.;
    measured("cells, with what is between steps: erosion, none due",
             cells(o, plain, true));
    o = fem;
    o.conducts_heat = true;
    o.conduction_interval = 0.; // every step; usually many
    measured("cells, with what is between steps: conduction in every step",
             cells(o, johnson_cook(conducting), true));
    o.conduction_interval = 1.;
    measured("cells, with what is between steps: conduction, none due",
             cells(o, johnson_cook(conducting), true));
  }

  const SpgOptions spg;
  measured("particles: all off", particles(spg, plain));
  measured("particles: Mie-Gruneisen",
           particles(spg, johnson_cook(strength(), true)));
  measured("particles: damage", particles(spg, johnson_cook(with_damage)));
  measured("particles: no heating", particles(spg, johnson_cook(cold)));
  {
    SpgOptions o = spg;
    o.stabilization = SpgOptions::Stabilization::none;
    measured("particles: no stabilisation", particles(o, plain));
    o = spg;
    o.bulk_viscosity_linear = o.bulk_viscosity_quadratic = 0.;
    measured("particles: no bulk viscosity", particles(o, plain));
    o = spg;
    o.approximation = SpgOptions::Approximation::convex_exponential;
    o.kernel_shape = SpgOptions::KernelShape::tensor;
    o.normalized_support = 1.5;
    measured("particles: convex 1.5, bond residual", particles(o, plain));
    o.stabilization = SpgOptions::Stabilization::none;
    measured("particles: convex 1.5, no stabilisation", particles(o, plain));
    o.stabilization = SpgOptions::Stabilization::second_gradient;
    measured("particles: convex 1.5, second gradient", particles(o, plain));
    // Between steps: kernel updates, failure, smoothing.
    o = spg;
    o.kernel_update_interval = 1000000;
    o.kernel_update_change = 10.;
    measured("particles, with what is between steps: no updates, no failure",
             particles(o, plain, true));
    measured("particles, with what is between steps: update every 30 steps",
             particles(spg, plain, true));
    o.critical_effective_plastic_strain = 100.;
    measured("particles, with what is between steps: failure, none due",
             particles(o, plain, true));
    o = spg;
    o.stabilization = SpgOptions::Stabilization::velocity_smoothing;
    measured("particles, with what is between steps: velocity smoothing",
             particles(o, plain, true));
  }
  return checks;
}

const RegisterProblem registered({"cost-of-options",
                                  "processor time with options on and off",
                                  "long", costs});
} // namespace
} // namespace sabot
