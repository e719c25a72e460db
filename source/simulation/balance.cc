// Energy and momentum over a run.
#include "sabot/simulation/balance.h"

#include "sabot/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sabot
{
EnergyBalance::EnergyBalance(const Scene &scene, MPI_Comm communicator)
    : scene(scene), communicator(communicator)
{
}

double EnergyBalance::total_energy(const double dt)
{
  EnergyLedger e;
  for (const auto &body : scene.bodies)
    body->add_energies(e);
  for (const auto &load : scene.loads)
    load->add_energies(e);
  for (const auto &coupling : scene.couplings)
    coupling->add_energies(e);
  e.reduce(communicator);
  ledger.clear();
  e.for_each(
      [&](const EnergyTerm &term, const double value) {
        ledger.push_back({term.name, "J", value});
      });
  const double total = e.total().value();
  ledger.push_back({"total", "J", total});

  double parts = 0., supplied = 0.;
  for (const EnergyTerm &term : energy_terms)
  {
    const double size = std::abs(find_measure(ledger, term.name));
    if (term.role == EnergyTerm::Role::part)
      parts += size;
    else if (term.role == EnergyTerm::Role::supplied)
      supplied += size;
  }
  passed = std::max(parts, supplied);
  return dt > 0. ? total - kick_energy(dt) + cut_kick : total;
}

double EnergyBalance::kick_energy(const double dt) const
{
  ExactSum kick;
  for (const auto &body : scene.bodies)
    body->add_kick_energy(dt, kick);
  for (const auto &load : scene.loads)
    load->take_kick_energy(dt, kick);
  ExactSum::reduce({&kick}, communicator);
  return kick.value();
}

void EnergyBalance::start()
{
  // Of strains and speeds over sound's of 1e-10: round-off stays far below.
  constexpr double nothing = 1e-20;
  initial_energy = total_energy(0.);
  largest_energy = passed;
  initial_kick = kick_energy(kick_step);
  for (const auto &body : scene.bodies)
  {
    const BodyMeasures m = body->measure();
    const double c = body->facts().material->sound_speed();
    least_energy += nothing * m.mass * c * c;
    momentum_scale += std::sqrt(2. * m.kinetic_energy * m.mass);
    for (int d = 0; d < 3; ++d)
      initial_momentum[d] += m.mass * m.velocity[d];
  }
}

void EnergyBalance::fill_row(const double time, const double dt)
{
  const double total = total_energy(dt);
  const double scale = std::max({largest_energy, passed, least_energy});
  if (dt > 0. && first_step == 0.)
    first_step = dt;
  // Loads that are there at once: the first half kick has its energy, too.
  const double at_start =
      initial_energy - initial_kick * std::pow(first_step / kick_step, 2);
  last = dt > 0. ? std::abs(total - at_start) / scale : 0.;
  ledger.insert(ledger.begin(), {{"time", "s", time}, {"step size", "s", dt}});
  ledger.push_back({"residual", "1", last});
}

void EnergyBalance::look(const double time, const double dt)
{
  fill_row(time, dt);
  largest_energy = std::max(largest_energy, passed);
  // Not-a-number stays.
  if (!(last <= largest))
    largest = last;
  if (scene.is_free)
    largest_momentum = std::max(largest_momentum, momentum_residual());
}

double EnergyBalance::momentum_residual() const
{
  std::array<double, 3> change = {
      {-initial_momentum[0], -initial_momentum[1], -initial_momentum[2]}};
  for (const auto &body : scene.bodies)
  {
    const BodyMeasures m = body->measure();
    for (int d = 0; d < 3; ++d)
      change[d] +=
          m.mass * m.velocity[d] + m.eroded_momentum[d] + m.added_momentum[d];
  }
  return momentum_scale > 0.
             ? std::sqrt(change[0] * change[0] + change[1] * change[1] +
                         change[2] * change[2]) /
                   momentum_scale
             : 0.;
}

void EnergyBalance::check(const double limit, const std::string &limiter) const
{
  if (last <= limit)
    return;
  // Name the part that holds the surplus.
  const EnergyTerm *largest_term = nullptr;
  double most = 0.;
  for (const EnergyTerm &term : energy_terms)
  {
    const double value = find_measure(ledger, term.name);
    if (term.role != EnergyTerm::Role::information &&
        (largest_term == nullptr || !(std::abs(value) <= std::abs(most))))
    {
      largest_term = &term;
      most = value;
    }
  }
  char text[300];
  std::snprintf(text, sizeof(text),
                "the energy balance is off by %.3g %%, more than the limit of "
                "%.3g %%; largest part: %s %.6g J; the step was limited by ",
                100. * last, 100. * limit, largest_term->name, most);
  throw PhysicsError(text + limiter);
}

void EnergyBalance::visit_state(StateVisitor &visitor)
{
  visitor.visit_value("initial energy", initial_energy);
  visitor.visit_value("initial kick energy", initial_kick);
  visitor.visit_value("first step", first_step);
  visitor.visit_value("largest energy", largest_energy);
  visitor.visit_value("least energy", least_energy);
  visitor.visit_value("last residual", last);
  visitor.visit_value("largest residual", largest);
  visitor.visit_array("initial momentum", initial_momentum);
  visitor.visit_value("momentum scale", momentum_scale);
  visitor.visit_value("largest momentum residual", largest_momentum);
}
} // namespace sabot
