#ifndef sabot_couplings_coupling_h
#define sabot_couplings_coupling_h

#include "sabot/base/ledger.h"
#include "sabot/base/measures.h"
#include "sabot/base/resultant.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body.h"

#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Acts between bodies through their nodes only. A step calls, in this order:
 * impose_kinematics() before the drift, add_forces() of all couplings in the
 * scene's order (ties last) after the bodies' own forces, accumulate_work()
 * with the forces before and after each drift; between steps update_search(),
 * and forward_changes() where a body's forces changed.
 */
class Coupling
{
public:
  explicit Coupling(const std::string &name) : name(name) {}
  virtual ~Coupling() = default;

  const std::string name; // in the scene, or with what part of it this is

  /** "tie", "contact" or "self-contact": the name of its timers and its type
      in results. Not to be compared: what it does, holds_apart() says. */
  virtual std::string kind() const = 0;
  /** Pairs of bodies, by number, that it keeps from passing through each other;
      (a, a): parts of one body. */
  virtual std::vector<std::pair<int, int>> holds_apart() const { return {}; }
  /** SpringOptions::stability_fraction of the springs that do; 0: none do. */
  virtual double stability_fraction() const { return 0.; }
  /** Bodies, by number, nodes of which it moves together with others', so that
      all of them take the same steps. */
  virtual std::vector<int> joins() const { return {}; }
  /** Once, after the bodies were distributed, ties before others: they change
      the inertia of leaders and followers. Throws InputError, on all ranks,
      where the bodies do not fit. Collective. */
  virtual void initialize() = 0;
  /** Sets velocities of owned nodes that others lead. Collective. */
  virtual void impose_kinematics() {}
  /** Add forces [N] to owned nodes. @p dt is the step just made [s]; 0 at the
      start, where nothing has moved yet and springs do not act. Collective. */
  virtual void add_forces(const double dt) = 0;
  /** The step that comes is cut to meet the end of the run: springs whose
      stiffness goes by the step keep that of the last one, of @p last_step [s],
      or what rests would be struck in the state that is written. Until the next
      add_forces(). */
  virtual void keep_stiffness(const double /*last_step*/) {}
  /** Between steps, after the bodies' own updates: what it does to bodies
      themselves. @return whether forces of bodies changed, the same on all
      ranks. Collective. */
  virtual bool change_bodies(const unsigned int /*step*/) { return false; }
  /** After an update between steps changed forces of bodies: pass the changes
      on. Collective. */
  virtual void forward_changes() {}
  /** Work of the current forces along half a step's motion, @p half_dt times
      the current velocities (called before and after each drift). */
  virtual void accumulate_work(const double /*half_dt*/) {}
  /** Largest stable step that it asks for, seen from this rank; none where it
      keeps itself stable. */
  virtual StableStep stable_step() const { return {}; }
  /** Searches that are due before step @p step of length @p dt [s].
      Collective. */
  virtual void update_search(const unsigned int /*step*/, const double /*dt*/)
  {
  }
  /** Add this rank's share of what it took from the bodies [J]. */
  virtual void add_energies(EnergyLedger &) const {}
  /** What initialize() found that can hardly be meant; the same on all
      ranks. */
  virtual std::vector<std::string> warnings() const { return {}; }
  /** What add_forces() goes through on this rank, now: nodes that may touch,
      loose particles that may meet, tied nodes. */
  virtual std::size_t n_items() const { return 0; }
  /** For results, e.g. tied nodes, penetration. Collective, same on all
      ranks. */
  virtual Measures measure() const { return {}; }
  /** What it does to each body that it holds apart or ties; none where bodies
      only meet themselves. Collective. */
  virtual std::vector<Resultant> resultants() const { return {}; }
  /** Everything that a restart needs and initialize() does not find. */
  virtual void visit_state(StateVisitor &) {}
};
} // namespace sabot

#endif
