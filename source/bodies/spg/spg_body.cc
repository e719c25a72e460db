#include "sabot/bodies/spg/spg_body.h"

#include "sabot/base/error.h"
#include "sabot/bodies/body_report.h"
#include "sabot/bodies/flow_stress.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
SpgBody::SpgBody(const std::string &name, const int id, ParticleCloud cloud,
                 std::shared_ptr<const Material> material,
                 const SpgOptions &options)
    : Body(name, id), cloud(std::move(cloud)), material(std::move(material)),
      options(options), n_global(this->cloud.position.size()),
      spacing(this->cloud.spacing),
      mean_spacing(std::cbrt(spacing[0] * spacing[1] * spacing[2])),
      face_axis(this->cloud.face_axis), is_regular(this->cloud.shape.empty()),
      points(this->material)
{
  bool known = options.failure_criterion !=
               SpgOptions::FailureCriterion::effective_plastic_strain;
  known = known || points.has_state("effective plastic strain");
  if (options.can_fail() && !known)
    throw InputError("Bodies/" + name + "/Critical effective plastic strain",
                     "the body's material has no effective plastic strain; "
                     "use a law with plasticity or remove the entry");
  if (options.conducts_heat && !(this->material->conductivity() > 0.))
    throw InputError("Bodies/" + name + "/Heat conduction",
                     "the body's material has no temperature or no thermal "
                     "conductivity; set \"Thermal conductivity\" of a law "
                     "with temperature, for example 167 W/m/K");
  for (unsigned int face = 0; face < ParticleCloud::n_faces; ++face)
    if (options.symmetry_faces & 1u << face &&
        (face >= face_axis.size() || face_axis[face] < 0))
      throw InputError("Bodies/" + name + "/Symmetry faces",
                       "these faces do not lie in one plane across the x, y "
                       "or z axis; a symmetry plane must");
  for (unsigned int face = 0; face < face_axis.size(); ++face)
    if (options.symmetry_faces & 1u << face)
      for (std::size_t i = 0; i < n_global; ++i)
        if (this->cloud.on_face[i] & 1u << face)
        {
          symmetry_planes.push_back(
              {face_axis[face], this->cloud.position[i][face_axis[face]]});
          break;
        }
}

