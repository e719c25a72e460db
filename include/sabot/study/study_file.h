#ifndef sabot_study_study_file_h
#define sabot_study_study_file_h

#include "sabot/base/parameter_file.h"

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/** A parameter of a study: one value sets one or more entries of the scene. */
struct StudyParameter
{
  /** What its values do; convergence is judged over spacings. */
  enum class Role
  {
    knob,    // trades speed for accuracy
    spacing, // its values are sizes of the discretization
    physics, // changes the problem
    repeat // moves it by next to nothing: runs by it are repeats of each other
  };
  std::string name; // its subsection in the study
  Role role;
  /** What each value sets: "Section/Name" of the scene, or "Scene" for the
      scene's file itself. */
  std::vector<std::string> entries;
  /** What one value writes into the scene. */
  struct Value
  {
    std::string label;             // in tables and charts
    std::vector<std::string> text; // per entry, as the scene takes it
    /** The first quantity in the label, SI: the spacing, or where the value
        stands on an axis; NaN when the label is a word. */
    double number;
  };
  std::vector<Value> values; // the first is the base
  OverrideOrigin origin;
};

/** A quantity of result.json that a study looks at, and what an experiment has
    found for it. */
struct StudyQuantity
{
  std::string name;   // of the scene's quantity
  std::string source; // of the measured value
  std::string over;   // quantity over which its history is drawn, too; or empty
  /** Parameter of impact velocities over which it is fitted as a ballistic
      curve (BallisticFit); or empty. */
  std::string ballistic;
  /** What an experiment found: impact and residual velocity [m/s]. */
  std::vector<std::pair<double, double>> measured_curve;
  double measured = std::numeric_limits<double>::quiet_NaN(); // SI; NaN: none
  std::string measured_text; // as the file has it
};

/** One run of a study: what is set in which scene. Two may have one key, when
    different choices give the same scene; they are run once. */
struct StudyRun
{
  std::vector<std::size_t> choice;    // per parameter: number of its value
  std::string scene;                  // file
  std::vector<std::string> overrides; // "Section/Name=value"
  /** 16 digits of the SHA-256 of the program's version and the expanded
      parameters: the name of the run's folder. */
  std::string key;
  /** Of each override, in the study file. */
  std::vector<OverrideOrigin> origins = {};
};

/**
 * A study file: a scene, parameters with lists of values, quantities. Reads
 * and checks everything, including each run's parameters, before anything is
 * run; InputError names file and line. Runs are each value with the first
 * values of all other parameters, or all combinations (a grid).
 *
 *     set Scene = ../perforation/base.prm     # beside the study's file
 *     subsection Parameters
 *       subsection spacing                    # any name
 *         set Role    = spacing
 *         set Entries = Bodies/core/Nodal spacing; Bodies/plate/Cell size
 *         set Values  = 1.5 mm; 1.05 mm; 0.75 mm
 *       end
 *     end
 *     subsection Quantities
 *       subsection residual velocity          # of the scene
 *         set Measured value = 217 m/s
 *       end
 *     end
 *
 * A value with vertical bars has a part for each entry: "1.5 mm | 3 mm".
 */
struct StudyFile
{
  /** @p overrides: "Section/Name=value" of the study's own entries. */
  StudyFile(const std::string &file, const std::vector<std::string> &overrides);

  std::string title, scene;          // scene: the base's file
  bool is_grid;                      // all combinations
  unsigned int n_processes, n_ranks; // at a time; of each run
  std::vector<std::string> fixed;    // overrides of every run
  OverrideOrigin origin_of_fixed;
  bool has_pictures;                        // of sections through the runs
  std::string picture_field, picture_times; // as `sabot picture` takes them
  std::vector<StudyParameter> parameters;
  std::vector<StudyQuantity> quantities;
  std::vector<StudyRun> runs; // the first is the base

  /** Declare the entries of a study with parameters and quantities of these
      names. */
  static void declare(Parameters &prm,
                      const std::vector<std::string> &parameter_names,
                      const std::vector<std::string> &quantity_names);

  /** Whether a run differs from the base in no other parameter than @p p; the
      base does. */
  bool varies_only(const StudyRun &run, const std::size_t p) const;
  /** The values of a run's parameters that are not the base's, in words,
      @p except that of one. */
  std::string label(const StudyRun &run,
                    const std::size_t except = std::size_t(-1)) const;

private:
  /** All but the runs. */
  void read(const ParameterFile &file);
  /** Which combinations of values there are. */
  void list_runs();
  /** The run with value @p choice of each parameter; checks its scene. */
  StudyRun make_run(const std::vector<std::size_t> &choice) const;
};
} // namespace sabot

#endif
