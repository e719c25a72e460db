// The entry "Sector" that round shapes share.
#include "sabot/geometry/sector.h"

#include "sabot/geometry/shape.h"

namespace sabot
{
void Sector::declare(Parameters &prm, const std::string &shape,
                     const std::string &sides)
{
  prm.declare_knob("Sector", "full", one_of("full|half|quarter"),
                   "Part of the " + shape + " that is modeled: " + sides);
}

Sector Sector::parse(const Parameters &prm)
{
  const std::string sector = prm.get("Sector");
  return {sector == "full" ? 0u : sector == "half" ? 1u : 2u};
}

void Sector::name_cuts(const unsigned int axis,
                       std::vector<std::string> &faces) const
{
  for (unsigned int cut = 0; cut < n_cuts; ++cut)
    faces.push_back(box_faces[2 * ((axis + cut) % 3)]);
}
} // namespace sabot
