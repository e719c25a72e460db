#ifndef sabot_geometry_file_mesh_h
#define sabot_geometry_file_mesh_h

#include "sabot/base/registry.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/** Number of a vertex or cell in a file's mesh, from 0. */
using FileIndex = std::uint32_t;

/** Corners of a face, around it. */
using FileFace = std::array<FileIndex, 4>;

/**
 * Hexahedra as a file has them, with the names that it gives to parts and
 * faces: what a reader leaves, before anything is made of it. A reader vouches
 * for the numbers, which are those of vertices and cells that are there;
 * whether the mesh makes sense is asked afterwards (mesh_check.h).
 */
struct FileMesh
{
  /** A part of the cells. */
  struct CellSet
  {
    std::string name;             // or the number, where it has no name
    std::string also;             // the number of one that has a name
    std::vector<FileIndex> cells; // ascending
    std::size_t n_others = 0;     // solids in it that are no hexahedra
  };
  /** Faces of cells, or free quadrilaterals that lie on some; inner ones do not
      count. */
  struct FaceSet
  {
    std::string name, also;
    std::vector<FileFace> faces;
  };
  /** A boundary face is in the set where its four corners are. */
  struct NodeSet
  {
    std::string name;
    std::vector<FileIndex> nodes; // ascending
  };
  /** A name that cannot be asked for, and why. */
  struct Unusable
  {
    std::string name, reason;
  };

  std::vector<std::array<double, 3>> vertices; // in the file's unit
  std::vector<std::array<FileIndex, 8>> cells; // in VTK order
  std::vector<std::string> prefixes{""};       // of labels: "P-1.", or nothing
  std::vector<FileIndex> prefix;               // of each cell, in prefixes
  std::vector<std::int64_t> label;             // of each cell, in the file
  std::vector<CellSet> cell_sets;
  std::vector<FaceSet> face_sets;
  std::vector<NodeSet> node_sets;
  std::vector<Unusable> unusable;
  std::size_t n_others = 0;                 // solids that are no hexahedra
  std::string first_other;                  // "line 12: elements of type C3D4"
  std::vector<std::string> notes, warnings; // one line each

  /** The cell as the file calls it: "P-1.17". */
  std::string name_of_cell(const std::size_t cell) const
  {
    return prefixes[prefix[cell]] + std::to_string(label[cell]);
  }
  void add_cell(const std::array<FileIndex, 8> &corners,
                const std::int64_t its_label, const FileIndex its_prefix = 0)
  {
    cells.push_back(corners);
    label.push_back(its_label);
    prefix.push_back(its_prefix);
  }
};

/** @p text for logs and messages: bytes that are no characters as "?", and not
    endless. */
std::string printable(const std::string &text);

/** A mesh file, and the entry that names it. */
struct MeshFile
{
  std::string name; // to be opened
  std::string path; // "Bodies/part/Mesh file"

  /** Throws InputError: why the file is not read, and in which @p line; 0: in
      none. */
  [[noreturn]] void refuse(const std::string &why,
                           const std::size_t line = 0) const;
  /** Refuses a @p line of names that is not UTF-8: no scene could ask for them
      and nothing read the results. @p number: as above. */
  void check_encoding(const std::string &line, const std::size_t number) const;
  /** All of it, lines of text with the ends of any system; refuses what cannot
      be opened and what is no file. */
  std::string text() const;
};

/**
 * A format of mesh files. Reads all of a file that may be anything: damaged,
 * cut off, of another program, made to do harm. So no count of the file is
 * believed before as much of the file is there, and no label is an index.
 * A new format is one file in source/geometry/mesh_files.
 */
class MeshReader
{
public:
  static constexpr const char *kind = "mesh format";
  using Make = std::unique_ptr<MeshReader>();
  virtual ~MeshReader() = default;

  /** Whether files with this ending (lower case, "msh") are of the format. */
  virtual bool takes(const std::string &ending) const = 0;
  /** Throws InputError by MeshFile::refuse(). Not collective. */
  virtual FileMesh read(const MeshFile &file) const = 0;
};

/**
 * Reads @p file by the format that its ending names; where none does, by
 * meshio's command line, if that is installed. Throws InputError with the line,
 * where there is one, and what would help.
 */
FileMesh read_mesh_file(const MeshFile &file);
} // namespace sabot

#endif
