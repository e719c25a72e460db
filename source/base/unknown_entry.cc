// What is said of an entry that is not declared.
#include "sabot/base/unknown_entry.h"

#include "sabot/base/declared_tree.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/text.h"

namespace sabot
{
namespace
{
using nlohmann::ordered_json;

/** Sections in which an entry of this name is declared. */
void find_entry(const ordered_json &tree, const std::string &name,
                const std::string &path, std::vector<std::string> &found)
{
  for (const auto &item : tree.items())
    if (is_entry(item.value()))
    {
      if (item.key() == name)
        found.push_back(path.empty() ? "the top level" : path);
    }
    else
      find_entry(item.value(), name,
                 path.empty() ? item.key() : path + "/" + item.key(), found);
}

/** What is allowed in a section, or where it can be read when @p message gives
    no other advice, for its end. */
std::string list_of(const std::vector<std::string> &allowed,
                    const std::string &message)
{
  constexpr std::size_t most = 30;
  if (allowed.empty())
    return "";
  if (allowed.size() <= most)
    return (message.back() == '?' ? " Allowed here: " : "; allowed here: ") +
           join(allowed, ", ");
  return message.find(';') == std::string::npos
             ? "; `sabot parameters` lists the entries of all sections"
             : "";
}

/** Which other kind of subsection beside @p path has the entry @p name, in
    words, by what @p declare_all declares of all kinds; "" for none. */
std::string
kind_with_entry(const std::function<void(Parameters &)> &declare_all,
                const std::string &path, const std::string &name)
{
  Parameters all;
  declare_all(all);
  const ordered_json tree = declared_tree(all);
  const std::string section = path.substr(0, path.find('/'));
  std::vector<std::string> found;
  if (tree.contains(section))
    find_entry(tree[section], name, "", found);
  if (found.empty())
    return "";
  // "<FEM file>" is a kind of body, "<name>" stands for all types.
  const std::string kind = found[0].substr(0, found[0].find('/'));
  const std::size_t blank = kind.find(' ');
  if (found[0] != kind || kind.size() < 3)
    return "";
  return blank == std::string::npos
             ? "another \"Type\""
             : "\"Discretization = " + kind.substr(1, blank - 1) +
                   "\" with \"Geometry = " +
                   kind.substr(blank + 1, kind.size() - blank - 2) + "\"";
}
} // namespace

std::string
about_unknown_entry(const UnknownEntry &unknown,
                    const std::vector<std::string> &allowed,
                    const std::function<void(Parameters &)> &declare_all)
{
  const auto &[tree, above, wanted, is_last] = unknown;
  std::string message = std::string("unknown ") +
                        (is_last ? "entry" : "subsection") + " \"" + wanted +
                        "\" in " +
                        (!above.empty()           ? above
                         : tree.contains("Scene") ? "the study"
                                                  : "the scene");
  std::vector<std::string> elsewhere;
  if (is_last)
    find_entry(tree, wanted, "", elsewhere);
  const std::string other =
      is_last && elsewhere.empty() && declare_all && !above.empty()
          ? kind_with_entry(declare_all, above, wanted)
          : "";
  if (!elsewhere.empty())
    message += "; an entry of this name belongs to " + elsewhere[0];
  else if (!other.empty())
    message += "; an entry of this name is for " + other;
  else
    message += suggestion(wanted, allowed);
  return message + list_of(allowed, message);
}
} // namespace sabot
