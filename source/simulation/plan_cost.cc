#include "sabot/base/error.h"
#include "sabot/bodies/spg/spg_body.h"
#include "sabot/integrator/central_difference.h"
#include "sabot/output/checkpoint.h"
#include "sabot/simulation/plan.h"

#include <sys/resource.h>

#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkZLibDataCompressor.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sabot
{
namespace
{
using Clock = std::chrono::steady_clock;

double since(const Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/** Part that zlib leaves of arbitrary doubles. */
constexpr double part_of_noise = 0.95;
/** VTK compresses blocks of this size. [bytes] */
constexpr std::size_t block = 32768;

template <typename T>
double compressed_size(const std::vector<T> &values)
{
  vtkNew<vtkZLibDataCompressor> compressor;
  compressor->SetCompressionLevel(1);
  const std::size_t n = values.size() * sizeof(T);
  const auto *const bytes =
      reinterpret_cast<const unsigned char *>(values.data());
  std::vector<unsigned char> room(
      compressor->GetMaximumCompressionSpace(block));
  double total = 0.;
  for (std::size_t i = 0; i < n; i += block)
    total += compressor->Compress(bytes + i, std::min(block, n - i),
                                  room.data(), room.size());
  return total;
}

/** Range of the nodes of a body, over all ranks. */
struct Extent
{
  double low[3], high[3];
  explicit Extent(const Body &body, MPI_Comm communicator)
  {
    double values[6];
    std::fill(values, values + 6, 1e300);
    for (std::size_t i = 0; i < body.nodes().n_owned; ++i)
      for (int d = 0; d < 3; ++d)
      {
        values[d] = std::min(values[d], body.nodes().position[i][d]);
        values[3 + d] = std::min(values[3 + d], -body.nodes().position[i][d]);
      }
    MPI_Allreduce(MPI_IN_PLACE, values, 6, MPI_DOUBLE, MPI_MIN, communicator);
    for (int d = 0; d < 3; ++d)
    {
      low[d] = values[d];
      high[d] = -values[3 + d];
    }
  }
  double distance(const Vec x) const
  {
    double square = 0.;
    for (int d = 0; d < 3; ++d)
      square += std::pow(std::max({0., low[d] - x[d], x[d] - high[d]}), 2);
    return std::sqrt(square);
  }
};

/** Distances of the nodes from where waves start: the other bodies that move
    otherwise. Empty when there is no such body. [m] */
std::vector<double> wave_distances(const Scene &scene, const std::size_t body,
                                   MPI_Comm communicator)
{
  std::vector<Extent> sources;
  const auto velocity = [](const Body &b)
  {
    std::array<double, 3> v{};
    for (const Measure &m : b.measure())
      for (int d = 0; d < 3; ++d)
        if (m.name == std::string("velocity ") + "xyz"[d])
          v[d] = m.value;
    return v;
  };
  std::vector<std::array<double, 3>> velocities;
  for (const auto &b : scene.bodies)
    velocities.push_back(velocity(*b));
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (velocities[b] != velocities[body])
      sources.emplace_back(*scene.bodies[b], communicator);
  std::vector<double> distances;
  if (sources.empty())
    return distances;
  const NodalState &nodes = scene.bodies[body]->nodes();
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    double nearest = 1e300;
    for (const Extent &source : sources)
      nearest = std::min(nearest, source.distance(nodes.position[i]));
    distances.push_back(nearest);
  }
  return distances;
}

double sum_over_ranks(double value, MPI_Comm communicator)
{
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, communicator);
  return value;
}

/** Bytes of all field outputs, and seconds to compress them once. */
/** Time between energy checks is the run's over this (as in run.cc). */
constexpr double n_checks = 200.;

double n_history_rows(const Scene &scene)
{
  double n = 0.;
  for (const OutputSettings &output : scene.outputs)
    if (output.type == OutputSettings::Type::history)
      n += std::floor(scene.settings.end_time / output.interval) + 1.;
  return n;
}

/** Wall time of one row of the histories [s]. */
double seconds_per_row(const Scene &scene)
{
  const auto start = Clock::now();
  EnergyLedger ledger;
  for (const auto &body : scene.bodies)
  {
    body->add_energies(ledger);
    body->measure();
  }
  for (const QuantityOfInterest &quantity : scene.quantities)
    scene.bodies[quantity.body]->measure();
  return since(start);
}

void plan_output(const Scene &scene, const PhysicsPlan &physics, CostPlan &plan,
                 double &seconds, MPI_Comm communicator)
{
  const double end = scene.settings.end_time;
  double bytes = 0., once = 0.;
  double n_frames = 0.;
  std::vector<double> times;
  for (const OutputSettings &output : scene.outputs)
    if (output.type == OutputSettings::Type::vtu)
    {
      n_frames = std::floor(end / output.interval * (1. + 1e-9)) + 1.;
      // Many frames are sampled by a hundred.
      const double n_samples = std::min(n_frames, 100.);
      for (double k = 0.; k < n_samples; k += 1.)
        times.push_back(end * k / std::max(1., n_samples - 1.));
    }
  for (std::size_t b = 0; b < scene.bodies.size() && !times.empty(); ++b)
  {
    const Body &body = *scene.bodies[b];
    const auto start = Clock::now();
    bool is_host = false;
    for (const auto &other : scene.bodies)
      if (other->item_name() == "particles" && body.item_name() == "cells")
        is_host = true;
    double speed = 0.;
    for (const Measure &m : body.measure())
      if (m.name.compare(0, 9, "velocity ") == 0)
        speed += m.value * m.value;
    // The far field of a zone yields only beside it.
    const FieldSize size =
        field_size(body.output_mesh(), !(is_host && speed == 0.));
    once += since(start);
    const std::vector<double> distances =
        wave_distances(scene, b, communicator);
    const double c = physics.bodies[b].wave_speed;
    for (const double t : times)
    {
      double n_disturbed = 0.;
      for (const double distance : distances)
        n_disturbed += distance <= c * t;
      const double part =
          distances.empty() ? 0. : n_disturbed / distances.size();
      bytes += (size.quiet + part * (size.disturbed - size.quiet)) * n_frames /
               times.size();
    }
  }
  // History: rows of all tables, also those of the regular energy checks.
  double columns = 12.;
  for (const auto &body : scene.bodies)
    columns += 1. + body->measure().size();
  columns += scene.quantities.empty() ? 0. : 1. + scene.quantities.size();
  plan.output_bytes = sum_over_ranks(bytes, communicator) +
                      8. * columns * (n_history_rows(scene) + n_checks);
  // Compression is what takes the time; frames full of numbers take longer.
  seconds = 2. * once * n_frames;
}

/** Integral over the rest of the run of the step now over the step then [s]. */
double steps_left(const ImpactFacts &impact, const double now, const double end)
{
  if (!impact.exists)
    return std::max(0., end - now);
  const auto strain = [&](const double t)
  { return std::min(impact.largest_strain, impact.strain_rate * t); };
  constexpr int n = 1000;
  double sum = 0.;
  for (int i = 0; i < n; ++i)
    sum += std::exp(strain(now + (end - now) * (i + 0.5) / n) - strain(now));
  return std::max(0., end - now) * sum / n;
}
} // namespace

