#ifndef sabot_bodies_spg_spg_mass_scaling_h
#define sabot_bodies_spg_spg_mass_scaling_h

#include "sabot/bodies/mass_scaling.h"
#include "sabot/bodies/spg/spg_parts.h"

namespace sabot
{
class Stabilization;

/** The smallest step of an SPG body: mass for particles whose bound
    (SpgStableStep) asks for less, as Gershgorin's rows go with 1/m. By how much
    the bounds are too short is measured anew where the least of them has
    moved. */
class SpgMassScaling : public MassScaling
{
public:
  /** All is kept by reference. Makes room for the steps of single particles
      (ParticleFields::own_step). Collective. */
  SpgMassScaling(const MassScalingOptions &options, SpgParts &parts,
                 SpgStableStep &stable, Stabilization &stabilization,
                 MPI_Comm communicator);
  /** Leaves the watch with the least step that is left. Collective. */
  bool hold(const unsigned int step, const double dt) override;

private:
  /** Mass where own_step calls for it. Collective. @return whether any rank
      has added some. */
  bool add_masses(const double dt);
  /** Of own_step, for the watch. */
  void find_smallest_step();

  SpgParts &parts;
  SpgStableStep &stable;
  Stabilization &stabilization;
  MPI_Comm communicator;
};
} // namespace sabot

#endif
