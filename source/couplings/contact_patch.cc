#include "sabot/couplings/contact.h"
#include "sabot/kernels/patch_weights.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
double Contact::patch_radius(const int nodes_of, const int faces_of) const
{
  // A particle stands for a volume as wide as the spacing, not for a point:
  // faces that are about as small or smaller would bulge between particles.
  constexpr double normalised_radius = 1.5, fine = 0.75;
  const ContactSurface &nodes = surfaces[nodes_of], &faces = surfaces[faces_of];
  if (bodies[nodes_of]->particles() == nullptr ||
      nodes.spacing < fine * faces.spacing)
    return 0.;
  return normalised_radius * std::max(nodes.spacing, faces.spacing);
}

void Contact::spread(const Group &group, const std::ptrdiff_t face,
                     const FaceProjection &projection, Vec &normal,
                     double &depth)
{
  touched.clear();
  for (int a = 0; a < 4; ++a)
    touched.push_back({face_slots[face][a], projection.weight[a], 0});
  normal = projection.normal;
  depth = -projection.gap;
  if (group.patch_radius > 0. && projection.along < 0.)
    spread_over_patch(group, projection, normal, depth);
}

void Contact::spread_over_patch(const Group &group,
                                const FaceProjection &projection, Vec &normal,
                                double &depth)
{
  // Nodes of all faces that look the same way, with their areas, the mean of
  // the faces' normals, and the mirror images of both in planes of symmetry:
  // there the half that is not modelled bears its part of the patch.
  constexpr double cosine = 0.5;
  const double radius = group.patch_radius;
  const Vec held = projection.face_normal, p = halo.position[group.slot],
            centre = p - projection.along * held;
  images.find(symmetry_planes, centre, radius);

  patch.clear();
  patch_points.clear();
  patch_areas.clear();
  Vec mean = {};
  for (std::size_t k = group.first_face; k < group.last_face; ++k)
  {
    const auto &corner = face_slots[face_of_group[k]];
    const Vec x[4] = {halo.position[corner[0]], halo.position[corner[1]],
                      halo.position[corner[2]], halo.position[corner[3]]};
    const Vec area = 0.5 * cross(x[2] - x[0], x[3] - x[1]);
    const double size = norm(area);
    if (dot(area, held) < cosine * size)
      continue;
    const Vec middle = 0.25 * (x[0] + x[1] + x[2] + x[3]);
    for (unsigned int image = 0; image < images.size(); ++image)
      mean += cubic_spline(norm(images(middle, image) - centre) / radius) *
              flipped(area, images.axes(image));
    for (int a = 0; a < 4; ++a)
    {
      std::ptrdiff_t &number = touched_number[corner[a]];
      if (number < 0)
      {
        number = patch.size();
        patch.push_back({corner[a], 0., 0});
        patch_points.push_back(x[a]);
        patch_areas.push_back(0.);
      }
      patch_areas[number] += 0.25 * size;
    }
  }
  for (const Touched &t : patch)
    touched_number[t.slot] = -1;
  const std::size_t n_real = patch.size();
  for (unsigned int image = 1; image < images.size(); ++image)
    for (std::size_t a = 0; a < n_real; ++a)
    {
      patch.push_back({patch[a].slot, 0., images.axes(image)});
      patch_points.push_back(images(patch_points[a], image));
      patch_areas.push_back(patch_areas[a]);
    }
  const double size = norm(mean);
  if (!(size > 0.))
    return;
  mean = (1. / size) * mean;
  if (!patch_weights(patch_points, patch_areas, centre, mean, radius,
                     patch_weight))
    return;
  // The gap to the same mean of the nodes that the force goes to, so that
  // force and gap belong to one energy; past a rim it is let go as before.
  Vec offset = p;
  for (std::size_t a = 0; a < patch.size(); ++a)
    offset -= patch_weight[a] * patch_points[a];
  const double rim = projection.gap / projection.along;
  depth = std::min(1., std::max(0., rim)) * std::max(0., -dot(offset, mean));
  normal = mean;
  touched.clear();
  for (std::size_t a = 0; a < patch.size(); ++a)
    if (patch_weight[a] != 0.)
    {
      touched.push_back(patch[a]);
      touched.back().weight = patch_weight[a];
    }
}

double Contact::compliance(const Group &group) const
{
  // An image stands for the node of the other half, whose mass is that of its
  // own; of a particle on the plane only its share presses here.
  double sum = 0.;
  for (const Touched &t : touched)
    sum += t.weight * t.weight / halo.inertia[t.slot];
  return group.patch_radius > 0. ? sum / group.share : sum;
}

Vec Contact::velocity_of_touched() const
{
  Vec v = {};
  for (const Touched &t : touched)
    v += t.weight * flipped(halo.velocity[t.slot], t.mirrored);
  return v;
}

double Contact::shear_limit(const Group &group) const
{
  if (!options.limit_by_yield)
    return options.shear_limit;
  double its = 0.;
  for (const Touched &t : touched)
    its += t.weight * flow_stress[t.slot];
  return std::min(flow_stress[group.slot], its) / std::sqrt(3.);
}

void Contact::push_touched(const Vec force, AlignedVector<Vec> &to) const
{
  for (const Touched &t : touched)
    to[t.slot] -= flipped(t.weight * force, t.mirrored);
}
} // namespace sabot
