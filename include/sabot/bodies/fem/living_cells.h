#ifndef sabot_bodies_fem_living_cells_h
#define sabot_bodies_fem_living_cells_h

#include "sabot/base/nodal_state.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/fem/fem_boundary.h"
#include "sabot/bodies/fem/hexahedra.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sabot
{
/**
 * Which cells of a FEM body are left, where some may go: by erosion or because
 * they turn into particles. Faces of cells that go leave the boundary; faces of
 * the living behind them join it where something may touch them.
 *
 * "Initial" counts this rank's cells as distributed; all arrays of the cells
 * themselves hold the active ones only, in the same order. Every rank that has
 * a cell takes it out, so nothing is exchanged.
 */
class LivingCells
{
public:
  /** Everything refers to the body and outlives this object.
      @param owned_cell  of active cells, those that this rank reports
      @param n_boundary_faces  of the whole mesh: ids from there on are new */
  LivingCells(NodalState &nodes, Hexahedra &cells, FemBoundary &boundary,
              std::vector<char> &owned_cell,
              const GlobalIndex n_boundary_faces);

  /** Take active cells out, ascending. The nodal forces lose their part, so
     that the half step that starts now does not feel them any more.
      @param opens  whether the faces of the living behind them join the
     boundary: with the id n_boundary_faces + 6 cell + side, cell and side those
     of the living cell, which no other face has at any time */
  void take_out(const std::vector<std::size_t> &leaving, const bool opens);

  /** Cells behind the boundary's faces, numbers of active cells. Parallel to
      FemBoundary::faces. */
  std::vector<std::uint32_t> cells_of_faces() const;
  /** Owned nodes that lost all their cells, [n_owned]. */
  const std::vector<char> &bare_nodes() const { return bare_node; }
  /** Number at the start of an active cell, and how many there were. */
  std::uint32_t initial_number(const std::size_t e) const { return initial[e]; }
  std::size_t n_initial() const { return alive.size(); }
  /** Whether the cell of this number in the mesh is one of this rank's that are
      left. */
  bool has(const GlobalIndex cell) const;

  /** Before the cells' own visit: a reader must know which are left before it
      fills their arrays. */
  void visit_state(StateVisitor &visitor, const std::string &body);
  /** All that this rank had at the start, of the body of that name. */
  StateItems items(const std::string &body) const;

private:
  /** Which cells share a face, by its sorted corners; once, before any goes.
      -1 on the surface and where another rank has the cell. Sorting, n log
      n. */
  void find_neighbors();
  /** Faces that go and come with these initial cells; counts the cells that
      nodes still have. Corners of new faces run so that the normal points out
      of the living cell. */
  void update_boundary(const std::vector<std::uint32_t> &gone,
                       const bool opens);
  /** Drop the active cells whose initial cell is gone from all arrays. */
  void compact();

  NodalState &nodal_state;
  Hexahedra &cells;
  FemBoundary &boundary;
  std::vector<char> &owned_cell;
  const GlobalIndex n_boundary_faces;

  std::vector<std::uint32_t> initial; // of active cells
  std::vector<char> alive;            // of initial cells
  std::vector<char> has_opened; // went, and faces behind joined the boundary
  std::vector<std::array<std::int32_t, 6>> across; // initial cells or -1
  std::vector<std::array<std::uint32_t, 8>> nodes; // of initial cells
  std::vector<GlobalIndex> id;                     // of initial cells
  std::vector<std::int32_t> face_cell; // initial cell of the boundary's faces
  std::vector<std::uint8_t> cells_of_node;
  std::vector<char> bare_node; // owned, lost all cells
};
} // namespace sabot

#endif
