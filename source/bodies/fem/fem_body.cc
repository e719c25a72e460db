#include "sabot/bodies/fem/fem_body.h"

#include "sabot/base/quantity.h"
#include "sabot/bodies/body_report.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace sabot
{
void FemOptions::declare_parameters(dealii::ParameterHandler &prm)
{
  prm.declare_entry("Hourglass control", "viscous",
                    dealii::Patterns::Selection("viscous|stiffness"),
                    "Flanagan-Belytschko; viscous for large plastic flow, "
                    "stiffness for elastic bodies.");
  prm.declare_entry("Hourglass coefficient", "0.1",
                    QuantityPattern(Dimension::none, 0., 1.),
                    "Usually 0.03 to 0.15.");
  prm.declare_entry("Heat conduction", "false", dealii::Patterns::Bool(),
                    "Implicit conduction inside the body, faces insulated. "
                    "Needs a law with temperature and conductivity.");
  prm.declare_entry("Conduction interval", "1 us",
                    QuantityPattern(Dimension::time, 0., 1e3),
                    "Time between conduction steps.");
  prm.declare_entry(
      "Objective rate", "Jaumann",
      dealii::Patterns::Selection("Jaumann|Green-Naghdi"),
      "Rate of the stress: with the spin of the velocity gradient, or with "
      "that of the rotation R of F = R U, which does not oscillate in large "
      "elastic shear.");
  prm.declare_entry("Linear bulk viscosity", "0.06",
                    QuantityPattern(Dimension::none, 0., 1.),
                    "Coefficient of rho c h |div v| in compression.");
  prm.declare_entry("Quadratic bulk viscosity", "1.5",
                    QuantityPattern(Dimension::none, 0., 10.),
                    "Coefficient of rho h^2 (div v)^2 in compression.");
}

FemOptions FemOptions::parse(const dealii::ParameterHandler &prm)
{
  FemOptions o;
  o.hourglass = prm.get("Hourglass control") == "viscous"
                    ? Hourglass::viscous
                    : Hourglass::stiffness;
  o.conducts_heat = prm.get_bool("Heat conduction");
  o.conduction_interval = get_quantity(prm, "Conduction interval");
  o.objective_rate = prm.get("Objective rate") == "Jaumann"
                         ? ObjectiveRate::jaumann
                         : ObjectiveRate::green_naghdi;
  o.hourglass_coefficient = get_quantity(prm, "Hourglass coefficient");
  o.bulk_viscosity_linear = get_quantity(prm, "Linear bulk viscosity");
  o.bulk_viscosity_quadratic = get_quantity(prm, "Quadratic bulk viscosity");
  return o;
}

FemBody::FemBody(const std::string &name, const int id, HexMesh mesh,
                 std::shared_ptr<const Material> material,
                 const FemOptions &options)
    : Body(name, id), mesh(std::move(mesh)), material(std::move(material)),
      options(options), n_global_cells(this->mesh.cells.size()),
      state_variables(this->material->state_variables()),
      n_states(count_states(state_variables))
{
  if (options.conducts_heat && !(this->material->conductivity() > 0.))
    throw InputError("Bodies/" + name + "/Heat conduction",
                     "the body's material has no temperature or no thermal "
                     "conductivity; set \"Thermal conductivity\" of a law "
                     "with temperature, for example 167 W/m/K");
}

void FemBody::distribute(const std::vector<int> &owner, MPI_Comm comm)
{
  communicator = comm;
  int rank;
  MPI_Comm_rank(communicator, &rank);

  // Cells of the owned nodes, then the nodes of these cells.
  std::vector<GlobalIndex> owned, ghosts;
  for (std::size_t i = 0; i < owner.size(); ++i)
    if (owner[i] == rank)
      owned.push_back(i);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
  {
    const auto &nodes = mesh.cells[c];
    if (std::none_of(nodes.begin(), nodes.end(),
                     [&](const GlobalIndex a) { return owner[a] == rank; }))
      continue;
    cell_id.push_back(c);
    owned_cell.push_back(owner[*std::min_element(nodes.begin(), nodes.end())] ==
                         rank);
    for (const GlobalIndex a : nodes)
      if (owner[a] != rank)
        ghosts.push_back(a);
  }
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  std::vector<int> ghost_owner;
  for (const GlobalIndex g : ghosts)
    ghost_owner.push_back(owner[g]);
  node_exchange =
      GhostExchange(communicator, owned.size(), ghost_owner, ghosts,
                    [&](const GlobalIndex key) {
                      return std::lower_bound(owned.begin(), owned.end(), key) -
                             owned.begin();
                    });

  std::vector<GlobalIndex> ids = owned;
  ids.insert(ids.end(), ghosts.begin(), ghosts.end());
  std::unordered_map<GlobalIndex, std::uint32_t> local;
  for (std::size_t i = 0; i < ids.size(); ++i)
    local[ids[i]] = i;
  nodal_state.resize(ids.size());
  nodal_state.n_owned = owned.size();
  nodal_state.global_id = ids;
  const auto &v = options.initial_velocity;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const auto &p = mesh.nodes[ids[i]];
    nodal_state.reference_position[i] = nodal_state.position[i] =
        vec(p[0], p[1], p[2]);
    nodal_state.velocity[i] = vec(v[0], v[1], v[2]);
    nodal_state.force[i] = Vec{};
    nodal_state.lumped_mass[i] = 0.;
  }

  // Reference geometry of the cells; masses add up in global cell order.
  const std::size_t n = cell_id.size();
  geometry.resize(n);
  hourglass_modes.resize(n);
  viscous_pressure.assign(n, 0.);
  constexpr int h[4][8] = {{1, 1, -1, -1, -1, -1, 1, 1},
                           {1, -1, -1, 1, -1, 1, 1, -1},
                           {1, -1, 1, -1, 1, -1, 1, -1},
                           {-1, 1, -1, 1, 1, -1, 1, -1}};
  for (std::size_t e = 0; e < n; ++e)
  {
    const GlobalIndex c = cell_id[e];
    std::array<std::uint32_t, 8> nodes;
    HourglassModes &modes = hourglass_modes[e];
    for (Vec &mode : modes.mode)
      mode = Vec{};
    geometry[e].gradient_square = Mat::zero();
    for (int a = 0; a < 8; ++a)
    {
      nodes[a] = local.at(mesh.cells[c][a]);
      const auto &B = mesh.mean_gradient[c][a];
      const Vec gradient = vec(B[0], B[1], B[2]);
      geometry[e].mean_gradient[a] = gradient;
      add_outer(geometry[e].gradient_square, gradient, gradient);
      nodal_state.lumped_mass[nodes[a]] +=
          0.125 * material->density() * mesh.volume[c];
      if (options.hourglass == FemOptions::Hourglass::stiffness)
        for (int m = 0; m < 4; ++m)
          modes.mode[m] +=
              double(h[m][a]) * nodal_state.reference_position[nodes[a]];
    }
    connectivity.push_back(nodes);
    volume.push_back(mesh.volume[c]);
  }
  nodal_state.inertia = nodal_state.lumped_mass;

  double total_area = 0.;
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f)
  {
    std::array<std::size_t, 4> face;
    bool here = true, fixed = std::count(options.clamped_boundary_ids.begin(),
                                         options.clamped_boundary_ids.end(),
                                         mesh.boundary_id[f]) > 0;
    Vec x[4];
    for (int a = 0; a < 4; ++a)
    {
      const GlobalIndex node = mesh.boundary_faces[f][a];
      const auto &p = mesh.nodes[node];
      x[a] = vec(p[0], p[1], p[2]);
      const auto found = local.find(node);
      here = here && found != local.end();
      if (found == local.end())
        continue;
      face[a] = found->second;
      if (fixed && found->second < nodal_state.n_owned)
        clamped.push_back(found->second);
    }
    total_area += 0.5 * norm(cross(x[2] - x[0], x[3] - x[1]));
    if (here)
    {
      boundary_faces.push_back(face);
      boundary_face_id.push_back(f);
    }
  }
  typical_spacing = std::sqrt(total_area / mesh.boundary_faces.size());
  std::sort(clamped.begin(), clamped.end());
  clamped.erase(std::unique(clamped.begin(), clamped.end()), clamped.end());

  gradient.assign(n, Mat::identity());
  if (options.objective_rate == FemOptions::ObjectiveRate::green_naghdi)
    polar_rotation.assign(n, Mat::identity());
  stress_data.assign(6 * n, 0.);
  state_data.resize(n_states * n);
  std::size_t s = 0;
  for (const StateVariable &variable : state_variables)
    for (int c = 0; c < (variable.is_tensor ? n_symmetric : 1); ++c, ++s)
      std::fill_n(&state_data[s * n], n, variable.initial_value);
  batch_states.resize(n_states);
  internal_energy.assign(n, 0.);
  hourglass_energy.assign(n, 0.);
  plastic_work.assign(n, 0.);
  mesh = HexMesh();
  if (options.conducts_heat)
  {
    std::vector<double> capacity = volume;
    for (double &c : capacity)
      c *= material->density() * material->specific_heat();
    heat = std::make_unique<HeatConduction>(material->conductivity(),
                                            connectivity, capacity, nodal_state,
                                            node_exchange, communicator);
  }
}