void SpgBody::distribute(const std::vector<int> &owner, MPI_Comm comm)
{
  communicator = comm;
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::vector<GlobalIndex> ids;
  for (std::size_t i = 0; i < owner.size(); ++i)
    if (owner[i] == rank)
      ids.push_back(i);
  const std::size_t n = ids.size();
  AlignedVector<Mat> kernels = cloud.shape;
  if (is_regular)
    kernels.push_back(Mat{
        {vec(spacing[0], 0, 0), vec(0, spacing[1], 0), vec(0, 0, spacing[2])}});
  for (Mat &H : kernels)
    H = options.normalized_support * H;
  BondList::Rows rows;
  try
  {
    rows = BondList::rows_in_kernels(
        cloud.position, kernels,
        options.kernel_shape == SpgOptions::KernelShape::tensor, ids);
  }
  catch (const std::invalid_argument &e)
  {
    throw InputError("Bodies/" + name, e.what());
  }
  rank_of = owner;
  nodal_state.resize(n);
  nodal_state.n_owned = n;
  nodal_state.global_id = ids;
  on_face.resize(n);
  const AlignedVector<Vec> normals =
      outward_normals(cloud, options.symmetry_faces);
  outward.resize(n);
  reference_volume.resize(n);
  const auto &v = options.initial_velocity;
  for (std::size_t i = 0; i < n; ++i)
  {
    const auto &p = cloud.position[ids[i]];
    const double volume = cloud.volume[ids[i]];
    nodal_state.reference_position[i] = nodal_state.position[i] =
        vec(p[0], p[1], p[2]);
    nodal_state.velocity[i] = vec(v[0], v[1], v[2]);
    nodal_state.force[i] = Vec{};
    nodal_state.lumped_mass[i] = nodal_state.inertia[i] =
        material->density() * volume;
    on_face[i] = cloud.on_face[ids[i]];
    const unsigned int planes = symmetry_axes(i);
    // Its mirror image has the other half of a plane's facets.
    Vec normal = normals[ids[i]];
    const double cosine = norm(normal);
    for (int d = 0; d < 3; ++d)
      if (planes >> d & 1)
      {
        normal[d] = 0.;
        constraints.prescribe(i, d, 0.);
      }
    outward[i] =
        norm_square(normal) > 0. ? cosine / norm(normal) * normal : normal;
    reference_volume[i] = volume;
    if (on_face[i] & options.clamped_faces)
      for (int d = 0; d < 3; ++d)
        constraints.prescribe(i, d, 0.);
    if (!is_regular)
      initial_kernel.push_back(kernels[ids[i]]);
  }
  constraints.finish();
  renumber(rows);
  cloud = ParticleCloud();

  kernel_volume = reference_volume;
  gradient.assign(n, Mat::identity());
  total_gradient.assign(n, Mat::identity());
  moment_inverse.resize(n);
  bond_stiffness.resize(n);
  weak.resize(n);
  residual_factor.assign(n, 1.);
  n_failed.assign(n, 0);
  if (options.neighbor_policy == SpgOptions::NeighborPolicy::search)
    failed_pairs.resize(n);
  if (options.stabilization == Stabilization::second_gradient)
  {
    second_gradient = std::make_unique<SecondGradient>(
        material->bulk_modulus(), material->shear_modulus(), n);
    second_gradient->generalized_stress.resize(nodal_state.size());
  }
  points.allocate(n, n);
  if (material->stiffens())
    stiffening.assign(n, 1.);
  bond_work.assign(n, 0.);
  failure_loss.assign(n, 0.);
  own_force.assign(n, Vec{});
  update_stable_step.resize(n);
  std::fill(std::begin(batch.extra_square), std::end(batch.extra_square), 0.);
  set_up_kernel();
  if (options.conducts_heat)
    set_up_conduction();
}

void SpgBody::set_up_conduction()
{
  std::vector<double> capacity = reference_volume;
  for (double &c : capacity)
    c *= material->density() * material->specific_heat();
  heat = std::make_unique<ParticleConduction>(
      material->conductivity(),
      ParticleConduction::Cloud{bonds, node_exchange, kernel_position,
                                moment_inverse, kernel_volume, weak},
      std::move(capacity), communicator);
}

void SpgBody::conduct_heat(const double time)
{
  heat->advance(time - last_conduction, points.state("temperature"));
  last_conduction = time;
}

double SpgBody::local_spacing(const std::size_t i) const
{
  return is_regular ? mean_spacing
                    : std::cbrt(determinant(initial_kernel[i])) /
                          options.normalized_support;
}

void SpgBody::renumber(const BondList::Rows &rows)
{
  const std::size_t n = nodal_state.n_owned;
  std::vector<GlobalIndex> ids(nodal_state.global_id.begin(),
                               nodal_state.global_id.begin() + n);
  const std::vector<GlobalIndex> ghosts = BondList::ghosts_of(rows, ids);
  std::vector<int> ghost_owner;
  for (const GlobalIndex g : ghosts)
    ghost_owner.push_back(rank_of[g]);
  node_exchange = GhostExchange(
      communicator, n, ghost_owner, ghosts,
      [&](const GlobalIndex key)
      { return std::lower_bound(ids.begin(), ids.end(), key) - ids.begin(); });
  ids.insert(ids.end(), ghosts.begin(), ghosts.end());
  nodal_state.resize(ids.size());
  nodal_state.global_id = ids;
  node_exchange.update(nodal_state.reference_position.data());
  node_exchange.update(nodal_state.position.data());
  node_exchange.update(nodal_state.velocity.data());
  node_exchange.update(nodal_state.lumped_mass.data());
  node_exchange.update(nodal_state.inertia.data());
  bonds.connect(rows, ids, ghost_owner, n_global, communicator);
  generalized_stress.resize(ids.size(), Mat::zero());
  kernel.resize(ids.size());
  previous_position = nodal_state.position;
  failure_measure.resize(ids.size());
  if (second_gradient)
    second_gradient->generalized_stress.resize(ids.size());
}

