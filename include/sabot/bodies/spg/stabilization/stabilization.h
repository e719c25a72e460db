#ifndef sabot_bodies_spg_stabilization_stabilization_h
#define sabot_bodies_spg_stabilization_stabilization_h

#include "sabot/base/memory_table.h"
#include "sabot/base/state_visitor.h"
#include "sabot/base/types.h"
#include "sabot/kernels/vec.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sabot
{
class BondList;
class Parameters;
struct CrackedParticles;
struct SpgParts;

/**
 * What keeps the sawtooth modes of direct nodal integration under control. A
 * form is one file: its parameters, what it keeps per bond and particle, its
 * part of the energy, of the checkpoint, of the bound of the stable step and of
 * the linearized body, and, at the bottom, the SPG step instantiated with the
 * form itself (spg_step.h), so that the choice is made once per step and the
 * loop stays fused.
 *
 * All functions act on the whole body, on all ranks alike; those that exchange
 * ghosts say "collective".
 *
 * Requirements on a form: it vanishes for linear fields and for rigid motions,
 * keeps both momenta exact, and its work is counted by work(), so that the
 * ledger closes (doc/theory/spg.md).
 */
class Stabilization
{
public:
  static constexpr const char *kind = "stabilization";
  /** Makes the form of one body; parameters are read before there is one. */
  using Maker = std::function<std::unique_ptr<Stabilization>()>;
  using Make = Maker(const Parameters &, const std::string &path);

  virtual ~Stabilization() = default;

  /** Whether it needs stored shape gradients and second_derivatives(). */
  virtual bool needs_second_derivatives() const { return false; }
  /** Where the approximation puts A grad grad Psi_J of each bond, by columns
      over BondList::n_with_ghosts() [1/m]; null where the form needs none. */
  virtual AlignedVector<Mat> *second_derivatives() { return nullptr; }

  /** Once, before anything else, for the owned particles. Sets work() to
      zero, [n_owned]; forms that override it call it. */
  virtual void allocate(const SpgParts &body);
  /** Room for more owned particles, without memory. */
  virtual void extend(const std::size_t n_owned) { done.resize(n_owned, 0.); }
  /** The list of bonds has changed: carry over what belongs to those that
      stayed. */
  virtual void carry_bonds(const BondList &) {}
  /** There are other ghosts; their positions are up to date. */
  virtual void renew_ghosts(const SpgParts &) {}

  /** Restored owned entries are there, those of images are not. Collective. */
  virtual void renew_images(const SpgParts &) {}

  /** What holds a particle's bonds now, positions as at the last force
      evaluation: forces of owned nodes [N], stress and energies advanced by
      @p dt [s] (0: forces only). Collective. body.nodes.force is
      overwritten. The form yields with the material: its stress enters by
      extra_square and is scaled by the return factor. */
  virtual void compute_forces(SpgParts &body, const double dt) = 0;
  /** What is done to the motion between two steps; @p step: the last one's
      number. Collective. */
  virtual void after_step(SpgParts &, const unsigned int) {}

  /** A kernel update begins; bonds, kernels and functions are the old ones.
      A form that is late with something (a return factor due on residuals)
      settles it here. Local. */
  virtual void begin_kernel_update(const SpgParts &) {}
  /** Bonds, moments and functions are new ones, at the start and after every
      kernel update. Where a form finds the stiffness of a particle, as far
      as it depends on kernel and moment. Local. */
  virtual void follow_functions(const SpgParts &) {}
  /** The end of a kernel update: the reference configuration is the present
      one. @p was_lost: which particles had lost a direction before. */
  virtual void end_kernel_update(const SpgParts &, const std::vector<char> &) {}

  /** The same around the removal of bonds from some rows while kernels stay as
      they are (doc/theory/spg.md, Kernel update): @p some owned particles
      before, then what is kept per bond by BondList::carry_rows(), then
      stiffness and residuals of @p rows. Forms that keep nothing per bond have
      nothing to do. Local. */
  virtual void begin_crack_update(const SpgParts &,
                                  const std::vector<std::uint32_t> &)
  {
  }
  virtual void carry_rows(const BondList &, const std::vector<std::uint32_t> &)
  {
  }
  virtual void end_crack_update(const SpgParts &,
                                const std::vector<std::uint32_t> &)
  {
  }

  /** Forces where cracks have changed something, in place of
      compute_forces(body, no_step) for all; own forces of the particles beside
      them are overwritten. Collective. @return false, and nothing is done,
      where the form evaluates all or nothing. */
  virtual bool renew_forces(SpgParts &, const CrackedParticles &)
  {
    return false;
  }

  /** Energy that an owned particle's bonds hold and would lose with them
      [J], 0 where the form holds none. For the ledger's failure: what is
      held before bonds go, less what is held after. Local. */
  virtual double held_energy(const SpgParts &, const std::size_t) const
  {
    return 0.;
  }
  /** Work done on the form by each owned particle so far [J]. */
  const std::vector<double> &work() const { return done; }

  /** Add the form's part of the row sums of K [N/m]: the Gershgorin bound of
      the stable step; of whole particles, on planes of symmetry, too.
      Collective. */
  virtual void add_row_sums(const SpgParts &, std::vector<double> &) const {}
  /** f = -K v of the body linearized at rest in the configuration of the last
      kernel update, elastic moduli, the form included; @p motion with ghosts.
      Collective. */
  virtual void apply_linearized(const SpgParts &body,
                                const AlignedVector<Vec> &motion,
                                AlignedVector<Vec> &force) = 0;

  /** What belongs to bonds; ghosts' bonds come anew. Collective. */
  virtual void visit_bonds(StateVisitor &, const SpgParts &, const StateRows &)
  {
  }
  virtual void visit_state(StateVisitor &visitor, const StateItems &items);
  /** Arrays kept from step to step; forms that have some of their own call the
      base. Local. */
  virtual void list_memory(MemoryTable &table) const
  {
    table.add("stabilization: work", done);
  }

protected:
  std::vector<double> done; // [J] per owned particle
};
} // namespace sabot

#endif
