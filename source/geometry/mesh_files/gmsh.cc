// Meshes of gmsh: MSH 2.2, 4.0 and 4.1, text and binary.
#include "sabot/base/text.h"
#include "sabot/geometry/mesh_text.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <unordered_map>

namespace sabot
{
namespace
{
/** Dimension and tag of a group, or of an entity of the geometry. */
using Key = std::pair<int, std::int64_t>;

/** Nodes by type of element, as the format numbers them from 1; 0: unknown. */
constexpr int n_nodes_of[] = {0, 2,  3,  4,  4,  8, 6, 5,  3,  6,
                              9, 10, 27, 18, 14, 1, 8, 20, 15, 13};
constexpr int dimension_of[] = {0, 1, 2, 2, 3, 3, 3, 3, 1, 2,
                                2, 3, 3, 3, 3, 0, 2, 3, 3, 3};
constexpr const char *solid_of[] = {"",
                                    "",
                                    "",
                                    "",
                                    "tetrahedra",
                                    "",
                                    "wedges",
                                    "pyramids",
                                    "",
                                    "",
                                    "",
                                    "quadratic tetrahedra",
                                    "quadratic hexahedra",
                                    "quadratic wedges",
                                    "quadratic pyramids",
                                    "",
                                    "",
                                    "quadratic hexahedra",
                                    "quadratic wedges",
                                    "quadratic pyramids"};
constexpr int quadrilateral = 3, hexahedron = 5;

class Gmsh
{
public:
  explicit Gmsh(const MeshFile &file) : text(file) {}

  FileMesh read()
  {
    read_header();
    bool has_nodes = false, has_elements = false;
    while (!text.at_end())
    {
      const std::string section(text.line());
      if (section == "$PhysicalNames")
        read_names();
      else if (section == "$Entities")
        read_entities();
      else if (section == "$PartitionedEntities" && version > 4.05)
        read_partitioned_entities();
      else if (section == "$Nodes")
      {
        version < 4. ? read_nodes() : read_node_blocks();
        has_nodes = true;
      }
      else if (section == "$Elements")
      {
        if (!has_nodes)
          text.refuse("the elements stand before the nodes");
        version < 4. ? read_elements() : read_element_blocks();
        has_elements = true;
      }
      if (section.size() < 2 || section[0] != '$')
        text.refuse("a line that begins a section, as $Nodes, is missing");
      text.skip_behind("$End" + section.substr(1));
      text.line();
    }
    if (!has_elements)
      text.refuse("it has no section $Elements");
    return finish();
  }

private:
  void read_header()
  {
    const std::string first(text.line());
    if (first == "$NOD")
      text.refuse("it is of gmsh's format 1; save it in format 2.2 or 4.1");
    if (first != "$MeshFormat")
      text.refuse("it does not begin with $MeshFormat, as files of gmsh do");
    version = text.real();
    const std::int64_t type = text.integer(), size = text.integer();
    if (version < 2. || version >= 4.2 || (version >= 3. && version < 4.))
      text.refuse("its format is none of 2.2, 4.0 and 4.1; save it as one of "
                  "these");
    if ((type != 0 && type != 1) || size != 8)
      text.refuse("its format has the type " + std::to_string(type) +
                  " and numbers of " + std::to_string(size) +
                  " bytes; 0 or 1, and 8, are known");
    text.line();
    is_binary = type == 1;
    if (is_binary && text.raw<std::int32_t>() != 1)
      text.refuse("its bytes have the order of another kind of machine; save "
                  "it as text");
    text.skip_behind("$EndMeshFormat");
    text.line();
  }

  // A number of the format: text, or bytes.
  std::int64_t small()
  {
    return is_binary ? text.raw<std::int32_t>() : text.integer();
  }
  std::int64_t large()
  {
    return is_binary ? std::int64_t(text.raw<std::uint64_t>()) : text.integer();
  }
  /** Tags of 4.0 are small, of 4.1 large. */
  std::int64_t tag() { return version < 4.05 ? small() : large(); }
  double real() { return is_binary ? text.raw<double>() : text.real(); }
  /** Of things with @p n numbers each; two bytes are a digit and a blank. */
  std::size_t count(const std::size_t n)
  {
    if (!is_binary)
      return text.count(2 * n);
    const std::uint64_t found = text.raw<std::uint64_t>();
    text.expect(found, 4 * n);
    return found;
  }

