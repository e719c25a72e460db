#ifndef sabot_bodies_spg_failure_bond_failure_h
#define sabot_bodies_spg_failure_bond_failure_h

#include "sabot/base/memory_table.h"
#include "sabot/base/state_visitor.h"
#include "sabot/base/types.h"
#include "sabot/bodies/spg/failure/failure_criterion.h"

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace sabot
{
class BondList;
class ParticleExchange;
class MaterialPoints;
class ParticleConduction;
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
  ~BondFailure();
  /**
   * From now on the measure m of the criterion is averaged over a length,
   *
   *   m_bar - l^2 div grad m_bar = m,
   *
   * insulated at surfaces and failed bonds (implicit gradient, Peerlings et al.
   * 1996): @p averaging is a step of conduction of one second with the
   * conductivity l^2 [m^2] and volumes as capacity. Where m is nowhere above
   * the critical value m_bar is not, either, and nothing is solved.
   */
  void average_by(std::unique_ptr<ParticleConduction> averaging);

  /** For @p n_owned particles under @p rule. */
  void allocate(const std::size_t n_owned, const ResidualStrength &rule);
  /** Room for more owned particles, sound ones; ghosts are dropped. */
  void extend(const std::size_t n_owned, const ResidualStrength &rule);
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
            const ParticleExchange &exchange, MPI_Comm communicator);
  /** Count the bonds that the last find() marked, and whose metal has crumbled
      by that. Collective. Each end counts its own, so a bond counts twice in
      the sum of n_failed. They stay in the list until remove(), or until rows
      come that leave them out, and then forget_marks(). */
  void count(const NodalState &nodes, const BondList &bonds,
             const ParticleExchange &exchange);
  /** Remove them from the list; arrays over bonds must then be carried over.
      Collective. @return whether the list has changed, the same on all ranks.
   */
  bool remove(BondList &bonds);
  /** The same for arrays that follow by BondList::carry_rows(). */
  bool remove_from_rows(BondList &bonds);
  /** Owned particles of which a bond is marked, ascending. */
  const std::vector<std::uint32_t> &marked_rows() const { return with_marks; }
  /** Per bond of the list, whether it is one of them. */
  const std::vector<char> &marks() const { return is_marked; }
  /** Whether this bond of the list is one of them. */
  bool has_failed_now(const std::size_t bond) const
  {
    return !is_marked.empty() && is_marked[bond];
  }
  void forget_marks()
  {
    is_marked.clear();
    with_marks.clear();
  }
  /** There are other ghosts; n_local with them. Collective where particles may
      crumble. */
  void renew_ghosts(const ParticleExchange &exchange,
                    const std::size_t n_local);

  /** Whether one of an owned particle's bonds failed while its own measure
      exceeded the critical value (ParticleDamage). */
  bool has_crumbled(const std::size_t i) const { return crumbled[i]; }
  /** Whether an owned particle is beside a crack, or crumbled. */
  bool has_cracks(const std::size_t i) const
  {
    return n_failed[i] > 0 || crumbled[i];
  }
  /** Whether a bond of the list holds, i owned, j its neighbor; without are
      those of crumbled metal that stays a continuum. */
  bool is_cohesive(const std::size_t i, const std::uint32_t j) const
  {
    return !(joins_crumbled && crumbled[i] && crumbled[j]);
  }
  /** Whether the rule keeps crumbled metal a continuum. */
  bool keeps_crumbled() const { return joins_crumbled; }
  /** Whether there are bonds between crumbled particles, which have to be found
      anew. Collective, the same on all ranks. */
  bool renews_crumbled(MPI_Comm communicator) const;
  /** How often which bonds hold may have changed so far without the list of
      bonds: metal crumbles. The same on all ranks. */
  std::size_t n_changes() const { return changes; }
  /** Bonds of an owned particle that hold. */
  std::size_t n_holding(const BondList &bonds, const std::size_t i) const;
  /** Failed bonds of an owned particle over these and those that hold; 0 for a
      particle that never had any. */
  double failed_fraction(const BondList &bonds, const std::size_t i) const;

  /** Ask @p rule which particles have failed, into is_failed. @p
      lost_direction [n_owned] as of the last kernel update. Local. */
  void judge(const std::vector<char> &lost_direction,
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

  void visit_state(StateVisitor &visitor, const StateItems &items);
  void list_memory(MemoryTable &table) const
  {
    table.add_rows("failure: failed pairs", failed_pairs);
    table.add("failure: failed bonds", n_failed);
    table.add("failure: energy let go", loss);
    table.add("failure: failed particles", is_failed);
    table.add("failure: heat of friction", friction_work);
    table.add("failure: measure", measure);
    table.add("failure: marked bonds", is_marked);
    table.add("failure: marked rows", with_marks);
    table.add("failure: crumbling", crumbles);
    table.add("failure: crumbled", crumbled);
  }

private:
  void visit_failed_pairs(StateVisitor &visitor, const StateItems &items);

  const std::shared_ptr<const FailureCriterion> criterion;
  const double critical_stretch;
  const unsigned int interval; // steps between looks
  const bool remembers_pairs;
  std::vector<double> measure;           // owned and ghosts
  std::vector<char> is_marked;           // per bond, by the last find()
  std::vector<std::uint32_t> with_marks; // particles, by the last find()
  /** m, or m_bar, of the owned particles into measure. Collective. @return
      false where no bond can fail by it. */
  bool find_measure(const BondList &bonds, const ParticleFields &fields,
                    const MaterialPoints &points, MPI_Comm communicator);

  std::unique_ptr<ParticleConduction> averaging; // only with a length
  bool joins_crumbled = false;
  std::size_t changes = 0;
  std::vector<char> crumbles; // owned, by the last find()
  std::vector<char> crumbled; // owned and ghosts, see has_crumbled()
};
} // namespace sabot

#endif
