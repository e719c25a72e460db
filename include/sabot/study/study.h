#ifndef sabot_study_study_h
#define sabot_study_study_h

#include "sabot/base/error.h"

#include <string>
#include <vector>

namespace sabot
{
struct StudyArguments
{
  std::string file, folder;
  std::string runs; // folder of the runs; empty: FOLDER/runs
  std::vector<std::string> overrides;
  unsigned int n_processes = 0; // 0: as the study says
  bool retry = false;           // run again what failed
  bool renew = false;           // and what another build of the program made
  bool quiet = false;
  bool list = false; // only say which runs there are
};

/**
 * Run what is missing of a study, each run as a process of its own in
 * FOLDER/runs/<key> (or where @p runs says: studies may share runs), where the
 * key is a hash of the program's version and the run's expanded parameters;
 * then write study.csv, study.h5, report.html and charts/. Runs that are
 * complete or failed are kept, interrupted ones resumed; what another build
 * made is named, or with @p renew run again. Must be called before MPI is
 * initialized. InputError, IOError.
 */
ExitCode run_study(const StudyArguments &arguments);
} // namespace sabot

#endif
