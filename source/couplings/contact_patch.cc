// The pressure of a particle on the nodes of fine faces around it.
#include "sabot/couplings/contact_patch.h"

#include "sabot/kernels/kernel_function.h"
#include "sabot/kernels/patch_weights.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
double ContactPatch::radius(const Body &body_of_nodes,
                            const ContactSurface &nodes,
                            const ContactSurface &faces)
{
  // Faces that are about as small or smaller would bulge between particles.
  constexpr double normalized_radius = 1.5, fine = 0.75;
  if (body_of_nodes.particles() == nullptr ||
      nodes.spacing < fine * faces.spacing)
    return 0.;
  return normalized_radius * std::max(nodes.spacing, faces.spacing);
}

void ContactPatch::reset(const std::vector<ContactSurface> &surfaces,
                         const std::size_t n_slots)
{
  planes.clear();
  for (const ContactSurface &surface : surfaces)
    for (const SymmetryPlane &plane : surface.symmetry_planes)
      if (std::find(planes.begin(), planes.end(), plane) == planes.end())
        planes.push_back(plane);
  number_of_slot.assign(n_slots, -1);
}

Vec ContactPatch::gather(const NearFaces &node, const Vec held,
                         const Vec center, const double radius)
{
  constexpr double cosine = 0.5; // as FaceStanding
  nodes.clear();
  points.clear();
  areas.clear();
  Vec mean = {};
  for (std::size_t k = node.first_face; k < node.last_face; ++k)
  {
    // Nothing of what is farther has a weight, and its images are farther yet.
    if (faces.is_farther(faces.face_of_node[k], center, radius))
      continue;
    const auto &corner = faces.corners[faces.face_of_node[k]];
    const Vec x[4] = {halo.position[corner[0]], halo.position[corner[1]],
                      halo.position[corner[2]], halo.position[corner[3]]};
    const Vec area = 0.5 * cross(x[2] - x[0], x[3] - x[1]);
    const double size = norm(area);
    if (dot(area, held) < cosine * size)
      continue;
    const Vec middle = 0.25 * (x[0] + x[1] + x[2] + x[3]);
    for (unsigned int image = 0; image < images.size(); ++image)
      mean += cubic_spline(norm(images(middle, image) - center) / radius) *
              flipped(area, images.axes(image));
    for (int a = 0; a < 4; ++a)
    {
      std::ptrdiff_t &number = number_of_slot[corner[a]];
      if (number < 0)
      {
        number = nodes.size();
        nodes.push_back({corner[a], 0., 0});
        points.push_back(x[a]);
        areas.push_back(0.);
      }
      areas[number] += 0.25 * size;
    }
  }
  for (const TouchedNode &t : nodes)
    number_of_slot[t.slot] = -1;
  return mean;
}

void ContactPatch::add_images()
{
  const std::size_t n_real = nodes.size();
  for (unsigned int image = 1; image < images.size(); ++image)
    for (std::size_t a = 0; a < n_real; ++a)
    {
      nodes.push_back({nodes[a].slot, 0., images.axes(image)});
      points.push_back(images(points[a], image));
      areas.push_back(areas[a]);
    }
}

bool ContactPatch::spread(const NearFaces &node, const double radius,
                          const FaceProjection &projection,
                          std::vector<TouchedNode> &touched, Vec &normal,
                          double &depth)
{
  const Vec held = projection.face_normal, p = halo.position[node.slot],
            center = p - projection.along * held;
  images.find(planes, center, radius);
  Vec mean = gather(node, held, center, radius);
  add_images();
  const double size = norm(mean);
  if (!(size > 0.))
    return false;
  mean = held;
  if (!patch_weights(points, areas, center, mean, radius, weights))
    return false;
  Vec offset = p;
  for (std::size_t a = 0; a < nodes.size(); ++a)
    offset -= weights[a] * points[a];
  depth = std::max(0., -dot(offset, mean));
  normal = mean;
  for (std::size_t a = 0; a < nodes.size(); ++a)
    if (weights[a] != 0.)
    {
      touched.push_back(nodes[a]);
      touched.back().weight = weights[a];
    }
  return true;
}
} // namespace sabot
