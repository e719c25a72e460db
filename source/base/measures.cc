// Numbers that a run reports of its bodies.
#include "sabot/base/measures.h"

#include <stdexcept>

namespace sabot
{
double find_measure(const Measures &measures, const std::string &name)
{
  for (const Measure &measure : measures)
    if (measure.name == name)
      return measure.value;
  throw std::logic_error("there is no measure \"" + name + "\"");
}

Measures BodyMeasures::columns() const
{
  const char axis[] = {'x', 'y', 'z'};
  Measures all = {{"mass", "kg", mass}};
  for (int d = 0; d < 3; ++d)
    all.push_back({std::string("velocity ") + axis[d], "m/s", velocity[d]});
  all.push_back({"kinetic energy", "J", kinetic_energy});
  for (int d = 0; d < 3; ++d)
  {
    all.push_back({std::string("minimum ") + axis[d], "m", low[d]});
    all.push_back({std::string("maximum ") + axis[d], "m", high[d]});
  }
  all.push_back({"internal energy", "J", internal_energy});
  all.insert(all.end(), own.begin(), own.end());
  return all;
}
} // namespace sabot
