#ifndef sabot_base_timers_h
#define sabot_base_timers_h

#include <chrono>
#include <map>
#include <string>

namespace sabot
{
/**
 * Wall-clock seconds per named phase of a run on this rank ("spg step",
 * "contact", "output"), for `timers` of result.json. A scope costs two reads
 * of the clock and a look-up by name: for phases of a step, not for what is
 * done per particle.
 *
 *     const auto timer = timers.scope("contact"); // to the end of the block
 *
 * Scopes may stand within each other: the outer one counts the time of the
 * inner one, too.
 *
 * Not thread-safe, not collective: ranks measure on their own, and waiting for
 * others counts for the phase that waits.
 */
class Timers
{
public:
  struct Phase
  {
    double seconds = 0.; // sum over all calls
    long calls = 0;
  };
  /**
   * Measures until it goes out of scope.
   * By the steady clock, which no change of the system's time moves. An
   * exception that leaves the block ends it, too.
   */
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
  /**
   * Start the phase @p name; it ends with the object that is returned.
   * A name comes into being with its first scope. The object must be kept: of
   * one that is not the phase ends at once.
   */
  Scope scope(const std::string &name) { return Scope(phases[name]); }
  /**
   * Phases that were met, by name.
   * Seconds of a scope that still runs are not in it.
   */
  const std::map<std::string, Phase> &all() const { return phases; }

private:
  std::map<std::string, Phase> phases; // scopes keep references to its values
};
} // namespace sabot

#endif
