// Which face holds a node, and how deep.
#include "sabot/couplings/face_standing.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
constexpr double same_side = 0.5; // least cosine between normals
} // namespace

void FaceStanding::clear()
{
  corners.clear();
  face_of_node.clear();
}

std::ptrdiff_t FaceStanding::closest(const NearFaces &node,
                                     FaceProjection &best,
                                     const Vec *const side) const
{
  const Vec p = halo.position[node.slot];
  const double touching = 1e-6 * node.spacing;
  const auto approach = [&](const std::size_t f, const FaceProjection &to)
  { return -dot(velocity_against(node, f, to), to.face_normal); };
  std::ptrdiff_t closest = -1;
  for (std::size_t k = node.first_face; k < node.last_face; ++k)
  {
    const std::size_t f = face_of_node[k];
    std::array<Vec, 4> x;
    for (int a = 0; a < 4; ++a)
      x[a] = halo.position[corners[f][a]];
    // With a margin, so that faces with the same closest point stay in.
    if (closest >= 0 &&
        is_farther(p, x, 1.001 * std::sqrt(best.distance_square) + touching))
      continue;
    const FaceProjection projection = project_on_face(p, x);
    if (side != nullptr && dot(projection.face_normal, *side) < same_side)
      continue;
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

Vec FaceStanding::velocity_against(const NearFaces &node,
                                   const std::ptrdiff_t face,
                                   const FaceProjection &projection) const
{
  Vec v = halo.velocity[node.slot];
  for (int a = 0; a < 4; ++a)
    v -= projection.weight[a] * halo.velocity[corners[face][a]];
  return v;
}

std::ptrdiff_t FaceStanding::holding(const NearFaces &node,
                                     ContactMemory &memory,
                                     FaceProjection &best,
                                     const double dt) const
{
  // Sideways, in spacings, to which a face reaches beyond its rim: equal
  // cross-sections that meet bulge by unequal fractions of this.
  constexpr double rim = 0.1;
  const std::ptrdiff_t nearest = closest(node, best);
  if (nearest < 0)
    return -1;
  const bool was_inside = memory.depth > 0.,
             has_side = norm_square(memory.side) > 0.;
  const double tolerance = rim * node.spacing;
  if (has_side && (was_inside || best.gap < tolerance) &&
      !(best.gap < 0. && dot(best.face_normal, memory.side) >= same_side))
  {
    FaceProjection held;
    const std::ptrdiff_t f = closest(node, held, &memory.side);
    if (f >= 0 && held.along < 0.)
    {
      const double sideways = std::sqrt(
          std::max(0., held.distance_square - held.along * held.along));
      // The most that the node may have moved against the face in the step.
      const double motion = 2. * norm(velocity_against(node, f, held)) * dt;
      if (sideways < tolerance && (was_inside || -held.along <= motion))
      {
        best = held;
        // Let go gradually past the rim.
        best.gap = held.along * (1. - sideways / tolerance);
        best.normal = held.face_normal;
        memory.side = held.face_normal;
        return f;
      }
    }
  }
  memory.side = best.face_normal;
  return best.gap < 0. ? nearest : -1;
}
} // namespace sabot
