#ifndef sabot_couplings_tie_h
#define sabot_couplings_tie_h

#include "sabot/couplings/coupling.h"
#include "sabot/couplings/node_halo.h"

#include <map>
#include <memory>
#include <string>
#include <utility>

namespace sabot
{
/** A follower and its leaders, by global numbers of their bodies; sum of the
    weights 1. Sent between ranks as it is in memory. */
struct TieConstraint
{
  GlobalIndex follower;
  double mass; // of the follower [kg]
  std::array<GlobalIndex, 8> leader;
  std::array<double, 8> weight; // zero where a leader takes no part
  /** On the face, to fall back on. */
  std::array<GlobalIndex, 4> face;
  std::array<double, 4> face_weight;
};

/** The nodes that the ties of a scene hold already, by body and global number,
    and by which tie; the same on every rank. */
struct TiedNodes
{
  using Node = std::pair<int, GlobalIndex>;
  std::map<Node, std::string> followers, leaders;
};

/**
 * Follower nodes move as weighted sums of leader nodes: v_f = sum w_a v_a,
 * f_a += w_a f_f, m_a += w_a m_f (doc/theory-coupling.md). Every node of the
 * follower body that lies on a boundary face of the leader body is tied, with
 * the face's bilinear shape functions as weights (one leader of weight one on
 * conforming meshes). A node that stands off the face, of a curved interface,
 * takes the trilinear functions of the cell behind, continued to where it is:
 * sum w_a = 1 and sum w_a x_a = x_f, so that linear fields are exact, and the
 * leaders' forces have the moment of the follower's.
 */
class Tie : public Coupling
{
public:
  /** @p bodies: all of the scene; @p follower, @p leader: numbers among them;
      the leader's surface has faces. @p tolerance: distance from a face, in
      follower spacings, up to which a node counts as lying on it. @p others:
      what other ties hold, of which each takes note; may be null. */
  Tie(const std::string &name, const std::vector<Body *> &bodies,
      const int follower, const int leader, const double tolerance,
      MPI_Comm communicator, const std::shared_ptr<TiedNodes> &others = {});

  std::string kind() const override { return "tie"; }
  std::vector<int> joins() const override;
  /** Finds followers and weights. A node that another tie holds already is
      left to it; InputError where no node is tied, where one follows here and
      leads there, and where the velocity of a follower is prescribed and that
      of its leaders is not the same. */
  void initialize() override;
  std::vector<std::string> warnings() const override;
  void impose_kinematics() override;
  void add_forces(const double dt) override;
  void forward_changes() override;
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  void visit_state(StateVisitor &visitor) override;
  std::size_t n_items() const override { return owned_followers.size(); }
  Measures measure() const override;
  /** On the follower what moves it as it does beside its own forces: the change
      of its momentum less the impulse of f_f; on the leader the opposite. As a
      force, m_f a_f - f_f. */
  std::vector<Resultant> resultants() const override;
  StableStep stable_step() const override;

private:
  using Constraint = TieConstraint;
  /** One term of a sum: a slot of the halo and its weight. */
  struct Term
  {
    std::size_t local; // the owned node that the sum is for
    std::size_t slot;
    double weight;
  };
  /** Of all nodes of the follower on the leader's surface, in the reference
      configuration; by follower, the same on every rank. Collective. */
  std::vector<Constraint> find_constraints() const;
  static void use_face(Constraint &constraint);
  /** Puts all followers on the faces where leaders would lose too much mass.
      @return factor of the stable step. Collective. */
  double keep_mass(std::vector<Constraint> &constraints) const;
  /** The least part of its mass that any leader keeps, and what negative
      weights take off the square of the stable step. Collective. */
  std::pair<double, double>
  judge(const std::vector<Constraint> &constraints) const;

  /** Leaders take over, w_a of it each, what mass scaling has added to
      followers since the last time. PhysicsError, on all ranks, where a
      negative weight would make one lighter. Collective. */
  void hand_on_added_mass();
  /** Leaders of the followers that are owned here. Collective. */
  void prepare_motion(const std::vector<Constraint> &constraints);
  /** Followers of the leaders that are owned here. Collective. */
  void prepare_forces(const std::vector<Constraint> &constraints);

  const std::vector<Body *> bodies;
  const int follower, leader;
  const double tolerance;
  MPI_Comm communicator;
  const std::shared_ptr<TiedNodes> others;
  std::size_t n_constraints = 0;
  std::string left_out;     // a warning, where nodes are
  double step_factor = 1.;  // below 1 where weights are negative
  NodeHalo leaders;         // of the followers owned here
  std::vector<Term> motion; // owned followers from leaders
  GhostExchange force_exchange;
  std::vector<std::size_t> owned_followers;  // local, ascending
  AlignedVector<Vec> follower_force;         // owned, then others'
  std::vector<GlobalIndex> remote_followers; // global numbers of those
  std::vector<Term> forces;                  // owned leaders from followers
  ExactSum work; // of the tie, on owned followers and leaders [J]
  // Of owned followers.
  AlignedVector<Vec> impulse;        // of their own forces so far [N s]
  AlignedVector<Vec> start_velocity; // [m/s]
  AlignedVector<Vec> mid_velocity;   // in the middle of the last step [m/s]
  double last_step = 0.;             // [s], 0: none yet
  /** Of owned followers, what mass scaling gave them and leaders have [kg]. */
  std::vector<double> handed_on;
  bool scales_masses = false; // of the follower body
  ExactSum added_energy;      // that it had at the leaders [J]
};
} // namespace sabot

#endif
