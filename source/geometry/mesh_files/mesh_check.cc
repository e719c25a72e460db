// What meshes of files may lack, and what no mesh may have.
#include "sabot/geometry/mesh_check.h"
#include "sabot/geometry/cell_shape.h"
#include "sabot/geometry/near_points.h"

#include "sabot/base/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

namespace sabot
{
CellCorners corners_of(const FileMesh &mesh, const std::size_t c)
{
  CellCorners x;
  for (int a = 0; a < 8; ++a)
  {
    const auto &p = mesh.vertices[mesh.cells[c][a]];
    x[a] = vec(p[0], p[1], p[2]);
  }
  return x;
}

namespace
{
/** "(1, 2, 3) mm", of a place in the file's unit. */
std::string place(const Vec &x, const MeshWish &wish)
{
  char text[100];
  double mm[3];
  for (int d = 0; d < 3; ++d)
    mm[d] = 1e3 * (x[d] * wish.unit + wish.origin[d]);
  std::snprintf(text, sizeof(text), "(%.6g, %.6g, %.6g) mm", mm[0], mm[1],
                mm[2]);
  return text;
}

std::string plural(const std::size_t n, const std::string &one)
{
  return std::to_string(n) + " " + one + (n == 1 ? "" : "s");
}

class MeshCheck
{
public:
  MeshCheck(FileMesh &mesh, const MeshFile &file, const MeshWish &wish)
      : mesh(mesh), file(file), wish(wish)
  {
  }

  void check()
  {
    check_numbers();
    turn_cells();
    check_shapes();
    find_coincident();
    check_equal();
    check_faces();
    count_pieces();
    say();
  }

private:
  std::string cell(const std::size_t c) const
  {
    return "cell " + mesh.name_of_cell(c) + " at " +
           place(middle(corners_of(mesh, c)), wish);
  }

  void check_numbers() const
  {
    // The square of an area of such a size is still a number.
    constexpr double largest = 1e30;
    for (const auto &x : mesh.vertices)
      for (int d = 0; d < 3; ++d)
        if (!(std::abs(x[d] * wish.unit) < largest))
          file.refuse("a coordinate of " + formatted("%.3g", x[d]) +
                      " is no place for a body");
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    {
      auto sorted = mesh.cells[c];
      std::sort(sorted.begin(), sorted.end());
      if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
        file.refuse(cell(c) +
                    " has a corner twice; give it eight corners of its own, or "
                    "mesh that part anew");
    }
  }

  /** Mirrored parts come with their cells inside out. */
  void turn_cells()
  {
    std::size_t n_turned = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    {
      if (!(middle_jacobian(corners_of(mesh, c)) < 0.))
        continue;
      auto &nodes = mesh.cells[c];
      std::swap_ranges(nodes.begin(), nodes.begin() + 4, nodes.begin() + 4);
      ++n_turned;
    }
    if (n_turned > 0)
      mesh.notes.push_back(plural(n_turned, "cell") +
                           " listed inside out, turned");
  }

  void check_shapes()
  {
    std::size_t n_bad = 0, worst = 0;
    double least = 0.;
    Vec where = {};
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    {
      const CellCorners x = corners_of(mesh, c);
      if (!(least_inner_jacobian(x) > 0.))
        file.refuse(cell(c) +
                    " is inverted or flat: its Jacobian is not positive "
                    "inside; mend the mesh there");
      const double slenderness = longest_edge(x) / shortest_edge(x);
      constexpr double most = 1000.;
      if (!(slenderness < most))
        file.refuse(cell(c) + " is " + formatted("%.3g", slenderness) +
                    " times as long as wide; is one of its nodes misplaced?");
      const CornerShape corner = worst_corner(x);
      if (corner.scaled_jacobian > 0.)
        continue;
      ++n_bad;
      if (n_bad == 1 || corner.scaled_jacobian < least)
      {
        worst = c;
        least = corner.scaled_jacobian;
        where = x[corner.number];
      }
    }
    if (n_bad > 0)
      mesh.warnings.push_back(
          plural(n_bad, "cell") +
          " with a corner that is flat or folded, the worst cell " +
          mesh.name_of_cell(worst) + " at " + place(where, wish) +
          " (scaled Jacobian " + formatted("%.3g", least) +
          "): it limits the step and turns inside out early");
  }

