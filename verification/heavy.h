#ifndef verification_heavy_h
#define verification_heavy_h

#include "sabot/bodies/body.h"

#include <utility>

namespace sabot
{
/** A body of class @p Base with a weight of its own, the acceleration @p
   gravity [m/s^2], that grows for the time @p rise [s]; its work is in no
   ledger. */
template <typename Base>
class Heavy : public Base
{
public:
  template <typename... Arguments>
  explicit Heavy(const Vec gravity, const double rise, Arguments &&...arguments)
      : Base(std::forward<Arguments>(arguments)...), gravity(gravity),
        rise(rise)
  {
  }
  void compute_forces(const double time, const double dt) override
  {
    Base::compute_forces(time, dt);
    NodalState &n = this->nodes();
    const Vec a = (time < rise ? time / rise : 1.) * gravity;
    for (std::size_t i = 0; i < n.n_owned; ++i)
      n.force[i] += n.lumped_mass[i] * a;
  }

private:
  const Vec gravity;
  const double rise;
};
} // namespace sabot

#endif
