#ifndef sabot_bodies_spg_stabilization_unstabilized_h
#define sabot_bodies_spg_stabilization_unstabilized_h

#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"

namespace sabot
{
/** The SPG step without a form's part (spg_step.h says what the hooks are): the
    choice "none", and the base of forms that act between steps only. */
class Unstabilized : public Stabilization
{
public:
  void compute_forces(SpgParts &body, const double dt) override;
  void apply_linearized(const SpgParts &body, const AlignedVector<Vec> &motion,
                        AlignedVector<Vec> &force) override;

  /** The hooks of spg_step.h, which compile to nothing: no force per bond, no
      trial stress (extra_square stays 0, as it starts), nothing to add to a
      particle's stress [J], no stiffness for its neighbors' fourth lanes, no
      ghosts' bonds to exchange. */
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
  /** The hooks of linearized_body.h. */
  double linear_stiffness(const std::size_t) const { return 0.; }
  void add_linearized(const SpgParts &, const AlignedVector<Vec> &,
                      const AlignedVector<Vec> &)
  {
  }
};
} // namespace sabot

#endif
