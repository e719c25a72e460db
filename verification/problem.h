#ifndef verification_problem_h
#define verification_problem_h

#include <mpi.h>

#include <string>
#include <vector>

namespace sabot
{
/** One comparison of a verification problem with an exact, published or
    converged answer. */
struct Check
{
  enum class Kind
  {
    near,     // |got - expected| <= tolerance
    at_most,  // got <= expected + tolerance
    at_least, // got >= expected - tolerance
    reported  // a measurement without a verdict
  };
  std::string name;
  double expected = 0., got = 0., tolerance = 0.; // all in unit
  std::string unit, source;
  Kind kind = Kind::near;

  /** False for anything that is not a number. */
  bool pass() const;
};

/** A verification problem: `sabot verify NAME` and, unless it is long, a
    test. */
struct VerificationProblem
{
  std::string name; // words joined by hyphens
  std::string description;
  /** One or more words. quick: part of the tests; long: minutes; extremes: the
      suite of extreme conditions. */
  std::string label;
  std::vector<Check> (*run)();

  bool has_label(const std::string &word) const;
};

/** All problems, sorted by name; filled by RegisterProblem. */
std::vector<VerificationProblem> &verification_problems();

/** Makes a problem known: one static object at the end of its file. */
struct RegisterProblem
{
  RegisterProblem(const VerificationProblem &problem);
};

/**
 * Run problems and print a line per check.
 * @param names of problems or labels; empty: all that are labeled quick.
 * @param json_file when not empty, the checks are written there as well.
 * @return whether all checks passed. Throws InputError for an unknown name.
 */
bool verify(const std::vector<std::string> &names,
            const std::string &json_file);

/** Print name, label and description of every problem. */
void list_problems();

/** The same as a page of the reference, in Markdown. */
std::string problems_page();
} // namespace sabot

#endif
