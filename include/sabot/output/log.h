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
  /** One line that is replaced on a terminal; elsewhere shown at most every
      two seconds. Not in the file. The @p last is shown in any case. */
  void progress(const std::string &text, const bool last = false);

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
