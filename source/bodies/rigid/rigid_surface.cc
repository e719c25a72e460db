// The surface of a rigid body, as contact and loads see it.
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/geometry/edge_distance.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
void RigidBody::take_faces(const LocalPart &part)
{
  double area = 0.;
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    std::array<std::size_t, 4> face;
    std::array<Vec, 4> x;
    bool complete = true;
    for (int a = 0; a < 4; ++a)
    {
      const GlobalIndex node = mesh.boundary_faces[f][a];
      const auto found = part.local.find(node);
      complete = complete && found != part.local.end();
      face[a] = found != part.local.end() ? found->second : 0;
      x[a] = vec(mesh.nodes[node][0], mesh.nodes[node][1], mesh.nodes[node][2]);
    }
    area += 0.5 * norm(cross(x[2] - x[0], x[3] - x[1]));
    if (complete)
    {
      boundary_faces.push_back(face);
      face_id.push_back(f);
      boundary.id.push_back(mesh.boundary_id[f]);
    }
  }
  typical_spacing = std::sqrt(area / mesh.boundary_faces.size());
  const std::vector<double> distances = edge_distances(mesh);
  for (const GlobalIndex a : part.nodes)
    boundary.edge_distance.push_back(distances[a]);
}

LoadedSurface
RigidBody::loaded_surface(const std::vector<unsigned int> &ids) const
{
  LoadedSurface surface;
  for (std::size_t f = 0; f < boundary_faces.size(); ++f)
    if (std::find(ids.begin(), ids.end(), boundary.id[f]) != ids.end())
      surface.faces.push_back(boundary_faces[f]);
  return surface;
}

ContactSurface RigidBody::contact_surface() const
{
  ContactSurface surface;
  surface.faces = boundary_faces;
  surface.face_id = face_id;
  for (const auto &face : boundary_faces)
    for (const std::size_t a : face)
      if (a < nodal_state.n_owned)
        surface.nodes.push_back(a);
  std::sort(surface.nodes.begin(), surface.nodes.end());
  surface.nodes.erase(std::unique(surface.nodes.begin(), surface.nodes.end()),
                      surface.nodes.end());
  for (const std::size_t a : surface.nodes)
    surface.edge_distance.push_back(boundary.edge_distance[a]);
  surface.bulk_modulus = material->bulk_modulus();
  surface.spacing = typical_spacing;
  return surface;
}
} // namespace sabot
