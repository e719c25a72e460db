#ifndef sabot_couplings_surface_normals_h
#define sabot_couplings_surface_normals_h

#include "sabot/couplings/mirror_images.h"
#include "sabot/couplings/node_halo.h"

#include <array>
#include <vector>

namespace sabot
{
/** The normal of a surface of faces at a place. */
struct SmoothNormal
{
  Vec direction = {}; // unit, outward; zero: there is none
  /** How far the faces around differ from it: with their area vectors A_i,
      2 (1 - |sum A_i|/sum |A_i|), the mean of the squares of their angles to
      it. 0 on a plane, 0.59 on an edge and 0.85 on a corner of a box. */
  double spread = 0.;
  /** Of a plane: how far it goes on, in spacings; 0: not known. */
  double reach = 0.;
};

/** Whether a node's own normal has a say in the common one. */
bool is_smooth(const SmoothNormal &own);

/** How far a surface of facets with this spread may be a round one, 0 to 1: as
    far as an own normal counts. */
double may_be_round(const double spread);

/**
 * The direction along which two surfaces press on each other, as the outward
 * normal of @p its: the mean of the two normals, each with the inverse of its
 * spread, for that is how far it may be off. So a plane decides before what is
 * bent, a fine mesh before a coarse one, and two equal ones share. Of two
 * planes at an angle one meets the other with an edge, and the one that goes on
 * further, which has no edge there, decides: alone from a spacing more on. From
 * where
 * faces differ by 25 degrees an own normal fades, and an edge has none.
 */
Vec common_normal(const SmoothNormal &its, const SmoothNormal &own);

/**
 * Least cosine between a face's normal and the opposite of a node's own normal
 * for which the face may meet the node: within 40 degrees of the directions in
 * which the node is the foremost of its body, which is the own normal on a
 * smooth surface and the cone of the faces around it, cos = 1 - spread/2 wide,
 * on edges and corners. (A node in the middle of a plane meets no face that
 * stands on the plane, however near.)
 */
double least_cosine_of_met_faces(const SmoothNormal &own);

/**
 * Normals of surfaces of quadrilaterals that do not jump from face to face:
 * means over the faces around a node, by area, carried on along each face by
 * the weights of its corners. Faces that differ by more than 32 to 46 degrees
 * have less to none in common, so that edges stay sharp. Planes of symmetry are
 * mirrors. In the current configuration; local to a rank, the same on all that
 * have the faces, as sums run in the order of the faces.
 */
class SurfaceNormals
{
public:
  using Corners = std::vector<std::array<std::size_t, 4>>;

  /** Both must outlive this object. @p corners: slots of each face, outward
      by the right-hand rule; complete around all nodes that are asked for. */
  SurfaceNormals(const NodeHalo &halo, const Corners &corners)
      : halo(halo), corners(corners)
  {
  }
  /** For the present faces and slots. @p planes: of symmetry, by body;
      @p nearness: within which a node lies on one [m]; @p reach: of the planes
      around each slot, in spacings; empty: not known. */
  void build(const std::vector<std::vector<SymmetryPlane>> &planes,
             const double nearness, const std::vector<double> &reach);
  /** Of a node among all of its faces. */
  SmoothNormal of_node(const std::size_t slot) const;
  /** Of face number @p face at the place with these weights of its corners. */
  SmoothNormal of_face(const std::size_t face,
                       const std::array<double, 4> &weight) const;
  /**
   * How far the round surface through the corners stands out, along their
   * normals, from the face at the place x = sum w_a x_a,
   *
   *     1/2 sum p_a w_a (x_a - x) . r_a,
   *
   * r_a being round normals, p_a the roundness(). Exact for paraboloids, up to
   * the fourth power of the angles for spheres and cylinders; negative where
   * the surface is hollow, nothing on planes and at edges [m].
   */
  double bulge(const std::size_t face,
               const std::array<double, 4> &weight) const;
  /** Curvature K of the round surface at the place with these weights of the
      corners, symmetric, in its tangent plane; the normal turns by K t along t
      [1/m]. At corners the least squares of e . K e = -2 e . r_a over the
      edges and diagonals e from there; positive where it is bulged. */
  Mat curvature(const std::size_t face,
                const std::array<double, 4> &weight) const;
  /** r_a of a corner: the normal of the sphere through it and those around it,
      exactly so for triangles (Max 1999); of the face itself at edges. */
  Vec round_normal(const std::size_t face, const int corner) const
  {
    return round(face).corner[corner].normal;
  }
  /** How far the surface there is taken for a round one, from 0 to 1: where the
      facets around differ by up to 20 degrees or so, but not crumpled metal. */
  double roundness(const std::size_t face, const int corner) const
  {
    return round(face).corner[corner].part;
  }
  /** Axes of the planes of symmetry on which a node lies. */
  std::vector<unsigned int> axes_across(const std::size_t slot) const;
  /** Of the face itself; zero where it has no area. */
  Vec own_normal(const std::size_t face) const { return at_corners(face).face; }
  /** Whether a node has faces of its own: particles have none. */
  bool has_faces(const std::size_t slot) const
  {
    return first_of_slot[slot + 1] > first_of_slot[slot];
  }
  /** Faces around a node, indices of corners: from first to last - 1. */
  const std::size_t *faces_around(const std::size_t slot, std::size_t &n) const
  {
    n = first_of_slot[slot + 1] - first_of_slot[slot];
    return face_of_slot.data() + first_of_slot[slot];
  }

private:
  /** What all places on a face share, found once after the halo has moved. */
  struct AtCorners
  {
    std::uint64_t version = 0; // of the halo
    Vec face = {};             // its own normal; zero: it has no area
    std::array<SmoothNormal, 4> normal;
  };
  const AtCorners &at_corners(const std::size_t face) const;
  /** The round surface at a corner. */
  struct RoundCorner
  {
    Vec normal = {};  // r_a
    double part = 0.; // p_a
    Mat curvature = Mat::zero();
  };
  struct Round
  {
    std::uint64_t version = 0;
    std::array<RoundCorner, 4> corner;
  };
  /** Found where it is asked for, which is where surfaces touch. */
  const Round &round(const std::size_t face) const;
  /** Of a node whose faces that look as @p like have the mean @p mean. */
  RoundCorner round_surface(const std::size_t slot, const Vec like,
                            const SmoothNormal &mean) const;
  void fit_curvature(const std::size_t slot, const Vec like,
                     RoundCorner &corner) const;
  /** Calls @p action(part, the three ways to the other corners, flipped()
      axes) for the faces, and their images, around a node that look as @p like,
      with the part in which they do. */
  template <typename Action>
  void for_edges(const std::size_t slot, const Vec like,
                 const Action &action) const;
  /** Sum of the area vectors of the faces around a node, and of their sizes;
      with @p like, a unit normal, of those that look the same way. */
  SmoothNormal around(const std::size_t slot, const Vec *const like) const;
  Vec area_of(const std::size_t face) const;
  /** Part in which a face with the area vector @p area belongs to @p like. */
  static double likeness(const Vec area, const Vec like);

  const NodeHalo &halo;
  const Corners &corners;
  std::vector<std::size_t> first_of_slot, face_of_slot; // ascending
  std::vector<std::vector<SymmetryPlane>> planes;       // by body
  double nearness = 0.;
  std::vector<double> reach_of_slot;
  mutable std::vector<AtCorners> cache; // of the faces that were asked for
  mutable std::vector<Round> rounds;
};
} // namespace sabot

#endif
