// Which face holds a node, how deep, and along which normal.
#include "sabot/couplings/face_standing.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
constexpr double same_side = 0.5; // least cosine between normals
// Sideways, in spacings, to which a face reaches beyond its rim: equal
// cross-sections that meet bulge by unequal fractions of this.
constexpr double rim = 0.1;
// By how much, in spacings, a place is less deep below the faces that are there
// than below the surface continued from the node's foot: up to where the latter
// is believed, and from where on it is not.
constexpr double alike = 0.05, unlike = 0.15;

/** The common normal with a node's own, which has no faces to tell how sure it
    is if @p is_particle: it counts like those of the faces, but they decide
    where they are planes (to 1e-3), and it where they are rough (0.05). */
Vec common_normal_of(const SmoothNormal &its, SmoothNormal own,
                     const bool is_particle)
{
  if (is_particle)
    own.spread += std::clamp(its.spread, 1e-6, 0.0025);
  return common_normal(its, own);
}

class MeanNormal
{
public:
  void add(const SmoothNormal &normal)
  {
    sum.direction += normal.direction;
    sum.spread += normal.spread;
    sum.reach += normal.reach;
    ++n;
  }
  SmoothNormal value() const
  {
    return {(1. / norm(sum.direction)) * sum.direction, sum.spread / n,
            sum.reach / n};
  }

private:
  SmoothNormal sum;
  int n = 0;
};

bool is_particle(const NearFaces &node)
{
  return norm_square(node.own.direction) > 0.;
}

Vec normal_of(const std::array<Vec, 4> &x)
{
  const Vec area = cross(x[2] - x[0], x[3] - x[1]);
  const double size = norm(area);
  return size > 0. ? (1. / size) * area : Vec{};
}
} // namespace

void FaceStanding::clear()
{
  corners.clear();
  face_of_node.clear();
  shapes.clear();
  version_of_shape.clear();
}

std::array<Vec, 4> FaceStanding::places(const std::size_t face) const
{
  std::array<Vec, 4> x;
  for (int a = 0; a < 4; ++a)
    x[a] = halo.position[corners[face][a]];
  return x;
}

void FaceStanding::build_normals(
    const std::vector<std::vector<SymmetryPlane>> &planes,
    const double nearness, const std::vector<double> &reach)
{
  normals.build(planes, nearness, reach);
  shapes.resize(corners.size());
  version_of_shape.assign(corners.size(), 0); // no halo has it
}

void FaceStanding::find_shape(const std::size_t face) const
{
  const std::array<Vec, 4> x = places(face);
  const FaceBall ball(x);
  shapes[face] = {ball.center, normal_of(x)};
  shapes[face].ball[3] = ball.radius;
  version_of_shape[face] = halo.version();
}

void FaceStanding::keep_within(const NearFaces &node, const double reach) const
{
  kept.clear();
  kept_for = node.slot;
  kept_reach = reach;
  const Vec p = halo.position[node.slot];
  for (const std::uint32_t f : faces_of(node))
    if (!is_farther(f, p, reach))
      kept.push_back(f);
}

std::ptrdiff_t FaceStanding::nearest_center(const NearFaces &node,
                                            const Side *const side) const
{
  const Vec p = halo.position[node.slot];
  std::ptrdiff_t nearest = -1;
  double least = 0.;
  for (const std::size_t f : faces_of(node))
  {
    const Shape &face = shape(f);
    const double square = norm_square(p - face.ball);
    if ((nearest < 0 || square < least) && looks(face, side))
    {
      nearest = f;
      least = square;
    }
  }
  return nearest;
}

std::ptrdiff_t FaceStanding::closest(const NearFaces &node,
                                     const std::ptrdiff_t first,
                                     FaceProjection &best,
                                     const Side *const side) const
{
  const Vec p = halo.position[node.slot];
  const double touching = 1e-6 * node.spacing;
  const auto approach = [&](const std::size_t f, const FaceProjection &to)
  { return -dot(velocity_against(node, f, to), to.face_normal); };
  if (first < 0)
    return -1;
  const FaceProjection on_first = project_on_face(p, places(first));
  // With a margin, so that faces with the same closest point stay in.
  const double bound = 1.001 * std::sqrt(on_first.distance_square) + touching;
  std::ptrdiff_t closest = -1;
  for (const std::size_t f : faces_of(node))
  {
    if (is_farther(f, p, bound) || !looks(shape(f), side))
      continue;
    const FaceProjection projection =
        f == std::size_t(first) ? on_first : project_on_face(p, places(f));
    const bool is_tie =
        std::abs(projection.distance_square - best.distance_square) <=
        1e-10 * best.distance_square;
    const bool touches_both =
        closest >= 0 && std::max(projection.distance_square,
                                 best.distance_square) < touching * touching;
    if (closest < 0 ||
        (touches_both ? approach(f, projection) > approach(closest, best)
         : is_tie     ? projection.facing > best.facing
                      : projection.distance_square < best.distance_square))
    {
      best = projection;
      closest = f;
    }
  }
  return closest;
}

