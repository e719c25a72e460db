#ifndef sabot_couplings_shared_work_h
#define sabot_couplings_shared_work_h

#include "sabot/base/exact_sum.h"
#include "sabot/base/state_visitor.h"
#include "sabot/couplings/contact_points.h"

#include <mpi.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * The work that the springs between two bodies have taken, and which of them
 * hold it. Where curved surfaces slide on each other, nodes come in at one end
 * of the contact without any work along the normal, and others leave at its
 * other end with what they took: only the sum over the contact comes back. So
 * each spring that has more than U = k d^2/2 of its own leaves the rest E to
 * the pair of bodies, out of which those that have less are filled up; and what
 * is left after that makes all springs of the pair stiffer, by
 *
 *     1 + E/sum U,   at most a factor of 2,
 *
 * until they have given it back. The sum of all is the work that the contact
 * took, so that it neither gives more than that nor keeps any. What damping
 * took, or could not be given back while it was there, goes to springs that
 * lack it when nothing else does, but never makes any stiffer: what slides
 * past faces that close in is held, and a contact as a whole gives no energy.
 * Places of round surfaces (PressingPlace) without friction share the force,
 * too: where the work does not suffice for all, each gets the same part of its
 * force, all together what each by itself would get and no more than the work
 * of all bears. Nodes that come in have taken none yet, so their springs would
 * stand back at one end of the contact, and the rest would turn what slides.
 * Between flat surfaces nothing is shared, for there each spring has k d^2/2 to
 * round-off.
 */
class SharedWork
{
public:
  /** @p pairs: of bodies that the contact holds apart, in any order and
      number. */
  SharedWork(const std::vector<std::pair<int, int>> &pairs,
             MPI_Comm communicator);
  /** ContactPoint::pair of two bodies. */
  int number_of(const int a, const int b) const;
  /** Make the springs of @p points stiffer by what is left. Before all forces,
      so that friction knows what presses. */
  void stiffen(std::vector<ContactPoint> &points) const;
  /** Set ContactPoint::part of @p points, each with a memory, by what their
      work bears (backed_part()), and share. After stiffen(). @p dt: the step
     just made [s]. Collective; sums are exact, over the points whose node is
     owned. */
  void back(std::vector<ContactPoint> &points, const double dt);
  /** E [J] of pair @p number. */
  double left(const int number) const { return pots[number].left; }
  void visit_state(StateVisitor &visitor);

private:
  struct Pot
  {
    double left = 0.; // E [J]
    double lost = 0.; // by damping and otherwise; negative: it gave more [J]
    double stiffer = 1.;
    double n_places = 0.; // that pressed in the last step
    /** What was given beyond what was taken, negative [J]. */
    double owed() const { return std::min(0., left + lost); }

    /** What the springs hold in all, lack and leave, and what was damped in a
        step [J]. @return the part of what they lack that they get. */
    double share(const double held, const double lacking, const double surplus,
                 const double damped);
  };
  struct Sums
  {
    ExactSum held, lacking, surplus; // U, U - stored, stored - U [J]
    ExactSum damped, places;
  };
  /** What a point's spring asks for and gets. */
  struct Asked
  {
    AskingSpring spring;
    SpringClaim claim;
    bool is_new;
    double part;
  };
  /** Each by its own books. */
  void ask(std::vector<ContactPoint> &points, const double dt);
  /** The places of a pair get equal parts, where there were any in the last
      step: nobody else waits for a message. Collective. */
  void share_between_places(const std::vector<ContactPoint> &points);
  /** Those that lack work from those that have more. Collective. */
  void fill(std::vector<ContactPoint> &points, std::vector<Sums> &sums);

  std::vector<std::pair<int, int>> pairs; // ascending
  MPI_Comm communicator;
  std::vector<Pot> pots;    // parallel to pairs
  std::vector<Asked> asked; // parallel to the points of the step
};
} // namespace sabot

#endif
