#ifndef sabot_couplings_face_standing_h
#define sabot_couplings_face_standing_h

#include "sabot/couplings/contact_spring.h"
#include "sabot/couplings/node_halo.h"
#include "sabot/kernels/closest_point.h"

#include <array>
#include <vector>

namespace sabot
{
/** A node and the faces that it may touch until the next search. */
struct NearFaces
{
  std::size_t slot;                  // of the halo
  std::size_t first_face, last_face; // of FaceStanding::face_of_node
  double spacing;                    // of the node's body [m]
};

/**
 * Where nodes stand against faces, in the current frame: which of the near
 * faces holds a node, and how deep. A face is four triangles around its center
 * (project_on_face()); gaps are negative inside, normals point outwards.
 */
class FaceStanding
{
public:
  /** @p halo: holds positions and velocities of all corners and nodes; must
      outlive this object. */
  explicit FaceStanding(const NodeHalo &halo) : halo(halo) {}

  std::vector<std::array<std::size_t, 4>> corners; // per face, slots
  std::vector<std::size_t> face_of_node; // indices of corners, node by node

  void clear();

  /**
   * Closest of a node's faces. Of faces that share the closest edge the one
   * that faces the node more squarely tells the right side; of faces that it
   * touches (closer than 1e-6 spacings) the one it moves against.
   * @param side: if given, only faces whose normal is within 60 degrees of it.
   * @return the face, -1 when there is none (@p projection is then left).
   */
  std::ptrdiff_t closest(const NearFaces &node, FaceProjection &projection,
                         const Vec *const side = nullptr) const;

  /**
   * The face that holds a node, with a negative gap in @p projection. A node
   * inside, or one that came through within the last step, is held by the
   * closest of the faces that look the way of the one it last met
   * (ContactMemory::side), not by the closest of all, so that aligned edges
   * cannot slip through each other; such a face reaches 0.1 spacings beyond its
   * rim, its gap fading to zero there. @p memory: the side follows.
   * @return the face, -1 when none holds it (@p projection is then of the
   *   closest).
   */
  std::ptrdiff_t holding(const NearFaces &node, ContactMemory &memory,
                         FaceProjection &projection, const double dt) const;

private:
  /** Velocity of the node against the face's closest point [m/s]. */
  Vec velocity_against(const NearFaces &node, const std::ptrdiff_t face,
                       const FaceProjection &projection) const;

  const NodeHalo &halo;
};
} // namespace sabot

#endif
