#ifndef sabot_bodies_spg_mirror_planes_h
#define sabot_bodies_spg_mirror_planes_h

#include "sabot/base/types.h"
#include "sabot/bodies/body.h"
#include "sabot/kernels/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sabot
{
/**
 * Planes of symmetry of one body, and the images of its particles beyond them.
 * An image is told by the particle's number and the number of the symmetry, an
 * element of the group that the planes generate: across each axis the identity,
 * the reflection in its plane; or, of a slab between two planes at a and b, one
 * of
 *
 *   x -> x + c (b - a),            c even,
 *   x -> 2 a - x + (c + 1) (b - a),  c odd,    |c| <= 4,
 *
 * so that c = -1 and 1 are the reflections at a and b. A particle that lies on
 * a plane is its own image in it: of the symmetries that bring it to the same
 * place one stands for all (the canonical one).
 *
 * Numbers of images: that of the particle plus 2^32 times that of the symmetry,
 * 0 the identity; they do not depend on how many particles there are.
 */
class MirrorPlanes
{
public:
  /** Numbers of particles are below 2^32. */
  static GlobalIndex particle_of(const GlobalIndex id)
  {
    return id & 0xffffffff;
  }
  static unsigned int symmetry_of(const GlobalIndex id) { return id >> 32; }
  static GlobalIndex image(const GlobalIndex particle,
                           const unsigned int symmetry)
  {
    return particle | GlobalIndex(symmetry) << 32;
  }

  MirrorPlanes() = default;
  /**
   * Of a body with its particles at @p points at the start. Axes whose planes
   * the body is not on one side of, or not between, get no images.
   * @param planes     each once
   * @param tolerance  closer ones lie on a plane [m]
   */
  MirrorPlanes(const std::vector<SymmetryPlane> &planes,
               const std::vector<std::array<double, 3>> &points,
               const double tolerance);

  bool any() const { return n_symmetries > 1; }
  /** Across which there are images, a bit each. */
  unsigned int across() const;
  /** Planes on which a particle lies that is at @p X at the start: bits 2 d and
      2 d + 1 of axis d, its lower and its upper plane; one alone is lower. */
  unsigned int planes_at(const Vec X) const;
  /** Of the owned ones of @p nodes. */
  std::vector<std::uint8_t> planes_of(const NodalState &nodes) const;
  /** Of a particle on these planes: volume of the whole over that which the
      model has of it. */
  static double copies(const unsigned int on)
  {
    return 1 << __builtin_popcount(on);
  }
  /** Bit d: a particle on these planes does not move along axis d. */
  static unsigned int held_axes(const unsigned int on)
  {
    return (on & 1) | (on >> 1 & 1) | ((on >> 2 & 1) | (on >> 3 & 1)) << 1 |
           ((on >> 4 & 1) | (on >> 5 & 1)) << 2;
  }

  /** Of a particle on planes @p on. */
  unsigned int canonical(const unsigned int symmetry,
                         const unsigned int on) const;
  unsigned int inverse(const unsigned int symmetry) const;
  /** Axes along which vectors are turned around, a bit each (mirror()). */
  unsigned int turned_axes(const unsigned int symmetry) const;
  /** What is added to a turned position [m]. */
  Vec offset(const unsigned int symmetry) const;
  /** Where the image of a particle at @p x is [m]. */
  Vec place(const unsigned int symmetry, const Vec x) const;

  /** Call @p visit(symmetry, place) for each image, the identity aside, of a
      particle at @p x on planes @p on that may be closer than @p reach [m] to
      any particle. Canonical symmetries. */
  template <typename Visit>
  void for_images(const Vec x, const unsigned int on, const double reach,
                  const Visit &visit) const
  {
    if (!any())
      return;
    const Elements x_axis = elements_near(x, on, reach, 0),
                   y_axis = elements_near(x, on, reach, 1),
                   z_axis = elements_near(x, on, reach, 2);
    for (int k = 0; k < z_axis.n; ++k)
      for (int j = 0; j < y_axis.n; ++j)
        for (int i = 0; i < x_axis.n; ++i)
          if (const unsigned int symmetry =
                  symmetry_with({{x_axis.c[i], y_axis.c[j], z_axis.c[k]}}))
            visit(symmetry, place(symmetry, x));
  }

private:
  /** Of one axis. */
  struct Axis
  {
    unsigned int n_planes = 0;
    double low = 0., high = 0.; // planes [m]
    double side = 0.; // of one plane: the model is where side (x - low) >= 0
  };
  static constexpr int farthest = 4; // |c|
  /** Symmetries across an axis. */
  static unsigned int n_of(const Axis &axis)
  {
    constexpr unsigned int n[] = {1, 2, 2 * farthest + 1};
    return n[axis.n_planes];
  }
  /** c of the symmetry along axis @p d; of one plane 0 or -1. */
  int element(unsigned int symmetry, const int d) const;
  static int element_of(const int digit);
  unsigned int symmetry_with(const std::array<int, 3> &elements) const;
  /** Of one axis, by which canonical images come near. */
  struct Elements
  {
    int n = 0;
    std::array<int, 2 * farthest + 1> c;
  };
  Elements elements_near(const Vec x, const unsigned int on, const double reach,
                         const int d) const;
  /** c for which a particle on planes @p on stands for @p c. */
  static int canonical_element(const int c, const unsigned int on, const int d);
  double offset_along(const int c, const int d) const;

  std::array<Axis, 3> axes;
  unsigned int n_symmetries = 1;
  double tolerance = 0.; // [m]
};
} // namespace sabot

#endif
