// Particles as part of a surface and of a volume, planes of symmetry.
#include "sabot/bodies/spg/particle_surface.h"

#include "sabot/base/error.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_options.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
ParticleSurface::ParticleSurface(const ParticleCloud &cloud,
                                 const SpgOptions &options,
                                 const std::string &path)
    : face_axis(cloud.face_axis), symmetry_faces(options.symmetry_faces)
{
  for (unsigned int face = 0; face < ParticleCloud::n_faces; ++face)
    if (symmetry_faces & 1u << face &&
        (face >= face_axis.size() || !face_axis[face]))
      throw InputError(path + "/Symmetry faces",
                       "these faces do not lie in one plane across the x, y "
                       "or z axis; a symmetry plane must");
  for (unsigned int face = 0; face < face_axis.size(); ++face)
    if (symmetry_faces & 1u << face)
      for (std::size_t i = 0; i < cloud.on_face.size(); ++i)
        if (cloud.on_face[i] & 1u << face)
        {
          symmetry_planes.push_back(
              {*face_axis[face], cloud.position[i][*face_axis[face]]});
          break;
        }
}

void ParticleSurface::distribute(const ParticleCloud &cloud,
                                 const std::vector<GlobalIndex> &owned,
                                 const std::uint32_t clamped_faces,
                                 VelocityConstraints &constraints)
{
  const Skin skin = skin_of(cloud);
  largest_spacing = *std::max_element(skin.spacing.begin(), skin.spacing.end());
  extend(cloud, skin, owned, clamped_faces, constraints);
  keep_shares(cloud, owned);
}

ParticleSurface::Skin ParticleSurface::skin_of(const ParticleCloud &cloud) const
{
  return {outward_normals(cloud, symmetry_faces),
          surface_spacings(cloud, symmetry_faces)};
}

void ParticleSurface::extend(const ParticleCloud &cloud, const Skin &skin,
                             const std::vector<GlobalIndex> &hosts,
                             const std::uint32_t clamped_faces,
                             VelocityConstraints &constraints)
{
  const std::size_t before = on_face.size(), n = before + hosts.size();
  on_face.resize(n);
  outward.resize(n);
  spacing.resize(n);
  for (std::size_t i = before; i < n; ++i)
  {
    const GlobalIndex node = hosts[i - before];
    on_face[i] = cloud.on_face[node];
    spacing[i] = skin.spacing[node];
    const unsigned int planes = symmetry_axes(i);
    // Its mirror image has the other half of a plane's facets.
    Vec normal = skin.normal[node];
    const double cosine = norm(normal);
    for (int d = 0; d < 3; ++d)
      if (planes >> d & 1)
      {
        normal[d] = 0.;
        constraints.prescribe(i, d, 0., VelocityConstraints::Holder::symmetry);
      }
    outward[i] =
        norm_square(normal) > 0. ? cosine / norm(normal) * normal : normal;
    if (on_face[i] & clamped_faces)
      for (int d = 0; d < 3; ++d)
        constraints.prescribe(i, d, 0., VelocityConstraints::Holder::clamp);
  }
  constraints.append();
}

void ParticleSurface::keep_shares(const ParticleCloud &cloud,
                                  const std::vector<GlobalIndex> &owned)
{
  std::vector<std::pair<std::size_t, std::size_t>> found; // particle, share
  for (std::size_t s = 0; s < cloud.face_shares.size(); ++s)
  {
    const ParticleCloud::FaceShare &share = cloud.face_shares[s];
    const bool on_plane =
        share.id < ParticleCloud::n_faces && symmetry_faces >> share.id & 1;
    const auto at = std::lower_bound(owned.begin(), owned.end(),
                                     GlobalIndex(share.particle));
    if (kept_faces.count(share.id) > 0 && !on_plane && at != owned.end() &&
        *at == GlobalIndex(share.particle))
      found.emplace_back(at - owned.begin(), s);
  }
  std::sort(found.begin(), found.end());
  for (const auto &[particle, s] : found)
    kept_shares.push_back(
        {particle, cloud.face_shares[s].id, cloud.face_shares[s].area});
}