SmoothNormal FaceStanding::normal_of_closest(const NearFaces &node,
                                             const Side &side,
                                             const FaceProjection &best) const
{
  // A node above a corner of several faces takes the mean of all of them, or
  // its choice would break the symmetry of what meets.
  const Vec p = halo.position[node.slot];
  const double distance =
      std::sqrt(best.distance_square) * (1. + 1e-6) + 1e-9 * node.spacing;
  MeanNormal mean;
  for (const std::size_t f : faces_within(node, distance))
  {
    if (is_farther(f, p, distance) ||
        dot(shape(f).normal, side.direction) < side.least_cosine)
      continue;
    const FaceProjection projection = project_on_face(p, places(f));
    if (projection.distance_square <= distance * distance)
      mean.add(normals.of_face(f, projection.weight));
  }
  return mean.value();
}

std::ptrdiff_t FaceStanding::hit(const NearFaces &node, const Vec p,
                                 const Vec n, const Side &side,
                                 const double reach, FaceHit &found,
                                 SmoothNormal &normal) const
{
  const double tie = 1e-9 * node.spacing,
               from_node = norm(p - halo.position[node.slot]);
  MeanNormal mean;
  feet.clear();
  for (const std::size_t f : faces_within(node, reach + from_node))
  {
    FaceHit here;
    if (is_farther(f, p, reach) ||
        dot(shape(f).normal, side.direction) < side.least_cosine ||
        !hit_face(p, n, places(f), here) ||
        std::abs(here.ahead) > std::abs(found.ahead) + tie)
      continue;
    if (std::abs(here.ahead) < std::abs(found.ahead) - tie)
    {
      mean = MeanNormal();
      feet.clear();
      found = here;
    }
    mean.add(normals.of_face(f, here.weight));
    feet.push_back({f, here.weight});
  }
  if (feet.empty())
    return -1;
  normal = mean.value();
  return feet.front().face;
}

std::ptrdiff_t FaceStanding::stand(const NearFaces &node,
                                   const SmoothNormal &own, const Side &side,
                                   const std::ptrdiff_t face,
                                   FaceProjection &projection) const
{
  // The line along the node's own normal, or that of the closest point, leads
  // to the place with whose normal the line is drawn once more: a step of the
  // fixed point p - x = gap n(x), whose error falls by depth over radius of
  // curvature.
  const double reach =
      2. * std::sqrt(projection.distance_square) + 1e-3 * node.spacing;
  SmoothNormal its = {-1. * own.direction, own.spread, own.reach};
  if (norm_square(own.direction) == 0. || !is_smooth(own))
    its = normal_of_closest(node, side, projection);
  std::ptrdiff_t at = face;
  for (int repeat = 0; repeat < 2; ++repeat)
  {
    const Vec n = common_normal_of(its, own, is_particle(node));
    FaceHit found;
    const std::ptrdiff_t f =
        hit(node, halo.position[node.slot], n, side, reach, found, its);
    if (f < 0)
      return repeat == 0 ? -1 : at;
    at = f;
    feet_of_node = feet;
    projection.gap = projection.along = -found.ahead - bulge_below_feet(node);
    projection.normal = projection.face_normal = n;
    projection.weight = found.weight;
    projection.distance_square = found.ahead * found.ahead;
  }
  return at;
}

Vec FaceStanding::velocity_against(const NearFaces &node,
                                   const std::ptrdiff_t face,
                                   const FaceProjection &projection) const
{
  Vec v = halo.velocity[node.slot];
  for (int a = 0; a < 4; ++a)
    v -= projection.weight[a] * halo.velocity[corners[face][a]];
  return v;
}

double FaceStanding::bulge_below(const NearFaces &node, const std::size_t face,
                                 const std::array<double, 4> &weight) const
{
  if (!normals.has_faces(node.slot))
    return 0.;
  const double part = may_be_round(normals.of_node(node.slot).spread);
  return part > 0. ? part * normals.bulge(face, weight) : 0.;
}

double FaceStanding::bulge_below_feet(const NearFaces &node) const
{
  double sum = 0.;
  for (const Foot &foot : feet)
    sum += bulge_below(node, foot.face, foot.weight);
  return sum / feet.size();
}

