#ifndef sabot_simulation_control_shares_h
#define sabot_simulation_control_shares_h

#include "sabot/base/measures.h"
#include "sabot/base/state_visitor.h"

#include <string>
#include <vector>

namespace sabot
{
/**
 * How much energy went into what only holds the discretization together,
 * hourglass control or stabilization, body by body. The share is
 *
 *   max over time |E_control| / max over time E_internal,
 *
 * a pure number: of elastic bodies both come and go, and at the end neither
 * says what the run went through. Above a tenth the answer depends on the
 * control and not on the metal alone. Not collective; the same on all ranks, as
 * measures are.
 */
class ControlShares
{
public:
  /** Above this a share is to be told. */
  static constexpr double most = 0.1;

  explicit ControlShares(const std::size_t n_bodies) : bodies(n_bodies) {}
  /** Body number @p body at this moment. */
  void look(const std::size_t body, const BodyMeasures &measures);
  /** 0 where there was neither. */
  double share(const std::size_t body) const;
  /** Whether it is above the most that is harmless and its energy more than
      1e-4 of @p scene_energy [J], which tells it from round-off. */
  bool is_large(const std::size_t body, const double scene_energy) const;
  void visit_state(StateVisitor &visitor)
  {
    visitor.visit_array("control energies", bodies);
  }

private:
  struct Largest
  {
    double control = 0., internal = 0.; // [J]
  };
  std::vector<Largest> bodies;
};
} // namespace sabot

#endif
