#ifndef sabot_geometry_split_mesh_h
#define sabot_geometry_split_mesh_h

#include "sabot/geometry/hex_mesh.h"
#include "sabot/geometry/particle_cloud.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * A mesh of hexahedra, each of which may be split into a lattice of smaller
 * ones. Edges that are opposite to each other in any cell form a row; all edges
 * of a row have the same number of parts, so that lattices of cells that share
 * a face or an edge meet there,
 *
 *   n = nearest whole number to (mean length of the row)/spacing, at least 1.
 *
 * The points of all lattices are sites, numbered: the nodes of the mesh first,
 * by their numbers, then those within edges, within faces, within cells. A site
 * lies where the linear, bilinear or trilinear functions N_a of the nodes of
 * its edge, face or cell put it; its position has the same bits seen from any
 * cell. The same on every rank; nothing is collective.
 */
class SplitMesh
{
public:
  /** @p spacing: that is asked for [m]. */
  SplitMesh(HexMesh mesh, const double spacing);

  /** Least and largest number of parts of any row; {1, 1}: nothing is split. */
  std::pair<unsigned int, unsigned int> parts() const { return ratio; }
  GlobalIndex n_nodes() const { return mesh.nodes.size(); }
  GlobalIndex n_sites() const { return n_all; }
  const std::array<GlobalIndex, 8> &nodes_of(const GlobalIndex cell) const
  {
    return mesh.cells[cell];
  }
  double volume(const GlobalIndex cell) const { return mesh.volume[cell]; }
  MeanGradients gradients(const GlobalIndex cell) const
  {
    return mean_gradients(mesh, cell);
  }

  /** The nodes of a site's edge, face or cell, which carry it as long as it
      does not move by itself; the lowest comes first. Weights N_a. */
  struct Carrier
  {
    int n = 0; // 1, 2, 4 or 8
    std::array<GlobalIndex, 8> node{};
    std::array<double, 8> weight{};
  };
  Carrier carrier(const GlobalIndex site) const;
  /** Numbers of the cells that have all nodes of the carrier, ascending. */
  std::vector<GlobalIndex> cells_around(const Carrier &carrier) const;

  /** A site as part of a cell. */
  struct Member
  {
    GlobalIndex site;
    /** Of the cell's mass: that of the trapezoid rule, 1/n per direction, half
        of it at the ends. With them sum share N_a = 1/8 for every node. */
    double share;
    /** Middle of its share of the cell, in [-1, 1]^3. */
    std::array<double, 3> middle;
  };
  /** All sites of a cell, its first direction running fastest. */
  std::vector<Member> members(const GlobalIndex cell) const;

  /** make_mesh_cloud() of the split mesh, but for these sites only and in their
      order: position, volume, shape, on_face. @p outward, @p along: their
      outward_normals() and surface_spacings() without the boundary ids
      @p without. No face_shares, no skin. The same bits whatever other sites
      are asked for. */
  ParticleCloud cloud_of(const std::vector<GlobalIndex> &sites,
                         const std::uint32_t without,
                         AlignedVector<Vec> &outward,
                         std::vector<double> &along) const;

  /** Of every node, lattice cells of the cells around it, an eighth each: about
      how many particles come with it. */
  std::vector<double> sites_by_node() const;

private:
  struct Edge
  {
    std::array<GlobalIndex, 2> node; // lower first
    std::uint32_t row;               // then its number of parts
    GlobalIndex first;               // site
  };
  struct Face
  {
    /** The lowest, the lower of its two neighbors, the other one, across. */
    std::array<GlobalIndex, 4> node;
    std::array<std::uint32_t, 2> parts; // from node 0 to 1 and 2
    GlobalIndex first;                  // site
  };
  struct Cell
  {
    std::array<std::uint32_t, 12> edge; // 4 d + place: along direction d
    std::array<std::uint32_t, 6> face;  // 2 d + side: across it
    std::array<std::uint32_t, 3> parts;
    GlobalIndex first; // site
  };
  using Index = std::array<unsigned int, 3>;

  void find_edges();
  void find_faces();
  void find_parts(const double spacing);
  void number_sites();
  void find_cells_of_nodes();
  /** The node of a cell at the corner whose bit d says whether it is at the
      upper end of direction d. */
  GlobalIndex at(const GlobalIndex cell, const int bits) const;
  GlobalIndex site_at(const GlobalIndex cell, const Index &i) const;
  GlobalIndex site_in_face(const GlobalIndex cell, const int d,
                           const Index &i) const;
  /** Fine cells and boundary faces of these cells. @p sites: by fine node. */
  HexMesh fine_part(const std::vector<GlobalIndex> &cells,
                    std::vector<GlobalIndex> &sites) const;

  HexMesh mesh;
  std::vector<Edge> edges;
  std::vector<Face> faces;
  std::vector<Cell> cells;
  std::vector<std::size_t> start_of_node; // into cells_of_node
  std::vector<std::uint32_t> cells_of_node;
  /** Ascending by cell: cell, side as in Cell::face, boundary id. */
  struct Outside
  {
    std::uint32_t cell, side;
    unsigned int id;
    std::size_t number; // among the faces of the mesh
  };
  std::vector<Outside> outside;
  std::pair<unsigned int, unsigned int> ratio{1, 1};
  GlobalIndex n_all = 0;
};
} // namespace sabot

#endif