LoadedSurface
ParticleSurface::loaded_surface(const std::vector<unsigned int> &ids) const
{
  LoadedSurface surface;
  for (const ParticleCloud::FaceShare &share : kept_shares)
    if (std::find(ids.begin(), ids.end(), share.id) != ids.end())
      surface.shares.push_back({share.particle, share.area});
  return surface;
}

std::vector<std::size_t>
ParticleSurface::particles_on(const std::uint32_t faces) const
{
  std::vector<std::size_t> particles;
  for (std::size_t i = 0; i < on_face.size(); ++i)
    if (on_face[i] & faces)
      particles.push_back(i);
  return particles;
}

unsigned int ParticleSurface::symmetry_axes(const std::size_t i) const
{
  return axes_across(on_face[i] & symmetry_faces, face_axis);
}

unsigned int axes_across(const std::uint32_t faces,
                         const std::vector<std::optional<int>> &face_axis)
{
  unsigned int axes = 0;
  for (std::size_t face = 0; face < face_axis.size(); ++face)
    if (faces & 1u << face)
      axes |= 1u << *face_axis[face];
  return axes;
}

ContactSurface ParticleSurface::contact_surface(const double bulk_modulus,
                                                const double mean) const
{
  ContactSurface surface;
  surface.nodes.resize(on_face.size());
  for (std::size_t i = 0; i < on_face.size(); ++i)
    surface.nodes[i] = i;
  if (symmetry_faces != 0)
    for (std::size_t i = 0; i < on_face.size(); ++i)
      surface.node_share.push_back(
          std::ldexp(1., -__builtin_popcount(symmetry_axes(i))));
  surface.symmetry_planes = symmetry_planes;
  surface.bulk_modulus = bulk_modulus;
  surface.spacing = mean;
  surface.largest_spacing = largest_spacing;
  return surface;
}

SurfacePoint ParticleSurface::point(const std::size_t i, const Mat &F) const
{
  // From the cosine of the normals that meet at a particle: an edge of 90
  // degrees has none of its own, a facet of a round side (0.92 with eight
  // around) does.
  constexpr double edge = 0.75, face = 0.9, least_flatness = 0.02;
  SurfacePoint point;
  const double cosine = norm(outward[i]);
  if (!(cosine > 0.))
    return point;
  point.flatness =
      std::clamp((cosine - edge) / (face - edge), least_flatness, 1.);
  point.spread = 2. * std::max(0., 1. - cosine);
  point.normal = transpose(inverse(F)) * outward[i];
  point.normal *= 1. / norm(point.normal);
  point.spacing = spacing[i] * std::sqrt(std::abs(determinant(F)) /
                                         norm(transpose(F) * point.normal));
  return point;
}

VolumePoint particle_volume(const std::size_t i, const ParticleFields &fields,
                            const ParticleApproximation &approximation,
                            const LagrangianKernel &kernel)
{
  // 1.75 spacings: half of the space is filled within 0.005 spacings of a
  // lattice's face wherever along it, and deep inside 0.98 to 1.005 of it; 1.5
  // make bumps of 0.08, and more rounds edges more.
  constexpr double radius = 1.75;
  VolumePoint point;
  double volume = fields.reference_volume[i];
  if (approximation.lost_direction[i])
  {
    // What lost a direction has no shape to speak of.
    point.to_unit = 1. / (radius * kernel.local_spacing(i)) * Mat::identity();
  }
  else
  {
    const Mat &F = fields.incremental_deformation_gradient[i];
    const Mat to_space = (radius / kernel.support()) * (F * fields.kernel[i]);
    point.to_unit = inverse(to_space);
    volume = fields.kernel_reference_volume[i] * determinant(F);
  }
  // The integral of the spline over the unit ball is pi/12.
  point.content = 12. / M_PI * volume * std::abs(determinant(point.to_unit));
  return point;
}
} // namespace sabot
