// Sets of nodes and elements of Abaqus decks.
#include "sabot/geometry/abaqus_model.h"
#include "sabot/geometry/mesh_text.h"

#include <algorithm>

namespace sabot
{
namespace
{
void sort_out(std::vector<FileIndex> &members)
{
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
}
} // namespace

const std::vector<FileIndex> &AbaqusModel::find_set(AbaqusPart &part,
                                                    const AbaqusPart::Kind kind,
                                                    const std::string &name)
{
  AbaqusSets &sets = part.sets[kind];
  // Marked before its blocks are read: sets that name each other end, too.
  if (sets.found.insert(name).second)
  {
    std::vector<FileIndex> members = sets.members[name];
    const auto blocks = sets.blocks.find(name);
    if (blocks != sets.blocks.end())
      for (const AbaqusBlock *const block : blocks->second)
        add_block(part, kind, *block, members);
    sort_out(members);
    sets.members[name] = std::move(members);
  }
  return sets.members[name];
}

void AbaqusModel::add_block(AbaqusPart &part, const AbaqusPart::Kind kind,
                            const AbaqusBlock &block,
                            std::vector<FileIndex> &found)
{
  AbaqusPart *of = &part;
  std::size_t first = 0;
  if (block.has("INSTANCE"))
  {
    const AbaqusInstance *const instance =
        find_instance(block.option("INSTANCE"));
    if (instance == nullptr)
      deck.refuse("there is no instance \"" + block.option("INSTANCE") + "\"",
                  block);
    of = instance->part;
    first = instance->first[kind];
  }
  std::vector<FileIndex> some;
  if (kind == AbaqusPart::node && block.has("ELSET"))
  {
    AbaqusRow at;
    at.file = block.file;
    at.line = block.line;
    std::vector<FileIndex> elements;
    add_members(*of, AbaqusPart::element, block.option("ELSET"), at, elements);
    for (const FileIndex e : elements)
      if (e < of->elements.size())
        some.insert(
            some.end(), of->elements[e].nodes.begin(),
            of->elements[e].nodes.begin() +
                (of->elements[e].shape == AbaqusPart::Shape::hexahedron ? 8
                 : of->elements[e].shape == AbaqusPart::Shape::quadrilateral
                     ? 4
                     : 0));
    sort_out(some);
  }
  else
    for (std::size_t i = 0; i < block.lines.size(); ++i)
    {
      const AbaqusRow row = deck.row(block, i);
      if (block.has("GENERATE"))
        add_range(of->sets[kind], row, 0, some);
      else
        for (const std::string_view what : row.parts)
          if (!what.empty())
            add_members(*of, kind, what, row, some);
    }
  for (const FileIndex member : some)
    found.push_back(first + member);
}

void AbaqusModel::add_range(const AbaqusSets &sets, const AbaqusRow &row,
                            const std::size_t first,
                            std::vector<FileIndex> &found)
{
  std::int64_t range[3] = {0, 0, 1};
  for (std::size_t i = 0; i < 3; ++i)
    if (i < row.parts.size())
    {
      const auto value = whole_number(row.parts[i]);
      constexpr std::int64_t largest = 1000000000000000;
      if (!value || *value < 1 || *value > largest)
        deck.refuse("GENERATE needs first, last, and step: whole numbers from "
                    "1 on",
                    row);
      range[i] = *value;
    }
  if (row.parts.size() < 2 || range[1] < range[0])
    deck.refuse("GENERATE needs first, last, and step", row);
  // Over what is shorter: the range may be made up.
  const std::size_t before = found.size();
  const std::uint64_t n = (range[1] - range[0]) / range[2] + 1;
  if (n < sets.of_label.size())
    for (std::int64_t label = range[0]; label <= range[1]; label += range[2])
    {
      const auto at = sets.of_label.find(label);
      if (at != sets.of_label.end())
        found.push_back(first + at->second);
    }
  else
    for (const auto &[label, number] : sets.of_label)
      if (label >= range[0] && label <= range[1] &&
          (label - range[0]) % range[2] == 0)
        found.push_back(first + number);
  n_missing += n - (found.size() - before);
}

void AbaqusModel::add_members(AbaqusPart &part, const AbaqusPart::Kind kind,
                              const std::string_view what, const AbaqusRow &row,
                              std::vector<FileIndex> &found)
{
  constexpr std::size_t most = 500000000;
  AbaqusPart *of = &part;
  std::size_t first = 0;
  std::string name(what);
  const std::size_t dot = name.find('.');
  if (dot != std::string::npos && &part == instances.front().part)
    if (const auto *const instance = find_instance(name.substr(0, dot)))
    {
      of = instance->part;
      first = instance->first[kind];
      name = name.substr(dot + 1);
    }
  if (const auto label = whole_number(name))
  {
    const auto at = of->sets[kind].of_label.find(*label);
    if (at == of->sets[kind].of_label.end())
      ++n_missing;
    else
      found.push_back(first + at->second);
    return;
  }
  if (name.size() > 1 && name.front() == '"' && name.back() == '"')
    name = name.substr(1, name.size() - 2);
  const std::string upper = upper_case(name);
  AbaqusSets &sets = of->sets[kind];
  if (sets.blocks.count(upper) == 0 && sets.members.count(upper) == 0)
    deck.refuse(
        "there is no set of " +
            std::string(kind == AbaqusPart::node ? "nodes" : "elements") +
            " \"" + std::string(what) + "\"",
        row);
  for (const FileIndex member : find_set(*of, kind, upper))
    found.push_back(first + member);
  n_members += find_set(*of, kind, upper).size();
  if (n_members > most)
    deck.refuse("its sets list too much", row);
}
} // namespace sabot
