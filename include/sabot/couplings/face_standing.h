#ifndef sabot_couplings_face_standing_h
#define sabot_couplings_face_standing_h

#include "sabot/couplings/contact_spring.h"
#include "sabot/couplings/pressing_place.h"
#include "sabot/kernels/closest_point.h"
#include "sabot/kernels/face_hit.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sabot
{
/** A node and the faces that it may touch until the next search. */
struct NearFaces
{
  std::size_t slot;                  // of the halo
  std::size_t first_face, last_face; // of FaceStanding::face_of_node
  double spacing;                    // of the node's body [m]
  /** Of a node without faces of its own, as of the last search; without a
      direction where it has none. */
  SmoothNormal own = {};
  /** The closest face when it was last looked for; -1: it has not been. Where
      to look first, which has no part in what is found. */
  std::ptrdiff_t last_closest = -1;
};

/**
 * Where nodes stand against faces, in the current frame: which of the near
 * faces holds a node, and how deep. A face is four triangles around its center;
 * gaps are negative inside, normals point outwards.
 *
 * A node is met only by faces that look against its own surface
 * (least_cosine_of_met_faces()), and stands above the place from which the
 * common_normal() leads to it. That direction does not jump from face to face,
 * and neither do place and gap.
 */
class FaceStanding
{
public:
  /** @p halo: holds positions and velocities of all corners and nodes; must
      outlive this object. */
  explicit FaceStanding(const NodeHalo &halo)
      : halo(halo), normals(halo, corners)
  {
  }
  FaceStanding(const FaceStanding &) = delete; // normals refer to corners

  /** Per face, slots; with the faces around all corners of those in
      face_of_node, and around all nodes that have faces. */
  std::vector<std::array<std::size_t, 4>> corners;
  std::vector<std::uint32_t> face_of_node; // indices of corners, node by node

  void clear();
  /** Once faces and halo are there; arguments of SurfaceNormals::build(). */
  void build_normals(const std::vector<std::vector<SymmetryPlane>> &planes,
                     const double nearness, const std::vector<double> &reach);

  /**
   * The face that holds a node, with a negative gap in @p projection. A node
   * inside is held by the closest of the faces that look the way of the one it
   * last met (ContactMemory::side), one that comes in by the closest of those
   * that look against its own surface; a node without a normal of its own by
   * those that look the way of the side it last met, or of the closest face. So
   * neither aligned edges slip through each other nor does a side face catch
   * what slides under an edge. A face reaches 0.1 spacings beyond its rim for
   * nodes that are inside or came in through its plane within the last step,
   * the gap fading to zero there. @p memory: the side follows.
   * @param nearest: distance to the closest of all faces [m]; infinite where
   *   there is none.
   * @param place: with which it presses; @p projection is where that stands,
   *   but for its gap, which is the node's.
   * @return the face, -1 when none holds it (@p projection and @p place are
   *   then meaningless).
   */
  std::ptrdiff_t holding(NearFaces &node, ContactMemory &memory,
                         FaceProjection &projection, PressingPlace &place,
                         double &nearest, const double dt) const;
  /** Whether all of a face is farther from @p p than @p distance [m], as its
      ball tells; of few that are not much farther it does not. */
  bool is_farther(const std::size_t face, const Vec p,
                  const double distance) const
  {
    const Vec ball = shape(face).ball; // a line of the cache for each test
    const double reach = distance + ball[3];
    return norm_square(p - ball) > reach * reach;
  }

private:
  /** Faces whose normal has at least this cosine with the direction. */
  struct Side
  {
    Vec direction;
    double least_cosine;
  };
  /**
   * Closest of a node's faces. Of faces that share the closest edge the one
   * that faces the node more squarely tells the right side; of faces that it
   * touches (closer than 1e-6 spacings) the one it moves against.
   * @param first: one of them, the closer the fewer are looked at; -1: there is
   *   none.
   * @param side: if given, only faces of that side.
   * @return the face, -1 when there is none (@p projection is then left).
   */
  std::ptrdiff_t closest(const NearFaces &node, const std::ptrdiff_t first,
                         FaceProjection &projection,
                         const Side *const side) const;
  /** The closest face of all, and where the node is against it. */
  struct Closest
  {
    std::ptrdiff_t face;
    FaceProjection projection;
  };
  /** Where the node stands against the faces of a side, whose closest is
      @p face with @p projection. @return the face above or below which it
      stands, -1 beyond the rim (@p projection is then left). */
  std::ptrdiff_t stand(const NearFaces &node, const SmoothNormal &own,
                       const Side &side, const std::ptrdiff_t face,
                       FaceProjection &projection) const;
  /** Mean normal of the faces of a side that are as close as @p best. */
  SmoothNormal normal_of_closest(const NearFaces &node, const Side &side,
                                 const FaceProjection &best) const;
  /** Where the line from @p p along @p n meets the node's faces of a side, at
      the first place, which is then in feet. @p mean: of the normals there, for
      at an edge faces that have little in common say different ones. @return a
      face; -1: none is met. */
  std::ptrdiff_t hit(const NearFaces &node, const Vec p, const Vec n,
                     const Side &side, const double reach, FaceHit &found,
                     SmoothNormal &mean) const;
  /** The face of a side that holds the node, of whose faces @p of_all is the
      closest. @p may_be_deep: it is known to be
      inside; else it must have come through in the last step. */
  std::ptrdiff_t try_hold(const NearFaces &node, const SmoothNormal &own,
                          const Side &side, const Closest &of_all,
                          const bool may_be_deep, FaceProjection &projection,
                          PressingPlace &place, const double dt) const;
  /** SurfaceNormals::bulge() of what a node meets; none for particles, which
      stand for a volume as wide as facets. */
  double bulge_below(const NearFaces &node, const std::size_t face,
                     const std::array<double, 4> &weight) const;
  /** Mean of the feet of the last hit(). */
  double bulge_below_feet(const NearFaces &node) const;
  /** The place with which a node that stands above @p face presses, which
      becomes the face below that place; @p standing follows. */
  PressingPlace find_place(const NearFaces &node, const Side &side,
                           std::ptrdiff_t &face,
                           FaceProjection &standing) const;
  std::array<Vec, 4> places(const std::size_t face) const;
  /** A face as many nodes ask for it; the radius of the ball around it stands
      in the fourth lane. */
  struct Shape
  {
    Vec ball = {}, normal = {};
  };
  /** Found once after the halo has moved. */
  const Shape &shape(const std::size_t face) const
  {
    if (version_of_shape[face] != halo.version())
      find_shape(face);
    return shapes[face];
  }
  void find_shape(const std::size_t face) const;
  /** Those of a node's faces that lines from it may meet within @p reach [m],
      ascending as all are. */
  void keep_within(const NearFaces &node, const double reach) const;
  struct Faces
  {
    const std::uint32_t *first, *last;
    const std::uint32_t *begin() const { return first; }
    const std::uint32_t *end() const { return last; }
  };
  Faces faces_of(const NearFaces &node) const
  {
    return {face_of_node.data() + node.first_face,
            face_of_node.data() + node.last_face};
  }
  /** All of a node's faces that may be within @p reach [m], and others. */
  Faces faces_within(const NearFaces &node, const double reach) const
  {
    if (node.slot == kept_for && reach <= kept_reach)
      return {kept.data(), kept.data() + kept.size()};
    return faces_of(node);
  }
  /** Whether the face is of the side; all are of none. */
  static bool looks(const Shape &face, const Side *const side)
  {
    return side == nullptr ||
           !(dot(face.normal, side->direction) < side->least_cosine);
  }
  /** Of a node's faces of the side; -1: there is none. */
  std::ptrdiff_t nearest_center(const NearFaces &node,
                                const Side *const side) const;
  /** Velocity of the node against the face's closest point [m/s]. */
  Vec velocity_against(const NearFaces &node, const std::ptrdiff_t face,
                       const FaceProjection &projection) const;

  const NodeHalo &halo;
  SurfaceNormals normals;
  // Of the faces that were asked for
  mutable AlignedVector<Shape> shapes;
  mutable std::vector<std::uint64_t> version_of_shape; // of the halo
  // keep_within() of the node that holding() looks at
  mutable std::vector<std::uint32_t> kept;
  mutable std::size_t kept_for = -1;
  mutable double kept_reach = -1.; // [m]
  // Of the last hit(), and below the node that stand() has found
  mutable std::vector<Foot> feet, feet_of_node;
};
} // namespace sabot

#endif
