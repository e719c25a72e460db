#ifndef sabot_base_parameters_h
#define sabot_base_parameters_h

#include "sabot/base/dimension.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dealii
{
class ParameterHandler;
namespace Patterns
{
class PatternBase;
}
} // namespace dealii

namespace sabot
{
/**
 * What an entry accepts. Cheap to copy; made by the functions below. Keeps
 * deal.II's parameter handler (four seconds of parsing per file) out of the
 * files that only declare and read entries.
 */
class Pattern
{
public:
  explicit Pattern(std::shared_ptr<const dealii::Patterns::PatternBase> base)
      : base(std::move(base))
  {
  }
  /**
   * Whether a file may have @p text; a unit of another dimension or a value out
   * of range is no match.
   */
  bool match(const std::string &text) const;
  /** What is right, in words, as the manual and messages say it. */
  std::string description() const;
  const dealii::Patterns::PatternBase &get() const { return *base; }

private:
  std::shared_ptr<const dealii::Patterns::PatternBase> base;
};

// What entries may be. The description of each says in the manual and in
// messages what is right.

/** Any text, also none. */
Pattern any_text();
/** Names separated by commas, up to 1000; also none. split_names() takes them
    apart. */
Pattern name_list();
/** One of the words in @p words, separated by '|'; a word may have blanks. */
Pattern one_of(const std::string &words);
/** "true" or "false". */
Pattern boolean();
/** A whole number in [low, high]; a bound that is not given is none. */
Pattern integer(const int low = -2147483647, const int high = 2147483647);
/** A number with an optional unit ("12.7 mm", "324 MPa", "1e-4"), without one
    in SI; refuses other dimensions and values outside [min, max] (SI). */
Pattern quantity(const Dimension dimension, const double min = -1e300,
                 const double max = 1e300);
/** @p n_min to @p n_max such numbers, separated by commas. */
Pattern quantities(const Dimension dimension, const unsigned int n_min,
                   const unsigned int n_max, const double min = -1e300,
                   const double max = 1e300);
/** @p word, or what @p other accepts: a name for a special case that would
    otherwise hide behind a number ("never", "yield"). */
Pattern word_or(const std::string &word, const Pattern &other);

/**
 * Declared entries in nested subsections, and their values: a facade of
 * deal.II's ParameterHandler with the part that models need to declare and to
 * read themselves. Names are case-sensitive; all methods act on the present
 * subsection.
 *
 *     prm.declare_entry("Yield stress", "0",
 *                       quantity(Dimension::pressure, 0., 1e12),
 *                       "Initial yield stress.");
 *     ...                                    // a file sets "324 MPa"
 *     const double Y = get_quantity(prm, "Yield stress"); // 3.24e8
 *
 * Defaults are text, too, with their unit: the manual shows them as a file
 * would have them. Sets and gets convert once, at the start of a run; models
 * keep numbers.
 */
class Parameters
{
public:
  Parameters();
  ~Parameters();
  Parameters(const Parameters &) = delete;
  Parameters &operator=(const Parameters &) = delete;

  /** Declare an entry of the present subsection.
      @param standard  its default, as a file would have it; it must match
                       @p pattern
      @param meaning   for the manual: what it does, in a sentence or two, with
                       the formula's letter; the pattern says unit and range */
  void declare_entry(const std::string &name, const std::string &standard,
                     const Pattern &pattern, const std::string &meaning = "");
  /** The same for an entry that trades speed for accuracy: result.json lists
      these with the values in force. */
  void declare_knob(const std::string &name, const std::string &standard,
                    const Pattern &pattern, const std::string &meaning);
  /** Defaults of knobs, by name, that stand in place of those that
      declare_knob() gets, wherever such a knob is declared from now on. */
  void set_standards(const std::map<std::string, std::string> &of_knobs)
  {
    standards = of_knobs;
  }
  /** Makes a declared entry of the present subsection a knob. */
  void mark_as_knob(const std::string &name);
  /** Path and value of all knobs, in the order of their declaration. */
  std::vector<std::pair<std::string, std::string>> knobs();
  /** Go down into the subsection @p name of the present one, which comes into
      being with its first entry; and up again. See EnteredSubsection. */
  void enter_subsection(const std::string &name);
  void leave_subsection();

  /** Text of an entry. One that is not declared is a mistake of the program:
      std::logic_error. */
  std::string get(const std::string &name) const;
  /** Value of an entry declared with boolean(). */
  bool get_bool(const std::string &name) const;
  /** Value of an entry declared with integer(). */
  long get_integer(const std::string &name) const;
  /** Whether the present subsection has this entry; for subsections never. */
  bool is_declared(const std::string &name) const;
  /** Names of the entries declared here, subsections left out. */
  std::vector<std::string> entry_names() const;
  /** @return false where the entry does not accept @p value. */
  bool set(const std::string &name, const std::string &value);

  /** deal.II's object, for reading and printing whole files. */
  dealii::ParameterHandler &handler() { return *prm; }
  const dealii::ParameterHandler &handler() const { return *prm; }

private:
  void expect_declared(const std::string &name) const;

  std::unique_ptr<dealii::ParameterHandler> prm;
  std::vector<std::string> section;                // present
  std::set<std::vector<std::string>> declared;     // sections and name
  std::vector<std::vector<std::string>> all_knobs; // sections and name
  std::map<std::string, std::string> standards;    // of knobs, set_standards()
};

/** Enters Section/name of the parameters while it lives: also an exception
    leaves them again. */
class EnteredSubsection
{
public:
  EnteredSubsection(Parameters &prm, const std::string &section,
                    const std::string &name)
      : prm(prm)
  {
    prm.enter_subsection(section);
    prm.enter_subsection(name);
  }
  ~EnteredSubsection()
  {
    prm.leave_subsection();
    prm.leave_subsection();
  }
  EnteredSubsection(const EnteredSubsection &) = delete;
  EnteredSubsection &operator=(const EnteredSubsection &) = delete;

private:
  Parameters &prm;
};

// Values of entries of the present subsection; std::logic_error for one that
// was not declared.

/** Value in SI units of an entry declared with quantity(). */
double get_quantity(const Parameters &prm, const std::string &name);
/** The same of an entry declared with word_or(word, quantity()): nothing where
    the entry is the word. */
std::optional<double> get_optional_quantity(const Parameters &prm,
                                            const std::string &name);
/** Values in SI units of an entry declared with quantities(). */
std::vector<double> get_quantities(const Parameters &prm,
                                   const std::string &name);
/** The first three of them. */
std::array<double, 3> get_vector(const Parameters &prm,
                                 const std::string &name);
/** SI value of a text that quantity() accepts for some dimension, e.g. "1.27
    mm"; nothing where there is no such dimension. */
std::optional<double> read_quantity(const std::string &text);
/** Whether @p text is a quantity that can be told in @p unit ("m/s"): a number
    alone, or with a unit of the same dimension. */
bool is_told_in(const std::string &text, const std::string &unit);
/** Names of a text that name_list() accepts, trimmed, empty ones dropped. */
std::vector<std::string> split_names(const std::string &text);
} // namespace sabot

#endif
