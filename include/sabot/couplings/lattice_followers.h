#ifndef sabot_couplings_lattice_followers_h
#define sabot_couplings_lattice_followers_h

#include "sabot/base/exact_sum.h"
#include "sabot/base/ghost_exchange.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/conversion.h"

#include <mpi.h>

#include <unordered_map>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Particles of split cells that lie within edges and faces which other cells
 * still have. They follow the nodes of these, without stiffness,
 *
 *   v_p = sum N_a v_a,  f_a += N_a f_p,  inertia_a = m_a + sum N_a m_p,
 *
 * until the last cell around them turns, and move by themselves from then on.
 * They start with velocities of the next order, exact for fields that are
 * quadratic in X,
 *
 *   v_p = sum N_a (v_a + G_a (X_p - X_a)/2),
 *
 * G_a the mean gradient of the cells around node a: linear ones in between lack
 * kinetic energy of the second order in the length of a cell over the wave's.
 * Of momenta nothing is lost (LatticeSpin).
 * Every follower is on the rank of its lowest node, which has all cells around
 * it; forces and masses go to other ranks' nodes by messages, summed in the
 * order of the particles' numbers.
 */
class LatticeFollowers
{
public:
  struct Parts
  {
    Body &zone, &host;
    CellSource &source;
    ParticleSink &sink;
    MPI_Comm communicator;
  };
  explicit LatticeFollowers(const Parts &parts);

  /** A cell that turns, from the rank of its lowest node. */
  struct Turning
  {
    GlobalIndex cell = 0;
    Vec center = {}; // of its nodes, now [m]
  };
  /** Of this rank's cells @p cells, which are about to turn; of all ranks,
      ascending. Collective. */
  std::vector<Turning> gather(const std::vector<std::size_t> &cells) const;
  /** What a particle lacks that turned cell @p cell made free, of what the
     nodes had for it: P [N s] and L about the origin [N m s]. */
  struct Missing
  {
    GlobalIndex cell = 0, site = 0;
    Vec momentum = {}, moment = {};
  };
  /** Who follows and who moves by itself after @p turned have become the
      particles of @p matter: inertia of nodes, energy and momenta.
      @p shared: owned particles and the nodes that they share. Collective. */
  void settle(const NodalMatter &matter, const std::vector<Turning> &turned,
              const std::vector<std::pair<std::size_t, std::size_t>> &shared);

  /** Collective. */
  void impose_kinematics();
  /** Forces to nodes, and those that were handed on last away again. The first
      is collective. */
  void hand_on();
  void take_back();

  /** Nodes that carry the owned particles @p failing: marked in @p is_failed
      [owned nodes of the host at least]. Collective. */
  void mark(const std::vector<std::size_t> &failing,
            std::vector<char> &is_failed) const;

  /** Kinetic energy that the nodes had beside that of their lattices [J], this
      rank's share. */
  const ExactSum &lost() const { return lost_energy; }
  /** After that of both bodies. Collective. */
  void visit_state(StateVisitor &visitor);

private:
  struct Motion
  {
    std::size_t particle, node;
    double weight;
  };
  struct Term
  {
    std::size_t leader, slot;
    double weight;
  };
  GlobalIndex site_of(const std::size_t i) const;
  /** Followers by what particles are: leaders, terms, exchange. Collective. */
  void rebuild();
  /** Gradients of the velocity by the undeformed place at the nodes of cells,
      means over all cells of the mesh around them [1/s]; turned cells' nodes
      move with their particles. Collective, the same on all ranks. */
  std::unordered_map<GlobalIndex, Mat>
  slopes(const std::vector<Turning> &turned) const;
  /** Sets those free whose last cell went. @return what is missing now. */
  std::vector<Missing>
  release(const NodalMatter &matter,
          const std::unordered_map<GlobalIndex, Mat> &slopes);
  void
  set_inertia(const NodalMatter &matter,
              const std::vector<std::size_t> &old_leaders,
              const std::vector<std::pair<std::size_t, std::size_t>> &shared);

  const Parts body;
  const SplitMesh &lattices;
  std::vector<GlobalIndex> followers; // numbers, of all ranks, ascending
  std::vector<std::size_t> owned;     // those owned here, local, ascending
  std::vector<Motion> motion;         // by follower
  std::vector<std::size_t> leaders;   // owned nodes of the host, ascending
  std::vector<Term> forces;           // by follower
  GhostExchange exchange;             // of owned followers, then others'
  AlignedVector<Vec> force;           // of those [N]
  AlignedVector<Vec> handed;          // to each leader, last [N]
  ExactSum lost_energy;
};
} // namespace sabot

#endif
