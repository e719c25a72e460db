// Entries of all outputs, and when each falls due.
#include "sabot/output/output.h"

#include "sabot/base/registry.h"
#include "sabot/base/state_visitor.h"

namespace sabot
{
void SceneOutput::declare_parameters(Parameters &prm, const std::string &type)
{
  Registry<SceneOutput>::declare_choice(prm, "Type", "VTU", "");
  prm.declare_entry("Interval", "5 us", quantity(Dimension::time, 1e-15, 1e3),
                    "Time between two writes; the end is always written.");
  Registry<SceneOutput>::declare_entries(prm, type);
}

std::unique_ptr<SceneOutput> SceneOutput::make(const Parameters &prm,
                                               const std::string &path)
{
  std::unique_ptr<SceneOutput> output =
      Registry<SceneOutput>::get(path + "/Type", prm.get("Type"))
          .make(prm, path);
  output->interval = get_quantity(prm, "Interval");
  return output;
}

void SceneOutput::write_when_due(const OutputMoment &moment, RunFiles &files)
{
  if (moment.is_last || is_due(moment.time))
    write(moment, files);
  while (is_due(moment.time))
    next += interval;
}

void SceneOutput::visit_state(StateVisitor &visitor, const std::string &name)
{
  visitor.visit_value(name, next);
  visit_more(visitor, name);
}
} // namespace sabot
