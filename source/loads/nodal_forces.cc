// Forces of a load on nodes of a body, and the work that they do.
#include "sabot/loads/nodal_forces.h"

namespace sabot
{
NodalForces::NodalForces(Body &body, std::vector<std::size_t> some_nodes)
    : body(body), nodes(std::move(some_nodes)), force(nodes.size(), Vec{}),
      work(nodes.size(), 0.), impulse(nodes.size(), Vec{})
{
}

NodalForces::NodalForces(Body &body) : body(body), is_on_all(true)
{
  follow_body();
}

void NodalForces::follow_body()
{
  const std::size_t n = body.nodes().n_owned;
  if (!is_on_all || nodes.size() == n)
    return;
  while (nodes.size() < n)
    nodes.push_back(nodes.size());
  force.resize(n, Vec{});
  work.resize(n, 0.);
  impulse.resize(n, Vec{});
}

void NodalForces::add()
{
  NodalState &state = body.nodes();
  for (std::size_t k = 0; k < nodes.size(); ++k)
    state.force[nodes[k]] += force[k];
}

void NodalForces::accumulate_work(const double half_dt)
{
  const NodalState &state = body.nodes();
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    work[k] += half_dt * dot(force[k], state.velocity[nodes[k]]);
    impulse[k] += half_dt * force[k];
  }
}

void NodalForces::add_energies(EnergyLedger &ledger) const
{
  ledger.external.add(total_work());
}

ExactSum NodalForces::total_work() const
{
  ExactSum sum;
  for (const double w : work)
    sum.add(w);
  return sum;
}

Resultant NodalForces::resultant(const std::string &name,
                                 MPI_Comm communicator) const
{
  ExactVectorSum now, total;
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    now.add(force[k]);
    total.add(impulse[k]);
  }
  ExactVectorSum::reduce({&now, &total}, communicator);
  return {name, body.id, now.value(), total.value(), true};
}

void NodalForces::visit_state(StateVisitor &visitor)
{
  follow_body(); // whose nodes have been restored
  std::vector<GlobalIndex> keys;
  for (const std::size_t i : nodes)
    keys.push_back(body.nodes().global_id[i]);
  const StateItems items = {visitor.section + "/loaded nodes of " + body.name,
                            keys.data(), keys.size(), keys.size()};
  visitor.visit_keys(items);
  visitor.visit_items("force of " + body.name, force, items);
  visitor.visit_items("work on " + body.name, work, items);
  visitor.visit_items("impulse on " + body.name, impulse, items);
}
} // namespace sabot
