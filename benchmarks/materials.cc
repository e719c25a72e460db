// Cost of one update of each law per point, plastic flow throughout:
// `ninja benchmarks && build/release/benchmarks`.
#include "sabot/kernels/stress_update.h"
#include "sabot/materials/laws.h"

#include <benchmark/benchmark.h>

#include <functional>

namespace
{
using namespace sabot;
const ElasticConstants aluminium{2700., 68.9e9, 0.33};
using Make = std::function<std::unique_ptr<Material>(const ElasticBase::Eos &)>;

void run(benchmark::State &bench, const Make &make, const bool gruneisen)
{
  ElasticBase::Eos eos;
  if (gruneisen)
    eos = std::make_shared<MieGruneisen>(
        MieGruneisenParameters{2700., 5386., 1.339, 1.99, 0.});
  const auto law = make(eos);
  constexpr std::size_t n = max_batch_points;
  double stress[6][n] = {}, strain[6][n] = {}, jacobian[n], extra[n] = {},
         factor[n], work[n], viscous[n] = {}, stiffening[n], F[9][n] = {};
  std::vector<std::vector<double>> states;
  std::vector<double *> views;
  for (const StateVariable &v : law->state_variables())
    for (int c = 0; c < (v.is_tensor ? 6 : 1); ++c)
      states.emplace_back(n, v.initial_value);
  for (auto &s : states)
    views.push_back(s.data());
  MaterialBatch batch;
  batch.n = n;
  batch.dt = 1e-8;
  for (int c = 0; c < 6; ++c)
  {
    batch.stress[c] = stress[c];
    batch.strain_increment[c] = strain[c];
  }
  batch.jacobian = jacobian;
  batch.states = views.data();
  batch.extra_square = extra;
  batch.return_factor = factor;
  batch.plastic_work = work;
  batch.viscous_pressure = viscous;
  if (law->needs_deformation_gradient())
    for (int c = 0; c < 9; ++c)
      batch.deformation_gradient[c] = F[c];
  if (law->stiffens())
    batch.stiffening = stiffening;
  for (std::size_t k = 0; k < n; ++k)
  {
    jacobian[k] = 0.99 + 1e-4 * k;
    strain[3][k] = 5e-4 + 1e-6 * k;
    F[0][k] = F[4][k] = F[8][k] = std::cbrt(jacobian[k]);
  }
  // Start again now and then, so that strain and temperature stay in range;
  // assignment keeps the buffers that the views point to.
  const auto initial = states;
  int step = 0;
  for (auto _ : bench)
  {
    law->update(batch);
    benchmark::DoNotOptimize(stress[0][0]);
    benchmark::ClobberMemory();
    if (++step % 2000 == 0)
      states = initial;
  }
  bench.counters["per point [s]"] =
      benchmark::Counter(n, benchmark::Counter::kIsIterationInvariantRate |
                                benchmark::Counter::kInvert);
}

template <typename Law>
Make plain()
{
  return [](const ElasticBase::Eos &eos)
  { return std::make_unique<Law>(aluminium, eos); };
}

JohnsonCookParameters johnson_cook(const bool damage)
{
  JohnsonCookParameters p;
  p.A = 324e6;
  p.B = 114e6;
  p.n = 0.42;
  p.C = 0.002;
  p.m = 1.34;
  p.melt_temperature = 925.;
  p.has_damage = damage;
  const double D[5] = {-0.77, 1.45, -0.47, 0., 1.6};
  std::copy(D, D + 5, p.D);
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
  return p;
}

SteinbergGuinanParameters steinberg()
{
  SteinbergGuinanParameters p;
  p.yield_stress = 0.29e9;
  p.largest_yield_stress = 0.68e9;
  p.beta = 125.;
  p.n = 0.1;
  p.pressure_coefficient = 65.2e-12;
  p.temperature_coefficient = 6.16e-4;
  p.melt_temperature = 1220.;
  return p;
}

template <typename Law, typename Parameters>
Make with(const Parameters &p)
{
  return [p](const ElasticBase::Eos &eos)
  { return std::make_unique<Law>(aluminium, p, eos); };
}
template <typename Law, typename Flow>
Make heated(const Flow &flow)
{
  return [flow](const ElasticBase::Eos &eos)
  { return std::make_unique<Law>(aluminium, flow, ThermalParameters(), eos); };
}
} // namespace

int main(int argc, char **argv)
{
  HardeningParameters table;
  table.table_strain = {0., 0.01, 0.1, 10.};
  table.table_stress = {324e6, 350e6, 400e6, 900e6};
  const std::vector<std::pair<std::string, Make>> laws = {
      {"elastic", plain<Elastic>()},
      {"neo-hookean", plain<NeoHookean>()},
      {"hardening isotropic",
       with<HardeningPlasticity>(HardeningParameters{324e6, 150e6, 1.})},
      {"hardening kinematic",
       with<HardeningPlasticity>(HardeningParameters{324e6, 150e6, 0.})},
      {"hardening table", with<HardeningPlasticity>(table)},
      {"johnson-cook", with<JohnsonCook>(johnson_cook(false))},
      {"johnson-cook damage", with<JohnsonCook>(johnson_cook(true))},
      {"steinberg-guinan",
       heated<SteinbergGuinan>(SteinbergGuinanFlow{steinberg()})},
      {"zerilli-armstrong fcc",
       heated<ZerilliArmstrongFcc>(ZerilliArmstrongFlow<false>{zerilli()})},
      {"zerilli-armstrong bcc",
       heated<ZerilliArmstrongBcc>(ZerilliArmstrongFlow<true>{zerilli()})}};
  for (const auto &law : laws)
    for (const bool gruneisen : {false, true})
      benchmark::RegisterBenchmark(
          (law.first + (gruneisen ? " + Mie-Gruneisen" : "")).c_str(),
          [law, gruneisen](benchmark::State &state)
          { run(state, law.second, gruneisen); });
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
