#ifndef sabot_bodies_spg_particle_heat_h
#define sabot_bodies_spg_particle_heat_h

#include "sabot/base/state_visitor.h"
#include "sabot/bodies/spg/particle_conduction.h"

#include <mpi.h>

#include <memory>

namespace sabot
{
class BondFailure;
class MaterialPoints;
struct SpgParts;

/** What diffuses between the particles of a body, where it is asked for: heat,
    and the measure of failure where it has a length. */
class ParticleHeat
{
public:
  /** For the particles that there are now: capacities, once bonds are known;
      again when particles have come. Collective. */
  void set_up(const SpgParts &body, BondFailure &failure,
              MPI_Comm communicator);
  /** Conduct since the last time where the interval is over. Collective. */
  void advance(const double time, const double interval,
               MaterialPoints &points);
  void visit_state(StateVisitor &visitor);

private:
  std::unique_ptr<ParticleConduction> conduction; // only where asked for
  double last = 0.;                               // [s]
};
} // namespace sabot

#endif
