// Whether two shapes overlap, touch, or meet when one flies along a line.
#include "sabot/geometry/outline.h"

#include "sabot/kernels/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sabot
{
namespace
{
constexpr double far = std::numeric_limits<double>::max();

/** Cosine between normal and direction of a face that is seen from its edge. */
constexpr double edge_on = 1e-6;

/** Where a line through a point meets a face. */
struct Crossing
{
  double way;   // from the point along the direction [m]
  double slope; // of the outward normal along the direction, -1 to 1
};

/**
 * The faces of an outline as a light along a direction sees them: in buckets
 * across it, so that a line finds those that it may meet.
 */
class Shadow
{
public:
  /** @p margin: widens the faces where near() asks [m]. */
  Shadow(const Outline &outline, const Vec direction, const bool with_cut,
         const double margin)
      : outline(outline), along(direction), margin(margin)
  {
    int least = 0;
    for (int d = 1; d < 3; ++d)
      if (std::abs(along[d]) < std::abs(along[least]))
        least = d;
    Vec helper = {};
    helper[least] = 1.;
    right = cross(along, helper);
    right *= 1. / norm(right);
    up = cross(along, right);
    for (std::size_t f = 0; f < outline.faces.size(); ++f)
      if (with_cut || !outline.is_cut[f])
        boxes.push_back(box_of(f));
    lay_out();
  }

  /** Calls @p see(crossing) wherever the line through @p x meets a face. */
  template <typename See>
  void cross_faces(const Vec x, const See &see) const
  {
    const double s = dot(x, right), t = dot(x, up);
    for (const std::uint32_t b : candidates(s, t))
    {
      const auto &face = outline.faces[boxes[b].face];
      for (int half = 0; half < 2; ++half)
        cross_triangle(x, s, t, outline.points[face[0]],
                       outline.points[face[1 + half]],
                       outline.points[face[2 + half]], see);
    }
  }

  /** Whether a face is within the margin of @p x on its way of @p longest, as
      far as boxes tell. */
  bool is_near(const Vec x, const double longest) const
  {
    const double s = dot(x, right), t = dot(x, up), depth = dot(x, along);
    for (const std::uint32_t b : candidates(s, t))
    {
      const Box &box = boxes[b];
      if (s >= box.low[0] && s <= box.high[0] && t >= box.low[1] &&
          t <= box.high[1] && depth + longest >= box.low[2] &&
          depth <= box.high[2])
        return true;
    }
    return false;
  }

private:
  struct Box
  {
    std::size_t face;
    double low[3], high[3]; // right, up, along; margin included
  };

  Box box_of(const std::size_t f) const
  {
    Box box = {f, {far, far, far}, {-far, -far, -far}};
    const Vec axes[3] = {right, up, along};
    for (const std::size_t a : outline.faces[f])
      for (int d = 0; d < 3; ++d)
      {
        const double at = dot(outline.points[a], axes[d]);
        box.low[d] = std::min(box.low[d], at - margin);
        box.high[d] = std::max(box.high[d], at + margin);
      }
    return box;
  }

  /** About as many buckets as faces. */
  void lay_out()
  {
    double high[2] = {-far, -far};
    origin[0] = origin[1] = far;
    for (const Box &box : boxes)
      for (int d = 0; d < 2; ++d)
      {
        origin[d] = std::min(origin[d], box.low[d]);
        high[d] = std::max(high[d], box.high[d]);
      }
    n = std::max<std::size_t>(1, std::sqrt(double(boxes.size())));
    buckets.resize(n * n);
    for (int d = 0; d < 2; ++d)
    {
      const double size = boxes.empty() ? 0. : (high[d] - origin[d]) / n;
      per_length[d] = size > 0. ? 1. / size : 0.;
    }
    for (std::uint32_t b = 0; b < boxes.size(); ++b)
      for (std::size_t i = column(0, boxes[b].low[0]);
           i <= column(0, boxes[b].high[0]); ++i)
        for (std::size_t j = column(1, boxes[b].low[1]);
             j <= column(1, boxes[b].high[1]); ++j)
          buckets[n * i + j].push_back(b);
  }

  std::size_t column(const int d, const double at) const
  {
    const double place = (at - origin[d]) * per_length[d];
    return std::clamp(place, 0., double(n - 1));
  }

  const std::vector<std::uint32_t> &candidates(const double s,
                                               const double t) const
  {
    return buckets[n * column(0, s) + column(1, t)];
  }

  template <typename See>
  void cross_triangle(const Vec x, const double s, const double t, const Vec a,
                      const Vec b, const Vec c, const See &see) const
  {
    const double as = dot(a, right) - s, at = dot(a, up) - t,
                 bs = dot(b, right) - s, bt = dot(b, up) - t,
                 cs = dot(c, right) - s, ct = dot(c, up) - t;
    const double of_a = bs * ct - bt * cs, of_b = cs * at - ct * as,
                 of_c = as * bt - at * bs, sum = of_a + of_b + of_c;
    const bool is_inside = (of_a >= 0. && of_b >= 0. && of_c >= 0.) ||
                           (of_a <= 0. && of_b <= 0. && of_c <= 0.);
    const Vec area = cross(b - a, c - a);
    const double slope = dot(area, along) / norm(area);
    // Seen from the side it is a line: neighbors tell.
    if (!is_inside || !(std::abs(slope) > edge_on))
      return;
    const Vec point = (of_a / sum) * a + (of_b / sum) * b + (of_c / sum) * c;
    see(Crossing{dot(point - x, along), slope});
  }

  const Outline &outline;
  const Vec along;
  Vec right, up;
  const double margin;
  std::vector<Box> boxes;
  std::size_t n;
  double origin[2], per_length[2];
  std::vector<std::vector<std::uint32_t>> buckets;
};

/** Calls @p see(x) for the middles of the faces that can be touched and look
    along @p direction, by a cosine above @p least, and for places next to their
    corners: not on an edge that another body may share without meeting it. */
template <typename See>
void look_from_faces(const Outline &outline, const Vec direction,
                     const double least, const See &see)
{
  constexpr double inwards = 1e-3;
  for (std::size_t f = 0; f < outline.faces.size(); ++f)
  {
    Vec x[4], middle = {};
    for (int a = 0; a < 4; ++a)
    {
      x[a] = outline.points[outline.faces[f][a]];
      middle += 0.25 * x[a];
    }
    const Vec area = cross(x[2] - x[0], x[3] - x[1]);
    if (outline.is_cut[f] || !(dot(area, direction) > least * norm(area)))
      continue;
    for (const Vec corner : x)
      see((1. - inwards) * corner + inwards * middle);
    see(middle);
  }
}

double distance_to_skin(const Outline &outline, const Vec x)
{
  double least = far;
  for (const auto &face : outline.faces)
    for (int half = 0; half < 2; ++half)
    {
      const Vec a = outline.points[face[0]], b = outline.points[face[1 + half]],
                c = outline.points[face[2 + half]];
      const auto w = closest_on_triangle(x, a, b, c);
      least = std::min(least, norm(x - w[0] * a - w[1] * b - w[2] * c));
    }
  return least;
}

bool is_between(const Vec x, const Vec low, const Vec high)
{
  for (int d = 0; d < 3; ++d)
    if (!(x[d] > low[d] && x[d] < high[d]))
      return false;
  return true;
}

/** Points of @p one inside of the skin of @p other. */
std::vector<Vec> points_inside(const Outline &one, const Outline &other)
{
  std::vector<Vec> candidates;
  for (const Vec x : one.points)
    if (is_between(x, other.low, other.high))
      candidates.push_back(x);
  std::vector<int> votes(candidates.size(), 0);
  // Along no axis, plane or diagonal of a mesh.
  const Vec directions[3] = {vec(0.5734, 0.6419, 0.5092),
                             vec(-0.3471, 0.7215, 0.5991),
                             vec(0.8128, -0.2347, 0.5332)};
  for (const Vec direction : directions)
  {
    if (candidates.empty())
      break;
    const Shadow shadow(other, (1. / norm(direction)) * direction, true, 0.);
    for (std::size_t i = 0; i < candidates.size(); ++i)
    {
      int n_ahead = 0;
      shadow.cross_faces(candidates[i], [&](const Crossing &crossing)
                         { n_ahead += crossing.way > 0.; });
      votes[i] += n_ahead % 2;
    }
  }
  std::vector<Vec> inside;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (votes[i] >= 2)
      inside.push_back(candidates[i]);
  return inside;
}

void deepen(const Outline &one, const Outline &other, Overlap &overlap)
{
  const std::vector<Vec> inside = points_inside(one, other);
  // Some thousand points say how deep, if not to the last digit.
  constexpr double most = 2e8;
  const std::size_t stride = std::max<std::size_t>(
      1, double(inside.size()) * other.faces.size() / most);
  for (std::size_t i = 0; i < inside.size(); i += stride)
  {
    const double depth = distance_to_skin(other, inside[i]);
    if (depth > overlap.depth)
      overlap = {depth, inside[i]};
  }
}

/** The way of the points of @p one along @p direction into @p other. */
double way_of(const Outline &one, const Outline &other, const Vec direction,
              const double slack)
{
  const Shadow shadow(other, direction, false, 0.);
  double least = far;
  look_from_faces(one, direction, edge_on,
                  [&](const Vec x)
                  {
                    shadow.cross_faces(
                        x,
                        [&](const Crossing &crossing)
                        {
                          if (crossing.slope < 0. && crossing.way >= -slack)
                            least = std::min(least, crossing.way);
                        });
                  });
  return least;
}

/** Whether boxes around both meet on the way. */
bool bounds_meet(const Outline &a, const Outline &b, const Vec direction,
                 const double longest, const double margin)
{
  double from = 0., to = longest;
  for (int d = 0; d < 3; ++d)
  {
    const double room_low = b.low[d] - a.high[d] - margin,
                 room_high = b.high[d] - a.low[d] + margin;
    if (std::abs(direction[d]) < 1e-12)
    {
      if (room_low > 0. || room_high < 0.)
        return false;
      continue;
    }
    const double one = room_low / direction[d],
                 other = room_high / direction[d];
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  }
  return from <= to;
}

bool face_touches(const Outline &one, const Outline &other,
                  const double tolerance)
{
  const Vec axes[3] = {vec(1., 0., 0.), vec(0., 1., 0.), vec(0., 0., 1.)};
  std::vector<Shadow> shadows;
  for (const Vec axis : axes)
    shadows.emplace_back(other, axis, false, 0.);
  const Vec room = vec(tolerance, tolerance, tolerance);
  bool found = false;
  for (std::size_t f = 0; f < one.faces.size() && !found; ++f)
  {
    const auto &x = one.points;
    const auto &face = one.faces[f];
    const Vec middle =
        0.25 * (x[face[0]] + x[face[1]] + x[face[2]] + x[face[3]]);
    if (one.is_cut[f] ||
        !is_between(middle, other.low - room, other.high + room))
      continue;
    const Vec area = cross(x[face[2]] - x[face[0]], x[face[3]] - x[face[1]]);
    int axis = 0;
    for (int d = 1; d < 3; ++d)
      if (std::abs(area[d]) > std::abs(area[axis]))
        axis = d;
    const double slope = area[axis] / norm(area);
    shadows[axis].cross_faces(
        middle,
        [&](const Crossing &crossing)
        {
          found = found || (crossing.slope * slope < 0. &&
                            std::abs(crossing.way * slope) < tolerance);
        });
  }
  return found;
}
} // namespace

Overlap deepest_overlap(const Outline &a, const Outline &b)
{
  Overlap overlap;
  if (a.faces.empty() || b.faces.empty() ||
      !bounds_meet(a, b, vec(1., 0., 0.), 0., 0.))
    return overlap;
  deepen(a, b, overlap);
  deepen(b, a, overlap);
  return overlap;
}

std::optional<double> way_to_meeting(const Outline &a, const Outline &b,
                                     const Vec direction, const double longest)
{
  if (a.faces.empty() || b.faces.empty())
    return std::nullopt;
  const double slack = 1e-3 * std::min(a.spacing(), b.spacing());
  if (!bounds_meet(a, b, direction, longest, slack))
    return std::nullopt;
  const double way =
      std::min(way_of(a, b, direction, slack), way_of(b, a, -direction, slack));
  return way <= longest ? std::optional<double>(std::max(0., way))
                        : std::nullopt;
}

bool may_come_near(const Outline &a, const Outline &b, const Vec direction,
                   const double longest, const double margin)
{
  if (a.faces.empty() || b.faces.empty())
    return true;
  if (!bounds_meet(a, b, direction, longest, margin))
    return false;
  bool near = false;
  const Shadow of_b(b, direction, false, margin),
      of_a(a, -direction, false, margin);
  constexpr double any = -2.;
  look_from_faces(a, direction, any,
                  [&](const Vec x)
                  { near = near || of_b.is_near(x, longest); });
  look_from_faces(b, direction, any,
                  [&](const Vec x)
                  { near = near || of_a.is_near(x, longest); });
  return near;
}

bool touch(const Outline &a, const Outline &b, const double tolerance)
{
  if (!bounds_meet(a, b, vec(1., 0., 0.), 0., tolerance))
    return false;
  return face_touches(a, b, tolerance) || face_touches(b, a, tolerance);
}
} // namespace sabot
