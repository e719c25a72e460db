#ifndef sabot_bodies_spg_failure_bond_failure_h
#define sabot_bodies_spg_failure_bond_failure_h

#include "sabot/base/state_visitor.h"
#include "sabot/base/types.h"
#include "sabot/bodies/spg/failure/failure_criterion.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace sabot
{
class BondList;
class GhostExchange;
class MaterialPoints;
class ResidualStrength;
struct NodalState;
struct ParticleFields;
struct SpgOptions;

/**
 * Bonds that fail: found by find(), removed and counted once by remove(), and
 * what their particles lose with them. The criterion is evaluated once per
 * look.
 *
 * Wu & Wu 2018, Eqs. 19 to 21: (m_N + m_J)/2 > m_crit and |dx| > s_crit |dX at
 * the start|, s_crit >= 1. Symmetric in the two ends, so both ranks of a bond
 * come to the same verdict.
 */
class BondFailure
{
public:
  /** Copies what it needs of the options; pairs are remembered only under
      the policy that searches all pairs. */
  explicit BondFailure(const SpgOptions &options);

  /** For @p n_owned particles under @p rule. */
  void allocate(const std::size_t n_owned, const ResidualStrength &rule);
  /** Every few steps: a regular kernel update looks as well. Failure is a
      property of the material, not of the search for neighbors: it has its
      own interval, shorter than that of kernel updates. */
  bool is_due(const unsigned int step) const { return step % interval == 0; }

  /** Mark the bonds whose criterion is met now: its mean over both ends
      above the critical value, and the distance above the critical stretch
      times that of the start. Equal at both ends. Collective. @return
      whether there are any on this rank. Positions of ghosts must be up to
      date. Nothing is changed but the marks; exits at once where the
      criterion can never be met. */
  bool find(const NodalState &nodes, const BondList &bonds,
            const ParticleFields &fields, const MaterialPoints &points,
            const GhostExchange &exchange);
  /** Remove the bonds that the last find() marked and count them; arrays
      over bonds must then be carried over. Collective. @return whether the
      list has changed, the same on all ranks. Each end counts its own, so a
      bond counts twice in the sum of n_failed. */
  bool remove(const NodalState &nodes, BondList &bonds);

  /** Failed bonds of an owned particle over all it ever had.
      n_failed/(n_failed + bonds left); 0 for a particle that never had any. */
  double failed_fraction(const BondList &bonds, const std::size_t i) const;

  /** Ask @p rule which particles have failed, into is_failed. @p
      lost_direction [n_owned] as of the last kernel update. Local. */
  void judge(const BondList &bonds, const std::vector<char> &lost_direction,
             const ResidualStrength &rule);

  /** As a neighbor search needs them, empty where there is none: the global
      numbers of those to which an owned particle's bonds failed. */
  std::vector<std::vector<GlobalIndex>> failed_pairs;
  std::vector<std::uint32_t> n_failed; // bonds per owned particle
  /** What failed bonds and cracks let go per owned particle, part of internal
      and stabilization energy [J]. */
  std::vector<double> loss;

  /** Owned particles that bear only what the rule for failed metal leaves. */
  std::vector<char> is_failed;
  /** Heat of the friction between pieces of failed metal per owned particle,
      part of internal and stabilization energy [J]; empty under rules that
      have none. */
  std::vector<double> friction_work;

  void visit_state(StateVisitor &visitor);

private:
  const std::shared_ptr<const FailureCriterion> criterion;
  const double critical_stretch;
  const unsigned int interval; // steps between looks
  const bool remembers_pairs;
  std::vector<double> measure; // owned and ghosts
  std::vector<char> is_marked; // per bond, by the last find()
  std::vector<char> exceeded;  // see ParticleDamage::exceeded_limit
};
} // namespace sabot

#endif
