// Parts, instances, nodes and elements of Abaqus decks.
#include "sabot/geometry/abaqus_model.h"

#include "sabot/geometry/mesh_text.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
using Shape = AbaqusPart::Shape;

bool starts_with(const std::string &text, const std::string &start)
{
  return text.compare(0, start.size(), start) == 0;
}

/** C3D8R, S4R, ...: what the elements of a type are. */
Shape shape_of(const std::string &type)
{
  for (const char *const hexahedron : {"C3D8", "DC3D8", "SC8R", "CSS8"})
    if (starts_with(type, hexahedron))
      return Shape::hexahedron;
  for (const char *const flat :
       {"S4", "SFM3D4", "M3D4", "CPS4", "CPE4", "R3D4", "DS4"})
    if (starts_with(type, flat))
      return Shape::quadrilateral;
  for (const char *const solid :
       {"C3D", "DC3D", "AC3D", "SC6", "COH3D", "EC3D"})
    if (starts_with(type, solid))
      return Shape::solid;
  return Shape::other;
}

/** Keywords that make or move nodes or cells in ways of their own. */
const std::set<std::string> makers = {
    "NGEN",   "NFILL",       "NCOPY",       "NMAP",
    "ELGEN",  "ELCOPY",      "PARAMETER",   "SYMMETRICMODELGENERATION",
    "IMPORT", "MODELCHANGE", "SUBSTRUCTURE"};
/** Those that need no word: of the mesh, or without content. */
const std::set<std::string> silent = {
    "HEADING",  "PREPRINT",    "INCLUDE",     "PART",    "ENDPART",
    "ASSEMBLY", "ENDASSEMBLY", "ENDINSTANCE", "ENDSTEP", "SYSTEM"};

double number(const AbaqusDeck &deck, const AbaqusRow &row, const std::size_t i)
{
  if (i >= row.parts.size() || row.parts[i].empty())
    return 0.; // as Abaqus has it
  const auto value = real_number(row.parts[i]);
  if (!value)
    deck.refuse("entry " + std::to_string(i + 1) + " is no number", row);
  return *value;
}

std::int64_t label(const AbaqusDeck &deck, const AbaqusRow &row,
                   const std::size_t i)
{
  const auto value = i < row.parts.size() ? whole_number(row.parts[i])
                                          : std::optional<std::int64_t>();
  if (!value || *value < 1)
    deck.refuse("entry " + std::to_string(i + 1) +
                    " is no label: a whole number from 1 on",
                row);
  return *value;
}
} // namespace

std::array<double, 3> AbaqusInstance::place(std::array<double, 3> x) const
{
  std::array<double, 3> placed = point;
  for (int d = 0; d < 3; ++d)
    x[d] += shift[d] - point[d];
  for (int d = 0; d < 3; ++d)
    for (int e = 0; e < 3; ++e)
      placed[d] += turn[d][e] * x[e];
  return placed;
}

AbaqusModel::AbaqusModel(const AbaqusDeck &deck) : deck(deck)
{
  parts.emplace_back();
  instances.emplace_back();
  instances.front().part = &parts.front();
  read_blocks();
  std::set<const AbaqusPart *> used;
  std::size_t first[2] = {0, 0};
  for (AbaqusInstance &instance : instances)
  {
    used.insert(instance.part);
    instance.first[AbaqusPart::node] = first[AbaqusPart::node];
    instance.first[AbaqusPart::element] = first[AbaqusPart::element];
    first[AbaqusPart::node] += instance.part->vertices.size();
    first[AbaqusPart::element] += instance.part->elements.size();
    constexpr std::size_t most = 200000000;
    if (first[0] > most || first[1] > most)
      deck.refuse("its instances have more than " + std::to_string(most) +
                      " nodes or elements",
                  deck.blocks.back());
  }
  for (const AbaqusPart &part : parts)
    if (used.count(&part) == 0 && !part.elements.empty())
      lonely.push_back(part.name);
}

