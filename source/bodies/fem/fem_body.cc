#include "sabot/bodies/fem/fem_body.h"

#include "sabot/base/parameters.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/body_report.h"
#include "sabot/bodies/fem/one_point.h"

#include <algorithm>

namespace sabot
{
void FemOptions::declare_parameters(Parameters &prm)
{
  Registry<Hexahedra>::declare_choice(prm, "Integration", "one point",
                                      "Points of a cell.");
  Registry<OnePoint>::declare_choice(prm, "Hourglass control", "viscous",
                                     "Of cells with one point.");
  prm.declare_entry("Hourglass coefficient", "0.1",
                    quantity(Dimension::none, 0., 1.), "Usually 0.03 to 0.15.");
  prm.declare_entry("Heat conduction", "false", boolean(),
                    "Implicit conduction inside the body, faces insulated. "
                    "Needs a law with temperature and conductivity.");
  prm.declare_entry("Conduction interval", "1 us",
                    quantity(Dimension::time, 0., 1e3),
                    "Time between conduction steps.");
  prm.declare_entry(
      "Objective rate", "Jaumann", one_of("Jaumann|Green-Naghdi"),
      "Rate of the stress: with the spin of the velocity gradient, or with "
      "that of the rotation R of F = R U, which does not oscillate in large "
      "elastic shear.");
  prm.declare_entry("Linear bulk viscosity", "0.06",
                    quantity(Dimension::none, 0., 1.),
                    "Coefficient of rho c h |div v| in compression.");
  prm.declare_entry("Quadratic bulk viscosity", "1.5",
                    quantity(Dimension::none, 0., 10.),
                    "Coefficient of rho h^2 (div v)^2 in compression.");
  prm.declare_entry("Erosion plastic strain", "1e10",
                    quantity(Dimension::none, 0.),
                    "A cell is eroded when its effective plastic strain "
                    "exceeds this. 1e10: never.");
  prm.declare_entry("Erosion damage", "1e10", quantity(Dimension::none, 0.),
                    "A cell is eroded when the material's damage reaches this "
                    "(1: fully damaged). 1e10: never.");
  prm.declare_entry("Erosion step", "0 s", quantity(Dimension::time, 0., 1.),
                    "A cell is eroded when its own stable step falls below "
                    "this. 0: never.");
  prm.declare_entry("Inversion", "stop", one_of("stop|erode|shrink step"),
                    "What to do when a cell is about to turn inside out: stop "
                    "the run, erode the cell, or (shrink step) let no step "
                    "take more than a quarter of a cell's volume.");
}

FemOptions FemOptions::parse(const Parameters &prm)
{
  FemOptions o;
  o.integration = prm.get("Integration");
  o.hourglass = prm.get("Hourglass control");
  o.conducts_heat = prm.get_bool("Heat conduction");
  o.conduction_interval = get_quantity(prm, "Conduction interval");
  o.objective_rate = prm.get("Objective rate") == "Jaumann"
                         ? ObjectiveRate::jaumann
                         : ObjectiveRate::green_naghdi;
  o.hourglass_coefficient = get_quantity(prm, "Hourglass coefficient");
  o.bulk_viscosity_linear = get_quantity(prm, "Linear bulk viscosity");
  o.bulk_viscosity_quadratic = get_quantity(prm, "Quadratic bulk viscosity");
  o.erosion_plastic_strain = get_quantity(prm, "Erosion plastic strain");
  o.erosion_damage = get_quantity(prm, "Erosion damage");
  o.erosion_step = get_quantity(prm, "Erosion step");
  const std::string inversion = prm.get("Inversion");
  o.inversion = inversion == "erode"  ? Inversion::erode
                : inversion == "stop" ? Inversion::stop
                                      : Inversion::shrink;
  return o;
}

FemBody::FemBody(const std::string &name, const int id, HexMesh mesh,
                 std::shared_ptr<const Material> material,
                 const FemOptions &options)
    : Body(name, id), mesh(std::move(mesh)), material(std::move(material)),
      options(options), n_global_cells(this->mesh.cells.size()),
      cells(Registry<Hexahedra>::get("Bodies/" + name + "/Integration",
                                     options.integration)
                .make(name, options, this->material))
{
  for (const unsigned int boundary : options.symmetry_boundary_ids)
  {
    const int axis = symmetry_axes[boundary] = symmetry_axis(boundary);
    for (std::size_t f = 0; f < this->mesh.boundary_faces.size(); ++f)
      if (this->mesh.boundary_id[f] == boundary)
      {
        symmetry_planes.push_back(
            {axis, this->mesh.nodes[this->mesh.boundary_faces[f][0]][axis]});
        break;
      }
  }
  const auto need = [&](const double limit, const std::string &variable,
                        const std::string &entry)
  {
    if (limit < FemOptions::never && !has_state(variable))
      throw InputError("Bodies/" + name + "/" + entry,
                       "the body's material has no " + variable +
                           "; use a law that has it or remove the entry");
  };
  need(options.erosion_plastic_strain, "effective plastic strain",
       "Erosion plastic strain");
  need(options.erosion_damage, "damage", "Erosion damage");
  if (options.conducts_heat && !(this->material->conductivity() > 0.))
    throw InputError("Bodies/" + name + "/Heat conduction",
                     "the body's material has no temperature or no thermal "
                     "conductivity; set \"Thermal conductivity\" of a law "
                     "with temperature, for example 167 W/m/K");
  if (options.conducts_heat && options.erodes())
    throw InputError("Bodies/" + name + "/Heat conduction",
                     "heat is conducted in all cells of a body or in none, so "
                     "cells must not erode; remove the erosion criteria (and "
                     "\"Inversion = erode\") or the conduction");
}

void FemBody::distribute(const std::vector<int> &owner, MPI_Comm comm)
{
  communicator = comm;
  int rank;
  MPI_Comm_rank(communicator, &rank);

  // Cells of the owned nodes, then the nodes of these cells.
  std::vector<GlobalIndex> owned, ghosts, cell_id;
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

  // Masses add up in global cell order.
  std::vector<std::array<std::uint32_t, 8>> connectivity;
  for (const GlobalIndex c : cell_id)
  {
    std::array<std::uint32_t, 8> nodes;
    for (int a = 0; a < 8; ++a)
    {
      nodes[a] = local.at(mesh.cells[c][a]);
      nodal_state.lumped_mass[nodes[a]] +=
          0.125 * material->density() * mesh.volume[c];
    }
    connectivity.push_back(nodes);
  }
  nodal_state.inertia = nodal_state.lumped_mass;

  set_up_boundary(local);

  cells->set_up(mesh, cell_id, connectivity);
  if (options.erodes())
    set_up_erosion();
  mesh = HexMesh();
  if (options.conducts_heat)
  {
    std::vector<double> capacity = cells->volume;
    for (double &c : capacity)
      c *= material->density() * material->specific_heat();
    heat = std::make_unique<HeatConduction>(
        material->conductivity(), cells->connectivity, capacity, nodal_state,
        node_exchange, communicator);
  }
}

void FemBody::conduct_heat(const double time)
{
  // Ghost positions are those of the last force computation: now.
  const std::vector<double> before = cells->cell_state("temperature");
  std::vector<double> change = before;
  heat->advance(nodal_state, time - last_conduction, change.data());
  for (std::size_t e = 0; e < change.size(); ++e)
    change[e] -= before[e];
  cells->shift_state("temperature", change);
  last_conduction = time;
}

bool FemBody::update_topology(const unsigned int, const double time)
{
  if (heat && time >= last_conduction + options.conduction_interval)
    conduct_heat(time);
  return erosion && erode_cells();
}

bool FemBody::has_state(const std::string &variable) const
{
  const auto &states = cells->states();
  return std::any_of(states.begin(), states.end(),
                     [&](const StateVariable &v)
                     { return v.name == variable; });
}

void FemBody::impose_velocities(const double)
{
  constraints.impose(nodal_state);
}

void FemBody::accumulate_work(const double half_dt)
{
  constraints.accumulate_work(nodal_state, half_dt);
}

void FemBody::update_ghosts()
{
  node_exchange.update(nodal_state.position.data());
  node_exchange.update(nodal_state.velocity.data());
}

void FemBody::compute_forces(const double /*time*/, const double dt)
{
  std::fill(nodal_state.force.begin(), nodal_state.force.end(), Vec{});
  cells->add_forces(nodal_state, dt);
}

StableStep FemBody::stable_step() const
{
  return cells->smallest_step;
}

void FemBody::add_energies(EnergyLedger &ledger) const
{
  const std::vector<char> *const is_free = free_nodes();
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    (is_free != nullptr && (*is_free)[i] ? ledger.eroded : ledger.kinetic)
        .add(0.5 * nodal_state.inertia[i] *
             norm_square(nodal_state.velocity[i]));
  ledger.external.add(constraints.work());
  if (erosion)
  {
    ledger.eroded.add(erosion->energy);
    ledger.plastic_work.add(erosion->plastic_work);
  }
  for (std::size_t e = 0; e < cells->size(); ++e)
    if (owned_cell[e])
    {
      ledger.internal.add(cells->internal_energy(e));
      ledger.hourglass.add(cells->hourglass_energy[e]);
      ledger.plastic_work.add(cells->plastic_work(e));
    }
}

BodyMeasures FemBody::measure() const
{
  const std::vector<double> eps = cells->cell_state("effective plastic strain"),
                            temperature = cells->cell_state("temperature");
  ExactSum internal, hourglass;
  double top[2] = {0., 0.};
  for (std::size_t e = 0; e < cells->size(); ++e)
    if (owned_cell[e])
    {
      internal.add(cells->internal_energy(e));
      hourglass.add(cells->hourglass_energy[e]);
      top[0] = std::max(top[0], eps.empty() ? 0. : eps[e]);
      top[1] = std::max(top[1], temperature.empty() ? 0. : temperature[e]);
    }
  ExactSum::reduce({&internal, &hourglass}, communicator);
  MPI_Allreduce(MPI_IN_PLACE, top, 2, MPI_DOUBLE, MPI_MAX, communicator);
  BodyMeasures measures =
      measure_nodes(nodal_state, communicator, free_nodes());
  measures.internal_energy = internal.value();
  measures.own.push_back({"hourglass energy", "J", hourglass.value()});
  measures.own.push_back({"plastic strain max", "1", top[0]});
  // Not from the array, which a rank without cells does not have.
  if (has_state("temperature"))
    measures.own.push_back({"temperature max", "K", top[1]});
  if (erosion)
    add_erosion_measures(measures);
  return measures;
}

BodyFacts FemBody::facts() const
{
  BodyFacts facts;
  facts.material = material.get();
  facts.is_clamped = !options.clamped_boundary_ids.empty();
  facts.velocity = options.initial_velocity;
  facts.spacing.fill(options.cell_size);
  return facts;
}

bool FemBody::is_held() const
{
  return !options.clamped_boundary_ids.empty() ||
         !options.symmetry_boundary_ids.empty() ||
         !options.driven_boundary_ids.empty();
}

std::vector<MaterialSite> FemBody::material_sites() const
{
  const std::vector<double> eps = cells->cell_state("effective plastic strain");
  std::vector<MaterialSite> sites;
  for (std::size_t e = 0; e < cells->size(); ++e)
    if (owned_cell[e])
    {
      MaterialSite site{};
      for (const std::uint32_t node : cells->connectivity[e])
        for (int d = 0; d < 3; ++d)
          site.reference_position[d] +=
              nodal_state.reference_position[node][d] / 8.;
      site.plastic_strain = eps.empty() ? 0. : eps[e];
      sites.push_back(site);
    }
  return sites;
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
  std::vector<std::size_t> owned;
  for (std::size_t e = 0; e < cells->size(); ++e)
    if (owned_cell[e])
    {
      owned.push_back(e);
      const auto &nodes = cells->connectivity[e];
      out.connectivity.insert(out.connectivity.end(), nodes.begin(),
                              nodes.end());
    }
  add_field(out.point_fields, "displacement", n_nodes,
            [&](const std::size_t i, const unsigned int c) {
              return nodal_state.position[i][c] -
                     nodal_state.reference_position[i][c];
            });
  add_field(out.point_fields, "velocity", n_nodes,
            [&](const std::size_t i, const unsigned int c)
            { return nodal_state.velocity[i][c]; });
  add_material_fields(out.cell_fields, owned, cells->size(),
                      cells->cell_stress().data(), cells->cell_states().data(),
                      cells->states());
  add_field(out.cell_fields, "body", owned.size(),
            [&](std::size_t, unsigned int) { return double(id); });
  add_field(out.cell_fields, "rank", owned.size(),
            [&](std::size_t, unsigned int) { return double(rank); });
  return out;
}

void FemBody::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("position", nodal_state.position);
  visitor.visit_array("velocity", nodal_state.velocity);
  visitor.visit_array("force", nodal_state.force);
  visitor.visit_array("inertia", nodal_state.inertia);
  if (erosion)
    visit_erosion(visitor);
  cells->visit_state(visitor);
  if (heat)
  {
    heat->visit_state(visitor);
    visitor.visit_value("last conduction", last_conduction);
  }
  visitor.visit_value("external work", constraints.work());
}
} // namespace sabot