  void find_coincident()
  {
    double shortest = std::numeric_limits<double>::max();
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      shortest = std::min(shortest, shortest_edge(corners_of(mesh, c)));
    constexpr double fraction = 1e-3;
    nearness = fraction * shortest;
    first = first_near(mesh.vertices, nearness);
    for (std::size_t i = 0; i < first.size(); ++i)
      if (first[i] != i && n_coincident++ == 0)
      {
        const auto &p = mesh.vertices[i];
        coincident = vec(p[0], p[1], p[2]);
      }
  }

  /** The nodes of cell @p c, coincident ones as one. */
  template <std::size_t n>
  std::array<FileIndex, n> merged(std::array<FileIndex, n> nodes) const
  {
    for (FileIndex &a : nodes)
      a = first[a];
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  void check_equal() const
  {
    std::vector<FileIndex> order(mesh.cells.size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<std::array<FileIndex, 8>> nodes;
    for (const auto &each : mesh.cells)
      nodes.push_back(merged(each));
    std::sort(order.begin(), order.end(),
              [&](const FileIndex a, const FileIndex b)
              { return nodes[a] != nodes[b] ? nodes[a] < nodes[b] : a < b; });
    std::size_t n_equal = 0, one = 0, other = 0;
    for (std::size_t i = 1; i < order.size(); ++i)
      if (nodes[order[i]] == nodes[order[i - 1]] && n_equal++ == 0)
      {
        one = order[i - 1];
        other = order[i];
      }
    if (n_equal > 0)
      file.refuse(
          plural(n_equal, "cell") +
          " would stand twice in the same place: " + mesh.name_of_cell(other) +
          " has the corners of " + cell(one) + "; remove one of the two");
  }

  void check_faces()
  {
    struct Side
    {
      FileFace sorted;
      FileIndex cell;
      bool is_even; // the sense in which it is listed
    };
    std::vector<Side> sides;
    sides.reserve(6 * mesh.cells.size());
    for (FileIndex c = 0; c < mesh.cells.size(); ++c)
      for (const auto &around : face_corners)
      {
        FileFace face;
        for (int a = 0; a < 4; ++a)
          face[a] = mesh.cells[c][around[a]];
        // Turned to begin with the least, the next tells the sense.
        const int at =
            std::min_element(face.begin(), face.end()) - face.begin();
        const bool is_even = face[(at + 1) % 4] < face[(at + 3) % 4];
        std::sort(face.begin(), face.end());
        sides.push_back({face, c, is_even});
      }
    std::sort(sides.begin(), sides.end(),
              [](const Side &a, const Side &b) {
                return a.sorted != b.sorted ? a.sorted < b.sorted
                                            : a.cell < b.cell;
              });
    separate(mesh.cells.size());
    for (std::size_t i = 1; i < sides.size(); ++i)
    {
      if (sides[i].sorted != sides[i - 1].sorted)
        continue;
      parent[root(sides[i].cell)] = root(sides[i - 1].cell);
      if (i > 1 && sides[i].sorted == sides[i - 2].sorted)
        file.refuse("a face has more than two cells, among them " +
                    cell(sides[i].cell) + " and " +
                    mesh.name_of_cell(sides[i - 1].cell));
      if (sides[i].is_even == sides[i - 1].is_even)
        file.refuse(cell(sides[i].cell) + " and " +
                    mesh.name_of_cell(sides[i - 1].cell) +
                    " lie on the same side of their common face: they overlap");
    }
    n_of_faces = count_roots();
  }

  /** Forest of pieces: each entry its own, to be joined. */
  void separate(const std::size_t n)
  {
    parent.resize(n);
    std::iota(parent.begin(), parent.end(), 0);
  }
  std::size_t root(std::size_t i)
  {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  }
  std::size_t count_roots() const
  {
    std::size_t n = 0;
    for (std::size_t i = 0; i < parent.size(); ++i)
      n += parent[i] == i;
    return n;
  }

  /** Cells that share nodes are a piece; @p joined: coincident ones, too. */
  std::size_t count(const bool joined)
  {
    separate(mesh.vertices.size());
    if (joined)
      for (std::size_t i = 0; i < first.size(); ++i)
        parent[root(i)] = root(first[i]);
    for (const auto &nodes : mesh.cells)
      for (const FileIndex a : nodes)
        parent[root(a)] = root(nodes[0]);
    return count_roots();
  }

  /** Pieces, of which the forest is there, that lie in each other. */
  void refuse_overlap()
  {
    std::vector<std::size_t> piece;
    for (const auto &nodes : mesh.cells)
      piece.push_back(root(nodes[0]));
    const auto pair = overlapping_cells(mesh, piece);
    if (pair)
      file.refuse(cell(pair->first) + " lies in " +
                  mesh.name_of_cell(pair->second) +
                  " of another piece: the two overlap, and their mass would "
                  "count twice; move one of the pieces, or take a part of the "
                  "file by \"Mesh material id\"");
  }

  void count_pieces()
  {
    n_pieces = count(false);
    if (n_pieces > 1)
      refuse_overlap();
    std::string said;
    if (n_pieces > 1)
      said = plural(n_pieces, "piece") + " that share no node";
    if (n_coincident > 0)
      said +=
          (said.empty() ? "" : ", ") + plural(n_coincident, "coincident node") +
          ", the first at " + place(coincident, wish) +
          ": what meets there is not joined" +
          (n_pieces > 1
               ? " (joined it would be " + plural(count(true), "piece") + ")"
               : std::string()) +
          "; \"Join nodes within = " +
          formatted("%.3g mm", 1e3 * nearness * wish.unit) + "\" joins them";
    else if (n_pieces > 1)
      said += ": nothing holds them together";
    if (!said.empty())
      mesh.warnings.push_back(said);
    if (n_of_faces > n_pieces)
      mesh.warnings.push_back(plural(n_of_faces, "piece") +
                              " of cells that share faces hang together by "
                              "edges or corners only, as hinges");
  }

  void say()
  {
    Vec low = vec(0., 0., 0.), high = low;
    for (int d = 0; d < 3; ++d)
    {
      low[d] = high[d] = mesh.vertices[0][d];
      for (const auto &x : mesh.vertices)
      {
        low[d] = std::min(low[d], x[d]);
        high[d] = std::max(high[d], x[d]);
      }
    }
    const double size = wish.unit * norm(high - low);
    std::vector<std::string> parts;
    for (const auto &set : mesh.cell_sets)
      if (!set.cells.empty())
        parts.push_back(set.name +
                        (set.also.empty() ? "" : " (" + set.also + ")"));
    const std::size_t n_parts = parts.size();
    constexpr std::size_t most = 12;
    if (n_parts > most)
      parts.resize(most);
    mesh.notes.push_back(plural(mesh.cells.size(), "cell") + ", " +
                         plural(mesh.vertices.size(), "node") + ", " +
                         plural(n_pieces, "piece") + ", from " +
                         place(low, wish) + " to " + place(high, wish) +
                         (parts.empty() ? ""
                                        : "; parts: " + join(parts, ", ") +
                                              (n_parts > most ? ", ..." : "")));
    constexpr double largest = 20., smallest = 20e-6;
    if (size > largest || size < smallest)
      mesh.warnings.push_back("the mesh is " + formatted("%.3g m", size) +
                              " across; is \"Mesh unit\" that of the file's "
                              "coordinates?");
  }

  FileMesh &mesh;
  const MeshFile &file;
  const MeshWish &wish;
  std::vector<std::size_t> first;  // of coincident vertices
  std::vector<std::size_t> parent; // of vertices or cells, towards the root
  double nearness = 0.;            // of coincident ones
  std::size_t n_coincident = 0, n_pieces = 0, n_of_faces = 0;
  Vec coincident = {};
};
} // namespace

void check_mesh(FileMesh &mesh, const MeshFile &file, const MeshWish &wish)
{
  MeshCheck(mesh, file, wish).check();
}
} // namespace sabot
