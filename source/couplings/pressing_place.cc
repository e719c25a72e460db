// What of a bent surface presses for a node.
#include "sabot/couplings/pressing_place.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
// Normals of ends that differ by less are those of a plane, which may have been
// bent by what presses on it.
constexpr double straight = 0.01;
// Cosine to the other surface's normal of faces that may press.
constexpr double against = -0.5;
// Depth over bulge up to which the surface around presses, and from which on
// the node does.
constexpr double shallow = 2., deep = 4.;
constexpr double gauss_point[4] = {0.069431844202973712, 0.33000947820757187,
                                   0.66999052179242813, 0.93056815579702629};
constexpr double gauss_weight[4] = {0.17392742256872693, 0.32607257743127307,
                                    0.32607257743127307, 0.17392742256872693};

/** Part of an edge, from the node (0) to the next one (1). */
struct Range
{
  double low = 0., high = 1.;
  bool is_empty() const { return !(low < high); }
};

/** The least range outside of which value + slope s - curved s^2/2 is not
    positive; it does not jump where the curvature passes zero. */
Range where_positive(const double value, const double slope,
                     const double curved)
{
  const double end = value + slope - 0.5 * curved,
               square = slope * slope + 2. * curved * value;
  const bool starts = value > 0., ends = end > 0.;
  if (starts && ends)
    return {0., 1.};
  if (!starts && !ends && !(slope > 0. && slope < curved && square > 0.))
    return {0., 0.};
  // Neither root is a difference of like numbers; the one over the curvature
  // goes to infinity where this is round-off, and is then not meant.
  const double sum =
      slope + std::copysign(std::sqrt(std::max(0., square)), slope);
  if (sum == 0.)
    return {0., 1.};
  const double near = std::clamp(-2. * value / sum, 0., 1.),
               far = curved != 0. ? std::clamp(sum / curved, 0., 1.) : 1.;
  if (!starts && !ends)
    return {near, far};
  const double change = (sum < 0.) == starts ? near : far;
  return starts ? Range{0., change} : Range{change, 1.};
}

/** The largest of slope s - curved s^2/2, 0 <= s <= 1. */
double most_along(const double slope, const double curved)
{
  if (slope > 0. && slope < curved)
    return 0.5 * slope * slope / curved;
  return std::max(0., slope - 0.5 * curved);
}

/** What all faces around a node share. */
struct Above
{
  const NodeHalo &halo;
  const SurfaceNormals &normals;
  const NodeAbove &node;
  // Of the other surface at the node's foot.
  Vec n = {}; // round normal
  Mat curvature = Mat::zero();
  double roundness = 0.;

  Vec turning(const Vec way) const { return curvature * way; }
};

