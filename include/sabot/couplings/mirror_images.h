#ifndef sabot_couplings_mirror_images_h
#define sabot_couplings_mirror_images_h

#include "sabot/bodies/body.h"

#include <cmath>
#include <vector>

namespace sabot
{
/** @p v with its components along @p axes (a bit each) turned around. */
inline Vec flipped(Vec v, const unsigned int axes)
{
  for (int d = 0; d < 3; ++d)
    if (axes >> d & 1)
      v[d] = -v[d];
  return v;
}

/** Images of points in the planes of symmetry near a place; image 0 is the
    point itself. */
class MirrorImages
{
public:
  /** Of the @p planes those closer to @p place than @p distance. */
  void find(const std::vector<SymmetryPlane> &planes, const Vec place,
            const double distance)
  {
    near.clear();
    for (const SymmetryPlane &plane : planes)
      if (std::abs(place[plane.axis] - plane.coordinate) < distance)
        near.push_back(plane);
  }
  unsigned int size() const { return 1u << near.size(); }
  /** Axes along which vectors of this image are turned around. */
  unsigned int axes(const unsigned int image) const
  {
    unsigned int turned = 0;
    for (std::size_t i = 0; i < near.size(); ++i)
      if (image >> i & 1)
        turned ^= 1u << near[i].axis;
    return turned;
  }
  Vec operator()(Vec x, const unsigned int image) const
  {
    for (std::size_t i = 0; i < near.size(); ++i)
      if (image >> i & 1)
        x[near[i].axis] = 2. * near[i].coordinate - x[near[i].axis];
    return x;
  }

private:
  std::vector<SymmetryPlane> near;
};
} // namespace sabot

#endif
