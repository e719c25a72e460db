#ifndef sabot_study_results_h
#define sabot_study_results_h

#include "sabot/output/history.h"
#include "sabot/study/analysis.h"
#include "sabot/study/ballistic_fit.h"
#include "sabot/study/chart.h"
#include "sabot/study/study_file.h"

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace sabot
{
/** What one run of a study gave. Numbers that it has not are NaN: failed runs
    stand in the tables beside the others. */
struct StudyOutcome
{
  /** As in result.json: "completed", "failed", "interrupted"; and why. */
  std::string status = "missing", reason;
  std::vector<double> quantities; // per quantity at the end, SI; NaN: none
  std::vector<std::string> units; // per quantity
  // [s] of all ranks, [s] by the clock, largest of the run.
  double cpu_seconds = std::numeric_limits<double>::quiet_NaN(),
         wall_seconds = std::numeric_limits<double>::quiet_NaN(),
         energy_residual = std::numeric_limits<double>::quiet_NaN();
  double steps = 0.;
  double items = 0.; // cells and particles of all bodies
  /** Parts of the energy balance at the end, as in result.json. [J] */
  std::vector<std::pair<std::string, double>> energy;
  std::string zone;    // its verdicts in words
  std::string picture; // file with a section through it; or empty
  /** Time and quantities; empty when there is no history. */
  History::Table history;

  double energy_of(const std::string &part) const; // NaN: none
  bool is_complete() const { return status == "completed"; }
};

/** Read result.json and history.h5 of a run's folder; a folder without them
    gives status "missing". The order of @p quantities is that of the outcome's.
    Never throws for what is missing or damaged. */
StudyOutcome read_outcome(const std::string &folder,
                          const std::vector<StudyQuantity> &quantities);

/** Against what a quantity's error counts; NaN where there is nothing. */
struct ErrorReference
{
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string origin; // in words: "measured (source)", ...
};

/** Runs that differ in one parameter only, which is a spacing: at least two. */
struct ConvergenceSeries
{
  std::size_t parameter, quantity;    // their numbers in the study
  std::string others;                 // what the other parameters are, in words
  std::vector<double> spacing, value; // [n_runs], SI
  Convergence fit;                    // what the values tend to
};

/** Runs that are repeats of each other. */
struct RepeatScatter
{
  std::size_t quantity;
  std::string others; // what the parameters are, in words
  std::size_t n = 0;
  double mean = 0.;
  double deviation = 0.; // standard deviation of one run, n - 1
  double range = 0.;     // largest less least
};

/** A quantity over impact velocities, for one choice of the others. */
struct BallisticSeries
{
  std::size_t parameter, quantity;
  std::vector<std::size_t> choice; // of the other parameters; 0 at this one
  std::string others;              // the same in words
  BallisticFit fit;
};

/**
 * Everything that a report shows: outcomes, and what follows from them for each
 * quantity, the reference of its errors, convergence, prices, Pareto front.
 * All found at construction.
 * What other runs than complete ones gave does not count.
 *
 * The report shades the runs of the Pareto fronts, and lists the prices: what a
 * value of a parameter saves in CPU time and moves in the quantity, against the
 * base's value, all else equal.
 */
struct StudyResults
{
  /** @p outcomes: one for each run of @p study, which must outlive this. */
  StudyResults(const StudyFile &study, std::vector<StudyOutcome> outcomes);

  const StudyFile &study;
  std::vector<StudyOutcome> outcomes;         // per run
  std::vector<ErrorReference> references;     // per quantity
  std::vector<ConvergenceSeries> convergence; // spacings only, means of repeats
  std::vector<RepeatScatter> scatter;         // where runs are repeated
  std::vector<BallisticSeries> ballistic;     // where it is asked for
  std::vector<std::vector<Price>> prices;     // per quantity
  std::vector<std::vector<std::size_t>> fronts; // per quantity: runs

  /** |value - reference|/|reference|; of a reference of 0, to which nothing is
      relative, |value - reference| in the quantity's unit. */
  double error(const std::size_t run, const std::size_t quantity) const;
  /** Whether errors of a quantity are relative. */
  bool has_relative_error(const std::size_t quantity) const
  {
    return references[quantity].value != 0.;
  }
  /** What error() is, for headings: "relative error of speed", "difference of
      speed". */
  std::string error_name(const std::size_t quantity) const;
  /** Its unit in tables of numbers: "1", or the quantity's. */
  std::string error_unit(const std::size_t quantity) const;
  /** The values of a run's parameters; where one is varied at a time, those
      that set it apart from the base, or "base". */
  std::string label(const std::size_t run) const;
  /** Of a quantity, as the first run that has it says; empty where none has. */
  std::string unit(const std::size_t quantity) const;
  /** Everything worth drawing, in the report's order. */
  std::vector<Chart> charts() const;

private:
  /** Whether a run ended well and has the quantity. */
  bool is_usable(const std::size_t run, const std::size_t quantity) const;
  /** Add the series of a quantity over a parameter that is a spacing. */
  void find_convergence(const std::size_t parameter,
                        const std::size_t quantity);
  /** Mean and scatter of a quantity over runs that are repeats. */
  void find_scatter(const std::size_t quantity);
  /** Fits of a quantity over impact velocities. */
  void find_ballistic(const std::size_t quantity);
  /** A run's choice with the parameters that repeat it at their first value. */
  std::vector<std::size_t> without_repeats(const std::size_t run) const;
  /** The measured value; where there is none the limit of the base's
      convergence, else the value of the run that took longest. */
  ErrorReference find_reference(const std::size_t quantity) const;
  /** Add prices and Pareto front of a quantity, whose reference is known. */
  void find_prices(const std::size_t quantity);
};

/** Names of the parts of the energy that are not zero in every run, without the
    total: columns of the tables. */
std::vector<std::string> energy_parts(const StudyResults &results);

/** A row for each run, as RFC 4180 has it: parameters, quantities with errors,
    costs, energies, verdicts. No value is an empty field. IOError. */
void write_csv(const StudyResults &results, const std::string &file);
/** The numbers of that as table "runs", and the histories of the quantities as
    "history of run <number>". IOError. */
void write_hdf5(const StudyResults &results, const std::string &file);
/** One HTML page that needs no other file: tables, @p charts as SVG, pictures
    within it. IOError. */
void write_report(const StudyResults &results, const std::vector<Chart> &charts,
                  const std::string &file);
} // namespace sabot

#endif
