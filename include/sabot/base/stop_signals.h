#ifndef sabot_base_stop_signals_h
#define sabot_base_stop_signals_h

#include <mpi.h>

#include <string>
#include <vector>

namespace sabot
{
// Signals that ask a program to come to an end: from users (SIGINT, SIGTERM),
// from a terminal that closes (SIGHUP), from batch systems when the time that
// they grant is nearly over (SIGTERM, SIGXCPU, SIGUSR1, SIGUSR2). The commands
// "run", "resume" and "study" take note of them and stop where they leave
// something to go on from; all else is killed by them, as usual. They listen
// from before the libraries start, which take half a second.

/** Take note of these signals from now on instead of being killed. SIGHUP is
    left alone where it is ignored (nohup). A pipe that nobody reads any more
    and a file that outgrows its limit become errors of the write. */
void listen_to_stop_signals();

/** While it lives, stop signals wait, if they are listened to; then they are
    again. For the start of libraries that set handlers of their own and take
    them back. */
class StopSignalsWait
{
public:
  StopSignalsWait();
  ~StopSignalsWait();
  StopSignalsWait(const StopSignalsWait &) = delete;

private:
  const bool waits;
};

/** The first signal that came to this process; 0: none. */
int stop_signal();

/** "SIGTERM" of its number; "a signal" of one that is no stop signal. */
std::string signal_name(const int signal);

/** Those that are noted: all of them but an ignored SIGHUP. */
std::vector<int> noted_stop_signals();

/** StoppedEarly on all ranks when a signal came to any: for the set-up, between
    its parts. Collective. */
void stop_early_when_asked(MPI_Comm communicator);
} // namespace sabot

#endif