  void read_names()
  {
    const std::size_t n = text.count(4);
    text.line();
    for (std::size_t i = 0; i < n; ++i)
    {
      const std::int64_t dimension = text.integer(), number = text.integer();
      const std::string_view rest = text.line();
      if (rest.size() < 2 || rest.front() != '"' || rest.back() != '"')
        text.refuse("the name of a physical group does not stand in quotes");
      text.check_encoding(rest);
      name[{int(dimension), number}] =
          trim(std::string(rest.substr(1, rest.size() - 2)));
    }
  }

  /** The groups of points, curves, surfaces and volumes of the geometry. */
  void read_entities()
  {
    std::array<std::size_t, 4> n;
    for (std::size_t &each : n)
      each = count(4);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < n[dimension]; ++i)
      {
        const Key entity(dimension, small());
        const int n_bounds = dimension == 0 && version > 4.05 ? 3 : 6;
        for (int b = 0; b < n_bounds; ++b)
          real();
        for (std::size_t g = count(1); g > 0; --g)
          groups_of[entity].push_back(std::abs(small())); // turned: negative
        if (dimension > 0)
          for (std::size_t b = count(1); b > 0; --b)
            small();
      }
  }

  /** The pieces into which gmsh cut them for parallel programs: elements name
      these instead. As 4.1 has it; other formats number elements by the
      whole. */
  void read_partitioned_entities()
  {
    large(); // how many parts
    for (std::size_t ghost = count(2); ghost > 0; --ghost)
    {
      small();
      small();
    }
    std::array<std::size_t, 4> n;
    for (std::size_t &each : n)
      each = count(4);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < n[dimension]; ++i)
      {
        const Key entity(dimension, small());
        small(); // dimension and number of the whole
        small();
        for (std::size_t part = count(1); part > 0; --part)
          small();
        for (int b = 0; b < (dimension == 0 ? 3 : 6); ++b)
          real();
        std::vector<std::int64_t> &groups = groups_of[entity];
        groups.clear();
        for (std::size_t g = count(1); g > 0; --g)
          groups.push_back(std::abs(small()));
        if (dimension > 0)
          for (std::size_t b = count(1); b > 0; --b)
            small();
      }
  }

  void add_node(const std::int64_t number, const std::array<double, 3> &x)
  {
    for (const double coordinate : x)
      if (!std::isfinite(coordinate))
        text.refuse("a coordinate of node " + std::to_string(number) +
                    " is no number");
    if (!node_of.emplace(number, mesh.vertices.size()).second)
      text.refuse("node " + std::to_string(number) + " is there twice");
    mesh.vertices.push_back(x);
  }

  void read_nodes()
  {
    const std::size_t n = text.count(8);
    text.line();
    for (std::size_t i = 0; i < n; ++i)
    {
      const std::int64_t number = small();
      const double x = real(), y = real(), z = real();
      add_node(number, {{x, y, z}});
    }
  }

  void read_node_blocks()
  {
    const std::size_t n_blocks = count(4);
    large();
    if (version > 4.05)
    {
      large();
      large();
    }
    for (std::size_t b = 0; b < n_blocks; ++b)
    {
      const std::int64_t first = small(), second = small(),
                         dimension = version > 4.05 ? first : second;
      const std::int64_t n_parameters =
          small() == 0 ? 0 : std::min<std::int64_t>(dimension, 3);
      const std::size_t n = count(4);
      std::vector<std::int64_t> numbers;
      if (version > 4.05)
        for (std::size_t i = 0; i < n; ++i)
          numbers.push_back(tag());
      for (std::size_t i = 0; i < n; ++i)
      {
        const std::int64_t number = version > 4.05 ? numbers[i] : tag();
        const double x = real(), y = real(), z = real();
        for (std::int64_t p = 0; p < n_parameters; ++p)
          real();
        add_node(number, {{x, y, z}});
      }
    }
  }

