#ifndef sabot_couplings_tie_h
#define sabot_couplings_tie_h

#include "sabot/couplings/coupling.h"
#include "sabot/couplings/node_halo.h"

namespace sabot
{
/**
 * Follower nodes move as weighted sums of leader nodes: v_f = sum w_a v_a,
 * f_a += w_a f_f, m_a += w_a m_f (doc/theory-coupling.md). Every node of the
 * follower body that lies on a boundary face of the leader body is tied, with
 * the face's bilinear shape functions as weights: exact for linear fields on
 * conforming (one leader of weight one) and non-conforming meshes.
 */
class Tie : public Coupling
{
public:
  /** @p tolerance: distance from a face, in follower spacings, up to which a
      node counts as lying on it. */
  Tie(const std::string &name, const std::vector<Body *> &bodies,
      const int follower, const int leader, const double tolerance,
      MPI_Comm communicator);

  std::string kind() const override { return "tie"; }
  void initialize() override;
  void impose_kinematics() override;
  void add_forces(const double dt) override;
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  void visit_state(StateVisitor &visitor) override;
  Measures measure() const override;

private:
  struct Constraint
  {
    GlobalIndex follower;
    std::array<GlobalIndex, 4> leader;
    std::array<double, 4> weight; // zero where a leader takes no part
  };
  /** One term of a sum: a slot of the halo and its weight. */
  struct Term
  {
    std::size_t local; // the owned node that the sum is for
    std::size_t slot;
    double weight;
  };
  std::vector<Constraint> find_constraints() const;

  const std::vector<Body *> bodies;
  const int follower, leader;
  const double tolerance;
  MPI_Comm communicator;
  std::size_t n_constraints = 0;
  NodeHalo leaders;         // of the followers owned here
  std::vector<Term> motion; // owned followers from leaders
  GhostExchange force_exchange;
  std::vector<std::size_t> owned_followers; // local, ascending
  AlignedVector<Vec> follower_force;        // owned, then others'
  std::vector<Term> forces;                 // owned leaders from followers
  ExactSum work; // of the tie, on owned followers and leaders [J]
};
} // namespace sabot

#endif
