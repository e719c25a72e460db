#ifndef sabot_simulation_directed_quantity_h
#define sabot_simulation_directed_quantity_h

#include "sabot/simulation/quantity_of_interest.h"

#include <cmath>

namespace sabot
{
/** Declares the entry "Body" of a quantity. */
void declare_body_of_quantity(Parameters &prm);
/** Declares the entries of a quantity of a body along a direction. */
void declare_directed_quantity(Parameters &prm);

/**
 * A body and a direction along which something is measured.
 * In the fixed frame of the scene. The body is kept by reference.
 */
struct DirectedQuantity
{
  const Body &body;
  Vec direction; // unit

  /** Reads the entries of declare_directed_quantity(). Throws InputError for a
      direction that is zero or, where @p is_along_axis, not along x, y or z. */
  static DirectedQuantity read(const QuantityRequest &request,
                               const bool is_along_axis);
  /**
   * The axis that the direction follows most.
   * 0, 1, 2: x, y, z.
   */
  int axis() const;
};

/** How many copies of a body that planes of symmetry cut make the whole: 2 for
    each plane. */
inline double copies_by_symmetry(const Body &body)
{
  return std::pow(2., double(body.planes_of_symmetry().size()));
}

/** Velocity of the center of mass of the whole body [m/s]: none across planes
   of symmetry, for what the model holds of a body bulges and its image does so
    the other way. Collective. */
inline std::array<double, 3> velocity_of_whole(const Body &body)
{
  std::array<double, 3> v = measure_with_particles(body).velocity;
  for (const SymmetryPlane &plane : body.planes_of_symmetry())
    v[plane.axis] = 0.;
  return v;
}

/**
 * Extent of @p m along an axis [m].
 * Between the outermost nodes in the present configuration; never negative.
 */
inline double extent(const BodyMeasures &m, const int axis)
{
  return m.high[axis] - m.low[axis];
}
} // namespace sabot

#endif
