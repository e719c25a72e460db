#ifndef verification_rubble_h
#define verification_rubble_h

#include "sabot/couplings/self_contact.h"
#include "verification/world.h"

#include <functional>

namespace sabot
{
/** Particles some of whose velocities a problem prescribes after every kick. */
class DrivenSpgBody : public SpgBody
{
public:
  using Drive = std::function<void(NodalState &, const double time)>;
  DrivenSpgBody(const std::string &name, ParticleCloud cloud,
                std::shared_ptr<const Material> material,
                const SpgOptions &options)
      : SpgBody(name, 0, std::move(cloud), std::move(material), options)
  {
  }
  void impose_velocities(const double time) override
  {
    SpgBody::impose_velocities(time);
    if (drive)
      drive(nodes(), time);
  }
  Drive drive;
};

/** Particles of a cubic lattice of spacing @p h [m], turned by @p angle [rad]
    about @p axis (unit), where @p inside says so; one particle is at the
    origin. Each has the volume of a cell of the lattice. */
ParticleCloud lattice_where(const double h, const Vec &axis, const double angle,
                            const double reach,
                            const std::function<bool(const Vec &)> &inside);
} // namespace sabot

#endif
