// What forms of stabilization have in common.
#include "sabot/bodies/spg/stabilization/stabilization.h"

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/spg/spg_parts.h"

namespace sabot
{
void Stabilization::allocate(const SpgParts &body)
{
  done.assign(body.nodes.n_owned, 0.);
}

void Stabilization::visit_state(StateVisitor &visitor, const StateItems &items)
{
  visitor.visit_items("stabilization work", done, items);
}
} // namespace sabot
