#ifndef sabot_study_study_h
#define sabot_study_study_h

#include "sabot/base/error.h"

#include <string>
#include <vector>

namespace sabot
{
/** What `sabot study` is asked for. */
struct StudyArguments
{
  std::string file;                   // the study's
  std::string folder;                 // for tables, charts and report
  std::string runs;                   // folder of the runs; empty: FOLDER/runs
  std::vector<std::string> overrides; // of the study's entries
  unsigned int n_processes = 0;       // 0: as the study says
  bool retry = false;                 // run again what failed
  bool renew = false; // and what another build of the program made
  bool quiet = false;
  bool list = false; // only say which runs there are
};

/**
 * Run what is missing of a study, each run as a process of its own in
 * FOLDER/runs/<key> (or where @p runs says: studies may share runs), where the
 * key is a hash of the program's version and the run's expanded parameters;
 * then write study.csv, study.h5, report.html and charts/. Runs that are
 * complete or failed are kept, interrupted ones resumed; what another build
 * made is named, or with @p renew run again. The report comes also where runs
 * failed: they stand in it. Must be called before MPI is initialized.
 * @return interrupted when a signal stopped it, physics_failed when a run has
 * not completed. InputError, IOError.
 */
ExitCode run_study(const StudyArguments &arguments);
} // namespace sabot

#endif
