// An SPG body as couplings and reports see particles.
#include "sabot/bodies/spg/spg_views.h"

#include "sabot/bodies/memory_lists.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/failure/fragments.h"
#include "sabot/bodies/spg/image_reaction.h"
#include "sabot/bodies/spg/mirror_planes.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"
#include "sabot/bodies/spg/stable_step.h"

namespace sabot
{
SurfacePoint SpgViews::surface_point(const std::size_t i) const
{
  return surface.point(i, body.fields.deformation_gradient(i));
}

VolumePoint SpgViews::volume_point(const std::size_t i) const
{
  return particle_volume(i, body.fields, body.approximation, body.kernel);
}

Vec SpgViews::present_area(const std::size_t i, const Vec area) const
{
  if (body.approximation.lost_direction[i])
    return Vec{};
  const Mat F = body.fields.deformation_gradient(i);
  return determinant(F) * (transpose(inverse(F)) * area);
}

Vec SpgViews::own_force(const std::size_t i) const
{
  return body.fields.own_force[i];
}

DebrisView SpgViews::debris() const
{
  DebrisView view;
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
    if (body.failure.has_cracks(i))
      view.nodes.push_back(i);
  if (body.failure.keeps_crumbled())
    for (const std::size_t i : view.nodes)
      view.is_continuous.push_back(body.failure.has_crumbled(i));
  view.bulk_modulus = body.points.law().bulk_modulus();
  view.spacing = body.kernel.mean_spacing();
  return view;
}

bool SpgViews::are_bonded(const std::size_t i, const GlobalIndex j) const
{
  const BondList &bonds = body.bonds;
  const std::size_t b = bonds.first_from(i, j);
  return b < bonds.end(i) && body.nodes.global_id[bonds.neighbor[b]] == j &&
         body.failure.is_cohesive(i, bonds.neighbor[b]);
}

bool SpgViews::are_bonded(const std::size_t i, const GlobalIndex j,
                          const Vec place) const
{
  constexpr double round_off = 1e-6;
  const double tolerance = round_off * body.kernel.mean_spacing();
  const BondList &bonds = body.bonds;
  const NodalState &nodes = body.nodes;
  // Images stand behind the particles.
  for (std::size_t b = bonds.first_from(i, MirrorPlanes::image(0, 1));
       b < bonds.end(i); ++b)
  {
    const std::uint32_t other = bonds.neighbor[b];
    if (MirrorPlanes::particle_of(nodes.global_id[other]) == j &&
        norm(nodes.position[other] - place) < tolerance)
      return body.failure.is_cohesive(i, other);
  }
  return false;
}

std::size_t SpgViews::n_bonds() const
{
  std::size_t n = 0;
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
    n += body.bonds.n_bonds(i);
  return n;
}

std::vector<GlobalIndex> SpgViews::piece_labels() const
{
  return known_pieces.labels(body, communicator);
}

std::vector<Fragment> SpgViews::connected_pieces() const
{
  constexpr double within = 1e-3; // of a spacing; particles are one apart
  const std::vector<SymmetryPlane> &planes = surface.planes();
  return find_fragments(
      body.nodes, known_pieces.labels(body, communicator),
      known_pieces.planes(body, planes, within * body.kernel.mean_spacing()),
      planes, communicator);
}

void SpgViews::list_memory(MemoryTable &table) const
{
  sabot::list_memory(body.nodes, table);
  body.bonds.list_memory(table);
  body.fields.list_memory(table);
  body.approximation.list_memory(table);
  form.list_memory(table);
  sabot::list_memory(body.points, table);
  body.failure.list_memory(table);
  body.stable_step.list_memory(table);
  body.kernel.list_memory(table);
  surface.list_memory(table);
  known_pieces.list_memory(table);
  if (body.reaction)
    body.reaction->list_memory(table);
  table.add("rank of every particle of the body", rank_of);
}
} // namespace sabot
