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
 * @p points and @p weights are the same on every rank; so is the result.
 * Collective.
 */
std::vector<int> partition(const std::vector<std::array<double, 3>> &points,
                           const std::vector<float> &weights,
                           MPI_Comm communicator);
} // namespace sabot

#endif
