#ifndef sabot_bodies_spg_stabilization_unstabilized_h
#define sabot_bodies_spg_stabilization_unstabilized_h

#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"

namespace sabot
{
/** The SPG step without a form's part (spg_step.h says what the hooks are):
    the choice "none", and the base of forms that act between steps only.
    Direct nodal integration as it is: sawtooth motions cost no energy. The
    stress of a particle is that of its material alone, work() stays zero,
    and K of the linearized body is that of the gradients. */
class Unstabilized : public Stabilization
{
public:
  /** The SPG step with hooks that do nothing. Collective. */
  void compute_forces(SpgParts &body, const double dt) override;
  /** The same beside cracks. Collective. */
  bool renew_forces(SpgParts &body, const CrackedParticles &cracked) override;
  /** The linearized body with hooks that do nothing. Collective. */
  void apply_linearized(const SpgParts &body, const AlignedVector<Vec> &motion,
                        AlignedVector<Vec> &force) override;

  /** The hooks of spg_step.h, which compile to nothing: no force per bond,
      no trial stress (extra_square stays 0, as it starts), nothing to add to
      a particle's stress [J], no stiffness for its neighbors' fourth lanes,
      no ghosts' bonds to exchange. trial: 3 tau^2 [Pa^2] for places of a
      batch. add_stress(i, place, J V, work, V sigma): adds to V sigma [J],
      returns what goes into the fourth lane. bond_forces: functor (bond,
      reverse, neighbor's lane) -> N, here none. add_forces: after
      the gathering, on top of it. */
  static constexpr bool has_bond_forces = false;
  void trial(const ParticleRange &, const SpgParts &) {}
  double add_stress(const std::size_t, const std::size_t, const double,
                    const StepWork &, Mat &)
  {
    return 0.;
  }
  void exchange(const SpgParts &) {}
  int bond_forces(const BondList &) const { return 0; }
  void add_forces(const SpgParts &) {}
  /** The hooks of linearized_body.h. k_N [N m] and what is added to f = -K
      v; zero and nothing. */
  double linear_stiffness(const std::size_t) const { return 0.; }
  void add_linearized(const SpgParts &, const AlignedVector<Vec> &,
                      const AlignedVector<Vec> &)
  {
  }
};
} // namespace sabot

#endif
