#ifndef sabot_output_log_h
#define sabot_output_log_h

#include <mpi.h>

#include <chrono>
#include <fstream>
#include <string>

namespace sabot
{
/** What a run says: rank 0 to the screen and to log.txt. */
class Log
{
public:
  Log(const bool quiet, MPI_Comm communicator);
  /** Also write to this file from now on (added to when it exists and
      @p append). IOError. */
  void open(const std::string &file, const bool append);
  void line(const std::string &text);
  void warning(const std::string &text);
  /** One line that is replaced on a terminal; elsewhere shown at most every
      two seconds. Not in the file. */
  void progress(const std::string &text, const bool last = false);

private:
  bool speaks, quiet, terminal, open_line = false;
  std::ofstream file;
  std::chrono::steady_clock::time_point last_progress;
};
} // namespace sabot

#endif
