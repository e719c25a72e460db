#ifndef sabot_geometry_abaqus_model_h
#define sabot_geometry_abaqus_model_h

#include "sabot/geometry/abaqus_deck.h"

#include <list>
#include <set>
#include <unordered_map>

namespace sabot
{
struct AbaqusInstance;

/** Nodes or elements of a part by label and by the names of sets. Names are in
    upper case, as Abaqus does not tell the cases apart. */
struct AbaqusSets
{
  std::unordered_map<std::int64_t, FileIndex> of_label;
  std::map<std::string, std::vector<const AbaqusBlock *>> blocks;
  /** Of the options NSET and ELSET of *Node and *Element; with those of the
      blocks once AbaqusModel::find_set() was asked. */
  std::map<std::string, std::vector<FileIndex>> members;
  std::map<std::string, std::string> shown; // as the deck spells them
  std::set<std::string> found;
};

/** What stands between *Part and *End Part, or outside of all parts. */
struct AbaqusPart
{
  enum Kind
  {
    node,
    element
  };
  enum class Shape
  {
    hexahedron,
    quadrilateral,
    solid, // that is no hexahedron
    other  // lines, triangles, masses: no part of a mesh of hexahedra
  };
  struct Element
  {
    Shape shape;
    std::int64_t label;
    std::array<FileIndex, 8> nodes;
  };

  std::string name;
  std::vector<std::array<double, 3>> vertices;
  std::vector<Element> elements;
  AbaqusSets sets[2]; // by Kind
  std::vector<const AbaqusBlock *> surfaces, sections;
  std::string first_other; // place and type of the first solid
};

/** A part in its place: x -> R (x + shift - a) + a, with the turn R about an
    axis through the point a. */
struct AbaqusInstance
{
  std::string name;
  AbaqusPart *part = nullptr;
  std::array<double, 3> shift{{0., 0., 0.}}, point{{0., 0., 0.}};
  std::array<std::array<double, 3>, 3> turn{
      {{{1., 0., 0.}}, {{0., 1., 0.}}, {{0., 0., 1.}}}};
  // Numbers of its first node and element among those of all instances.
  std::size_t first[2] = {0, 0};

  std::array<double, 3> place(std::array<double, 3> x) const;
};

/**
 * Parts, instances and sets of an Abaqus deck. What stands outside of parts and
 * in the assembly itself is the first instance, without a name. Keywords of the
 * analysis are left out; those that would make or move nodes in ways that are
 * not known here are refused.
 */
class AbaqusModel
{
public:
  explicit AbaqusModel(const AbaqusDeck &deck);
  AbaqusModel(const AbaqusModel &) = delete;
  AbaqusModel &operator=(const AbaqusModel &) = delete;

  const AbaqusDeck &deck;
  std::list<AbaqusInstance> instances;
  std::vector<std::string> left_out; // keywords, as they stand there
  std::vector<std::string> lonely;   // parts without an instance

  /** Members of a set, ascending: numbers in the part, for the first instance
      among those of all. */
  const std::vector<FileIndex> &find_set(AbaqusPart &part,
                                         const AbaqusPart::Kind kind,
                                         const std::string &name);
  /** Adds what a label or the name of a set means to @p found; in the assembly
      also as "P-1.17". Refuses unknown names; labels that are not there are
      counted. */
  void add_members(AbaqusPart &part, const AbaqusPart::Kind kind,
                   const std::string_view what, const AbaqusRow &row,
                   std::vector<FileIndex> &found);
  std::size_t n_missing = 0; // labels in sets that are not there

private:
  void read_blocks();
  void read_block(const AbaqusBlock &block, AbaqusPart &part);
  void read_nodes(const AbaqusBlock &block, AbaqusPart &part) const;
  void read_elements(const AbaqusBlock &block, AbaqusPart &part) const;
  void begin_instance(const AbaqusBlock &block);
  AbaqusInstance *find_instance(const std::string &name);
  void add_block(AbaqusPart &part, const AbaqusPart::Kind kind,
                 const AbaqusBlock &block, std::vector<FileIndex> &found);
  void add_range(const AbaqusSets &sets, const AbaqusRow &row,
                 const std::size_t first, std::vector<FileIndex> &found);

  std::list<AbaqusPart> parts; // the first: outside of all
  std::size_t n_members = 0;   // of all sets
};
} // namespace sabot

#endif
