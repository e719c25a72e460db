#ifndef sabot_couplings_contact_patch_h
#define sabot_couplings_contact_patch_h

#include "sabot/couplings/face_standing.h"
#include "sabot/couplings/mirror_images.h"

namespace sabot
{
/** A node that another presses on, or its mirror image in planes of symmetry
    across the axes of the bits. */
struct TouchedNode
{
  std::size_t slot;      // of the halo
  double weight;         // part of the force that it takes
  unsigned int mirrored; // flipped() axes
};

/**
 * What a particle presses on: it stands for a volume as wide as the spacing,
 * not for a point, so that on faces that are about as small its force goes to
 * the nodes within a radius R of the closest point, as a smooth pressure
 *
 *     w_a = phi(|x_a - c|/R) A_a (c0 + c1 . (x_a - c)),
 *
 * with the cubic spline phi, the nodes' areas A_a and c0, c1 such that sum w =
 * 1 and sum w (x_a - c) = 0 (patch_weights()). Mirror images in planes of
 * symmetry stand for the half that is not modeled.
 */
class ContactPatch
{
public:
  /** Both must outlive this object. */
  ContactPatch(const NodeHalo &halo, const FaceStanding &faces)
      : halo(halo), faces(faces)
  {
  }
  /** R [m] for nodes of one body on the faces of another; 0 where they press
      at points: nodes of hexahedra, and particles on faces coarser than 4/3 of
      the spacing. */
  static double radius(const Body &body_of_nodes, const ContactSurface &nodes,
                       const ContactSurface &faces);
  /** For a halo of @p n_slots, with the planes of the @p surfaces. */
  void reset(const std::vector<ContactSurface> &surfaces,
             const std::size_t n_slots);

  /**
   * Append what @p node presses on to @p touched, and change @p normal and
   * @p depth to the mean normal of the patch and the gap to the weighted mean
   * of its nodes, so that force and gap belong to one energy.
   * @param projection: on the face that holds the node.
   * @return false, with nothing changed, where the nodes in reach do not span
   *   the surface, or a weight would pull.
   */
  bool spread(const NearFaces &node, const double radius,
              const FaceProjection &projection,
              std::vector<TouchedNode> &touched, Vec &normal, double &depth);

private:
  /** Nodes of all faces that look the same way, with their areas. @return the
      sum of the faces' area vectors, images included, weighted by phi. */
  Vec gather(const NearFaces &node, const Vec held, const Vec center,
             const double radius);
  void add_images();

  const NodeHalo &halo;
  const FaceStanding &faces;
  std::vector<SymmetryPlane> planes;
  MirrorImages images;
  // Of the patch at hand
  std::vector<TouchedNode> nodes;
  std::vector<Vec> points;
  std::vector<double> areas, weights;
  std::vector<std::ptrdiff_t> number_of_slot; // -1: not in the patch
};
} // namespace sabot

#endif
