#ifndef sabot_couplings_mirror_images_h
#define sabot_couplings_mirror_images_h

#include "sabot/bodies/body.h"
#include "sabot/kernels/mirrored.h"

#include <cmath>
#include <vector>

namespace sabot
{
/** @p v with its components along @p axes turned around: bit d of it stands for
    axis d. The mirror image of a vector (velocity, force, normal) in planes
    across these axes; its own inverse. */
inline Vec flipped(const Vec v, const unsigned int axes)
{
  return v * mirror_signs(axes);
}

/**
 * Images of points in the planes of symmetry near a place. With p planes near
 * there are 2^p images, numbered by the planes that they are mirrored in, a bit
 * each; image 0 is the point itself. What presses near a plane presses on the
 * half that is not modeled, too: its nodes are images of those that are.
 * Planes are across axes, so mirroring commutes; two planes across the same
 * axis (a slab between them) give images of images once each.
 */
class MirrorImages
{
public:
  /** Take of the @p planes those closer to @p place than @p distance [m]: only
      across those a point and its image can both be that close to the place. */
  void find(const std::vector<SymmetryPlane> &planes, const Vec place,
            const double distance)
  {
    near.clear();
    for (const SymmetryPlane &plane : planes)
      if (std::abs(place[plane.axis] - plane.coordinate) < distance)
        near.push_back(plane);
  }
  /** Number of images, the point itself included. */
  unsigned int size() const { return 1u << near.size(); }
  /** Axes along which vectors of this image are turned around, for
      flipped(). */
  unsigned int axes(const unsigned int image) const
  {
    unsigned int turned = 0;
    for (std::size_t i = 0; i < near.size(); ++i)
      if (image >> i & 1)
        turned ^= 1u << near[i].axis;
    return turned;
  }
  /** Where image number @p image of a point at @p x is [m]. */
  Vec operator()(Vec x, const unsigned int image) const
  {
    for (std::size_t i = 0; i < near.size(); ++i)
      if (image >> i & 1)
        x[near[i].axis] = 2. * near[i].coordinate - x[near[i].axis];
    return x;
  }
  /** Whether image number @p image of a point at @p x is where one of fewer
      planes is, since the point lies on one of its planes, within @p tolerance
      [m]. */
  bool repeats(const Vec x, const unsigned int image,
               const double tolerance) const
  {
    for (std::size_t i = 0; i < near.size(); ++i)
      if (image >> i & 1 &&
          std::abs(x[near[i].axis] - near[i].coordinate) < tolerance)
        return true;
    return false;
  }

private:
  std::vector<SymmetryPlane> near; // a bit of the image's number each
};
} // namespace sabot

#endif