void FemBody::conduct_heat(const double time)
{
  // Ghost positions are those of the last force computation: now.
  heat->advance(nodal_state, time - last_conduction,
                state_array("temperature"));
  last_conduction = time;
}

void FemBody::impose_velocities(const double)
{
  for (const std::size_t i : clamped)
    nodal_state.velocity[i] = Vec{};
}

const double *FemBody::state_array(const std::string &wanted) const
{
  return find_state(state_variables, state_data, connectivity.size(), wanted);
}

void FemBody::add_energies(EnergyLedger &ledger) const
{
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    ledger.kinetic.add(0.5 * nodal_state.inertia[i] *
                       norm_square(nodal_state.velocity[i]));
  for (std::size_t e = 0; e < connectivity.size(); ++e)
    if (owned_cell[e])
    {
      ledger.internal.add(internal_energy[e]);
      ledger.hourglass.add(hourglass_energy[e]);
      ledger.plastic_work.add(plastic_work[e]);
    }
}

Measures FemBody::measure() const
{
  const double *const eps = state_array("effective plastic strain");
  const double *const temperature = state_array("temperature");
  ExactSum internal, hourglass;
  double top[2] = {0., 0.};
  for (std::size_t e = 0; e < connectivity.size(); ++e)
    if (owned_cell[e])
    {
      internal.add(internal_energy[e]);
      hourglass.add(hourglass_energy[e]);
      top[0] = std::max(top[0], eps ? eps[e] : 0.);
      top[1] = std::max(top[1], temperature ? temperature[e] : 0.);
    }
  ExactSum::reduce({&internal, &hourglass}, communicator);
  MPI_Allreduce(MPI_IN_PLACE, top, 2, MPI_DOUBLE, MPI_MAX, communicator);
  Measures measures = measure_nodes(nodal_state, communicator);
  measures.push_back({"internal energy", "J", internal.value()});
  measures.push_back({"hourglass energy", "J", hourglass.value()});
  measures.push_back({"plastic strain max", "1", top[0]});
  // Not from the array, which a rank without cells does not have.
  if (std::any_of(state_variables.begin(), state_variables.end(),
                  [](const StateVariable &v)
                  { return v.name == "temperature"; }))
    measures.push_back({"temperature max", "K", top[1]});
  return measures;
}

