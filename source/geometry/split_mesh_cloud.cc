// Particles on the sites of split hexahedra, as many as are asked for.
#include "sabot/geometry/split_mesh.h"

#include <algorithm>
#include <unordered_map>

namespace sabot
{
namespace
{
/** The quadrilaterals of one side of a lattice of @p n cells, 2 d for the lower
    one across direction d. @p at_place: the node at a point of it. */
template <typename AtPlace>
void add_side(const unsigned int side, const unsigned int id,
              const std::array<std::uint32_t, 3> &n, const AtPlace &at_place,
              HexMesh &fine)
{
  // Outwards: from the second direction to the first on the lower side.
  const unsigned int d = side / 2, upper = side % 2,
                     a = (d + (upper ? 1 : 2)) % 3,
                     b = (d + (upper ? 2 : 1)) % 3;
  std::array<unsigned int, 3> p{};
  p[d] = upper ? n[d] : 0;
  for (unsigned int t = 0; t < n[b]; ++t)
    for (unsigned int s = 0; s < n[a]; ++s)
    {
      const auto corner = [&](const unsigned int ds, const unsigned int dt)
      {
        p[a] = s + ds;
        p[b] = t + dt;
        return at_place(p);
      };
      fine.boundary_faces.push_back(
          {{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}});
      fine.boundary_id.push_back(id);
    }
}
} // namespace

HexMesh SplitMesh::fine_part(const std::vector<GlobalIndex> &some,
                             std::vector<GlobalIndex> &sites) const
{
  constexpr int corner_bits[8] = {0, 1, 3, 2, 4, 5, 7, 6};
  HexMesh fine;
  std::unordered_map<GlobalIndex, GlobalIndex> number;
  const auto node_of = [&](const GlobalIndex site)
  {
    const auto [found, is_new] = number.emplace(site, sites.size());
    if (is_new)
      sites.push_back(site);
    return found->second;
  };
  for (const GlobalIndex c : some)
  {
    const auto &n = cells[c].parts;
    std::vector<GlobalIndex> node; // of the cell's lattice
    for (const Member &member : members(c))
      node.push_back(node_of(member.site));
    const auto at_place = [&](const Index &i)
    { return node[i[0] + (n[0] + 1) * (i[1] + (n[1] + 1) * i[2])]; };
    Index i;
    for (i[2] = 0; i[2] < n[2]; ++i[2])
      for (i[1] = 0; i[1] < n[1]; ++i[1])
        for (i[0] = 0; i[0] < n[0]; ++i[0])
        {
          std::array<GlobalIndex, 8> corners;
          for (int a = 0; a < 8; ++a)
          {
            const unsigned int bits = corner_bits[a];
            corners[a] = at_place({{i[0] + (bits & 1), i[1] + (bits >> 1 & 1),
                                    i[2] + (bits >> 2)}});
          }
          fine.cells.push_back(corners);
        }
    const auto first = std::lower_bound(
        outside.begin(), outside.end(), c,
        [](const Outside &o, const GlobalIndex cell) { return o.cell < cell; });
    for (auto o = first; o != outside.end() && o->cell == c; ++o)
      add_side(o->side, o->id, n, at_place, fine);
  }
  for (const GlobalIndex site : sites)
  {
    const Carrier on = carrier(site);
    std::array<double, 3> x{};
    for (int a = 0; a < on.n; ++a)
      for (int d = 0; d < 3; ++d)
        x[d] += on.weight[a] * mesh.nodes[on.node[a]][d];
    fine.nodes.push_back(x);
  }
  return fine;
}

ParticleCloud SplitMesh::cloud_of(const std::vector<GlobalIndex> &wanted,
                                  const std::uint32_t without,
                                  AlignedVector<Vec> &outward,
                                  std::vector<double> &along) const
{
  std::vector<GlobalIndex> around;
  for (const GlobalIndex site : wanted)
    for (const GlobalIndex cell : cells_around(carrier(site)))
      around.push_back(cell);
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  std::vector<GlobalIndex> sites;
  const ParticleCloud part = make_mesh_cloud(fine_part(around, sites));
  const AlignedVector<Vec> normals = outward_normals(part, without);
  const std::vector<double> spacings = surface_spacings(part, without);
  std::unordered_map<GlobalIndex, std::size_t> place;
  for (std::size_t k = 0; k < sites.size(); ++k)
    place[sites[k]] = k;
  ParticleCloud cloud;
  cloud.spacing = part.spacing;
  outward.clear();
  along.clear();
  for (const GlobalIndex site : wanted)
  {
    const std::size_t k = place.at(site);
    cloud.position.push_back(part.position[k]);
    cloud.volume.push_back(part.volume[k]);
    cloud.shape.push_back(part.shape[k]);
    cloud.on_face.push_back(part.on_face[k]);
    outward.push_back(normals[k]);
    along.push_back(spacings[k]);
  }
  return cloud;
}
} // namespace sabot
