#include "sabot/couplings/contact.h"
#include "sabot/kernels/patch_weights.h"

#include <algorithm>

namespace sabot
{
double Contact::patch_radius(const int nodes_of, const int faces_of) const
{
  // A particle stands for a volume as wide as the spacing, not for a point:
  // faces that are about as small or smaller would bulge between particles.
  constexpr double normalised_radius = 1.5, fine = 0.75;
  const ContactSurface &nodes = surfaces[nodes_of], &faces = surfaces[faces_of];
  if (bodies[nodes_of]->item_name() != "particles" ||
      nodes.spacing < fine * faces.spacing)
    return 0.;
  return normalised_radius * std::max(nodes.spacing, faces.spacing);
}

void Contact::spread(const Group &group, const std::ptrdiff_t face,
                     const FaceProjection &projection, Vec &normal,
                     double &depth)
{
  touched_slots.assign(face_slots[face].begin(), face_slots[face].end());
  touched_weights.assign(projection.weight.begin(), projection.weight.end());
  normal = projection.normal;
  depth = -projection.gap;
  if (group.patch_radius == 0. || !(projection.along < 0.))
    return;

  // Areas of the nodes of all faces that look the same way, and the mean of
  // their normals.
  constexpr double cosine = 0.5;
  const Vec held = projection.face_normal;
  std::vector<std::size_t> slots;
  touched_area.clear();
  touched_points.clear();
  const Vec p = halo.position[group.slot];
  const Vec centre = p - projection.along * held;
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
    mean += cubic_spline(norm(middle - centre) / group.patch_radius) * area;
    for (int a = 0; a < 4; ++a)
    {
      std::ptrdiff_t &number = touched_number[corner[a]];
      if (number < 0)
      {
        number = slots.size();
        slots.push_back(corner[a]);
        touched_points.push_back(x[a]);
        touched_area.push_back(0.);
      }
      touched_area[number] += 0.25 * size;
    }
  }
  for (const std::size_t slot : slots)
    touched_number[slot] = -1;
  const double size = norm(mean);
  if (!(size > 0.))
    return;
  mean = (1. / size) * mean;
  std::vector<double> weights;
  if (!patch_weights(touched_points, touched_area, centre, mean,
                     group.patch_radius, weights))
    return;
  // The gap to the same mean of the nodes that the force goes to, so that
  // force and gap belong to one energy; past a rim it is let go as before.
  Vec offset = p;
  for (std::size_t a = 0; a < slots.size(); ++a)
    offset -= weights[a] * touched_points[a];
  const double rim = projection.gap / projection.along;
  depth = std::min(1., std::max(0., rim)) * std::max(0., -dot(offset, mean));
  normal = mean;
  touched_slots.clear();
  touched_weights.clear();
  for (std::size_t a = 0; a < slots.size(); ++a)
    if (weights[a] != 0.)
    {
      touched_slots.push_back(slots[a]);
      touched_weights.push_back(weights[a]);
    }
}
} // namespace sabot
