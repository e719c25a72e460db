#ifndef sabot_geometry_turn_h
#define sabot_geometry_turn_h

#include "sabot/kernels/vec.h"

#include <array>
#include <string>

namespace sabot
{
class Parameters;
struct HexMesh;
struct ParticleCloud;

/**
 * A rotation of a body about a point, x = c + R (X - c), applied to what its
 * shape made before anything else is done with it. Faces keep their ids and so
 * their names, which are the body's; numbers of nodes, cells and particles,
 * masses and volumes stay as they are.
 *
 * Entries of R that differ from 0 or +-1 by round-off are set to these: by
 * right angles coordinates change places exactly, and a turn about an axis
 * leaves coordinates along it as they are, so that planes of symmetry across it
 * stay planes. No function is collective.
 */
class Turn
{
public:
  /** None. */
  Turn() = default;
  /** @p angle [rad] by the right-hand rule about @p axis, of any length but 0,
      through @p center [m]. */
  static Turn about(const std::array<double, 3> &axis, const double angle,
                    const std::array<double, 3> &center);
  /** R = Rz(yaw) Ry(pitch) Rx(roll): first by roll about x, then by pitch about
      y, then by yaw about z, all fixed axes [rad]. */
  static Turn by_angles(const double yaw, const double pitch, const double roll,
                        const std::array<double, 3> &center);

  /** The entries of a body. */
  static void declare(Parameters &prm);
  /** From the entries of the body @p path, whose subsection is entered; its
      entry "Center" is the point unless another is set. InputError where both
      ways of giving the rotation are used, and for an axis of length 0. */
  static Turn parse(const Parameters &prm, const std::string &path);

  bool is_none() const { return none; }
  /** Where a point goes [m]. */
  std::array<double, 3> place(const std::array<double, 3> &point) const;
  /** Where a point came from [m]. */
  std::array<double, 3> origin(const std::array<double, 3> &place) const;
  /** R v. */
  Vec direction(const Vec v) const { return rotation * v; }

  /** Nodes, and mean gradients with them. */
  void apply(HexMesh &mesh) const;
  /** Particles, their areas and the directions of their lattice; which faces
      lie across an axis is found again. */
  void apply(ParticleCloud &cloud) const;

private:
  Turn(const Mat &rotation, const std::array<double, 3> &center);

  bool none = true;
  Mat rotation = Mat::identity();
  Vec center = {};
};
} // namespace sabot

#endif
