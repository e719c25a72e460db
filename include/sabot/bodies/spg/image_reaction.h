#ifndef sabot_bodies_spg_image_reaction_h
#define sabot_bodies_spg_image_reaction_h

#include "sabot/base/memory_table.h"
#include "sabot/base/resultant.h"
#include "sabot/base/state_visitor.h"
#include "sabot/base/types.h"
#include "sabot/kernels/vec.h"

#include <mpi.h>

namespace sabot
{
/**
 * What the images of a body's particles do to it across planes of symmetry. The
 * forces between its own particles add up to nothing, those of bonds to images
 * do along the planes only; so what is left of the sum of all is the force of
 * the other side, and the sum of their impulses its impulse.
 *
 * The impulse stands with each particle and is added up where it is asked for,
 * exactly, as sums over ranks have to be.
 */
class ImageReaction
{
public:
  /** @p axes: across which there are images, a bit each. */
  explicit ImageReaction(const unsigned int axes) : axes(axes) {}

  /** Room for @p n_owned particles, of which new ones have met nothing. */
  void extend(const std::size_t n_owned) { impulse.resize(n_owned, Vec{}); }
  /** The body's own forces of now act for @p duration [s]. Local. */
  void wait(const double duration) { waiting += duration; }
  /** Before own forces change; @p own: those that have acted [N]. Local. */
  void settle(const AlignedVector<Vec> &own);
  /** Momentum that particle @p i got from others and images at once [N s]. */
  void add(const std::size_t i, const Vec momentum) { impulse[i] += momentum; }
  /** On body number @p body, whose own forces are @p own. Collective. */
  Resultant resultant(const int body, const AlignedVector<Vec> &own,
                      MPI_Comm communicator) const;

  void visit_state(StateVisitor &visitor, const StateItems &items)
  {
    visitor.visit_items("impulse with images", impulse, items);
    visitor.visit_value("time of own forces", waiting);
  }
  void list_memory(MemoryTable &table) const
  {
    table.add("impulses of images", impulse);
  }

private:
  const unsigned int axes;
  AlignedVector<Vec> impulse; // of owned particles [N s]
  double waiting = 0.;        // since the last settle() [s]
};
} // namespace sabot

#endif
