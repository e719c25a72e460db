#ifndef sabot_bodies_scaled_body_h
#define sabot_bodies_scaled_body_h

#include "sabot/bodies/body.h"
#include "sabot/bodies/mass_scaling.h"

#include <memory>

namespace sabot
{
/** A body that may hold its items at a smallest step. It adds the energies,
    measures and state of that to its own. */
class ScaledBody : public Body
{
public:
  using Body::Body;
  bool hold_step(const unsigned int step, const double dt) final
  {
    return scaling && scaling->hold(step, dt);
  }
  const MassScaling *mass_scaling() const final { return scaling.get(); }

protected:
  // Its part; nothing without.
  void add_scaling(EnergyLedger &ledger) const
  {
    if (scaling)
      scaling->add_energies(ledger);
  }
  void add_scaling(BodyMeasures &measures) const
  {
    if (scaling)
      scaling->add_measures(measures);
  }
  void visit_scaling(StateVisitor &visitor)
  {
    if (scaling)
      scaling->visit_state(visitor, nodes_of_state(*this));
  }

  std::unique_ptr<MassScaling> scaling; // only where asked for
};
} // namespace sabot

#endif
