// The entries of the spring that all contacts share.
#include "sabot/couplings/contact_spring.h"

#include "sabot/base/parameters.h"

namespace sabot
{
void SpringOptions::declare_parameters(Parameters &prm)
{
  prm.declare_knob("Damping fraction", "0.1", quantity(Dimension::none, 0., 1.),
                   "Of critical, while two nodes approach.");
  prm.declare_knob("Stiffness scale", "1", quantity(Dimension::none, 1e-3, 10.),
                   "Penalty stiffness over bulk modulus times spacing.");
}

void SpringOptions::parse_parameters(const Parameters &prm)
{
  damping_fraction = get_quantity(prm, "Damping fraction");
  stiffness_scale = get_quantity(prm, "Stiffness scale");
}
} // namespace sabot
