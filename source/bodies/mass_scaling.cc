// Mass scaling: inertia that holds the steps of a body's items, and the books
// of what it brings.
#include "sabot/bodies/mass_scaling.h"

#include "sabot/base/added_mass.h"
#include "sabot/base/choice.h"
#include "sabot/base/error.h"
#include "sabot/base/parameters.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/velocity_constraints.h"

#include <algorithm>
#include <cstdio>

namespace sabot
{
namespace
{
constexpr const char *standard_share = "0.01";
} // namespace

void MassScalingOptions::declare_parameters(Parameters &prm)
{
  prm.declare_knob("Smallest step", "none",
                   word_or("none", quantity(Dimension::time, 1e-15, 1.)),
                   "Mass scaling: where the own stable step of a cell or "
                   "particle falls below this, inertia is added to its nodes "
                   "until it does not; it stays.");
  prm.declare_knob("Largest added mass", standard_share,
                   quantity(Dimension::none, 0., 1.),
                   "Share of the body's mass that mass scaling may add before "
                   "the run stops.");
}

MassScalingOptions MassScalingOptions::parse(const Parameters &prm,
                                             const std::string &path)
{
  MassScalingOptions o;
  o.smallest_step = get_optional_quantity(prm, "Smallest step").value_or(0.);
  o.largest_share = get_quantity(prm, "Largest added mass");
  if (!o.is_on() && !same_value(prm.get("Largest added mass"), standard_share))
    throw InputError(path + "/Largest added mass",
                     "is " + prm.get("Largest added mass") +
                         ", but nothing adds mass to the body; set "
                         "\"Smallest step\" or remove the entry");
  return o;
}

MassScaling::MassScaling(const MassScalingOptions &options,
                         const std::string &body_name,
                         const std::string &item_name, NodalState &nodes,
                         const VelocityConstraints &held, MPI_Comm communicator)
    : options(options), body_name(body_name), item_name(item_name),
      nodes(nodes), held(held), communicator(communicator)
{
  nodes.added_mass.assign(nodes.n_owned, 0.);
  ExactSum all;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    all.add(nodes.lumped_mass[i]);
  ExactSum::reduce({&all}, communicator);
  body_mass = all.value();
}

double MassScaling::share_for(const double step) const
{
  const double ratio = options.smallest_step / step;
  return std::max(0., ratio * ratio - 1.);
}

void MassScaling::add(const std::size_t node, const double more,
                      const double dt)
{
  if (node >= nodes.n_owned)
    return;
  const Vec v = nodes.velocity[node];
  nodes.added_mass[node] += more;
  mass.add(more);
  momentum.add(more * v);
  has_added = true;
  if (nodes.is_follower(node))
    return; // the tie's to hand on
  energy.add(
      energy_of_added_mass(nodes, node, held.held_at(node).first, more, dt));
  nodes.inertia[node] += more;
}

bool MassScaling::settle(const StableStep &shortest)
{
  int any = has_added;
  has_added = false;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
  if (any == 0)
    return false;
  ExactSum all = mass;
  ExactSum::reduce({&all}, communicator);
  total = all.value();
  if (!(share() <= options.largest_share))
    refuse(shortest);
  return true;
}

void MassScaling::refuse(StableStep shortest) const
{
  double least = shortest.dt;
  MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, communicator);
  GlobalIndex who = shortest.dt == least
                        ? shortest.item
                        : std::numeric_limits<GlobalIndex>::max();
  MPI_Allreduce(MPI_IN_PLACE, &who, 1, MPI_INT64_T, MPI_MIN, communicator);
  char text[400];
  std::snprintf(text, sizeof(text),
                "body %s: its \"Smallest step\" of %.4g s would add %.4g kg, "
                "%.3g %% of its mass, more than \"Largest added mass\" allows "
                "(%.3g %%); the least step of its %s by itself is %.4g s "
                "(#%lld); set a smaller \"Smallest step\", take such %s out, "
                "or allow more",
                body_name.c_str(), options.smallest_step, total, 100. * share(),
                100. * options.largest_share, item_name.c_str(), least,
                static_cast<long long>(who), item_name.c_str());
  throw PhysicsError(text);
}

void MassScaling::add_energies(EnergyLedger &ledger) const
{
  ledger.added_mass.add(energy);
}

void MassScaling::add_measures(BodyMeasures &measures) const
{
  ExactVectorSum now, brought = momentum;
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    now.add(nodes.added_mass[i] * nodes.velocity[i]);
  ExactVectorSum::reduce({&now, &brought}, communicator);
  for (int d = 0; d < 3; ++d)
    measures.added_momentum[d] = now.value()[d] - brought.value()[d];
  measures.own.push_back({"added mass", "kg", total});
  measures.own.push_back({"added mass share", "1", share()});
}

void MassScaling::visit_state(StateVisitor &visitor, const StateItems &items)
{
  visitor.visit_items("added mass", nodes.added_mass, items);
  visitor.visit_value("added mass of all", total);
  visitor.visit_sum("mass added here", mass);
  visitor.visit_sum("energy of added mass", energy);
  visitor.visit_sum("momentum of added mass", momentum);
}
} // namespace sabot
