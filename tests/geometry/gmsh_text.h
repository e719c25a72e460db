#ifndef sabot_tests_geometry_gmsh_text_h
#define sabot_tests_geometry_gmsh_text_h

#include "mesh_files.h"

namespace sabot
{
/** The block with its lower face as physical surface 11, "struck face". */
class GmshText
{
public:
  GmshText(const double version, const bool is_binary)
      : version(version), is_binary(is_binary)
  {
    text << "$MeshFormat\n" << version << " " << is_binary << " 8\n";
    if (is_binary)
      bytes<std::int32_t>(1);
    text << "\n$EndMeshFormat\n$PhysicalNames\n2\n2 11 \"struck face\"\n"
            "3 1 \"plate\"\n$EndPhysicalNames\n";
    version < 4. ? old() : blocks();
  }
  std::string str() const { return text.str(); }

private:
  template <typename T, typename Value>
  void bytes(const Value value)
  {
    const T as = value;
    text.write(reinterpret_cast<const char *>(&as), sizeof(as));
  }
  template <typename Value>
  void small(const Value value)
  {
    is_binary ? bytes<std::int32_t>(value) : void(text << value << " ");
  }
  template <typename Value>
  void large(const Value value)
  {
    is_binary ? bytes<std::uint64_t>(value) : void(text << value << " ");
  }
  void real(const double value)
  {
    is_binary ? bytes<double>(value) : void(text << value << " ");
  }
  void end_line()
  {
    if (!is_binary)
      text << "\n";
  }
  /** A tag of a node or an element in a block. */
  template <typename Value>
  void tag(const Value value)
  {
    version < 4.05 ? small(value) : large(value);
  }

  void old()
  {
    text << "$Nodes\n27\n";
    for (int i = 0; i < 27; ++i)
    {
      small(100 + i);
      for (const double x : block.nodes[i])
        real(x);
      end_line();
    }
    text << "\n$EndNodes\n$Elements\n12\n";
    int number = 1;
    for (const bool is_cell : {false, true})
    {
      if (is_binary)
        for (const int value : {is_cell ? 5 : 3, is_cell ? 8 : 4, 2})
          small(value);
      for (int c = 0; c < (is_cell ? 8 : 4); ++c)
      {
        small(number++);
        if (!is_binary)
          text << (is_cell ? "5 2 " : "3 2 ");
        small(is_cell ? 1 : 11);
        small(7);
        for (int a = 0; a < (is_cell ? 8 : 4); ++a)
          small(99 + block.cells[c][a]);
        end_line();
      }
    }
    text << "\n$EndElements\n";
  }

  void entity(const int number, const int group)
  {
    small(number);
    for (int b = 0; b < 6; ++b)
      real(0.);
    large(1);
    small(group);
    large(0);
    end_line();
  }

  void blocks()
  {
    const bool is_new = version > 4.05;
    text << "$Entities\n";
    for (const int n : {0, 0, 1, 1})
      large(n);
    end_line();
    entity(5, -11);
    entity(1, 1);
    text << "\n$EndEntities\n$Nodes\n";
    for (const int n : {1, 27})
      large(n);
    if (is_new)
      for (const int n : {100, 126})
        large(n);
    end_line();
    small(is_new ? 3 : 1);
    small(is_new ? 1 : 3);
    small(0);
    large(27);
    end_line();
    for (int i = 0; is_new && i < 27; ++i)
      tag(100 + i);
    end_line();
    for (int i = 0; i < 27; ++i)
    {
      if (!is_new)
        tag(100 + i);
      for (const double x : block.nodes[i])
        real(x);
      end_line();
    }
    text << "\n$EndNodes\n$Elements\n";
    for (const int n : {2, 12})
      large(n);
    if (is_new)
      for (const int n : {1, 12})
        large(n);
    end_line();
    int number = 1;
    for (const bool is_cell : {false, true})
    {
      const int dimension = is_cell ? 3 : 2, its_tag = is_cell ? 1 : 5;
      small(is_new ? dimension : its_tag);
      small(is_new ? its_tag : dimension);
      small(is_cell ? 5 : 3);
      large(is_cell ? 8 : 4);
      end_line();
      for (int c = 0; c < (is_cell ? 8 : 4); ++c)
      {
        tag(number++);
        for (int a = 0; a < (is_cell ? 8 : 4); ++a)
          tag(99 + block.cells[c][a]);
        end_line();
      }
    }
    text << "\n$EndElements\n";
  }

  const double version;
  const bool is_binary;
  const Block block;
  std::ostringstream text;
};
} // namespace sabot

#endif