PressingPlace FaceStanding::find_place(const NearFaces &node, const Side &side,
                                       std::ptrdiff_t &face,
                                       FaceProjection &standing) const
{
  const NodeAbove above = {node.slot, -standing.gap, standing.normal,
                           feet_of_node};
  const Foot first = {std::size_t(face), standing.weight};
  PressingPlace place = find_pressing_place(halo, corners, normals, above);
  if (place.shares.empty())
    return place;
  // Where the place stands, along the normal of both surfaces there.
  const Vec p = halo.position[node.slot] + place.way;
  SmoothNormal its = normals.of_face(face, standing.weight);
  its.direction = place.normal;
  double depth = -1e300; // beyond the edge of the other surface
  for (int repeat = 0; repeat < 2; ++repeat)
  {
    place.normal = common_normal(its, place.own);
    FaceHit found;
    const std::ptrdiff_t below =
        hit(node, p, place.normal, side,
            std::abs(place.depth) + 0.5 * node.spacing, found, its);
    if (below < 0)
      break;
    face = below;
    standing.weight = found.weight;
    depth = found.ahead + bulge_below_feet(node) + place.bulge;
  }
  // The other surface was continued from below the node: on crumpled metal and
  // beyond rims it is not where that leads.
  const double missing = (place.depth - depth) / node.spacing,
               trust =
                   std::clamp((unlike - missing) / (unlike - alike), 0., 1.);
  if (trust < 1.)
  {
    const Vec normal = place.normal;
    place = find_pressing_place(halo, corners, normals, above, trust);
    if (place.shares.empty())
    {
      face = first.face;
      standing.weight = first.weight;
      return place;
    }
    place.normal = normal;
  }
  place.seen = std::min(place.depth, depth);
  standing.normal = standing.face_normal = place.normal;
  return place;
}

std::ptrdiff_t
FaceStanding::try_hold(const NearFaces &node, const SmoothNormal &own,
                       const Side &side, const Closest &of_all,
                       const bool may_be_deep, FaceProjection &projection,
                       PressingPlace &place, const double dt) const
{
  // The closest of all is closest of its side.
  FaceProjection held;
  std::ptrdiff_t nearest = of_all.face;
  if (looks(shape(of_all.face), &side))
    held = of_all.projection;
  else
    nearest = closest(node, nearest_center(node, &side), held, &side);
  if (nearest < 0)
    return -1;
  std::ptrdiff_t f = stand(node, own, side, nearest, held);
  if (f < 0)
  {
    // Let go gradually past the rim; what is as far beside as half its depth
    // is still below.
    const double tolerance = rim * node.spacing,
                 sideways =
                     std::sqrt(std::max(0., held.distance_square -
                                                held.along * held.along)) -
                     0.5 * std::abs(held.along);
    if (sideways >= tolerance)
      return -1;
    f = nearest;
    held.gap = held.along -= bulge_below(node, f, held.weight);
    held.normal = common_normal_of(normal_of_closest(node, side, held), own,
                                   is_particle(node));
    held.face_normal = held.normal;
    place = PressingPlace();
    place.depth = -held.gap;
    place.normal = held.normal;
    // All of the force fades, damping and friction included: what is let go
    // has the full speed of approach.
    place.fade = 1. - std::max(0., sideways) / tolerance;
    place.seen = place.acting_depth();
  }
  else
    place = find_place(node, side, f, held);
  if (!(place.depth > 0.))
    return -1;
  // The most that the node may have moved against the face in the step.
  if (!may_be_deep &&
      -held.along >
          2. * std::abs(dot(velocity_against(node, f, held), held.normal)) * dt)
    return -1;
  projection = held;
  return f;
}

std::ptrdiff_t FaceStanding::holding(NearFaces &node, ContactMemory &memory,
                                     FaceProjection &projection,
                                     PressingPlace &place, double &nearest,
                                     const double dt) const
{
  Closest of_all{-1, {}};
  FaceProjection &any = of_all.projection;
  // A close face leaves few others to be looked at.
  of_all.face = closest(node,
                        node.last_closest >= 0 ? node.last_closest
                                               : nearest_center(node, nullptr),
                        any, nullptr);
  node.last_closest = of_all.face;
  nearest = std::sqrt(any.distance_square);
  if (of_all.face < 0)
    return -1;
  const double distance = nearest;
  // How far round surfaces may stand out on both sides.
  const double margin = normals.has_faces(node.slot) ? most_bulge : 0.;
  nearest = std::max(0., nearest - margin * node.spacing);
  double gap = any.gap;
  if (gap < margin * node.spacing)
    gap -= bulge_below(node, of_all.face, any.weight);
  const bool was_inside = memory.depth > 0.,
             is_inside = gap<0., has_side = norm_square(memory.side)> 0.;
  std::ptrdiff_t f = -1;
  if (was_inside || gap < std::max(rim, margin) * node.spacing)
  {
    keep_within(node, 3. * distance + 0.1 * node.spacing);
    SmoothNormal own = normals.of_node(node.slot);
    if (norm_square(own.direction) == 0.)
      own = node.own;
    const bool has_own = norm_square(own.direction) > 0.;
    if (has_side && (was_inside || !has_own))
      f = try_hold(node, own, {memory.side, same_side}, of_all,
                   was_inside || (is_inside && dot(any.face_normal,
                                                   memory.side) >= same_side),
                   projection, place, dt);
    if (f < 0 && has_own)
      f = try_hold(node, own,
                   {-1. * own.direction, least_cosine_of_met_faces(own)},
                   of_all, is_inside, projection, place, dt);
    else if (f < 0 && is_inside)
      f = try_hold(node, own, {any.face_normal, same_side}, of_all, true,
                   projection, place, dt);
    kept_for = -1;
  }
  memory.side = f >= 0 ? projection.face_normal : any.face_normal;
  return f;
}
} // namespace sabot
