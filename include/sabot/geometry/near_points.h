#ifndef sabot_geometry_near_points_h
#define sabot_geometry_near_points_h

#include <array>
#include <vector>

namespace sabot
{
/** For every point the first one within @p distance of it that has none before
    it itself; the point itself where there is none. Linear in time unless very
    many are near each other. */
std::vector<std::size_t>
first_near(const std::vector<std::array<double, 3>> &points,
           const double distance);
} // namespace sabot

#endif