/** A face around the node, as a square with the node at (0, 0). */
class BentFace
{
public:
  BentFace(const Above &above, const std::array<std::size_t, 4> &c,
           const std::size_t face)
      : above(above), face(face)
  {
    first = std::find(c.begin(), c.end(), above.node.slot) - c.begin();
    x[0] = Vec{};
    const auto round = [&](const int corner)
    {
      return above.normals.roundness(face, corner) *
             above.normals.round_normal(face, corner);
    };
    const Vec r0 = round(first);
    for (int a = 1; a < 4; ++a)
    {
      const int corner = (first + a) & 3;
      x[a] =
          above.halo.position[c[corner]] - above.halo.position[above.node.slot];
      const double turn = dot(x[a], above.turning(x[a])),
                   bend = dot(x[a], round(corner) - r0);
      curved[a] = bend + turn;
      // Of d(s) = d_a + slope s - curved s^2/2.
      slope[a] = 0.5 * bend - dot(above.n, x[a]);
    }
    area = 0.5 * norm(cross(x[2], x[3] - x[1]));
  }
  /** How far it stands out between the node and the others. */
  double bulge() const
  {
    double most = 0.;
    for (int a = 1; a < 4; ++a)
      most = std::max(most, curved[a] - straight * norm(x[a]));
    return 0.125 * most;
  }
  double size() const { return area; }
  /** The rectangle in which d may be positive. @return false: nowhere. */
  bool find_rectangle()
  {
    const double p = curved[1], q = curved[3], pq = 0.5 * (curved[2] - p - q),
                 determinant = p * q - pq * pq, d = above.node.depth;
    if (is_bent(1) && is_bent(3))
    {
      range[0] = range[1] = Range();
      if (!(determinant > 0.01 * p * q))
        return true; // a twisted face: all of it
      const double xi = (q * slope[1] - pq * slope[3]) / determinant,
                   eta = (p * slope[3] - pq * slope[1]) / determinant,
                   most = d + 0.5 * (slope[1] * xi + slope[3] * eta);
      narrow(0, xi, most * q / determinant);
      narrow(1, eta, most * p / determinant);
    }
    else
    {
      // By the far corner, which need not be x[1] + x[3].
      const double by_corner = slope[2] - 0.5 * curved[2] -
                               (slope[1] - 0.5 * p) - (slope[3] - 0.5 * q),
                   mixed = std::max({0., -pq, by_corner});
      range[0] =
          where_positive(d + most_along(slope[3] + mixed, q), slope[1], p);
      range[1] =
          where_positive(d + most_along(slope[1] + mixed, p), slope[3], q);
    }
    return !range[0].is_empty() && !range[1].is_empty();
  }
  /** Calls @p action(weights of corners, way, part of the face, d > 0, b). */
  template <typename Action>
  void for_points(const Action &action) const
  {
    const double width = range[0].high - range[0].low,
                 height = range[1].high - range[1].low;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
      {
        const double xi = range[0].low + width * gauss_point[i],
                     eta = range[1].low + height * gauss_point[j];
        const double w[4] = {(1. - xi) * (1. - eta), xi * (1. - eta), xi * eta,
                             (1. - xi) * eta};
        std::array<double, 4> weight;
        Vec way = {};
        for (int a = 0; a < 4; ++a)
        {
          weight[(first + a) & 3] = w[a];
          way += w[a] * x[a];
        }
        const double bulge = above.normals.bulge(face, weight),
                     depth = above.node.depth - dot(above.n, way) -
                             0.5 * dot(way, above.turning(way)) + bulge;
        if (depth > 0.)
          action(weight, way,
                 w[0] * gauss_weight[i] * gauss_weight[j] * width * height,
                 depth, bulge);
      }
  }
  std::size_t number() const { return face; }

private:
  /** Whether the bend towards a corner is more than round-off, which the
      ellipse's center would magnify. */
  bool is_bent(const int corner) const
  {
    return curved[corner] > 1e-6 * norm(x[corner]);
  }
  void narrow(const int axis, const double middle, const double two_depth)
  {
    const double half = std::sqrt(2. * std::max(0., two_depth));
    range[axis].low = std::max(range[axis].low, middle - half);
    range[axis].high = std::min(range[axis].high, middle + half);
  }

  const Above &above;
  const std::size_t face;
  int first;            // corner that is the node
  std::array<Vec, 4> x; // from the node, which is the first
  double curved[4] = {0., 0., 0., 0.}, slope[4] = {0., 0., 0., 0.};
  double area;
  Range range[2]; // along the edges to corners 1 and 3
};

/** Sums over the places around a node, by w_a max(0, d) dA. */
struct Pressing
{
  double force = 0., energy = 0.; // over k and k/2
  double bulge = 0.;
  Vec way = {};
  SmoothNormal normal;

  void add(const double part, const double depth, const Vec from_node,
           const double its_bulge)
  {
    bulge += part * depth * its_bulge;
    force += part * depth;
    energy += part * depth * depth;
    way += (part * depth) * from_node;
  }
  void add_normal(const double part_of_force, const SmoothNormal &there)
  {
    normal.direction += part_of_force * there.direction;
    normal.spread += part_of_force * there.spread;
    normal.reach += part_of_force * there.reach;
  }
};

