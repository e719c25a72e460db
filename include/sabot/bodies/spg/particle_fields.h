#ifndef sabot_bodies_spg_particle_fields_h
#define sabot_bodies_spg_particle_fields_h

#include "sabot/base/memory_table.h"
#include "sabot/base/state_visitor.h"
#include "sabot/base/types.h"
#include "sabot/kernels/vec.h"

#include <cstddef>
#include <vector>

namespace sabot
{
class MirrorPlanes;
struct NodalState;

/**
 * What an SPG body knows of its particles beside their motion (NodalState) and
 * their material (MaterialPoints), one array per quantity. The configuration of
 * the last kernel update is where the meshfree functions live, so
 *
 *   F = F_inc F_ref,   dV = J_inc V_ref,
 *
 * F_inc incremental, since that update; F_ref and V_ref as of it. SI units.
 *
 * F maps vectors of the undeformed configuration to the present one. At a
 * kernel update F_ref and V_ref take over F_inc and J_inc, and F_inc starts at
 * 1 (Wu & Wu 2018, Eq. 16).
 */
struct ParticleFields
{
  // Owned particles, then ghosts
  AlignedVector<Vec> kernel_reference_position; // X of the last kernel update
  /** Kernel of each particle as the matrix H whose columns are its semi-axes:
      a neighbor has weight where |H^-1 dX| < 1 [m]. */
  AlignedVector<Mat> kernel;
  /**
   * What a particle's stress does to its neighbors, [n] by columns in row[]:
   * Q = V P M^-1 with least squares, V P with stored shape gradients [J, J/m];
   * P the nominal stress. The fourth lane of row[0] carries what a
   * stabilization wants its neighbors to know, for the bond residual the
   * stiffness theta k [N m^2/m^2].
   */
  AlignedVector<Mat> generalized_stress;

  // Owned particles
  /** Integral of the trilinear function of the node in meshes, cell of the
      lattice in boxes; never changes. */
  std::vector<double> reference_volume;                     // V_0 [m^3]
  std::vector<double> kernel_reference_volume;              // V_ref [m^3]
  AlignedVector<Mat> incremental_deformation_gradient;      // F_inc
  AlignedVector<Mat> kernel_reference_deformation_gradient; // F_ref
  /** Dilatational modulus over the one at rest; empty unless the material
      stiffens. */
  std::vector<double> stiffening;
  AlignedVector<Vec> own_force; // [N], without what couplings added
  /** Volume of the whole particle over that which the model has of it: 2 for
      each plane of symmetry that it lies on; empty of bodies whose particles
      have no images (MirrorPlanes). */
  std::vector<double> copies;
  /** Stable step of each particle, the least of the evaluations since the last
      step; empty unless mass scaling asks for it [s]. */
  std::vector<double> own_step;

  /** Undeformed particles with these volumes [m^3]. [n_owned]; F_inc = F_ref
      = 1, V_ref = V_0, no stiffening. Kernels come later, by
      LagrangianKernel::start(). */
  void allocate(const std::vector<double> &volume, const bool stiffens);
  /** Room for @p n_owned particles, more than there are; ghosts are dropped.
      New ones are undeformed, without volume. */
  void extend(const std::size_t n_owned);
  /** copies of the owned ones of @p nodes. */
  void note_planes(const MirrorPlanes &mirror, const NodalState &nodes);
  /** Room for ghosts: @p n_local particles, owned ones included. New entries
      of stress are zero, of kernels and positions at the last update the
      caller's to fill. */
  void resize(const std::size_t n_local);

  /** Total F of an owned particle. */
  Mat deformation_gradient(const std::size_t i) const
  {
    return incremental_deformation_gradient[i] *
           kernel_reference_deformation_gradient[i];
  }

  /** Owned and ghost entries, as kernels of ghosts are those of the last
      update. */
  void visit_state(StateVisitor &visitor, const StateItems &items);
  void list_memory(MemoryTable &table) const
  {
    table.add("positions of the kernel update", kernel_reference_position);
    table.add("kernels", kernel);
    table.add("generalized stress", generalized_stress);
    table.add("volumes of the start", reference_volume);
    table.add("volumes of the kernel update", kernel_reference_volume);
    table.add("F since the kernel update", incremental_deformation_gradient);
    table.add("F at the kernel update", kernel_reference_deformation_gradient);
    table.add("stiffening", stiffening);
    table.add("own forces", own_force);
    table.add("own steps", own_step);
    table.add("shares on planes of symmetry", copies);
  }

private:
  bool stiffens = false;
};
} // namespace sabot

#endif
