#include "sabot/bodies/spg/spg_body.h"

#include "sabot/base/error.h"
#include "sabot/base/quantity.h"
#include "sabot/bodies/body_report.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
void SpgOptions::declare_parameters(dealii::ParameterHandler &prm)
{
  const SpgOptions d;
  using dealii::Patterns::Double;
  using dealii::Patterns::Integer;
  prm.declare_entry("Normalised support size", "2.0",
                    QuantityPattern(Dimension::none, 1.8, 2.8),
                    "Kernel radius over nodal spacing.");
  prm.declare_entry("Stabilisation coefficient", "4",
                    QuantityPattern(Dimension::none, 0., 20.),
                    "Stiffness of the bond residual in shear moduli; 3 to 5 "
                    "give the same answers, 0 switches it off.");
  prm.declare_entry("Kernel update interval", "30", Integer(1),
                    "Steps between updates of the Lagrangian kernel; an "
                    "update is also made when a volume changes by 60 %.");
  prm.declare_entry("Failure check interval", "5", Integer(1),
                    "Steps between checks of the bonds; where any fails, the "
                    "kernel is updated at once.");
  prm.declare_entry("Critical effective plastic strain", "1e10",
                    QuantityPattern(Dimension::none, 0.),
                    "A bond fails for ever when the mean effective plastic "
                    "strain of its ends exceeds this and its stretch exceeds "
                    "the critical stretch. 1e10: bonds never fail.");
  prm.declare_entry("Critical stretch", "1",
                    QuantityPattern(Dimension::none, 1., 10.),
                    "Distance over original distance above which a bond may "
                    "fail; at least 1, so that none fails in compression.");
  prm.declare_entry("Linear bulk viscosity", "0.06",
                    QuantityPattern(Dimension::none, 0., 1.),
                    "Coefficient of rho c h |div v| in compression.");
  prm.declare_entry("Quadratic bulk viscosity", "1.5",
                    QuantityPattern(Dimension::none, 0., 10.),
                    "Coefficient of rho h^2 (div v)^2 in compression.");
}

SpgOptions SpgOptions::parse(const dealii::ParameterHandler &prm)
{
  SpgOptions o;
  o.normalized_support = get_quantity(prm, "Normalised support size");
  o.stabilization_coefficient = get_quantity(prm, "Stabilisation coefficient");
  o.kernel_update_interval = prm.get_integer("Kernel update interval");
  o.failure_check_interval = prm.get_integer("Failure check interval");
  o.critical_effective_plastic_strain =
      get_quantity(prm, "Critical effective plastic strain");
  o.critical_stretch = get_quantity(prm, "Critical stretch");
  o.bulk_viscosity_linear = get_quantity(prm, "Linear bulk viscosity");
  o.bulk_viscosity_quadratic = get_quantity(prm, "Quadratic bulk viscosity");
  return o;
}

SpgBody::SpgBody(const std::string &name, const int id, ParticleCloud cloud,
                 std::shared_ptr<const Material> material,
                 const SpgOptions &options)
    : Body(name, id), cloud(std::move(cloud)), material(std::move(material)),
      options(options), n_global(this->cloud.position.size()),
      spacing(this->cloud.spacing),
      mean_spacing(std::cbrt(spacing[0] * spacing[1] * spacing[2])),
      state_variables(this->material->state_variables())
{
  n_states = count_states(state_variables);
  bool fails = options.critical_effective_plastic_strain < 1e10, known = false;
  for (const StateVariable &variable : state_variables)
    known = known || variable.name == "effective plastic strain";
  if (fails && !known)
    throw InputError("Bodies/" + name + "/Critical effective plastic strain",
                     "the body's material has no effective plastic strain; "
                     "use a law with plasticity or remove the entry");
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
  std::vector<GlobalIndex> ghosts;
  try
  {
    ghosts = bonds.build(cloud.position, cloud.spacing,
                         options.normalized_support, ids);
  }
  catch (const std::invalid_argument &e)
  {
    throw InputError("Bodies/" + name, e.what());
  }
  std::vector<int> ghost_owner;
  for (const GlobalIndex g : ghosts)
    ghost_owner.push_back(owner[g]);
  node_exchange = GhostExchange(
      communicator, n, ghost_owner, ghosts,
      [&](const GlobalIndex key)
      { return std::lower_bound(ids.begin(), ids.end(), key) - ids.begin(); });

  ids.insert(ids.end(), ghosts.begin(), ghosts.end());
  nodal_state.resize(ids.size());
  nodal_state.n_owned = n;
  nodal_state.global_id = ids;
  on_face.resize(n);
  reference_volume.resize(n);
  const auto &v = options.initial_velocity;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const auto &p = cloud.position[ids[i]];
    const double volume = cloud.volume[ids[i]];
    nodal_state.reference_position[i] = nodal_state.position[i] =
        vec(p[0], p[1], p[2]);
    nodal_state.velocity[i] = vec(v[0], v[1], v[2]);
    nodal_state.force[i] = Vec{};
    nodal_state.lumped_mass[i] = nodal_state.inertia[i] =
        material->density() * volume;
    if (i < n)
    {
      on_face[i] = cloud.on_face[ids[i]];
      reference_volume[i] = volume;
      for (int face = 0; face < 6; ++face)
        if (on_face[i] & options.symmetry_faces & 1 << face)
          constraints.prescribe(i, face / 2, 0.);
    }
  }
  constraints.finish();
  bonds.connect(ids, ghost_owner, n_global, communicator);
  cloud = ParticleCloud();

  kernel_volume = reference_volume;
  generalized_stress.assign(ids.size(), Mat::zero());
  kernel.resize(ids.size());
  plastic_strain_copy.assign(ids.size(), 0.);
  gradient.assign(n, Mat::identity());
  total_gradient.assign(n, Mat::identity());
  moment_inverse.resize(n);
  bond_stiffness.resize(n);
  weak.resize(n);
  has_failed_bond.assign(n, 0);
  stress_data.assign(6 * n, 0.);
  state_data.resize(n_states * n);
  std::size_t s = 0;
  for (const StateVariable &variable : state_variables)
    for (int c = 0; c < (variable.is_tensor ? 6 : 1); ++c, ++s)
      std::fill_n(&state_data[s * n], n, variable.initial_value);
  batch_states.resize(n_states);
  viscous_pressure.assign(n, 0.);
  internal_energy.assign(n, 0.);
  bond_work.assign(n, 0.);
  force_on_residual.assign(n, 0.);
  plastic_work.assign(n, 0.);
  update_stable_step.resize(n);
  std::fill(std::begin(batch.return_factor), std::end(batch.return_factor), 1.);
  set_up_kernel();
}

const double *SpgBody::state_array(const std::string &wanted) const
{
  return find_state(state_variables, state_data, nodal_state.n_owned, wanted);
}

std::vector<std::size_t>
SpgBody::particles_on_faces(const std::uint8_t faces) const
{
  std::vector<std::size_t> particles;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    if (on_face[i] & faces)
      particles.push_back(i);
  return particles;
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
      surface.node_share.push_back(std::ldexp(
          1., -__builtin_popcount(on_face[i] & options.symmetry_faces)));
  surface.bulk_modulus = material->bulk_modulus();
  surface.spacing = mean_spacing;
  return surface;
}

DebrisView SpgBody::debris() const
{
  DebrisView view;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    if (has_failed_bond[i])
      view.nodes.push_back(i);
  const double K = material->bulk_modulus(), G = material->shear_modulus();
  view.young_modulus = 9. * K * G / (3. * K + G);
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