void AbaqusModel::read_blocks()
{
  AbaqusPart *part = &parts.front();
  bool is_in_instance = false;
  // Elements wait until all nodes of their part are there.
  std::vector<const AbaqusBlock *> elements;
  const auto leave_part = [&]()
  {
    for (const AbaqusBlock *const block : elements)
      read_elements(*block, *part);
    elements.clear();
    part = &parts.front();
    is_in_instance = false;
  };
  for (const AbaqusBlock &block : deck.blocks)
  {
    const std::string &word = block.keyword;
    if (word == "PART" || word == "INSTANCE" || word == "ENDPART" ||
        word == "ENDINSTANCE" || word == "ASSEMBLY")
      leave_part();
    if (word == "PART")
    {
      for (const AbaqusPart &other : parts)
        if (other.name == upper_case(block.option("NAME")))
          deck.refuse("a part needs a name of its own", block);
      parts.emplace_back();
      part = &parts.back();
      part->name = upper_case(block.option("NAME"));
    }
    else if (word == "INSTANCE")
    {
      begin_instance(block);
      part = instances.back().part;
      is_in_instance = true;
    }
    else
    {
      // Independent instances have meshes of their own.
      if (is_in_instance && (word == "NODE" || word == "ELEMENT"))
      {
        parts.push_back(*part);
        part = instances.back().part = &parts.back();
        is_in_instance = false;
      }
      if (word == "ELEMENT")
        elements.push_back(&block);
      else
        read_block(block, *part);
    }
  }
  leave_part();
}

void AbaqusModel::read_block(const AbaqusBlock &block, AbaqusPart &part)
{
  const std::string &word = block.keyword;
  const bool is_nset = word == "NSET", is_elset = word == "ELSET";
  if (makers.count(word) > 0 || (word == "SYSTEM" && !block.lines.empty()))
    deck.refuse(block.shown +
                    " is not known here; save the deck with all its nodes and "
                    "elements written out",
                block);
  if (word == "NODE")
    read_nodes(block, part);
  else if (is_nset || is_elset)
  {
    const std::string name = block.option(word);
    if (name.empty())
      deck.refuse(block.shown + " needs a name: " + word + "=NAME", block);
    AbaqusSets &sets = part.sets[is_nset ? 0 : 1];
    sets.blocks[upper_case(name)].push_back(&block);
    sets.shown.emplace(upper_case(name), name);
  }
  else if (word == "SURFACE")
    part.surfaces.push_back(&block);
  else if (word == "SOLIDSECTION")
    part.sections.push_back(&block);
  else if (silent.count(word) == 0 &&
           std::find(left_out.begin(), left_out.end(), block.shown) ==
               left_out.end())
    left_out.push_back(block.shown);
}

void AbaqusModel::read_nodes(const AbaqusBlock &block, AbaqusPart &part) const
{
  const std::string system = upper_case(block.option("SYSTEM")),
                    set = block.option("NSET");
  if (block.has("INPUT"))
    deck.refuse("nodes of another file are not looked up; use *Include", block);
  if (!system.empty() && system != "R")
    deck.refuse("SYSTEM=" + system +
                    " is not known here; save nodes with x, y and z",
                block);
  AbaqusSets &sets = part.sets[AbaqusPart::node];
  for (std::size_t i = 0; i < block.lines.size(); ++i)
  {
    const AbaqusRow row = deck.row(block, i);
    const std::int64_t its_label = label(deck, row, 0);
    if (!sets.of_label.emplace(its_label, part.vertices.size()).second)
      deck.refuse("node " + std::to_string(its_label) + " is there twice", row);
    if (!set.empty())
    {
      sets.members[upper_case(set)].push_back(part.vertices.size());
      sets.shown.emplace(upper_case(set), set);
    }
    part.vertices.push_back(
        {{number(deck, row, 1), number(deck, row, 2), number(deck, row, 3)}});
  }
}