OutputMesh FemBody::output_mesh() const
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  OutputMesh out;
  const std::size_t n_nodes = nodal_state.size();
  for (std::size_t i = 0; i < n_nodes; ++i)
    for (int d = 0; d < 3; ++d)
      out.points.push_back(nodal_state.position[i][d]);
  std::vector<std::size_t> cells;
  for (std::size_t e = 0; e < connectivity.size(); ++e)
    if (owned_cell[e])
    {
      cells.push_back(e);
      out.connectivity.insert(out.connectivity.end(), connectivity[e].begin(),
                              connectivity[e].end());
    }
  add_field(out.point_fields, "displacement", "m", n_nodes, 3,
            [&](const std::size_t i, const unsigned int c) {
              return nodal_state.position[i][c] -
                     nodal_state.reference_position[i][c];
            });
  add_field(out.point_fields, "velocity", "m/s", n_nodes, 3,
            [&](const std::size_t i, const unsigned int c)
            { return nodal_state.velocity[i][c]; });
  add_material_fields(out.cell_fields, cells, connectivity.size(), stress_data,
                      state_data, state_variables);
  add_field(out.cell_fields, "body", "1", cells.size(), 1,
            [&](std::size_t, unsigned int) { return double(id); });
  add_field(out.cell_fields, "rank", "1", cells.size(), 1,
            [&](std::size_t, unsigned int) { return double(rank); });
  return out;
}

void FemBody::visit_state(StateVisitor &visitor)
{
  const auto visit = [&](const std::string &array, auto &data)
  { visitor.visit(array, data.data(), data.size(), sizeof(data[0])); };
  visit("position", nodal_state.position);
  visit("velocity", nodal_state.velocity);
  visit("force", nodal_state.force);
  visit("inertia", nodal_state.inertia);
  visit("gradient", gradient);
  visit("polar rotation", polar_rotation);
  if (heat)
  {
    heat->visit_state(visitor);
    visitor.visit("last conduction", &last_conduction, 1, sizeof(double));
  }
  visit("hourglass modes", hourglass_modes);
  visit("viscous pressure", viscous_pressure);
  visit("stress", stress_data);
  visit("state", state_data);
  visit("internal energy", internal_energy);
  visit("hourglass energy", hourglass_energy);
  visit("plastic work", plastic_work);
  visitor.visit("stable step", &current_stable_step, 1, sizeof(double));
  visitor.visit("stable step item", &stable_step_item, 1, sizeof(GlobalIndex));
}

ContactSurface FemBody::contact_surface() const
{
  ContactSurface surface;
  surface.faces = boundary_faces;
  surface.face_id = boundary_face_id;
  for (const auto &face : boundary_faces)
    for (const std::size_t a : face)
      if (a < nodal_state.n_owned)
        surface.nodes.push_back(a);
  std::sort(surface.nodes.begin(), surface.nodes.end());
  surface.nodes.erase(std::unique(surface.nodes.begin(), surface.nodes.end()),
                      surface.nodes.end());
  surface.bulk_modulus = material->bulk_modulus();
  surface.spacing = typical_spacing;
  return surface;
}
} // namespace sabot
