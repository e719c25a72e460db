// Output of the fields of all bodies for ParaView.
#include "sabot/base/registry.h"
#include "sabot/output/output.h"
#include "sabot/output/run_files.h"

namespace sabot
{
namespace
{
class VtuOutput : public SceneOutput
{
public:
  bool writes_fields() const override { return true; }
  void open(RunFiles &files) override { files.open_fields(); }

protected:
  void write(const OutputMoment &moment, RunFiles &files) override
  {
    // The histories are kept as far as the fields: a run that is killed leaves
    // both.
    if (files.write_fields(moment.time, moment.bodies))
      files.write_history();
  }
};

const Registry<SceneOutput>::Add
    registered({"VTU", "fields of all bodies for ParaView.", nullptr,
                [](const Parameters &, const std::string &)
                { return std::make_unique<VtuOutput>(); }});
} // namespace
} // namespace sabot
