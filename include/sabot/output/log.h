#ifndef sabot_output_log_h
#define sabot_output_log_h

#include <mpi.h>

#include <chrono>
#include <fstream>
#include <string>

namespace sabot
{
/**
 * What a run says: rank 0 to the screen and to log.txt, the other ranks
 * nothing, so that all may call it alike; not collective. A quiet log still
 * fills the file.
 */
class Log
{
public:
  Log(const bool quiet, MPI_Comm communicator);
  /** Also write to this file from now on (added to when it exists and
      @p append). IOError. */
  void open(const std::string &file, const bool append);
  /** Say a line, at once (flushed). */
  void line(const std::string &text);
  /** The same after "warning: ". */
  void warning(const std::string &text);
  /** A line of the file that also goes to the screen, unless that is a
      terminal, which has the live line. */
  void record(const std::string &text);
  /** Whether progress() would show a text now. */
  bool wants_progress() const;
  /** The live line: replaced in place, on a terminal only, at most five times a
      second. Not in the file. */
  void progress(const std::string &text);

private:
  bool speaks;            // rank 0
  bool quiet;             // nothing to the screen
  bool terminal;          // whether the screen is one
  bool open_line = false; // a progress line stands without its end
  std::ofstream file;
  std::chrono::steady_clock::time_point last_progress;
};
} // namespace sabot

#endif
