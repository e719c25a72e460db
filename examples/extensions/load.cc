// Adds the load "drag": what a medium takes from a body that moves through it,
//
//   f_a = -m_a v_a/tau,
//
// m_a and v_a mass and velocity of a node, tau a time: the body slows down as
// exp(-t/tau). To keep it, copy this file into source/loads.
// Scene: load.prm.
#include "sabot/loads/load.h"
#include "sabot/loads/nodal_forces.h"

#include <numeric>
#include <optional>

namespace sabot
{
namespace
{
class Drag : public Load
{
public:
  explicit Drag(const LoadRequest &request)
      : Load(request.name),
        body(*request.body("Body", request.prm.get("Body"))),
        relaxation_time(get_quantity(request.prm, "Relaxation time")),
        communicator(request.communicator)
  {
  }
  std::string type() const override { return "drag"; }
  void initialize() override
  {
    std::vector<std::size_t> all(body.nodes().n_owned);
    std::iota(all.begin(), all.end(), 0);
    forces.emplace(body, std::move(all));
  }
  void add_forces(const double) override
  {
    const NodalState &state = body.nodes();
    for (std::size_t i = 0; i < forces->force.size(); ++i)
      forces->force[i] =
          (-state.lumped_mass[i] / relaxation_time) * state.velocity[i];
    forces->add();
  }
  // What most loads of forces share.
  void accumulate_work(const double half_dt) override
  {
    forces->accumulate_work(half_dt);
  }
  void add_energies(EnergyLedger &ledger) const override
  {
    forces->add_energies(ledger);
  }
  double total_work() const override
  {
    ExactSum work = forces->total_work();
    ExactSum::reduce({&work}, communicator);
    return work.value();
  }
  std::vector<Resultant> resultants() const override
  {
    return {forces->resultant(name, communicator)};
  }
  void visit_state(StateVisitor &visitor) override
  {
    forces->visit_state(visitor);
  }

private:
  Body &body;
  const double relaxation_time; // [s]
  MPI_Comm communicator;
  std::optional<NodalForces> forces; // once the body is distributed
};

void declare(Parameters &prm)
{
  prm.declare_entry("Body", "", any_text(), "Name of the body.");
  prm.declare_entry("Relaxation time", "1 ms",
                    quantity(Dimension::time, 1e-9, 1e6),
                    "Time tau in which the speed falls to 1/e.");
}

const Registry<Load>::Add
    registered({"drag", "of a medium, in proportion to mass and velocity.",
                declare, [](const LoadRequest &request) {
                  return std::make_unique<Drag>(request);
                }});
} // namespace
} // namespace sabot
