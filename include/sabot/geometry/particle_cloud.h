#ifndef sabot_geometry_particle_cloud_h
#define sabot_geometry_particle_cloud_h

#include "sabot/geometry/hex_mesh.h"
#include "sabot/geometry/outline.h"
#include "sabot/kernels/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace sabot
{
/** Particles of an SPG body before it is distributed, the same on every rank,
    numbered along a space-filling curve. */
struct ParticleCloud
{
  std::vector<std::array<double, 3>> position; // [m]
  std::vector<double> volume;                  // tributary, sums to the body
  /** Per axis [m]; the same mean along all axes where shape is given. */
  std::array<double, 3> spacing;
  /** Faces a particle lies on, a bit per boundary id below n_faces; of a box
      bits 0..5 = -x,+x,-y,+y,-z,+z. */
  std::vector<std::uint32_t> on_face;
  static constexpr unsigned int n_faces = 32;
  /** Shares of particles in the areas of boundary faces, outwards [m^2]. */
  struct FaceShare
  {
    std::size_t particle;
    unsigned int id;
    Vec area;
  };
  std::vector<FaceShare> face_shares;
  /** The closed skin of the body: quadrilaterals of particles, outwards, and
      the boundary id of each. */
  std::vector<std::array<std::size_t, 4>> skin;
  std::vector<unsigned int> skin_id;
  /** Axis across which the face of each boundary id is a plane; nothing where
      it is none. */
  std::vector<std::optional<int>> face_axis{0, 0, 1, 1, 2, 2};
  /**
   * Size and directions of the lattice around each particle [m]: the matrix S
   * that maps the unit ball to the ellipsoid through the neighbors a cell away.
   * Symmetric, but R S where the body was turned by R. Empty: diag(spacing) for
   * all.
   */
  AlignedVector<Mat> shape;
};

/**
 * Particles on the nodes of a regular lattice over a box, faces included, as
 * in the reference paper (30 x 30 x 12.7 mm at 1.6 mm: 20 x 20 x 9 = 3600).
 * The spacing is the nearest that divides the size. Volumes are the lattice
 * cells' shares (half on faces, a quarter on edges), so mass is exact.
 */
ParticleCloud make_box_cloud(const std::array<double, 3> &center,
                             const std::array<double, 3> &size,
                             const std::array<double, 3> &nodal_spacing);
ParticleCloud make_box_cloud(const std::array<double, 3> &center,
                             const std::array<double, 3> &size,
                             const double nodal_spacing);

/**
 * Particles on the nodes of hexahedra. Volumes are the integrals of the nodes'
 * trilinear functions (2x2x2 Gauss points, exact): they sum to the mesh's
 * volume and have its center of mass. With the edge vectors a, b, c of a cell
 * (means of its four parallel edges) a particle's shape is
 *   S^2 = mean over the cells around of a a^T + b b^T + c c^T,
 * for which |S^-1 dX| counts lattice steps in any lattice of parallelepipeds,
 * next to its faces, too: kernels of S times the support see as many
 * neighbors there as in a cubic lattice.
 */
ParticleCloud make_mesh_cloud(const HexMesh &mesh);

/**
 * Per particle the outward unit normal of the boundary without the boundary ids
 * in @p without (a bit each), times the least cosine to it of the normals of
 * the faces around: less than 1 on edges. Zero inside.
 */
AlignedVector<Vec> outward_normals(const ParticleCloud &cloud,
                                   const std::uint32_t without);

/**
 * Per particle the distance between particles along the skin, without the
 * boundary ids in @p without: the root of the mean area of the quadrilaterals
 * around it [m]. 0 where there are none. Shells of a ball are finer along its
 * radius than around, so the mean over the volume would tell too little.
 */
std::vector<double> surface_spacings(const ParticleCloud &cloud,
                                     const std::uint32_t without);

/** The shape of the cloud; @p cut: boundary ids on planes of symmetry, a bit
    each. */
Outline outline_of(const ParticleCloud &cloud, const std::uint32_t cut);

/** Number of intervals of about @p spacing in @p length, at least one. */
unsigned int n_intervals(const double length, const double spacing);
} // namespace sabot

#endif
