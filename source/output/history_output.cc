// Output of averages and energies as tables over time.
#include "sabot/base/registry.h"
#include "sabot/output/output.h"
#include "sabot/output/run_files.h"

namespace sabot
{
namespace
{
class HistoryOutput : public SceneOutput
{
public:
  bool needs_rows() const override { return true; }

protected:
  void write(const OutputMoment &moment, RunFiles &files) override
  {
    // The file is laid out whole: rows wait in memory, and in checkpoints.
    if (moment.is_last)
      files.write_history();
  }
};

const Registry<SceneOutput>::Add
    registered({"history", "averages and energies in history.h5.", nullptr,
                [](const Parameters &, const std::string &)
                { return std::make_unique<HistoryOutput>(); }});
} // namespace
} // namespace sabot
