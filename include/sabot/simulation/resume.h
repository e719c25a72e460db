#ifndef sabot_simulation_resume_h
#define sabot_simulation_resume_h

#include <mpi.h>

#include <string>
#include <vector>

namespace sabot
{
/** Where a run in a results folder can go on. */
struct ResumePoint
{
  std::string checkpoint;            // the newest whole file
  std::string scene;                 // its parameters, as a file
  double time = 0.;                  // of its state [s]
  std::vector<std::string> warnings; // e.g. damaged files passed over
};

/**
 * What a run writes as parameters.prm: version and identity of the run, then
 * every entry of its scene (@p parameters). The identity is a hash of those
 * entries on which the state depends: equal runs have the same, and no entry of
 * another run is resumed by mistake.
 */
std::string parameters_file(const std::string &version,
                            const std::string &parameters);

/**
 * Find the newest valid checkpoint of the run of a results folder and put its
 * parameters into parameters.prm. Files of other runs that got among them are
 * passed over. InputError when there is none, when it was written on another
 * number of ranks, or when @p overrides would change what the state depends on.
 * Collective; throws on all ranks.
 *
 * @p overrides: entries as the command line gives them, "path = value"; those
 * on when a run ends and when checkpoints are due are free, all others are
 * refused.
 */
ResumePoint find_resume_point(const std::string &folder,
                              const std::vector<std::string> &overrides,
                              MPI_Comm communicator);
} // namespace sabot

#endif
