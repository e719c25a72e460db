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
struct NodalState;
struct ParticleFields;
struct SpgOptions;

/**
 * Bonds that fail: found by find(), removed and counted once by remove(), and
 * what their particles lose with them. The criterion is evaluated once per
 * look.
 */
class BondFailure
{
public:
  explicit BondFailure(const SpgOptions &options);

  void allocate(const std::size_t n_owned);
  bool is_due(const unsigned int step) const { return step % interval == 0; }

  /** Mark the bonds whose criterion is met now: its mean over both ends above
      the critical value, and the distance above the critical stretch times
      that of the start. Equal at both ends. Collective.
      @return whether there are any on this rank. */
  bool find(const NodalState &nodes, const BondList &bonds,
            const ParticleFields &fields, const MaterialPoints &points,
            const GhostExchange &exchange);
  /** Remove the bonds that the last find() marked and count them; arrays over
      bonds must then be carried over. Collective.
      @return whether the list has changed, the same on all ranks. */
  bool remove(const NodalState &nodes, BondList &bonds);

  /** Failed bonds of an owned particle over all it ever had. */
  double failed_fraction(const BondList &bonds, const std::size_t i) const;

  /** As a neighbor search needs them, empty where there is none: the global
      numbers of those to which an owned particle's bonds failed. */
  std::vector<std::vector<GlobalIndex>> failed_pairs;
  std::vector<std::uint32_t> n_failed; // bonds per owned particle
  /** What failed bonds and cracks let go per owned particle, part of internal
      and stabilization energy [J]. */
  std::vector<double> loss;

  void visit_state(StateVisitor &visitor);

private:
  const std::shared_ptr<const FailureCriterion> criterion;
  const double critical_stretch;
  const unsigned int interval; // steps between looks
  const bool remembers_pairs;
  std::vector<double> measure; // owned and ghosts
  std::vector<char> is_marked; // per bond, by the last find()
};
} // namespace sabot

#endif
