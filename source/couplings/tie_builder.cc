// The coupling "tie" of a scene.
#include "sabot/couplings/coupling_builder.h"
#include "sabot/couplings/tie.h"

namespace sabot
{
namespace
{
void declare(Parameters &prm)
{
  prm.declare_entry("Follower", "", any_text(),
                    "Body whose nodes on the leader's surface are tied.");
  prm.declare_entry("Leader", "", any_text(), "A FEM body.");
  prm.declare_knob("Tolerance", "0.05", quantity(Dimension::none, 1e-6, 1.),
                   "Distance from the surface, in follower spacings, up to "
                   "which a node is tied.");
}

class TieBuilder : public CouplingBuilder
{
public:
  int order() const override { return 0; }
  // They hand over all other forces on followers.
  bool acts_last() const override { return true; }

  std::vector<std::unique_ptr<Coupling>>
  build(const Parameters &prm, const std::string &path, const std::string &name,
        CouplingContext &context) const override
  {
    const int follower =
                  context.body_index(path + "/Follower", prm.get("Follower")),
              leader = context.body_index(path + "/Leader", prm.get("Leader"));
    if (follower == leader)
      throw InputError(path + "/Leader", "a body cannot be tied to itself");
    const FaceView *const faces = context.bodies[leader]->faces();
    if (faces == nullptr || !faces->deform())
      throw InputError(path + "/Leader", "the leader must be a FEM body");
    if (!context.bodies[follower]->moves_node_by_node())
      throw InputError(path + "/Follower",
                       "a rigid body cannot follow another");
    if (context.bodies[follower]->particle_sink() != nullptr)
      throw InputError(path + "/Follower",
                       "\"" + prm.get("Follower") +
                           "\" is a self-finding zone, whose particles come "
                           "while the run goes on; with its host it is one "
                           "without a tie, and another body is to be tied to "
                           "the host, cells at which stay cells");
    context.tied.insert({follower, leader});
    if (!context.tied_nodes)
      context.tied_nodes = std::make_shared<TiedNodes>();
    std::vector<std::unique_ptr<Coupling>> ties;
    ties.push_back(std::make_unique<Tie>(
        name, context.bodies, follower, leader, get_quantity(prm, "Tolerance"),
        context.communicator, context.tied_nodes));
    return ties;
  }
};

const Registry<CouplingBuilder>::Add
    registered({"tie", "nodes of one body move with the surface of another.",
                declare, [] { return std::make_unique<TieBuilder>(); }});
} // namespace
} // namespace sabot
