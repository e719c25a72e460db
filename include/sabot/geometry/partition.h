#ifndef sabot_geometry_partition_h
#define sabot_geometry_partition_h

#include <mpi.h>

#include <array>
#include <vector>

namespace sabot
{
/** The points that a rank hands to the partition: a stretch of those of all
    bodies one after the other. None on one rank, where there is no choice. */
struct PointShare
{
  /** @p n: points of all bodies. */
  PointShare(const std::size_t n, MPI_Comm communicator);
  /** Those of a body that are in this rank's stretch.
      @param first   number of its first point among those of all bodies
      @param some    all points of the body, reference positions [m]
      @param weight  relative cost of each */
  void add(const std::size_t first,
           const std::vector<std::array<double, 3>> &some, const float weight);

  std::size_t begin, end;
  std::vector<std::array<double, 3>> points; // from begin on
  std::vector<float> weights;                // parallel to points
};

/**
 * Owner rank of every point by recursive coordinate bisection (Zoltan RCB),
 * all bodies together, so that both sides of a tie live near each other.
 * Cuts are across the coordinate axes, so parts are boxes and a moved body does
 * not need a new partition.
 * @param share  this rank's of the points
 * @param n      points of all bodies
 * @return rank of each point, the same on every rank; zeros on one rank
 * Collective. Throws std::runtime_error where Zoltan fails.
 */
std::vector<int> partition(PointShare share, const std::size_t n,
                           MPI_Comm communicator);
} // namespace sabot

#endif
