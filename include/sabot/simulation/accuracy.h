#ifndef sabot_simulation_accuracy_h
#define sabot_simulation_accuracy_h

#include <map>
#include <string>
#include <vector>

namespace sabot
{
class Parameters;

/**
 * The entry `Accuracy`: how the knobs that a scene leaves alone are set, the
 * factor on its spacings among them. What a scene sets itself stays. Errors and
 * costs are measured on three scenes (doc/accuracy.md).
 */
struct Accuracy
{
  static constexpr const char *entry = "Accuracy";
  static constexpr const char *standard = "balanced";

  static void declare(Parameters &prm);
  /** Defaults of knobs by the choice @p name; none for the standard, nor for a
      name that there is not, which reading the file tells. */
  static std::map<std::string, std::string> standards(const std::string &name);
  /** What the choice costs and how far off it is, for the plan. */
  static std::string price(const std::string &name);
  /** Multiply nodal spacings and cell sizes of @p bodies by the entry `Spacing
      factor`, and set that to 1: the expanded parameters say what was run, and
      a resumed run is not scaled again. Meshes from files stay. */
  static void scale_spacings(Parameters &prm,
                             const std::vector<std::string> &bodies);
};
} // namespace sabot

#endif
