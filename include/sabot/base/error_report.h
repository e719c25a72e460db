#ifndef sabot_base_error_report_h
#define sabot_base_error_report_h

#include "sabot/base/error.h"

#include <functional>
#include <string>

namespace sabot
{
/**
 * Do @p work; what it throws becomes "error: ..." in one line on the standard
 * error and an exit code. With @p uses_mpi, MPI has been started: what all
 * ranks throw is told by rank 0; what one rank met alone (memory, an error that
 * nobody foresaw) is told by this rank, which then ends the others, as they may
 * wait for it. Collective with @p uses_mpi. Never throws.
 */
int report_errors(const bool uses_mpi, const std::function<ExitCode()> &work);

/** What an exception of any library says, in one line: of deal.II's its
    additional information, without places in the code and stack traces. */
std::string in_one_line(const std::string &what);

/**
 * Do @p work; where memory does not suffice, a MemoryError that names @p what
 * it was for ("body \"plate\""), how much the process has and what limits it.
 * The innermost name counts. Costs nothing where all goes well.
 */
void within_memory(const std::string &what, const std::function<void()> &work);
} // namespace sabot

#endif
