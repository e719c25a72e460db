// Meshes from Abaqus input decks.
#include "sabot/geometry/abaqus_model.h"
#include "sabot/geometry/mesh_text.h"

#include "sabot/base/text.h"

#include <algorithm>

namespace sabot
{
namespace
{
using Kind = AbaqusPart::Kind;
using Shape = AbaqusPart::Shape;

/** The sides S1 to S6 of a hexahedron, by its corners. */
constexpr int sides[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                             {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};

/** The number of a name that Cubit has made from it: 5 of "SS5". */
std::string number_behind(const std::string &start, const std::string &name)
{
  if (name.compare(0, start.size(), start) != 0)
    return "";
  const auto number = whole_number(std::string_view(name).substr(start.size()));
  return number ? std::to_string(*number) : "";
}

/** The members of a set in all instances, and how the deck spells it. */
struct Members
{
  std::string shown;
  std::vector<FileIndex> of;
};
using Named = std::map<std::string, Members>;

class Abaqus
{
public:
  explicit Abaqus(const MeshFile &file) : file(file), deck(file), model(deck) {}

  FileMesh read()
  {
    for (const AbaqusInstance &instance : model.instances)
      add_instance(instance);
    for (const AbaqusInstance &instance : model.instances)
    {
      name_sets(instance, Kind::node, node_sets);
      name_sets(instance, Kind::element, element_sets);
    }
    name_parts();
    for (const AbaqusInstance &instance : model.instances)
      for (const AbaqusBlock *const surface : instance.part->surfaces)
        add_surface(instance, *surface);
    leave_sets();
    if (mesh.cells.empty() && mesh.n_others == 0)
      file.refuse(model.lonely.empty()
                      ? "it has no elements that are hexahedra (C3D8, C3D8R)"
                      : "its part " + model.lonely[0] +
                            " stands in no *Instance of an *Assembly; add one");
    say();
    return std::move(mesh);
  }

private:
  void add_instance(const AbaqusInstance &instance)
  {
    const AbaqusPart &part = *instance.part;
    if (!part.elements.empty() && !instance.name.empty())
      mesh.prefixes.push_back(instance.name + ".");
    const FileIndex prefix = mesh.prefixes.size() - 1;
    for (const auto &x : part.vertices)
      mesh.vertices.push_back(instance.place(x));
    for (AbaqusPart::Element element : part.elements)
    {
      for (FileIndex &node : element.nodes)
        node += instance.first[Kind::node];
      cell_of.push_back(mesh.cells.size());
      if (element.shape == Shape::hexahedron)
        mesh.add_cell(element.nodes, element.label, prefix);
      if (element.shape == Shape::solid && mesh.n_others++ == 0)
        mesh.first_other = part.first_other;
      elements.push_back(element);
    }
  }

  /** The sets of an instance, by their name, and with that of the instance. */
  void name_sets(const AbaqusInstance &instance, const Kind kind, Named &named)
  {
    // Those of the assembly have numbers of all instances.
    const bool is_assembly = instance.name.empty();
    const std::size_t first = is_assembly ? 0 : instance.first[kind];
    const auto shown = instance.part->sets[kind].shown;
    for (const auto &[name, spelled] : shown)
    {
      const auto &members = model.find_set(*instance.part, kind, name);
      std::vector<std::pair<std::string, std::string>> names{{name, spelled}};
      if (!is_assembly)
        names.push_back({upper_case(instance.name) + "." + name,
                         instance.name + "." + spelled});
      for (const auto &[key, as] : names)
      {
        named[key].shown = as;
        for (const FileIndex member : members)
          named[key].of.push_back(first + member);
      }
    }
  }

  /** Instances, parts, and materials of sections as sets of elements. */
  void name_parts()
  {
    std::map<std::string, std::vector<FileIndex>> found;
    std::map<std::string, std::string> shown;
    const auto add = [&](const std::string &name, const FileIndex element)
    {
      if (!name.empty() && element_sets.count(upper_case(name)) == 0)
      {
        found[upper_case(name)].push_back(element);
        shown.emplace(upper_case(name), name);
      }
    };
    for (const AbaqusInstance &instance : model.instances)
    {
      AbaqusPart &part = *instance.part;
      const std::size_t first = instance.first[Kind::element];
      for (std::size_t e = 0; e < part.elements.size(); ++e)
      {
        add(instance.name, first + e);
        if (upper_case(instance.name) != part.name)
          add(part.name, first + e);
      }
      for (const AbaqusBlock *const section : part.sections)
        for (const FileIndex e : model.find_set(
                 part, Kind::element, upper_case(section->option("ELSET"))))
          add(section->option("MATERIAL"),
              (instance.name.empty() ? 0 : first) + e);
    }
    for (auto &[name, members] : found)
      element_sets[name] = {shown[name], std::move(members)};
  }

  void add_surface(const AbaqusInstance &instance, const AbaqusBlock &block)
  {
    const std::string type = upper_case(block.option("TYPE")),
                      own = block.option("NAME"),
                      name = instance.name.empty() ? own
                                                   : instance.name + "." + own;
    if (own.empty())
      deck.refuse("*Surface needs a name: NAME=...", block);
    if (block.has("COMBINE") || block.has("CROP") ||
        (!type.empty() && type != "ELEMENT" && type != "NODE"))
    {
      give_up(own, "it is made from other surfaces or by formula", block.line);
      return;
    }
    const Kind kind = type == "NODE" ? Kind::node : Kind::element;
    const std::size_t first = instance.name.empty() ? 0 : instance.first[kind];
    std::vector<FileIndex> nodes;
    std::vector<FileFace> faces;
    for (std::size_t i = 0; i < block.lines.size(); ++i)
    {
      const AbaqusRow row = deck.row(block, i);
      std::vector<FileIndex> members;
      if (row.parts[0].empty()) // all that is free
        for (std::size_t e = 0; e < instance.part->elements.size(); ++e)
          members.push_back(e);
      else
        model.add_members(*instance.part, kind, row.parts[0], row, members);
      for (FileIndex &member : members)
        member += first;
      if (kind == Kind::node)
        nodes.insert(nodes.end(), members.begin(), members.end());
      else if (!add_sides(members, row, faces))
      {
        give_up(own, "it has sides other than S1 to S6", row.line);
        return;
      }
    }
    surface(upper_case(own), own, nodes, faces);
    if (!instance.name.empty())
      surface(upper_case(name), name, nodes, faces);
  }

  void give_up(const std::string &name, const std::string &why,
               const std::size_t line)
  {
    mesh.unusable.push_back({name, why + " (line " + std::to_string(line) +
                                       "); give it by elements and their "
                                       "sides, or by nodes"});
  }

  /** The sides of elements that the row of a surface names; false where there
      are no such sides. */
  bool add_sides(const std::vector<FileIndex> &members, const AbaqusRow &row,
                 std::vector<FileFace> &faces) const
  {
    const std::string side =
        row.parts.size() < 2 ? "" : upper_case(std::string(row.parts[1]));
    const bool is_numbered =
        side.size() == 2 && side[0] == 'S' && side[1] >= '1' && side[1] <= '6';
    if (!side.empty() && !is_numbered && side != "SPOS" && side != "SNEG")
      return false;
    for (const FileIndex member : members)
    {
      const AbaqusPart::Element &element = elements[member];
      const auto &nodes = element.nodes;
      if (element.shape == Shape::quadrilateral)
        faces.push_back({{nodes[0], nodes[1], nodes[2], nodes[3]}});
      else if (element.shape == Shape::hexahedron)
        for (int s = 0; s < 6; ++s)
          if (side.empty() || (is_numbered && side[1] == '1' + s))
            faces.push_back({{nodes[sides[s][0]], nodes[sides[s][1]],
                              nodes[sides[s][2]], nodes[sides[s][3]]}});
    }
    return true;
  }

  void surface(const std::string &key, const std::string &shown,
               const std::vector<FileIndex> &nodes,
               const std::vector<FileFace> &faces)
  {
    if (!nodes.empty() && surfaces[key].faces.empty())
    {
      Members &set = node_sets[key];
      set.shown = shown;
      set.of.insert(set.of.end(), nodes.begin(), nodes.end());
      surfaces.erase(key);
      return;
    }
    FileMesh::FaceSet &set = surfaces[key];
    set.name = shown;
    set.also = number_behind("SS", key);
    set.faces.insert(set.faces.end(), faces.begin(), faces.end());
  }

  void leave_sets()
  {
    for (auto &[name, set] : element_sets)
    {
      FileMesh::CellSet cells;
      FileMesh::FaceSet flat;
      cells.name = flat.name = set.shown;
      cells.also = number_behind("EB", name);
      std::sort(set.of.begin(), set.of.end());
      set.of.erase(std::unique(set.of.begin(), set.of.end()), set.of.end());
      for (const FileIndex e : set.of)
      {
        const auto &nodes = elements[e].nodes;
        if (elements[e].shape == Shape::hexahedron)
          cells.cells.push_back(cell_of[e]);
        else if (elements[e].shape == Shape::quadrilateral)
          flat.faces.push_back({{nodes[0], nodes[1], nodes[2], nodes[3]}});
        else if (elements[e].shape == Shape::solid)
          ++cells.n_others;
      }
      if (!flat.faces.empty() && surfaces.count(name) == 0 &&
          node_sets.count(name) == 0)
        surfaces[name] = std::move(flat);
      if (!cells.cells.empty() || cells.n_others > 0)
        mesh.cell_sets.push_back(std::move(cells));
    }
    for (auto &[name, set] : node_sets)
    {
      std::sort(set.of.begin(), set.of.end());
      set.of.erase(std::unique(set.of.begin(), set.of.end()), set.of.end());
      if (surfaces.count(name) == 0)
        mesh.node_sets.push_back({set.shown, std::move(set.of)});
    }
    for (auto &[name, set] : surfaces)
      mesh.face_sets.push_back(std::move(set));
  }

  void say()
  {
    mesh.notes = deck.notes;
    if (!model.left_out.empty())
    {
      constexpr std::size_t most = 8;
      std::vector<std::string> some(model.left_out.begin(),
                                    model.left_out.begin() +
                                        std::min(most, model.left_out.size()));
      mesh.notes.push_back(
          "left out of the deck, as scenes say it in their own words: " +
          join(some, ", ") +
          (model.left_out.size() > most
               ? " and " + std::to_string(model.left_out.size() - most) +
                     " more keywords"
               : std::string()));
    }
    for (const std::string &part : model.lonely)
      mesh.warnings.push_back("part " + part +
                              " of the deck stands in no instance and is left "
                              "out");
    if (model.n_missing > 0)
      mesh.warnings.push_back("sets of the deck name " +
                              std::to_string(model.n_missing) +
                              " labels that are not there");
  }

  const MeshFile &file;
  const AbaqusDeck deck;
  AbaqusModel model;
  std::vector<AbaqusPart::Element> elements; // of all instances
  std::vector<FileIndex> cell_of;            // parallel, where it is one
  Named node_sets, element_sets;
  std::map<std::string, FileMesh::FaceSet> surfaces;
  FileMesh mesh;
};

class AbaqusReader : public MeshReader
{
public:
  bool takes(const std::string &ending) const override
  {
    return ending == "inp";
  }
  FileMesh read(const MeshFile &file) const override
  {
    return Abaqus(file).read();
  }
};

const Registry<MeshReader>::Add
    added({"Abaqus",
           ".inp, flat decks and assemblies; keywords of the analysis are "
           "left out.",
           nullptr, [] { return std::make_unique<AbaqusReader>(); }});
} // namespace
} // namespace sabot
