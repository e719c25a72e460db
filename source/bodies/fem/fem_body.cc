// A body of hexahedra: its nodes on this rank, the life of a step, and reports.
#include "sabot/bodies/fem/fem_body.h"

#include "sabot/base/memory_limit.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/fem/fem_mass_scaling.h"

#include <algorithm>

namespace sabot
{
FemBody::FemBody(const std::string &name, const int id, HexMesh mesh,
                 std::shared_ptr<const Material> material,
                 const FemOptions &options)
    : ScaledBody(name, id), mesh(std::move(mesh)),
      material(std::move(material)), options(options),
      n_global_cells(this->mesh.cells.size()),
      cells(Registry<Hexahedra>::get("Bodies/" + name + "/Integration",
                                     options.integration)
                .make(name, options, this->material)),
      boundary(name, this->mesh, options),
      conversion({*this->material, nodal_state, node_exchange, *cells,
                  [this]() -> LivingCells & { return *living; },
                  [this]() { ++surface_version; }})
{
  outline = outline_of(this->mesh, options.symmetry_boundary_ids);
  prescribed_velocities = &constraints;
  for (const ErosionLimit &limit : options.erosion_limits())
    if (!has_state(limit.variable))
      throw InputError("Bodies/" + name + "/" + limit.entry,
                       "the body's material has no " + limit.variable +
                           "; use a law that has it or remove the entry");
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

void FemBody::lay_out_nodes(const LocalPart &part,
                            const std::vector<int> &owner)
{
  const auto owned_end = part.nodes.begin() + part.n_owned;
  const std::vector<GlobalIndex> owned(part.nodes.begin(), owned_end),
      ghosts(owned_end, part.nodes.end());
  std::vector<int> ghost_owner;
  for (const GlobalIndex g : ghosts)
    ghost_owner.push_back(owner[g]);
  node_exchange =
      GhostExchange(communicator, owned.size(), ghost_owner, ghosts,
                    [&](const GlobalIndex key) {
                      return std::lower_bound(owned.begin(), owned.end(), key) -
                             owned.begin();
                    });
  nodal_state.resize(part.nodes.size());
  nodal_state.n_owned = part.n_owned;
  nodal_state.global_id = part.nodes;
  const auto &v = options.initial_velocity;
  for (std::size_t i = 0; i < part.nodes.size(); ++i)
  {
    const auto &p = mesh.nodes[part.nodes[i]];
    nodal_state.reference_position[i] = nodal_state.position[i] =
        vec(p[0], p[1], p[2]);
    nodal_state.velocity[i] = vec(v[0], v[1], v[2]);
    nodal_state.force[i] = Vec{};
    nodal_state.lumped_mass[i] = 0.;
  }
}

void FemBody::distribute(const std::vector<int> &owner, MPI_Comm comm)
{
  communicator = comm;
  int rank;
  MPI_Comm_rank(communicator, &rank);
  LocalCells local;
  const GlobalIndex n_boundary_faces = mesh.boundary_faces.size();
  std::vector<unsigned int> held = options.driven_boundary_ids;
  held.insert(held.end(), boundary.loaded_faces().begin(),
              boundary.loaded_faces().end());
  const std::vector<GlobalIndex> held_nodes = conversion.is_on()
                                                  ? nodes_of_faces(mesh, held)
                                                  : std::vector<GlobalIndex>();
  {
    LocalPart part = find_local_part(mesh, owner, rank);
    lay_out_nodes(part, owner);
    local.connectivity = part.connectivity(mesh);
    local.volume.reserve(part.cells.size());
    for (const GlobalIndex c : part.cells)
      local.volume.push_back(mesh.volume[c]);
    boundary.set_up(mesh, part.local, nodal_state.n_owned, constraints);
    local.id = std::move(part.cells);
    owned_cell = std::move(part.owned_cell);
    mesh = HexMesh(); // before the cells take their room
  }
  give_back_memory();
  // Masses add up in global cell order.
  for (std::size_t e = 0; e < local.id.size(); ++e)
    for (const std::uint32_t a : local.connectivity[e])
      nodal_state.lumped_mass[a] +=
          0.125 * material->density() * local.volume[e];
  nodal_state.inertia = nodal_state.lumped_mass;

  cells->set_up(std::move(local), nodal_state.reference_position);
  if (options.erodes() || conversion.is_on())
    living = std::make_unique<LivingCells>(nodal_state, *cells, boundary,
                                           owned_cell, n_boundary_faces);
  if (options.erodes())
    erosion =
        std::make_unique<FemErosion>(options, *material, nodal_state, *cells,
                                     *living, owned_cell, communicator);
  if (conversion.is_on())
    conversion.set_up(held_nodes);
  if (options.mass_scaling.is_on())
    scaling = std::make_unique<FemMassScaling>(
        options.mass_scaling, name, nodal_state, constraints, *cells,
        material->density(), communicator);
  if (options.conducts_heat)
  {
    std::vector<double> capacity(cells->volume.begin(),
                                 cells->volume.begin() + cells->size());
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
  if (!erosion || !erosion->erode())
    return false;
  ++surface_version;
  return true;
}

const std::vector<char> *FemBody::free_nodes() const
{
  return erosion ? &living->bare_nodes() : nullptr;
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
  {
    ExactTerms kinetic(ledger.kinetic), eroded(ledger.eroded);
    for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
      (is_free != nullptr && (*is_free)[i] ? eroded : kinetic)
          .add(0.5 * nodal_state.inertia[i] *
               norm_square(nodal_state.velocity[i]));
  }
  ledger.external.add(constraints.work());
  conversion.add_energies(ledger);
  add_scaling(ledger);
  if (erosion)
    erosion->add_energies(ledger);
  ExactTerms internal(ledger.internal), hourglass(ledger.hourglass),
      plastic_work(ledger.plastic_work);
  for (std::size_t e = 0; e < cells->size(); ++e)
    if (owned_cell[e])
    {
      internal.add(cells->internal_energy(e));
      hourglass.add(cells->hourglass_energy[e]);
      plastic_work.add(cells->plastic_work(e));
    }
}

BodyFacts FemBody::facts() const
{
  BodyFacts facts;
  facts.material = material.get();
  facts.is_clamped = !options.clamped_boundary_ids.empty();
  facts.velocity = options.initial_velocity;
  if (!options.driven_boundary_ids.empty())
  {
    facts.driven_velocity = options.initial_velocity;
    for (int d = 0; d < 3; ++d)
      if (options.driven_components[d])
        (*facts.driven_velocity)[d] = options.driven_velocity[d];
  }
  const bool flies =
      options.initial_velocity != std::array<double, 3>{{0., 0., 0.}};
  facts.moves_by_itself =
      facts.driven_velocity.has_value() || (flies && facts.is_clamped);
  facts.spacing.fill(options.cell_size);
  facts.hourglass_control = cells->hourglass_control();
  return facts;
}

bool FemBody::is_held() const
{
  return !options.clamped_boundary_ids.empty() ||
         !options.symmetry_boundary_ids.empty() ||
         !options.driven_boundary_ids.empty();
}

void FemBody::add_section_force(const Vec normal, const double offset,
                                ExactVectorSum &sum) const
{
  for (std::size_t e = 0; e < cells->size(); ++e)
  {
    bool is_beyond[8];
    int n_beyond = 0;
    for (int a = 0; a < 8; ++a)
    {
      const Vec X = nodal_state.reference_position[cells->connectivity[e][a]];
      is_beyond[a] = dot(X, normal) > offset;
      n_beyond += is_beyond[a];
    }
    if (!owned_cell[e] || n_beyond == 0 || n_beyond == 8)
      continue;
    Vec force[8];
    cells->cell_forces(nodal_state, e, force);
    for (int a = 0; a < 8; ++a)
      if (is_beyond[a])
        sum.add(force[a]);
  }
}

void FemBody::visit_state(StateVisitor &visitor)
{
  const StateItems items = nodes_of_state(*this);
  visitor.visit_keys(items);
  visitor.visit_items("position", nodal_state.position, items);
  visitor.visit_items("velocity", nodal_state.velocity, items);
  visitor.visit_items("force", nodal_state.force, items);
  visitor.visit_items("inertia", nodal_state.inertia, items);
  if (living)
  {
    living->visit_state(visitor, name);
    visitor.visit_value("surface version", surface_version);
  }
  if (erosion)
    erosion->visit_state(visitor);
  if (conversion.is_on())
  {
    visitor.visit_items("lumped mass", nodal_state.lumped_mass, items);
    conversion.visit_state(visitor, living->items(name));
  }
  const StateItems of_cells = {"body " + name + "/cells", cells->cell_id.data(),
                               cells->size(), cells->size()};
  visitor.visit_keys(of_cells);
  cells->visit_state(visitor, of_cells);
  visit_scaling(visitor);
  if (heat)
  {
    heat->visit_state(visitor, items, of_cells);
    visitor.visit_value("last conduction", last_conduction);
  }
  visitor.visit_sum("external work", constraints.work());
  constraints.visit_state(visitor, name, nodal_state);
}

ContactSurface FemBody::contact_surface() const
{
  return boundary.surface(nodal_state.n_owned, material->bulk_modulus());
}

const std::vector<std::uint32_t> &FemBody::cell_of_faces() const
{
  if (living) // faces and cells come and go
    known_cell_of_faces = living->cells_of_faces();
  else if (known_cell_of_faces.size() != boundary.faces.size())
    known_cell_of_faces = boundary.find_cells(*cells);
  return known_cell_of_faces;
}

std::vector<std::array<std::size_t, 8>> FemBody::cells_behind_faces() const
{
  std::vector<std::array<std::size_t, 8>> behind;
  for (const std::uint32_t e : cell_of_faces())
  {
    behind.emplace_back();
    if (e != FemBoundary::no_cell)
      std::copy(cells->connectivity[e].begin(), cells->connectivity[e].end(),
                behind.back().begin());
  }
  return behind;
}

std::vector<double>
FemBody::flow_stress(const std::vector<std::size_t> &some_nodes) const
{
  return boundary.flow_stress(some_nodes, nodal_state.size(), *cells,
                              cell_of_faces());
}
} // namespace sabot
