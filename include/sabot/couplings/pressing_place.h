#ifndef sabot_couplings_pressing_place_h
#define sabot_couplings_pressing_place_h

#include "sabot/couplings/surface_normals.h"

#include <vector>

namespace sabot
{
/** By which a bent surface stands out from nodes and facets at most, over the
    spacing: with a radius of less than two spacings on either side. */
constexpr double most_bulge = 0.2;

/** With what a node presses: itself, or what is around it on a bent surface. */
struct PressingPlace
{
  /** Part of a node of the own body in what presses. */
  struct Share
  {
    std::size_t slot;
    double weight;
  };
  double depth = 0.; // that gives force and energy of the spring [m]
  /** Below the faces that are there [m]; of a node by itself more than any. */
  double seen = 1e300;
  double fade = 1.; // part of the spring that acts
  /** Sum 1; none: the node is the place. */
  std::vector<Share> shares;
  Vec way = {};      // from the node to the place [m]
  double bulge = 0.; // of the own surface above its facets there [m]
  SmoothNormal own;  // of the own surface at the place
  Vec normal = {};   // of what is pressed on, there, unit

  /** Of all of the spring [m]. */
  double acting_depth() const { return fade * depth; }
};

/** A place on a face. */
struct Foot
{
  std::size_t face;
  std::array<double, 4> weight; // of its corners
};

/** A node above another surface. */
struct NodeAbove
{
  std::size_t slot;
  double depth; // of the node itself [m]; may be negative
  Vec normal;   // common, outward of the other surface
  /** Of the other surface, below the node: one place, on all faces that share
      it, for each of them takes the surface there as round in its own way. */
  const std::vector<Foot> &feet;
};

/**
 * What a node of a bent surface presses with, or one above a bent surface. It
 * stands for the surface around it, each place of it with the part w_a (xi,
 * eta) that the node has there, so
 *
 *     force = k int w_a max(0, d) dA/int w_a dA,
 *
 * which has an energy, and which for all nodes together depends on how deep the
 * surfaces are in each other only, not on where facets and nodes are: what
 * rolls on bends and facets presses as the round body does. With the other
 * surface's normal n and curvature K the depth at the way t is
 *
 *     d = d_a - n . t - t . K t/2 + b(w),
 *
 * b being the bulge above the own face. 4 x 4 Gauss points in each face around
 * the node lie in the rectangle around the ellipse where d > 0 by the second
 * order at the node. A node that is deeper than four times what the faces
 * around it bulge, as on planes, presses with itself; from half of that on it
 * goes over. @p trust: part of what is around the node that counts at most.
 */
PressingPlace
find_pressing_place(const NodeHalo &halo,
                    const std::vector<std::array<std::size_t, 4>> &corners,
                    const SurfaceNormals &normals, const NodeAbove &node,
                    const double trust = 1.);
} // namespace sabot

#endif
