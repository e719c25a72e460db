#ifndef sabot_simulation_directed_quantity_h
#define sabot_simulation_directed_quantity_h

#include "sabot/simulation/quantity_of_interest.h"

namespace sabot
{
/** Declares the entry "Body" of a quantity. */
void declare_body_of_quantity(Parameters &prm);
/** Declares the entries of a quantity of a body along a direction. */
void declare_directed_quantity(Parameters &prm);

/** A body and a direction along which something is measured. */
struct DirectedQuantity
{
  const Body &body;
  Vec direction; // unit

  /** Reads the entries of declare_directed_quantity(). Throws InputError for a
      direction that is zero or, where @p is_along_axis, not along x, y or z. */
  static DirectedQuantity read(const QuantityRequest &request,
                               const bool is_along_axis);
  /** The axis that the direction follows most. */
  int axis() const;
};

/** Extent of @p m along an axis [m]. */
inline double extent(const BodyMeasures &m, const int axis)
{
  return m.high[axis] - m.low[axis];
}
} // namespace sabot

#endif
