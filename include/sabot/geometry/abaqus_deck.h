#ifndef sabot_geometry_abaqus_deck_h
#define sabot_geometry_abaqus_deck_h

#include "sabot/geometry/file_mesh.h"

#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sabot
{
/** A line of data between commas, its parts trimmed. */
struct AbaqusRow
{
  std::vector<std::string_view> parts;
  std::size_t file = 0, line = 0; // place in AbaqusDeck::files
  bool goes_on = false;           // it ends with a comma
};

/** A keyword with its options and the lines of data below it. */
struct AbaqusBlock
{
  std::string keyword; // upper case, without blanks: "SOLIDSECTION"
  std::string shown;   // as it stands there: "*Solid Section"
  std::map<std::string, std::string> options; // names in upper case
  std::vector<std::string_view> lines;
  std::vector<std::size_t> numbers; // of these lines in the file
  std::size_t file = 0, line = 0;

  /** The value of an option, "" where it has none or is not there. */
  std::string option(const std::string &name) const
  {
    const auto found = options.find(name);
    return found == options.end() ? "" : found->second;
  }
  bool has(const std::string &name) const { return options.count(name) > 0; }
};

/**
 * The keywords of an Abaqus input deck, in order, with those of the decks that
 * it includes: comments gone, continued keyword lines joined.
 */
class AbaqusDeck
{
public:
  /** Throws InputError for files that cannot be opened, includes of includes
      beyond the eighth, text before the first keyword, and keywords and data
      that are not UTF-8; comments and headings may be anything. */
  explicit AbaqusDeck(const MeshFile &file);

  std::vector<AbaqusBlock> blocks;
  std::vector<std::string> notes; // on text that is passed over

  /** The number @p i of the lines below a keyword, taken apart. */
  AbaqusRow row(const AbaqusBlock &block, const std::size_t i) const;
  /** Throws InputError with file and line. */
  [[noreturn]] void refuse(const std::string &why, const AbaqusBlock &at) const;
  [[noreturn]] void refuse(const std::string &why, const AbaqusRow &at) const;

private:
  void read(const MeshFile &file, const int depth);
  /** Refuses a line that is not UTF-8; where it @p is_passed_over, notes the
      first of the file. */
  void check_encoding(const MeshFile &file, const std::string_view line,
                      const std::size_t number, const bool is_passed_over);
  /** A block of the same keyword and options for lines of another file: an
      included one may hold data alone. */
  void go_on(const std::size_t file_number, const std::size_t number);
  /** Adds the keyword that the line begins; @p at is moved behind lines that
      continue it. */
  void add_keyword(std::string line, std::string_view text, std::size_t &at,
                   std::size_t &number, const std::size_t file_number);

  std::deque<std::string> texts; // what the blocks look into
  std::vector<MeshFile> files;
  std::string noted; // file of the last note
};

/** Upper case, as Abaqus compares names. */
std::string upper_case(std::string text);
} // namespace sabot

#endif
