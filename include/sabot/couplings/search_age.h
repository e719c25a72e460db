#ifndef sabot_couplings_search_age_h
#define sabot_couplings_search_age_h

#include "sabot/bodies/body.h"
#include "sabot/couplings/closing_speed.h"

#include <vector>

namespace sabot
{
/** What makes a search among particles old: the way that they may have come
    closer since, and particles that have come. */
class SearchAge
{
public:
  double traveled = 0.; // [m]
  ClosingSpeed closing_speed;
  /** Whether bodies have others. Since the last call; the same on all ranks. */
  bool have_changed(const std::vector<Body *> &bodies)
  {
    const unsigned int before = sum;
    sum = 0;
    for (const Body *const body : bodies)
      if (body->particles() != nullptr)
        sum += body->contact_surface_version();
    return sum != before;
  }
  void visit_state(StateVisitor &visitor)
  {
    visitor.visit_value("traveled", traveled);
    visitor.visit_value("versions of particles", sum);
    closing_speed.visit_state(visitor);
  }

private:
  unsigned int sum = 0;
};
} // namespace sabot

#endif
