#ifndef sabot_output_first_rank_h
#define sabot_output_first_rank_h

#include <mpi.h>

#include <functional>

namespace sabot
{
/**
 * Rank 0 does @p work on files while the others wait. Where that throws an
 * IOError, all ranks throw one: rank 0 its own, which report_errors() tells,
 * the others "rank 0 could not <@p what>". Collective.
 */
void on_first_rank(MPI_Comm communicator, const char *const what,
                   const std::function<void()> &work);
} // namespace sabot

#endif
