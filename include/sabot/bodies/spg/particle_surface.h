#ifndef sabot_bodies_spg_particle_surface_h
#define sabot_bodies_spg_particle_surface_h

#include "sabot/base/memory_table.h"
#include "sabot/base/types.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/velocity_constraints.h"
#include "sabot/geometry/particle_cloud.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace sabot
{
class ParticleApproximation;
class LagrangianKernel;
struct ParticleFields;
struct SpgOptions;

/**
 * Where particles lie on the surface of their body: faces, outward normals,
 * planes of symmetry; and what they show to others without having faces, their
 * part of a surface and of a volume.
 *
 * Known from the cloud at the start: which faces a particle lies on and the
 * mean of their outward normals, whose length is the cosine of the angle
 * between them and the mean. Surfaces that open later have no normals. No
 * function is collective.
 */
class ParticleSurface : public LoadView
{
public:
  /** Throws InputError where a face of symmetry is not a plane across an axis.
      @p path: of the body. */
  ParticleSurface(const ParticleCloud &cloud, const SpgOptions &options,
                  const std::string &path);

  /** Keep the particles with these global numbers, ascending; hold their
      velocities across planes of symmetry and on clamped faces. Mirror
      images count: the normal on a plane of symmetry has no component across
      it. */
  void distribute(const ParticleCloud &cloud,
                  const std::vector<GlobalIndex> &owned,
                  const std::uint32_t clamped_faces,
                  VelocityConstraints &constraints);

  /** What a surface is made of, of all particles of a cloud. */
  struct Skin
  {
    AlignedVector<Vec> normal;   // outward_normals()
    std::vector<double> spacing; // surface_spacings() [m]
  };
  Skin skin_of(const ParticleCloud &cloud) const;
  /** More particles, of the nodes @p hosts of the cloud, behind those that are
      there; @p skin of that cloud. */
  void extend(const ParticleCloud &cloud, const Skin &skin,
              const std::vector<GlobalIndex> &hosts,
              const std::uint32_t clamped_faces,
              VelocityConstraints &constraints);
  /** Of a body that grows, over all ranks [m]. */
  void set_largest_spacing(const double largest) { largest_spacing = largest; }

  void keep_faces(const std::vector<unsigned int> &ids) override
  {
    kept_faces.insert(ids.begin(), ids.end());
  }
  /** Owned particles' shares in the areas of these of the kept faces. */
  LoadedSurface
  loaded_surface(const std::vector<unsigned int> &ids) const override;

  /** Local indices of owned particles on the faces of @p faces (bits as in
      ParticleCloud::on_face). */
  std::vector<std::size_t> particles_on(const std::uint32_t faces) const;

  /** Where the model is cut, the same on every rank. */
  void list_memory(MemoryTable &table) const
  {
    table.add("surface: faces", on_face);
    table.add("surface: normals", outward);
    table.add("surface: spacings", spacing);
    table.add("surface: areas", kept_shares);
  }
  const std::vector<SymmetryPlane> &planes() const { return symmetry_planes; }
  /** All particles: any may come to lie open, so all may touch faces.
      node_share is 1/2 per plane of symmetry through the particle; no faces.
      Pa and m, of the body as a whole. */
  ContactSurface contact_surface(const double bulk_modulus,
                                 const double mean) const;
  /** Owned particle @p i, @p F its deformation gradient; normals go with
      F^-T, areas with det F over the length of F^T n. Normal F^-T n/|F^-T
      n|, spacing that along the skin times sqrt(det F/|F^T n_now|) [m];
      flatness goes linearly from an edge of 90 degrees (cosine 0.75, little)
      to a facet (0.9, 1). Zero where it has no normal. */
  SurfacePoint point(const std::size_t i, const Mat &F) const;

private:
  void keep_shares(const ParticleCloud &cloud,
                   const std::vector<GlobalIndex> &owned);
  /** Axes across which owned particle @p i lies on a plane of symmetry, a bit
      each. */
  unsigned int symmetry_axes(const std::size_t i) const;

  /** Across each boundary id; nothing: not a plane. */
  const std::vector<std::optional<int>> face_axis;
  const std::uint32_t symmetry_faces;
  std::vector<SymmetryPlane> symmetry_planes;
  std::vector<std::uint32_t> on_face; // owned
  AlignedVector<Vec> outward;         // owned, at the start, outward_normals()
  std::vector<double> spacing;        // owned, at the start, surface_spacings()
  double largest_spacing = 0.;        // of all
  std::set<unsigned int> kept_faces;  // boundary ids
  /** Of the kept faces, by particle; local numbers. */
  std::vector<ParticleCloud::FaceShare> kept_shares;
};

/** Axes across which the planes among @p faces lie, a bit each; @p faces as in
    ParticleCloud::on_face, @p face_axis as there. */
unsigned int axes_across(const std::uint32_t faces,
                         const std::vector<std::optional<int>> &face_axis);

/** Owned particle @p i as part of a volume (Body::volume_point): the shape
    of its kernel, or of a ball where it lost a direction and has none.
    Radius of 1.75 spacings in the shape of F_inc H; content = 12/pi V |det
    to_unit|, as the integral of the cubic spline over the unit ball is
    pi/12. */
VolumePoint particle_volume(const std::size_t i, const ParticleFields &fields,
                            const ParticleApproximation &approximation,
                            const LagrangianKernel &kernel);
} // namespace sabot

#endif
