#ifndef sabot_tests_geometry_mesh_files_h
#define sabot_tests_geometry_mesh_files_h

#include "sabot/base/error.h"
#include "sabot/geometry/mesh_import.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

// Mesh files for the tests of their readers.

namespace sabot
{
inline std::string write_file(const std::string &name, const std::string &text)
{
  const std::string file = testing::TempDir() + name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/** A block of 2x2x2 cells of edge @p h, nodes and cells numbered from 1. */
struct Block
{
  explicit Block(const double h = 1.)
  {
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          nodes.push_back({{i * h, j * h, k * h}});
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i)
        {
          const int n = 1 + i + 3 * j + 9 * k;
          cells.push_back(
              {{n, n + 1, n + 4, n + 3, n + 9, n + 10, n + 13, n + 12}});
        }
  }
  std::vector<std::array<double, 3>> nodes;
  std::vector<std::array<int, 8>> cells;

  /** *Node and *Element of Abaqus; labels of elements from @p first on. */
  std::string abaqus(const int first = 1) const
  {
    std::ostringstream text;
    text << "*Node\n";
    for (std::size_t i = 0; i < nodes.size(); ++i)
      text << i + 1 << ", " << nodes[i][0] << ", " << nodes[i][1] << ", "
           << nodes[i][2] << "\n";
    text << "*Element, type=C3D8R\n";
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      text << first + c;
      for (const int node : cells[c])
        text << ", " << node;
      text << "\n";
    }
    return text.str();
  }
};

inline NamedMesh read_text(const std::string &name, const std::string &text,
                           const MeshWish &wish = MeshWish())
{
  return read_mesh({write_file(name, text), "Bodies/a/Mesh file"}, wish);
}

/** What refuses the file; "" where nothing does. */
inline std::string refusal(const std::string &name, const std::string &text,
                           const MeshWish &wish = MeshWish())
{
  try
  {
    read_text(name, text, wish);
  }
  catch (const InputError &error)
  {
    return error.what();
  }
  return "";
}

inline bool has(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}

inline double volume_of(const NamedMesh &made)
{
  double sum = 0.;
  for (const double v : made.mesh.volume)
    sum += v;
  return sum;
}

/** Area vector of the faces called @p name. */
inline std::array<double, 3> area_of(const NamedMesh &made,
                                     const std::string &name)
{
  std::array<double, 3> sum{{0., 0., 0.}};
  const HexMesh &mesh = made.mesh;
  for (const unsigned int id : find_face_ids("Faces", name, made))
    for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
      if (mesh.boundary_id[f] == id)
        for (int d = 0; d < 3; ++d)
        {
          const auto x = [&](const int a, const int c)
          { return mesh.nodes[mesh.boundary_faces[f][a]][(d + c) % 3]; };
          sum[d] += 0.5 * ((x(2, 1) - x(0, 1)) * (x(3, 2) - x(1, 2)) -
                           (x(2, 2) - x(0, 2)) * (x(3, 1) - x(1, 1)));
        }
  return sum;
}

/** Lowest and highest corner of the mesh along an axis. */
inline std::pair<double, double> range_of(const NamedMesh &made, const int axis)
{
  std::pair<double, double> range{1e300, -1e300};
  for (const auto &x : made.mesh.nodes)
    range = {std::min(range.first, x[axis]), std::max(range.second, x[axis])};
  return range;
}
} // namespace sabot

#endif