bool find_other(Above &above)
{
  const NodeAbove &node = above.node;
  const double part = 1. / node.feet.size();
  for (const Foot &foot : node.feet)
  {
    above.curvature = above.curvature +
                      part * above.normals.curvature(foot.face, foot.weight);
    for (int a = 0; a < 4; ++a)
    {
      above.n += foot.weight[a] * above.normals.round_normal(foot.face, a);
      above.roundness +=
          part * foot.weight[a] * above.normals.roundness(foot.face, a);
    }
  }
  // The other faces around a foot on a plane of symmetry are images.
  for (const unsigned int axis : above.normals.axes_across(node.slot))
  {
    above.n[axis] = 0.;
    for (unsigned int d = 0; d < 3; ++d)
      if (d != axis)
      {
        above.curvature.set(d, axis, 0.);
        above.curvature.set(axis, d, 0.);
      }
  }
  const double length = norm(above.n);
  if (length > 0.)
    above.n *= 1. / length;
  return length > 0.;
}

/** Adds what a face of the node presses with, of which @p part counts. */
void press_with(BentFace &face, const std::array<std::size_t, 4> &corners,
                const SurfaceNormals &normals, const double part, Pressing &all,
                std::vector<PressingPlace::Share> &shares)
{
  if (!face.find_rectangle())
    return;
  std::array<double, 4> sum{};
  double here = 0.;
  face.for_points(
      [&](const std::array<double, 4> &weight, const Vec way,
          const double part_of_face, const double depth, const double bulge)
      {
        const double here_part = part * part_of_face * face.size();
        all.add(here_part, depth, way, bulge);
        here += here_part * depth;
        for (int a = 0; a < 4; ++a)
          sum[a] += here_part * depth * weight[a];
      });
  if (!(here > 0.))
    return;
  for (int a = 0; a < 4; ++a)
    shares.push_back({corners[a], sum[a]});
  for (double &weight : sum)
    weight *= 1. / here;
  all.add_normal(here, normals.of_face(face.number(), sum));
}
} // namespace

PressingPlace
find_pressing_place(const NodeHalo &halo,
                    const std::vector<std::array<std::size_t, 4>> &corners,
                    const SurfaceNormals &normals, const NodeAbove &node,
                    const double trust)
{
  PressingPlace place;
  place.depth = node.depth;
  place.normal = node.normal;
  Above above{halo, normals, node};
  if (!normals.has_faces(node.slot) || !find_other(above))
    return place;
  std::vector<BentFace> faces;
  std::size_t n_faces;
  const std::size_t *const around = normals.faces_around(node.slot, n_faces);
  double bulge = 0., area = 0.;
  for (std::size_t k = 0; k < n_faces; ++k)
    if (dot(normals.own_normal(around[k]), above.n) < against)
    {
      faces.emplace_back(above, corners[around[k]], around[k]);
      bulge = std::max(bulge, faces.back().bulge());
      area += 0.25 * faces.back().size();
    }
  if (!(bulge > 0.) || !(node.depth < deep * bulge))
    return place;
  // Of crumpled metal, and of facets too coarse for it, nothing is known.
  const double around_part =
      above.roundness * trust *
      std::min(1., (deep - node.depth / bulge) / (deep - shallow));
  if (!(around_part > 0.))
    return place;
  Pressing all;
  for (BentFace &face : faces)
    press_with(face, corners[face.number()], normals, around_part / area, all,
               place.shares);
  if (!(all.force > 0.))
  {
    place.shares.clear();
    return place;
  }
  if (node.depth > 0. && around_part < 1.)
  {
    all.add(1. - around_part, node.depth, Vec{}, 0.);
    all.add_normal((1. - around_part) * node.depth, normals.of_node(node.slot));
    place.shares.push_back({node.slot, (1. - around_part) * node.depth});
  }
  for (PressingPlace::Share &share : place.shares)
    share.weight *= 1. / all.force;
  place.way = (1. / all.force) * all.way;
  place.bulge = all.bulge / all.force;
  place.depth = all.energy / all.force;
  place.fade = all.force / place.depth;
  place.own = all.normal;
  place.own.spread *= 1. / all.force;
  place.own.reach *= 1. / all.force;
  for (const unsigned int axis : normals.axes_across(node.slot))
    place.way[axis] = place.own.direction[axis] = 0.;
  place.own.direction *= 1. / norm(place.own.direction);
  place.normal = above.n + above.turning(place.way);
  place.normal *= 1. / norm(place.normal);
  return place;
}
} // namespace sabot
