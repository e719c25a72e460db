#ifndef sabot_simulation_accuracy_h
#define sabot_simulation_accuracy_h

#include <map>
#include <string>

namespace sabot
{
class Parameters;

/**
 * The entry `Accuracy`: how the knobs that a scene leaves alone are set. What a
 * scene sets itself stays. Spacings and zones are no part of it: they are the
 * scene's, and most of the error (doc/accuracy.md has both, measured).
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
};
} // namespace sabot

#endif
