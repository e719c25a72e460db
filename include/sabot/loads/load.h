#ifndef sabot_loads_load_h
#define sabot_loads_load_h

#include "sabot/base/ledger.h"
#include "sabot/base/registry.h"
#include "sabot/base/resultant.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/** What a load is built from; its subsection is entered. The bodies are not
    distributed yet: only what they are may be asked. */
struct LoadRequest
{
  const Parameters &prm;
  std::string path, name;     // "Loads/weight", "weight"
  std::vector<Body *> bodies; // all, numbered by Body::id
  /** The body called @p value; InputError for the entry @p entry where there is
      none. */
  std::function<Body *(const std::string &entry, const std::string &value)>
      body;
  MPI_Comm communicator;
  double end_time = 0.; // of the run [s], 0 where there is none
};

/**
 * Something outside of the scene that acts on bodies: f_external of
 * Wu & Wu 2018, Eq. 5, or a motion that is forced upon them. A step calls, in
 * this order: impose_velocities() after the bodies' own and before that of the
 * couplings, after each kick; accumulate_work() before and after the drift;
 * add_forces() after the bodies' own forces and before the couplings, so that
 * ties hand on what acts on followers.
 *
 * The work of a load along a step is half of dt v(n+1/2) . (f(n) + f(n+1)), as
 * that of couplings; it is the ledger's external work.
 *
 * A new kind is one file: a class with the work, its entries, and on its last
 * line its registration,
 *
 *     const Registry<Load>::Add registered({"gravity", "...", declare, make});
 *
 * SI units. What it adds to a node must depend on that node and its faces
 * alone, in the order of global numbers, so that it is the same on any rank.
 */
class Load
{
public:
  static constexpr const char *kind = "load";
  /** Reads its entries; throws InputError, by the entry. Not collective. */
  using Make = std::unique_ptr<Load>(const LoadRequest &);
  explicit Load(const std::string &name) : name(name) {}
  virtual ~Load() = default;

  const std::string name; // in the scene

  /** Its kind in results. */
  virtual std::string type() const = 0;

  /** Once, after the bodies were distributed and the couplings have started, so
      that it is known which nodes ties move. Throws
      InputError, on all ranks, where a body cannot bear it. Collective. */
  virtual void initialize() = 0;
  /** Bodies, by number, of which it prescribes velocities. */
  virtual std::vector<int> drives() const { return {}; }
  /** InputError, on all ranks, where it contradicts @p other, which comes
      before it in the scene. After initialize() of all loads. Collective. */
  virtual void check_beside(const Load & /*other*/) const {}
  /** Velocities of owned nodes that it prescribes. @p begin and @p end [s]: the
      stretch of time along which nodes move with them; equal ones: the velocity
      at that time. Local. */
  virtual void impose_velocities(const double /*begin*/, const double /*end*/)
  {
  }
  /** Add forces [N] to owned nodes at the present positions and @p time [s].
      Local. */
  virtual void add_forces(const double /*time*/) {}
  /** Work of the current forces along half a step's motion, @p half_dt times
     the current velocities (called before and after each drift). Local. */
  virtual void accumulate_work(const double half_dt) = 0;
  /** Add this rank's share of the work done so far [J]. Local. */
  virtual void add_energies(EnergyLedger &ledger) const = 0;
  /** Take off what Body::add_kick_energy() counts of kicks that the load
      undoes: of components whose velocity it prescribes. Local. */
  virtual void take_kick_energy(const double /*dt*/, ExactSum & /*sum*/) const
  {
  }
  /** For results: the work so far [J]. Collective, same on all ranks. */
  virtual double total_work() const = 0;
  /** Its force on each of its bodies now and the impulse so far; nothing where
      the body tells by itself. Collective, same on all ranks. */
  virtual std::vector<Resultant> resultants() const { return {}; }
  /** Everything that a restart needs and initialize() does not find. */
  virtual void visit_state(StateVisitor &visitor) = 0;
};
} // namespace sabot

#endif
