// Takes note of signals that ask the program to stop.
#include "sabot/base/stop_signals.h"

#include "sabot/base/error.h"

#include <csignal>
#include <cstring>

namespace sabot
{
namespace
{
struct StopSignal
{
  int number;
  const char *name;
};

constexpr StopSignal stop_signals[] = {
    {SIGINT, "SIGINT"},   {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"},
    {SIGXCPU, "SIGXCPU"}, {SIGUSR1, "SIGUSR1"}, {SIGUSR2, "SIGUSR2"}};

volatile std::sig_atomic_t first_signal = 0;
bool is_listening = false;
bool hears_hang_ups = true;

void note_stop(int number)
{
  if (first_signal == 0)
    first_signal = number;
}

/** A handler and not SIG_IGN, which programs that this one starts would
    inherit. */
void pass_over(int) {}

bool is_ignored(const int signal)
{
  struct sigaction present;
  return sigaction(signal, nullptr, &present) == 0 &&
         present.sa_handler == SIG_IGN;
}

void handle(const int signal, void (*const handler)(int))
{
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART; // no write is cut short
  sigaction(signal, &action, nullptr);
}

sigset_t all_stop_signals()
{
  sigset_t signals;
  sigemptyset(&signals);
  for (const StopSignal &signal : stop_signals)
    sigaddset(&signals, signal.number);
  return signals;
}

/** Called before the constructors of all libraries: those of deal.II take half
    a second. */
void listen_early(int argc, char **argv, char **)
{
  for (const char *const command : {"run", "resume", "study"})
    if (argc > 1 && std::strcmp(argv[1], command) == 0)
      listen_to_stop_signals();
}

__attribute__((section(".preinit_array"),
               used)) void (*const before_libraries)(int, char **,
                                                     char **) = listen_early;
} // namespace

void listen_to_stop_signals()
{
  // Libraries may forget that it is ignored.
  if (!is_listening)
    hears_hang_ups = !is_ignored(SIGHUP);
  is_listening = true;
  for (const StopSignal &signal : stop_signals)
    if (signal.number != SIGHUP || hears_hang_ups)
      handle(signal.number, note_stop);
  if (!hears_hang_ups)
    handle(SIGHUP, SIG_IGN);
  for (const int signal : {SIGPIPE, SIGXFSZ})
    if (!is_ignored(signal))
      handle(signal, pass_over);
}

StopSignalsWait::StopSignalsWait() : waits(is_listening)
{
  const sigset_t signals = all_stop_signals();
  if (waits)
    sigprocmask(SIG_BLOCK, &signals, nullptr);
}

StopSignalsWait::~StopSignalsWait()
{
  const sigset_t signals = all_stop_signals();
  if (!waits)
    return;
  listen_to_stop_signals();
  sigprocmask(SIG_UNBLOCK, &signals, nullptr);
}

int stop_signal()
{
  return first_signal;
}

std::string signal_name(const int signal)
{
  for (const StopSignal &known : stop_signals)
    if (known.number == signal)
      return known.name;
  return "a signal";
}

std::vector<int> noted_stop_signals()
{
  std::vector<int> numbers;
  for (const StopSignal &signal : stop_signals)
    if (!is_ignored(signal.number))
      numbers.push_back(signal.number);
  return numbers;
}

void stop_early_when_asked(MPI_Comm communicator)
{
  int signal = first_signal;
  MPI_Allreduce(MPI_IN_PLACE, &signal, 1, MPI_INT, MPI_MAX, communicator);
  if (signal != 0)
    throw StoppedEarly(signal_name(signal) +
                       " asked to stop during the set-up; nothing was run");
}
} // namespace sabot