std::vector<std::size_t>
SpgBody::particles_on_faces(const std::uint32_t faces) const
{
  std::vector<std::size_t> particles;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    if (on_face[i] & faces)
      particles.push_back(i);
  return particles;
}

unsigned int SpgBody::symmetry_axes(const std::size_t i) const
{
  unsigned int axes = 0;
  for (std::size_t face = 0; face < face_axis.size(); ++face)
    if (on_face[i] & options.symmetry_faces & 1u << face)
      axes |= 1u << face_axis[face];
  return axes;
}

ContactSurface SpgBody::contact_surface() const
{
  // Any particle may come to lie open, so all may touch faces.
  ContactSurface surface;
  surface.nodes.resize(nodal_state.n_owned);
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    surface.nodes[i] = i;
  if (options.symmetry_faces != 0)
    for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
      surface.node_share.push_back(
          std::ldexp(1., -__builtin_popcount(symmetry_axes(i))));
  surface.symmetry_planes = symmetry_planes;
  surface.bulk_modulus = material->bulk_modulus();
  surface.spacing = mean_spacing;
  return surface;
}

std::vector<double>
SpgBody::flow_stress(const std::vector<std::size_t> &some_nodes) const
{
  FlowStressProbe probe(*material);
  for (const std::size_t i : some_nodes)
    points.add_to(probe, i,
                  determinant(gradient[i]) * kernel_volume[i] /
                      reference_volume[i]);
  return probe.flow_stress();
}

SurfacePoint SpgBody::surface_point(const std::size_t i) const
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
  // Normals go with F^-T, areas with det F over the length of F^T n.
  const Mat F = deformation_gradient(i);
  point.normal = transpose(inverse(F)) * outward[i];
  point.normal *= 1. / norm(point.normal);
  point.spacing = mean_spacing * std::sqrt(std::abs(determinant(F)) /
                                           norm(transpose(F) * point.normal));
  return point;
}

VolumePoint SpgBody::volume_point(const std::size_t i) const
{
  // 1.75 spacings: half of the space is filled within 0.005 spacings of a
  // lattice's face wherever along it, and deep inside 0.98 to 1.005 of it; 1.5
  // make bumps of 0.08, and more rounds edges more.
  constexpr double radius = 1.75;
  VolumePoint point;
  double volume = reference_volume[i];
  if (weak[i])
  {
    // What lost a direction has no shape to speak of.
    point.to_unit = 1. / (radius * local_spacing(i)) * Mat::identity();
  }
  else
  {
    const Mat to_space =
        (radius / options.normalized_support) * (gradient[i] * kernel[i]);
    point.to_unit = inverse(to_space);
    volume = kernel_volume[i] * determinant(gradient[i]);
  }
  // The integral of the spline over the unit ball is pi/12.
  point.content = 12. / M_PI * volume * std::abs(determinant(point.to_unit));
  return point;
}

DebrisView SpgBody::debris() const
{
  DebrisView view;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    if (n_failed[i] > 0)
      view.nodes.push_back(i);
  view.bulk_modulus = material->bulk_modulus();
  view.spacing = mean_spacing;
  return view;
}

bool SpgBody::are_bonded(const std::size_t i, const GlobalIndex j) const
{
  for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    if (nodal_state.global_id[bonds.neighbor[b]] == j)
      return true;
  return false;
}
} // namespace sabot