  /** An element of the groups @p groups, its nodes read by @p node. */
  template <typename Node>
  void add_element(const std::int64_t type, const std::int64_t number,
                   const std::vector<std::int64_t> &groups, const Node &node)
  {
    std::array<FileIndex, 8> corners{};
    for (int a = 0; a < n_nodes_of[type]; ++a)
    {
      const std::int64_t label = node();
      if (type != quadrilateral && type != hexahedron)
        continue;
      const auto found = node_of.find(label);
      if (found == node_of.end())
        text.refuse("element " + std::to_string(number) + " has the node " +
                    std::to_string(label) + ", which is not there");
      corners[a] = found->second;
    }
    const int dimension = dimension_of[type];
    if (type == hexahedron)
    {
      for (const std::int64_t g : groups)
        cells[{3, g}].cells.push_back(mesh.cells.size());
      mesh.add_cell(corners, number);
    }
    else if (type == quadrilateral)
      for (const std::int64_t g : groups)
        faces[{2, g}].push_back(
            {{corners[0], corners[1], corners[2], corners[3]}});
    else if (dimension == 3)
    {
      for (const std::int64_t g : groups)
        ++cells[{3, g}].n_others;
      if (mesh.n_others++ == 0)
        mesh.first_other =
            "element " + std::to_string(number) + " of " + solid_of[type];
    }
  }

  void check_type(const std::int64_t type) const
  {
    if (type < 1 || type > 19)
      text.refuse("elements have the type " + std::to_string(type) +
                  ", which is none of linear or quadratic ones; save the mesh "
                  "with order 1");
  }

  void read_elements()
  {
    const std::size_t n = text.count(6);
    text.line();
    std::size_t done = 0;
    while (done < n)
    {
      // Text has a header in each line, bytes one for a block.
      std::int64_t number = is_binary ? 0 : text.integer();
      const std::int64_t type = small();
      check_type(type);
      const std::int64_t n_here = is_binary ? small() : 1, n_tags = small();
      if (n_here < 1 || n_here > std::int64_t(n - done) || n_tags < 0)
        text.refuse("the header of a block of elements does not fit");
      for (std::int64_t i = 0; i < n_here; ++i)
      {
        if (is_binary)
          number = small();
        text.expect(n_tags, 2);
        std::vector<std::int64_t> groups;
        for (std::int64_t t = 0; t < n_tags; ++t)
        {
          const std::int64_t group = small();
          if (t == 0 && group != 0)
            groups.push_back(group);
        }
        add_element(type, number, groups, [this] { return small(); });
      }
      done += n_here;
    }
  }

  void read_element_blocks()
  {
    const std::size_t n_blocks = count(4);
    large();
    if (version > 4.05)
    {
      large();
      large();
    }
    for (std::size_t b = 0; b < n_blocks; ++b)
    {
      const std::int64_t first = small(), second = small(), type = small();
      check_type(type);
      const Key entity =
          version > 4.05 ? Key(first, second) : Key(second, first);
      const auto found = groups_of.find(entity);
      const std::size_t n = count(1 + n_nodes_of[type]);
      for (std::size_t i = 0; i < n; ++i)
      {
        const std::int64_t number = tag();
        add_element(type, number,
                    found == groups_of.end() ? std::vector<std::int64_t>()
                                             : found->second,
                    [this] { return tag(); });
      }
    }
  }

  FileMesh finish()
  {
    const auto title = [this](const Key &key, auto &set)
    {
      const auto found = name.find(key);
      const std::string number = std::to_string(key.second);
      set.name = found == name.end() ? number : found->second;
      set.also = found == name.end() ? "" : number;
    };
    for (auto &[key, set] : cells)
    {
      title(key, set);
      mesh.cell_sets.push_back(std::move(set));
    }
    for (auto &[key, list] : faces)
    {
      FileMesh::FaceSet set;
      title(key, set);
      set.faces = std::move(list);
      mesh.face_sets.push_back(std::move(set));
    }
    return std::move(mesh);
  }

  MeshText text;
  double version = 0.;
  bool is_binary = false;
  std::map<Key, std::string> name; // of physical groups
  std::map<Key, std::vector<std::int64_t>> groups_of;
  std::unordered_map<std::int64_t, FileIndex> node_of;
  std::map<Key, FileMesh::CellSet> cells;
  std::map<Key, std::vector<FileFace>> faces;
  FileMesh mesh;
};

class GmshReader : public MeshReader
{
public:
  bool takes(const std::string &ending) const override
  {
    return ending == "msh";
  }
  FileMesh read(const MeshFile &file) const override
  {
    return Gmsh(file).read();
  }
};

const Registry<MeshReader>::Add
    added({"gmsh", ".msh, formats 2.2, 4.0 and 4.1, as text or binary.",
           nullptr, [] { return std::make_unique<GmshReader>(); }});
} // namespace
} // namespace sabot
