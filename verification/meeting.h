#ifndef verification_meeting_h
#define verification_meeting_h

#include "sabot/couplings/closing_limit.h"
#include "sabot/couplings/contact.h"
#include "verification/world.h"

namespace sabot
{
/** Lets bodies 0 and 1, the only ones of @p world, meet both ways, as fast as
    they may, and starts it. */
inline void start_meeting(World &world)
{
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(),
      std::vector<ContactPair>{{0, 1, false}, {1, 0, false}}, ContactOptions(),
      MPI_COMM_WORLD));
  world.couplings.push_back(std::make_unique<ClosingLimit>(
      world.pointers(), world.couplings, MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
}
} // namespace sabot

#endif
