// How good hexahedra are.
#include "sabot/geometry/cell_shape.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
// The neighbors of each corner, right-handed, in VTK order.
constexpr int next[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                            {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
constexpr double place[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},
                                {-1, 1, -1},  {-1, -1, 1}, {1, -1, 1},
                                {1, 1, 1},    {-1, 1, 1}};

/** det dx/dxi at @p xi. */
double jacobian(const CellCorners &x, const double (&xi)[3])
{
  Mat gradient = Mat::zero();
  for (int a = 0; a < 8; ++a)
  {
    const double *const c = place[a];
    const double f0 = 1. + xi[0] * c[0], f1 = 1. + xi[1] * c[1],
                 f2 = 1. + xi[2] * c[2];
    add_outer(gradient, x[a],
              0.125 * vec(c[0] * f1 * f2, f0 * c[1] * f2, f0 * f1 * c[2]));
  }
  return determinant(gradient);
}
} // namespace

Vec middle(const CellCorners &x)
{
  Vec sum = {};
  for (const Vec &corner : x)
    sum += 0.125 * corner;
  return sum;
}

double middle_jacobian(const CellCorners &x)
{
  return jacobian(x, {0., 0., 0.});
}

double least_inner_jacobian(const CellCorners &x)
{
  double least = middle_jacobian(x);
  const double g = 1. / std::sqrt(3.);
  for (const auto &c : place)
    least = std::min(least, jacobian(x, {g * c[0], g * c[1], g * c[2]}));
  return least;
}

double shortest_edge(const CellCorners &x)
{
  double shortest = norm(x[1] - x[0]);
  for (int a = 0; a < 8; ++a)
    for (const int b : next[a])
      shortest = std::min(shortest, norm(x[b] - x[a]));
  return shortest;
}

double longest_edge(const CellCorners &x)
{
  double longest = 0.;
  for (int a = 0; a < 8; ++a)
    for (const int b : next[a])
      longest = std::max(longest, norm(x[b] - x[a]));
  return longest;
}

CornerShape worst_corner(const CellCorners &x)
{
  CornerShape worst;
  for (int a = 0; a < 8; ++a)
  {
    Vec edge[3];
    double product = 1.;
    for (int d = 0; d < 3; ++d)
    {
      edge[d] = x[next[a][d]] - x[a];
      product *= norm(edge[d]);
    }
    const double scaled =
        product > 0. ? dot(edge[0], cross(edge[1], edge[2])) / product : 0.;
    if (scaled < worst.scaled_jacobian)
    {
      worst.scaled_jacobian = scaled;
      worst.number = a;
    }
  }
  return worst;
}
} // namespace sabot
