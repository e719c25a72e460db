#ifndef sabot_geometry_item_count_h
#define sabot_geometry_item_count_h

#include <array>
#include <stdexcept>
#include <string>

namespace sabot
{
// Cells and particles are counted before they are made: a length without its
// unit asks for more than there is memory. Counts are doubles, as they may be
// larger than any integer.

/** Thrown by what makes meshes and lattices, before it allocates; whoever knows
    the entry that says the size makes an InputError of it. */
class TooManyItems : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/** Intervals of about @p spacing in @p length, as n_intervals(). */
double count_of_intervals(const double length, const double spacing);

/** Intervals that growing_sizes() would make of these, at most two more. */
double count_of_growing(const double length, const double fine,
                        const double coarsest, const double growth);

/** What a body is divided into, and the memory that each takes while a scene is
    set up: 1.2 kB for a cell, 3 kB for a particle (measured on boxes of 2e5 to
    5e5 cells, of 3e4 to 7e4 particles with the standard support). */
enum class Item
{
  cell,
  particle
};

/** Throws TooManyItems where @p n of them take more than memory_limit(); says
   on the error stream of rank 0 that they are made where they are more than
   3e5.
    @param how  how they come about, for the message: "5000 x 5000 x 5000" */
void check_memory_for(const double n, const Item item, const std::string &how);

/** The same for a block of these numbers along the axes. */
void check_memory_for(const std::array<double, 3> &n, const Item item);
} // namespace sabot

#endif
