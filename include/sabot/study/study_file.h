#ifndef sabot_study_study_file_h
#define sabot_study_study_file_h

#include <limits>
#include <string>
#include <vector>

namespace sabot
{
class Parameters;
}

namespace sabot
{
class ParameterFile;

/** A parameter of a study: one value sets one or more entries of the scene. */
struct StudyParameter
{
  enum class Role
  {
    knob,    // trades speed for accuracy
    spacing, // its values are sizes of the discretization
    physics  // changes the problem
  };
  std::string name;
  Role role;
  std::vector<std::string> entries; // "Section/Name", or "Scene" for the file
  struct Value
  {
    std::string label;
    std::vector<std::string> text; // per entry
    double number;                 // of the label; NaN when it is none [SI]
  };
  std::vector<Value> values; // the first is the base
};

/** A quantity of result.json that a study looks at. */
struct StudyQuantity
{
  std::string name, source;
  std::string over; // quantity over which its history is drawn, too; or empty
  double measured = std::numeric_limits<double>::quiet_NaN();
};

/** One run of a study: what is set in which scene. */
struct StudyRun
{
  std::vector<std::size_t> choice; // per parameter
  std::string scene;
  std::vector<std::string> overrides;
  std::string key; // of its expanded parameters
};

/**
 * A study file: a scene, parameters with lists of values, quantities. Reads
 * and checks everything, including each run's parameters; InputError.
 */
struct StudyFile
{
  StudyFile(const std::string &file, const std::vector<std::string> &overrides);

  std::string title, scene;
  bool is_grid;
  unsigned int n_processes, n_ranks;
  std::vector<std::string> fixed;           // overrides of every run
  bool has_pictures;                        // of sections through the runs
  std::string picture_field, picture_times; // as `sabot picture` takes them
  std::vector<StudyParameter> parameters;
  std::vector<StudyQuantity> quantities;
  std::vector<StudyRun> runs; // the first is the base

  static void declare(Parameters &prm,
                      const std::vector<std::string> &parameter_names,
                      const std::vector<std::string> &quantity_names);

  /** Whether a run differs from the base in no other parameter than @p p. */
  bool varies_only(const StudyRun &run, const std::size_t p) const;
  /** The values of a run's parameters that are not the base's, in words,
      @p except that of one. */
  std::string label(const StudyRun &run,
                    const std::size_t except = std::size_t(-1)) const;

private:
  void read(const ParameterFile &file);
  void list_runs();
  /** The run with value @p choice of each parameter; checks its scene. */
  StudyRun make_run(const std::vector<std::size_t> &choice) const;
};
} // namespace sabot

#endif
