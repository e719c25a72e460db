#ifndef sabot_bodies_fem_fem_boundary_h
#define sabot_bodies_fem_fem_boundary_h

#include "sabot/bodies/body.h"
#include "sabot/bodies/fem/fem_options.h"
#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/geometry/hex_mesh.h"

#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * The faces of a body of hexahedra on this rank: what other bodies may touch,
 * and the nodes whose velocity is prescribed. Faces on symmetry planes are left
 * out: nothing touches a body from inside of its other half. No function is
 * collective.
 */
class FemBoundary : public LoadView
{
public:
  /** Finds the symmetry planes. Throws InputError, by the entry "Symmetry
      faces", unless such faces lie in one plane across an axis; see also
      refuse_contradictions(). */
  FemBoundary(const std::string &body_name, const HexMesh &mesh,
              const FemOptions &options);

  /**
   * Takes the faces whose nodes are all here, and prescribes velocities. Where
   * clamped, driven and symmetry faces share nodes, they agree.
   * @param local  number on this rank of the mesh's nodes that are here
   *
   * Ids of the faces are their numbers in the mesh; the typical spacing [m] is
   * the root of the mean area of all faces of the mesh, the same on every rank.
   */
  void set_up(const HexMesh &mesh,
              const std::unordered_map<GlobalIndex, std::uint32_t> &local,
              const std::size_t n_owned, VelocityConstraints &constraints);

  /** As of now, for couplings. Bulk modulus in Pa. node_share halves a
      node's part for each plane of symmetry through it. */
  ContactSurface surface(const std::size_t n_owned,
                         const double bulk_modulus) const;

  void keep_faces(const std::vector<unsigned int> &ids) override
  {
    kept.insert(kept.end(), ids.begin(), ids.end());
  }
  /** Boundary ids of faces that loads have asked for. */
  const std::vector<unsigned int> &loaded_faces() const { return kept; }
  LoadedSurface
  loaded_surface(const std::vector<unsigned int> &ids) const override;

  static constexpr std::uint32_t no_cell = -1;
  /** Numbers of the cells behind the faces; no_cell where another rank's nodes
      have it. Searches all cells. */
  std::vector<std::uint32_t> find_cells(const Hexahedra &cells) const;

  /** Present flow stress [Pa] at some owned nodes of the faces: the mean over
      the faces around a node of that of the cells behind them; never_yields
     where there are no faces.
      @param cell_of  cells behind the faces, see find_cells() */
  std::vector<double>
  flow_stress(const std::vector<std::size_t> &some_nodes,
              const std::size_t n_local_nodes, const Hexahedra &cells,
              const std::vector<std::uint32_t> &cell_of) const;

  /** Where the model is cut, the same on every rank. */
  const std::vector<SymmetryPlane> &planes() const { return symmetry_planes; }

  // Faces come and go where cells erode; see FemErosion.
  std::vector<std::array<std::size_t, 4>> faces; // local nodes
  std::vector<GlobalIndex> face_id;              // the same on every rank

private:
  /** Prescribes the normal velocity of the nodes on symmetry planes, a bit per
      axis each. */
  void hold_on_planes(const std::map<std::size_t, int> &planes,
                      VelocityConstraints &constraints);

  const FemOptions options;
  std::map<unsigned int, int> symmetry_axes; // of boundary ids
  std::vector<SymmetryPlane> symmetry_planes;
  /** Boundary ids of the faces of the start, by their numbers. */
  std::vector<std::pair<GlobalIndex, unsigned int>> id_of_face; // ascending
  /** Symmetry planes through owned nodes that lie on any. */
  std::map<std::size_t, int> n_symmetry_planes;
  double typical_spacing = 0.; // [m]
  std::vector<unsigned int> kept;
};

/**
 * InputError, by the entry "Driven faces" of the body, where a node would be
 * driven and held along one axis: on a clamped face or across a plane of
 * symmetry, also along the edge of two faces. A drive of 0 m/s holds, too, and
 * agrees with both.
 * @param symmetry_axes  of the boundary ids of planes of symmetry
 */
void refuse_contradictions(const std::string &body_name, const HexMesh &mesh,
                           const FemOptions &options,
                           const std::map<unsigned int, int> &symmetry_axes);
} // namespace sabot

#endif
