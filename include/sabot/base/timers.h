#ifndef sabot_base_timers_h
#define sabot_base_timers_h

#include "sabot/base/message_count.h"

#include <time.h>

#include <chrono>
#include <map>
#include <string>

namespace sabot
{
/**
 * Wall-clock and processor seconds per named phase of a run on this rank ("spg
 * step", "contact", "output"), the items that it went through and what it told
 * other ranks, for `timers` of result.json. Processor time is
 * that of the calling thread: it does not grow while the system gives the
 * processor to others or the phase waits for the disk, but does while MPI waits
 * for other ranks, as it asks again and again. A scope costs two reads of the
 * steady clock and a look-up by name: for phases of a step, not for what is
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
    double seconds = 0.;     // wall clock, sum over all calls
    double cpu_seconds = 0.; // of the processor
    long calls = 0;
    double items = 0.; // that the calls went through, on this rank
    MessageCount messages;
  };

private:
  using Wall = std::chrono::steady_clock;

  /**
   * Seconds of the thread on the processor. Asking the system costs 0.4 us, ten
   * times the steady clock: within 20 us of an answer the thread is taken to
   * have run all the time, as the system does not take the processor away for
   * so short a time.
   */
  class ProcessorClock
  {
  public:
    double at(const Wall::time_point wall)
    {
      const double since =
          std::chrono::duration<double>(wall - asked_at).count();
      if (since < 20e-6)
        return answer + since;
      timespec now;
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
      answer = now.tv_sec + 1e-9 * now.tv_nsec;
      asked_at = wall;
      return answer;
    }

  private:
    Wall::time_point asked_at;
    double answer = 0.;
  };

public:
  /**
   * Measures until it goes out of scope.
   * By the steady clock, which no change of the system's time moves. An
   * exception that leaves the block ends it, too.
   */
  class Scope
  {
  public:
    Scope(Phase &phase, ProcessorClock &processor)
        : phase(phase), processor(processor), start(Wall::now()),
          cpu_start(processor.at(start)), messages_start(messages_so_far())
    {
    }
    ~Scope()
    {
      const Wall::time_point end = Wall::now();
      phase.seconds += std::chrono::duration<double>(end - start).count();
      phase.cpu_seconds += processor.at(end) - cpu_start;
      ++phase.calls;
      phase.messages.add(messages_so_far().since(messages_start));
    }
    Scope(const Scope &) = delete;
    /** It goes through @p n items more, as which its cost is told. */
    void count(const double n) const { phase.items += n; }

  private:
    Phase &phase;
    ProcessorClock &processor;
    const Wall::time_point start;
    const double cpu_start;
    const MessageCount messages_start;
  };
  /**
   * Start the phase @p name; it ends with the object that is returned.
   * A name comes into being with its first scope. The object must be kept: of
   * one that is not the phase ends at once.
   */
  Scope scope(const std::string &name)
  {
    return Scope(phases[name], processor);
  }
  /**
   * Phases that were met, by name.
   * Seconds of a scope that still runs are not in it.
   */
  const std::map<std::string, Phase> &all() const { return phases; }

private:
  std::map<std::string, Phase> phases; // scopes keep references to its values
  ProcessorClock processor;
};
} // namespace sabot

#endif
