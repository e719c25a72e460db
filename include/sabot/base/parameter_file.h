#ifndef sabot_base_parameter_file_h
#define sabot_base_parameter_file_h

#include "sabot/base/error.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/parameters.h"

#include <functional>
#include <iosfwd>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace sabot
{
/** Where an override comes from that is not of the command line: what names the
    entry, and what gives the value ("study.prm:12"). */
struct OverrideOrigin
{
  std::string entry, value;
};

/**
 * A parameter file in deal.II's text format with all its includes, which are
 * looked up beside the including file, and overrides from the command line.
 * Keeps for every entry the file and line it comes from, so that each problem
 * is answered by one line that says where, what, and what would be right.
 * Everything that is wrong throws InputError.
 *
 *     # a comment, to the end of the line
 *     include base.prm              # its entries, as if they stood here
 *     set End time = 60 us          # of the present subsection
 *     subsection Bodies
 *       subsection plate            # may be opened more than once
 *         set Size = 76 mm, 76 mm, \
 *                    26.3 mm        # a backslash continues a line
 *       end
 *     end
 *
 * Text is UTF-8, with or without a byte order mark, with the line ends of any
 * system. A file that one section includes twice is read once.
 *
 * Blanks around names and values do not count, upper and lower case do. A
 * later file wins over an earlier one, so that an including file changes what
 * it includes; within one file an entry stands once. Reading knows nothing of
 * what is declared: the scene first asks what the file chooses, declares what
 * these choices have, and then lets parse_into() check every entry.
 */
class ParameterFile
{
public:
  /** @p overrides: "Section/Sub/Name=value"; later values replace earlier
      ones, but one file may set an entry only once. @p origins: of each; none:
      the command line. */
  ParameterFile(const std::string &file,
                const std::vector<std::string> &overrides,
                const std::vector<OverrideOrigin> &origins = {});

  /** Names of the subsections directly below @p path ("Bodies"), in the order
      in which files and overrides first name them. */
  std::vector<std::string> subsections(const std::string &path) const;
  /** Whether a file or an override sets the entry @p path
      ("Bodies/plate/Size"); defaults do not count. */
  bool is_set(const std::string &path) const;
  /** The same by somebody who might have left it alone: not by a file that
      writes all entries out, as parameters.prm of a run does. */
  bool is_chosen(const std::string &path) const;
  /** Text of an entry, or @p standard where it is not set. */
  std::string value(const std::string &path, const std::string &standard) const;
  /** "scene.prm:12" of an entry or subsection, "" where it is not set; for a
      path that is not set, the nearest enclosing subsection that is. */
  std::string origin(const std::string &path) const;

  /** The file that sets an entry; for one that is not set, or by an override,
      the one that was given. */
  std::string file_of(const std::string &path) const;
  /** "file:line: entry: message" of what is wrong with an entry. */
  std::string located(const InputError &error) const;

  /** Set in @p prm what the file sets. InputError, with file and line, the
      nearest name, and what is allowed there, for an entry that is not
      declared or does not accept its value. @p declare_all: declares the
     entries of all kinds, so that one of another kind can be told from a
     misspelled one. */
  void
  parse_into(Parameters &prm,
             const std::function<void(Parameters &)> &declare_all = {}) const;
  /** Entries that go by a name of an earlier version (entry_aliases.h), one
      line for each name; lookups know the present names only. */
  const std::vector<std::string> &notes() const { return said; }

  const std::string file_name; // as given: the top of the includes

private:
  /** What one line, or one override, sets. */
  struct SetEntry
  {
    std::vector<std::string> section;
    std::string name, value, origin, file;
    std::string named_at = {}; // where an override names it; "": origin
  };
  /** Read a file into the subsection @p section; @p included_at is where it
      was included, @p open_files those that are being read. */
  void read(const std::string &file, const std::string &included_at,
            std::vector<std::string> &section,
            std::vector<std::string> &open_files);
  void override_by(const std::string &text, const OverrideOrigin &origin);
  /** Enter under the present name; the last of several files wins. */
  void add(const SetEntry &entry);

  std::vector<SetEntry> entries;             // in order, each path once
  std::map<std::string, std::size_t> number; // path -> entries
  std::vector<std::pair<std::string, std::string>> sections; // path, origin
  std::set<std::pair<std::string, std::string>> included;    // section, file
  std::set<std::string> listings; // files that write all entries out
  std::set<std::string> renamed;  // old names that were met
  std::vector<std::string> said;  // about them
};

/** The declared entries as tables in Markdown, one for each subsection: name,
    default, meaning, allowed values. */
void print_tables(const Parameters &prm, std::ostream &out);

/** The same below a title. */
void print_manual(const Parameters &prm, std::ostream &out);

/** The declared entries with their present values in a @p format that deal.II
   offers: "prm", "json" or "xml"; anything else: its own description. */
void print_parameters(const Parameters &prm, const std::string &format,
                      std::ostream &out);

/** All parameters with their present values, as a parameter file that gives
    the same run again: what a run leaves as parameters.prm. */
void print_expanded(const Parameters &prm, std::ostream &out);
} // namespace sabot

#endif
