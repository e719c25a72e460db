#ifndef sabot_geometry_mesh_check_h
#define sabot_geometry_mesh_check_h

#include "sabot/geometry/cell_shape.h"
#include "sabot/geometry/file_mesh.h"

#include <optional>
#include <utility>
#include <vector>

namespace sabot
{
/** What a scene wants of a mesh file. */
struct MeshWish
{
  double unit = 1.; // length of a unit of the file's coordinates [m]
  std::array<double, 3> origin{{0., 0., 0.}}; // where the file's lies [m]
  std::string part = "all"; // name or number of a set of cells
  std::string part_path;    // entry of it, for messages
  /** Nodes nearer than this become one [m]; nothing: none do. */
  std::optional<double> joining;
};

/** Keeps the cells of the wish and the vertices that these use. Throws
    InputError for unknown parts, with the list of those that are there, and
    where solids other than hexahedra are among the cells. */
void keep_part(FileMesh &mesh, const MeshFile &file, const MeshWish &wish);

/** Makes one of vertices that are nearer than @p distance (file's unit). */
void join_vertices(FileMesh &mesh, const double distance);

/** Of cell @p c, in the file's unit. */
CellCorners corners_of(const FileMesh &mesh, const std::size_t c);

/** A cell and one of another piece in which a part of it lies, if there are
    such: by its middle and points towards its corners, deeper than a tenth of
    an edge, as round surfaces of flat faces that touch go into each other
    less. @p piece:
    the number of each cell's. */
std::optional<std::pair<FileIndex, FileIndex>>
overlapping_cells(const FileMesh &mesh, const std::vector<std::size_t> &piece);

/**
 * Looks for what no mesh of hexahedra has, and turns cells that are listed
 * inside out. Throws InputError, with the names of the cells, for cells with
 * a corner twice, for equal ones, for pieces that overlap, for faces with more
 * than two cells or with both on one side, and for cells that are inverted:
 * whose Jacobian is not positive at a point of integration or in the middle.
 * Warnings for pieces that share no node, coincident nodes, corners that are
 * bad, and free faces that lie on no cell. Notes: sizes and names. @p wish: for
 * lengths with unit.
 */
void check_mesh(FileMesh &mesh, const MeshFile &file, const MeshWish &wish);
} // namespace sabot

#endif
