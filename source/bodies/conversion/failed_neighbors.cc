// Cells turn into particles ahead of a crack that comes their way.
#include "sabot/base/registry.h"
#include "sabot/bodies/conversion_criterion.h"

namespace sabot
{
namespace
{
constexpr const char *entry = "Conversion layers";

class FailedNeighbors : public ConversionCriterion
{
public:
  explicit FailedNeighbors(const unsigned int layers) : layers(layers) {}
  Onset onset() const override { return {std::nullopt, double(layers)}; }
  void mark(CellConditions &cells, std::vector<char> &unfit) const override
  {
    const std::vector<char> is_near = cells.near_failure(layers);
    for (std::size_t e = 0; e < is_near.size(); ++e)
      unfit[e] |= is_near[e];
  }

private:
  const unsigned int layers;
};

const Registry<ConversionCriterion>::Add registered(
    {"failed neighbors", "particles with broken bonds are within some layers.",
     [](Parameters &prm)
     {
       prm.declare_knob(entry, "2", integer(1),
                        "Layers of cells around particles with broken bonds "
                        "that turn into particles.");
     },
     [](const Parameters &prm, const std::string &) {
       return std::make_shared<const FailedNeighbors>(prm.get_integer(entry));
     }});
} // namespace
} // namespace sabot