FieldSize field_size(const OutputMesh &mesh, const bool all_yield)
{
  FieldSize size{0., 0.};
  const double points = compressed_size(mesh.points);
  size.quiet += points;
  size.disturbed += part_of_noise * 8. * mesh.points.size();
  const double cells = compressed_size(mesh.connectivity);
  size.quiet += cells;
  size.disturbed += cells;
  for (const auto *const fields : {&mesh.point_fields, &mesh.cell_fields})
    for (const OutputField &field : *fields)
    {
      const double now = compressed_size(field.values);
      size.quiet += now;
      const bool is_constant = field.name == "body" || field.name == "rank" ||
                               field.name == "failed-bond fraction";
      const bool is_flow = field.unit == "1" || field.unit == "K";
      size.disturbed += is_constant || (is_flow && !all_yield)
                            ? now
                            : part_of_noise * 8. * field.values.size();
    }
  return size;
}

CostPlan plan_cost(Scene &scene, const PhysicsPlan &physics,
                   const double seconds, MPI_Comm communicator)
{
  const auto start = Clock::now();
  CostPlan plan;
  Timers timers;
  CentralDifference integrator(scene.bodies, scene.couplings, timers,
                               communicator);
  scene.distribute();
  integrator.initialize();
  plan.set_up_seconds = since(start);
  for (const auto &body : scene.bodies)
  {
    CostPlan::Item item{body->name, body->item_name(), double(body->n_items()),
                        0.};
    if (const auto *const spg = dynamic_cast<const SpgBody *>(body.get()))
    {
      double bonds = 0.;
      for (std::size_t i = 0; i < spg->nodes().n_owned; ++i)
        bonds += spg->bond_list().n_bonds(i);
      item.neighbours = sum_over_ranks(bonds, communicator) / item.n;
    }
    plan.items.push_back(item);
  }
  double output_seconds = 0.;
  plan_output(scene, physics, plan, output_seconds, communicator);
  {
    StateSaver saver;
    for (const auto &body : scene.bodies)
      body->visit_state(saver);
    double bytes = 0.;
    for (const StateBlock &saved : saver.blocks)
      bytes += saved.bytes.size();
    plan.checkpoint_bytes = sum_over_ranks(bytes, communicator);
  }

  constexpr unsigned int least_steps = 6;
  const double end = scene.settings.end_time * (1. - 1e-12);
  std::vector<double> steps;
  const auto calibration = Clock::now();
  for (bool go_on = true; go_on;)
  {
    const StepProposal proposal = integrator.propose(false);
    if (steps.empty())
    {
      plan.first_stable_step = proposal.dt;
      plan.limiter = proposal.limiter;
    }
    double dt = std::min(scene.settings.step_factor * proposal.dt,
                         scene.settings.largest_step);
    if (!steps.empty())
      dt = std::min(dt, 1.05 * steps.back());
    dt = std::min(dt, scene.settings.end_time - integrator.time);
    steps.push_back(dt);
    try
    {
      integrator.advance(dt);
      integrator.update_topology(steps.size());
    }
    catch (const PhysicsError &e)
    {
      plan.problem = e.what();
      break;
    }
    int more = integrator.time < end &&
               (steps.size() < least_steps || since(calibration) < seconds);
    MPI_Bcast(&more, 1, MPI_INT, 0, communicator);
    go_on = more != 0;
  }
  plan.seconds_per_step = since(calibration) / steps.size();
  plan.calibration_steps = steps.size();
  double sum = 0.;
  const std::size_t half = steps.size() / 2;
  for (std::size_t s = half; s < steps.size(); ++s)
    sum += steps[s];
  plan.mean_step = sum / (steps.size() - half);
  plan.steps = steps.size() + steps_left(physics.impact, integrator.time,
                                         scene.settings.end_time) /
                                  plan.mean_step;
  plan.steps = std::ceil(plan.steps * (1. - 1e-9));
  const double n_rows = std::min(plan.steps, n_history_rows(scene) + n_checks);
  plan.seconds = plan.set_up_seconds + plan.steps * plan.seconds_per_step +
                 n_rows * seconds_per_row(scene) + output_seconds;
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  plan.memory_bytes = sum_over_ranks(1024. * usage.ru_maxrss, communicator);
  return plan;
}
} // namespace sabot
