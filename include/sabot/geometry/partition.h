#ifndef sabot_geometry_partition_h
#define sabot_geometry_partition_h

#include <mpi.h>

#include <array>
#include <vector>

namespace sabot
{
/**
 * Owner rank of every point by recursive coordinate bisection (Zoltan RCB),
 * all bodies together, so that both sides of a tie live near each other.
 * Cuts are across the coordinate axes, so parts are boxes and a moved body does
 * not need a new partition.
 * @param points   of all bodies one after the other, reference positions [m],
 *                 the same on every rank
 * @param weights  relative cost of each, parallel to points
 * @return rank of each point, the same on every rank; zeros on one rank
 * Collective. Throws std::runtime_error where Zoltan fails.
 */
std::vector<int> partition(const std::vector<std::array<double, 3>> &points,
                           const std::vector<float> &weights,
                           MPI_Comm communicator);
} // namespace sabot

#endif
