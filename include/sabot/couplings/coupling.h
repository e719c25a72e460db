#ifndef sabot_couplings_coupling_h
#define sabot_couplings_coupling_h

#include "sabot/base/ledger.h"
#include "sabot/base/measures.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body.h"

#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/** Acts between bodies through their nodes only. */
class Coupling
{
public:
  explicit Coupling(const std::string &name) : name(name) {}
  virtual ~Coupling() = default;

  const std::string name;

  /** "tie", "contact" or "self-contact": the name of its timers and its type
      in results. Not to be compared: what it does, holds_apart() says. */
  virtual std::string kind() const = 0;
  /** Pairs of bodies, by number, that it keeps from passing through each other;
      (a, a): parts of one body. */
  virtual std::vector<std::pair<int, int>> holds_apart() const { return {}; }
  /** Once, after the bodies were distributed. Collective. */
  virtual void initialize() = 0;
  /** Followers take the motion of their leaders. */
  virtual void impose_kinematics() {}
  /** Add forces to owned nodes. @p dt is the step just made. Collective. */
  virtual void add_forces(const double dt) = 0;
  /** After an update between steps changed forces of bodies: pass the changes
      on. Collective. */
  virtual void forward_changes() {}
  /** Work of the current forces along half a step's motion, @p half_dt times
      the current velocities (called before and after each drift). */
  virtual void accumulate_work(const double /*half_dt*/) {}
  virtual StableStep stable_step() const { return {}; }
  /** Searches that are due. Collective. */
  virtual void update_search(const unsigned int /*step*/, const double /*dt*/)
  {
  }
  virtual void add_energies(EnergyLedger &) const {}
  /** Collective, same on all ranks. */
  virtual Measures measure() const { return {}; }
  virtual void visit_state(StateVisitor &) {}
};
} // namespace sabot

#endif