void AbaqusModel::read_elements(const AbaqusBlock &block,
                                AbaqusPart &part) const
{
  const std::string type = upper_case(block.option("TYPE")),
                    set = block.option("ELSET");
  if (type.empty() || block.has("INPUT"))
    deck.refuse("*Element needs TYPE=, and its elements below it", block);
  const Shape shape = shape_of(type);
  const std::size_t n_nodes = shape == Shape::hexahedron      ? 8
                              : shape == Shape::quadrilateral ? 4
                                                              : 0;
  if (shape == Shape::solid && part.first_other.empty())
    part.first_other =
        "line " + std::to_string(block.line) + ": elements of type " + type;
  AbaqusSets &sets = part.sets[AbaqusPart::element];
  for (std::size_t i = 0; i < block.lines.size(); ++i)
  {
    AbaqusRow row = deck.row(block, i);
    AbaqusPart::Element element{shape, label(deck, row, 0), {}};
    std::vector<std::string_view> nodes(row.parts.begin() + 1, row.parts.end());
    while (row.goes_on && i + 1 < block.lines.size() &&
           (n_nodes == 0 || nodes.size() < n_nodes))
    {
      row = deck.row(block, ++i);
      nodes.insert(nodes.end(), row.parts.begin(), row.parts.end());
    }
    const std::string name = "element " + std::to_string(element.label);
    if (n_nodes > 0 && nodes.size() != n_nodes)
      deck.refuse(name + " of type " + type + " has " +
                      std::to_string(nodes.size()) + " nodes, not " +
                      std::to_string(n_nodes),
                  row);
    for (std::size_t a = 0; a < n_nodes; ++a)
    {
      const auto node_label = whole_number(nodes[a]);
      const auto &of_label = part.sets[AbaqusPart::node].of_label;
      const auto found =
          node_label ? of_label.find(*node_label) : of_label.end();
      if (found == of_label.end())
        deck.refuse(name + " has the node \"" + std::string(nodes[a]) +
                        "\", which is not there",
                    row);
      element.nodes[a] = found->second;
    }
    if (!sets.of_label.emplace(element.label, part.elements.size()).second)
      deck.refuse(name + " is there twice", row);
    if (!set.empty())
    {
      sets.members[upper_case(set)].push_back(part.elements.size());
      sets.shown.emplace(upper_case(set), set);
    }
    part.elements.push_back(element);
  }
}

void AbaqusModel::begin_instance(const AbaqusBlock &block)
{
  AbaqusInstance instance;
  instance.name = block.option("NAME");
  if (instance.name.empty() || find_instance(instance.name) != nullptr)
    deck.refuse("an instance needs a name of its own", block);
  const std::string name = upper_case(block.option("PART"));
  for (AbaqusPart &part : parts)
    if (instance.part == nullptr && !name.empty() && part.name == name)
      instance.part = &part;
  if (instance.part == nullptr)
    deck.refuse("there is no part \"" + block.option("PART") +
                    "\" before it; put the part into the deck",
                block);
  if (block.lines.size() > 2)
    deck.refuse("an instance has a line that moves it and one that turns it",
                block);
  if (!block.lines.empty())
  {
    const AbaqusRow row = deck.row(block, 0);
    for (int d = 0; d < 3; ++d)
      instance.shift[d] = number(deck, row, d);
  }
  if (block.lines.size() == 2)
  {
    const AbaqusRow row = deck.row(block, 1);
    std::array<double, 3> axis;
    double square = 0.;
    for (int d = 0; d < 3; ++d)
    {
      instance.point[d] = number(deck, row, d);
      axis[d] = number(deck, row, 3 + d) - instance.point[d];
      square += axis[d] * axis[d];
    }
    const double angle = number(deck, row, 6) * M_PI / 180.;
    if (!(square > 0.) || !std::isfinite(square))
      deck.refuse("the two points of the axis are the same", row);
    const double c = std::cos(angle), s = std::sin(angle);
    for (double &a : axis)
      a /= std::sqrt(square);
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e)
        instance.turn[d][e] =
            (d == e ? c
                    : s * ((e - d + 3) % 3 == 1 ? -1. : 1.) * axis[3 - d - e]) +
            (1. - c) * axis[d] * axis[e];
  }
  instances.push_back(std::move(instance));
}

AbaqusInstance *AbaqusModel::find_instance(const std::string &name)
{
  for (AbaqusInstance &instance : instances)
    if (!instance.name.empty() && upper_case(instance.name) == upper_case(name))
      return &instance;
  return nullptr;
}
} // namespace sabot
