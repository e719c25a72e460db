#ifndef sabot_couplings_tie_conflicts_h
#define sabot_couplings_tie_conflicts_h

#include "sabot/couplings/tie.h"

#include <string>
#include <vector>

namespace sabot
{
/** Nodes of a tie that something else moves as well: another tie, or a
    prescribed velocity. The tie's own members, by reference; constraints are
    the same on every rank. */
struct TieConflicts
{
  const std::string &name;
  const std::vector<Body *> &bodies;
  const int follower, leader;
  MPI_Comm communicator;
  TiedNodes &others;

  /** Takes out the nodes that another tie moves, and notes the others as this
      one's. @return what was taken out, for a warning; or empty. Collective. */
  std::string leave_to_others(std::vector<TieConstraint> &constraints) const;
  /** InputError for nodes that follow in one tie and lead in another one.
      Collective. */
  void refuse_chains(const std::vector<TieConstraint> &constraints) const;
  /** InputError for followers with prescribed velocities that their leaders do
      not have. Collective. */
  void refuse_held(const std::vector<TieConstraint> &constraints) const;

private:
  /** "(1, 2, 3) mm" of a node at the start. Collective. */
  std::string place_of(const int body, const GlobalIndex node) const;
};
} // namespace sabot

#endif
