#ifndef sabot_bodies_mass_scaling_h
#define sabot_bodies_mass_scaling_h

#include "sabot/base/exact_sum.h"
#include "sabot/base/ledger.h"
#include "sabot/base/measures.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/resultant.h"
#include "sabot/base/state_visitor.h"

#include <mpi.h>

#include <string>

namespace sabot
{
class Parameters;
class VelocityConstraints;
struct StableStep;

/** What a scene says about the smallest step of a body. */
struct MassScalingOptions
{
  double smallest_step = 0.;   // [s], 0: as small as it has to be
  double largest_share = 0.01; // of the body's mass that may be added

  bool is_on() const { return smallest_step > 0.; }

  /** "Smallest step" and "Largest added mass", of the body's subsection. */
  static void declare_parameters(Parameters &prm);
  /** Throws InputError, by the @p path of the body, for a share without a
      smallest step. */
  static MassScalingOptions parse(const Parameters &prm,
                                  const std::string &path);
};

/**
 * Inertia that is added to nodes of a body so that no item (cell or particle)
 * of it asks for less than a smallest step. An item of mass m with the stable
 * step dt_i < dt_min of its own gets
 *
 *   dm = m [ (dt_min/dt_i)^2 - 1 ],
 *
 * as frequencies go with 1/sqrt(m). What was added is never taken away.
 *
 * Which mass counts: the integrator divides by lumped and added mass
 * (NodalState::inertia), so both count in the momentum that is kept and in the
 * kinetic energy of the ledger. The lumped mass alone is the body's mass, its
 * weight, and what its velocity and kinetic energy in measures are made of.
 * Mass comes with the velocity of its node, hence changes no motion at that
 * moment, in no frame; the momentum dm v and the energy that it brings
 * (energy_of_added_mass()) are kept book of, so that both balances close. Nodes
 * that a tie moves have no inertia: the tie hands what they get on to their
 * leaders and keeps book of that energy.
 *
 * Off, a body has no such object. Kinds of bodies derive from it. Books are
 * exact sums: the same for every number of ranks.
 */
class MassScaling
{
public:
  /** Makes room for the added mass of the owned @p nodes, which are kept by
      reference as @p held is. Collective. */
  MassScaling(const MassScalingOptions &options, const std::string &body_name,
              const std::string &item_name, NodalState &nodes,
              const VelocityConstraints &held, MPI_Comm communicator);
  virtual ~MassScaling() = default;

  /** See Body::hold_step(). Collective. */
  virtual bool hold(const unsigned int step, const double dt) = 0;

  double added_mass() const { return total; } // [kg], of all ranks
  double smallest_step() const { return options.smallest_step; } // [s]
  /** Over the mass of the body. */
  double share() const { return total / body_mass; }

  /** The energy that it brought. Local. */
  void add_energies(EnergyLedger &ledger) const;
  /** Mass, and the momentum that the added mass has won since it came.
      Collective. */
  void add_measures(BodyMeasures &measures) const;
  /** @p items: the body's nodes. */
  void visit_state(StateVisitor &visitor, const StateItems &items);

protected:
  /** (dt_min/@p step)^2 - 1, at least 0: over its mass, what must have been
      added to an item with this step [s] of its own. */
  double share_for(const double step) const;
  /** Add @p mass [kg] to a local node after a step of @p dt [s]; what others
     own is theirs. Local. */
  void add(const std::size_t node, const double mass, const double dt);
  /** Agree on what was added since the last time. @p shortest: the least step
      of an item by itself, for the message. Collective.
      @return whether any rank has added mass. Throws PhysicsError, on all
      ranks, where the body has got more than its largest share. */
  bool settle(const StableStep &shortest);

private:
  void refuse(StableStep shortest) const;

  const MassScalingOptions options;
  const std::string body_name, item_name;
  NodalState &nodes;
  const VelocityConstraints &held;
  MPI_Comm communicator;
  double body_mass = 0., total = 0.; // [kg], of all ranks
  bool has_added = false;            // since settle()
  ExactSum mass, energy;             // added by this rank [kg], [J]
  ExactVectorSum momentum;           // that it brought [kg m/s]
};
} // namespace sabot

#endif
