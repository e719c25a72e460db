#ifndef sabot_base_timers_h
#define sabot_base_timers_h

#include <chrono>
#include <map>
#include <string>

namespace sabot
{
/** Wall-clock seconds per named phase of a run. */
class Timers
{
public:
  struct Phase
  {
    double seconds = 0.;
    long calls = 0;
  };
  /** Measures until it goes out of scope. */
  class Scope
  {
  public:
    explicit Scope(Phase &phase)
        : phase(phase), start(std::chrono::steady_clock::now())
    {
    }
    ~Scope()
    {
      phase.seconds += std::chrono::duration<double>(
                           std::chrono::steady_clock::now() - start)
                           .count();
      ++phase.calls;
    }
    Scope(const Scope &) = delete;

  private:
    Phase &phase;
    const std::chrono::steady_clock::time_point start;
  };
  Scope scope(const std::string &name) { return Scope(phases[name]); }
  const std::map<std::string, Phase> &all() const { return phases; }

private:
  std::map<std::string, Phase> phases;
};
} // namespace sabot

#endif
