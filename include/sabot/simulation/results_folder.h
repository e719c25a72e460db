#ifndef sabot_simulation_results_folder_h
#define sabot_simulation_results_folder_h

#include <mpi.h>

#include <string>

namespace sabot
{
/**
 * Make sure that a new run may write into @p folder, which need not exist yet.
 * InputError where it holds the results of a finished or interrupted run, or a
 * checkpoint from which one could go on, unless @p overwrite. What a failed run
 * left is replaced without being told.
 *
 * Then removes what an earlier run of any scene may have left there: frames,
 * sabot.pvd, history.h5, result.json, checkpoints, by the names that runs give
 * them, and nothing else, so that old frames do not stand beside new ones.
 * IOError where something of this cannot be removed. Collective; throws on all
 * ranks, before anything is written.
 */
void claim_results_folder(const std::string &folder, const bool overwrite,
                          MPI_Comm communicator);
} // namespace sabot

#endif
