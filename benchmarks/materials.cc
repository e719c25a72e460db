// Cost of one update of each law per point, in plastic flow and below yield:
// build/release/benchmark_materials
#include "benchmarks/law_batch.h"
#include "sabot/materials/laws.h"
#include "sabot/materials/mie_gruneisen.h"
#include "verification/metals.h"

#include <benchmark/benchmark.h>

#include <functional>

namespace
{
using namespace sabot;
using Make = std::function<std::unique_ptr<Material>(const ElasticBase::Eos &)>;

/** @p amount of shear strain per step. */
void run(benchmark::State &bench, const Make &make, const bool gruneisen,
         const double amount)
{
  ElasticBase::Eos eos;
  if (gruneisen)
    eos = std::make_shared<MieGruneisen>(
        mie_gruneisen_parameters("al6061-t6-eos"));
  const auto law = make(eos);
  LawBatch points(*law, amount);
  // Start again now and then, so that strain and temperature stay in range.
  int step = 0;
  for (auto _ : bench)
  {
    law->update(points.batch);
    benchmark::DoNotOptimize(points.batch.stress[0][0]);
    benchmark::ClobberMemory();
    if (++step % 2000 == 0)
      points.restart();
  }
  bench.counters["per point [s]"] = benchmark::Counter(
      LawBatch::n, benchmark::Counter::kIsIterationInvariantRate |
                       benchmark::Counter::kInvert);
}

template <typename Law>
Make plain()
{
  return [](const ElasticBase::Eos &eos)
  { return std::make_unique<Law>(aluminum(), eos); };
}

JohnsonCookParameters johnson_cook(const bool damage)
{
  JohnsonCookParameters p = johnson_cook_parameters("al6061-t6");
  p.has_damage = damage;
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
  const auto entry = [](const std::string &e)
  { return metal_entry("al6061-t6-steinberg", "Steinberg-Guinan/" + e); };
  SteinbergGuinanParameters p;
  p.yield_stress = entry("Initial yield stress");
  p.largest_yield_stress = entry("Largest yield stress");
  p.beta = entry("Hardening coefficient");
  p.n = entry("Hardening exponent");
  p.pressure_coefficient = entry("Pressure coefficient");
  p.temperature_coefficient = entry("Temperature coefficient");
  p.melt_temperature = entry("Melt temperature");
  return p;
}

template <typename Law, typename Parameters>
Make with(const Parameters &p)
{
  return [p](const ElasticBase::Eos &eos)
  { return std::make_unique<Law>(aluminum(), p, eos); };
}
template <typename Law, typename Flow>
Make heated(const Flow &flow)
{
  return [flow](const ElasticBase::Eos &eos)
  { return std::make_unique<Law>(aluminum(), flow, ThermalParameters(), eos); };
}
} // namespace

int main(int argc, char **argv)
{
  const double Y = aluminum_yield_stress();
  HardeningParameters table;
  table.table_strain = {0., 0.01, 0.1, 10.};
  table.table_stress = {Y, 350e6, 400e6, 900e6};
  const std::vector<std::pair<std::string, Make>> laws = {
      {"elastic", plain<Elastic>()},
      {"neo-hookean", plain<NeoHookean>()},
      {"hardening isotropic",
       with<HardeningPlasticity>(HardeningParameters{Y, 150e6, 1.})},
      {"hardening kinematic",
       with<HardeningPlasticity>(HardeningParameters{Y, 150e6, 0.})},
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
      for (const double amount : {5e-4, 1e-12})
        benchmark::RegisterBenchmark(
            (law.first + (gruneisen ? " + Mie-Gruneisen" : "") +
             (amount < 1e-9 ? ", below yield" : ""))
                .c_str(),
            [law, gruneisen, amount](benchmark::State &state)
            { run(state, law.second, gruneisen, amount); });
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
