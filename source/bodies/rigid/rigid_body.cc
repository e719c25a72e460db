// Rigid bodies: six degrees of freedom, with the nodes and faces of a mesh.
#include "sabot/bodies/rigid/rigid_body.h"

#include "sabot/base/parameters.h"
#include "sabot/bodies/body_report.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** a b. */
std::array<double, 4> product(const std::array<double, 4> &a,
                              const std::array<double, 4> &b)
{
  return {{a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
           a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
           a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
           a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]}};
}

/** Rotation by the vector @p angle. */
std::array<double, 4> rotation_by(const Vec angle)
{
  const double size = norm(angle), half = 0.5 * size;
  const double s = size > 1e-8 ? std::sin(half) / size : 0.5;
  return {{std::cos(half), s * angle[0], s * angle[1], s * angle[2]}};
}

/** Tensor of inertia of a point mass at @p r. */
Mat point_inertia(const double m, const Vec r)
{
  Mat I = (m * norm_square(r)) * Mat::identity();
  add_outer(I, -m * r, r);
  return I;
}
} // namespace

void RigidOptions::declare_parameters(Parameters &prm)
{
  prm.declare_entry("Motion", "free", one_of("free|prescribed"),
                    "free: six degrees of freedom; prescribed: the initial "
                    "velocities stay, and their work counts as external.");
  prm.declare_entry("Angular velocity", "0 1/s, 0 1/s, 0 1/s",
                    quantities(Dimension::strain_rate, 3, 3, -1e8, 1e8),
                    "Rotation vector per time at time 0, about the center of "
                    "mass.");
}

RigidOptions RigidOptions::parse(const Parameters &prm)
{
  RigidOptions o;
  o.is_prescribed = prm.get("Motion") == "prescribed";
  const std::vector<double> w = get_quantities(prm, "Angular velocity");
  o.angular_velocity = {{w[0], w[1], w[2]}};
  return o;
}

RigidBody::RigidBody(const std::string &name, const int id, HexMesh m,
                     std::shared_ptr<const Material> material,
                     const RigidOptions &options)
    : Body(name, id), mesh(std::move(m)), material(std::move(material)),
      options(options), n_global_cells(mesh.cells.size()),
      is_prescribed(options.is_prescribed)
{
  outline = outline_of(mesh, {});
  node_masses.assign(mesh.nodes.size(), 0.);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const GlobalIndex a : mesh.cells[c])
      node_masses[a] += 0.125 * this->material->density() * mesh.volume[c];
  const auto point = [&](const std::size_t a)
  { return vec(mesh.nodes[a][0], mesh.nodes[a][1], mesh.nodes[a][2]); };
  center = Vec{};
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
  {
    mass += node_masses[a];
    center += node_masses[a] * point(a);
  }
  center /= broadcast(mass);
  inertia = Mat::zero();
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    inertia = inertia + point_inertia(node_masses[a], point(a) - center);
  inverse_inertia = inverse(inertia);
  const auto &v = options.initial_velocity, &w = options.angular_velocity;
  momentum = mass * vec(v[0], v[1], v[2]);
  prescribed_spin = vec(w[0], w[1], w[2]);
  angular_momentum = inertia * prescribed_spin;
}

void RigidBody::distribute(const std::vector<int> &owner, MPI_Comm comm)
{
  communicator = comm;
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const LocalPart part = find_local_part(mesh, owner, rank);
  owned_cell = part.owned_cell;
  cells = part.connectivity(mesh);
  const std::vector<GlobalIndex> &ids = part.nodes;
  nodal_state.resize(ids.size());
  nodal_state.n_owned = part.n_owned;
  nodal_state.global_id = ids;
  arm.resize(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const auto &p = mesh.nodes[ids[i]];
    nodal_state.reference_position[i] = nodal_state.position[i] =
        vec(p[0], p[1], p[2]);
    arm[i] = nodal_state.position[i] - center;
    nodal_state.force[i] = Vec{};
    nodal_state.lumped_mass[i] = nodal_state.inertia[i] = node_masses[ids[i]];
  }
  take_faces(part);
  rigid_velocity.resize(part.n_owned);
  set_velocities();
  mesh = HexMesh();
  node_masses.clear();
}

Mat RigidBody::matrix(const std::array<double, 4> &q)
{
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {{vec(1. - 2. * (y * y + z * z), 2. * (x * y - w * z),
               2. * (x * z + w * y)),
           vec(2. * (x * y + w * z), 1. - 2. * (x * x + z * z),
               2. * (y * z - w * x)),
           vec(2. * (x * z - w * y), 2. * (y * z + w * x),
               1. - 2. * (x * x + y * y))}};
}

Vec RigidBody::spin(const Mat &rotation) const
{
  if (is_prescribed)
    return prescribed_spin;
  return rotation *
         (inverse_inertia * (transpose(rotation) * angular_momentum));
}

void RigidBody::set_velocities()
{
  const Mat rotation = matrix(quaternion);
  const Vec velocity = (1. / mass) * momentum, omega = spin(rotation);
  for (std::size_t i = 0; i < nodal_state.size(); ++i)
    nodal_state.velocity[i] = velocity + cross(omega, rotation * arm[i]);
  std::copy_n(nodal_state.velocity.begin(), rigid_velocity.size(),
              rigid_velocity.begin());
}

void RigidBody::impose_velocities(const double)
{
  if (!is_prescribed)
  {
    // The kick gave each node its own impulse.
    ExactSum sums[6];
    for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    {
      const Vec change = nodal_state.velocity[i] - rigid_velocity[i];
      if (norm_square(change) == 0.)
        continue;
      const Vec impulse = nodal_state.inertia[i] * change,
                turn = cross(nodal_state.position[i] - center, impulse);
      for (int d = 0; d < 3; ++d)
      {
        sums[d].add(impulse[d]);
        sums[3 + d].add(turn[d]);
      }
    }
    ExactSum::reduce(
        {&sums[0], &sums[1], &sums[2], &sums[3], &sums[4], &sums[5]},
        communicator);
    momentum += vec(sums[0].value(), sums[1].value(), sums[2].value());
    angular_momentum += vec(sums[3].value(), sums[4].value(), sums[5].value());
  }
  set_velocities();
}

void RigidBody::move_rigidly(const Vec velocity, const Vec angular_velocity,
                             const bool is_start)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  if (!is_start && rank == 0) // once, as all know it
    impulse.add(mass * velocity - momentum);
  momentum = mass * velocity;
  prescribed_spin = angular_velocity;
  set_velocities();
}

void RigidBody::accumulate_work(const double half_dt)
{
  if (!is_prescribed)
    return;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    if (norm_square(nodal_state.force[i]) > 0.)
    {
      work.add(-half_dt * dot(nodal_state.force[i], nodal_state.velocity[i]));
      impulse.add(-half_dt * nodal_state.force[i]);
    }
}

void RigidBody::add_kick_energy(const double dt, ExactSum &sum) const
{
  if (is_prescribed)
    return;
  ExactVectorSum force, torque;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    const Vec f = nodal_state.force[i];
    force.add(f);
    torque.add(cross(nodal_state.position[i] - center, f));
  }
  ExactVectorSum::reduce({&force, &torque}, communicator);
  int rank;
  MPI_Comm_rank(communicator, &rank);
  if (rank != 0) // once, as all know it
    return;
  const auto as_vec = [](const std::array<double, 3> &v)
  { return vec(v[0], v[1], v[2]); };
  const Vec f = as_vec(force.value()),
            t = transpose(matrix(quaternion)) * as_vec(torque.value());
  sum.add(dt * dt / 8. * (norm_square(f) / mass + dot(t, inverse_inertia * t)));
}

std::vector<Resultant> RigidBody::reactions() const
{
  if (!is_prescribed)
    return {};
  ExactVectorSum force, total = impulse;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    force.add(-1. * nodal_state.force[i]);
  ExactVectorSum::reduce({&force, &total}, communicator);
  return {{"prescribed motion", id, force.value(), total.value(), true}};
}

void RigidBody::compute_forces(const double, const double dt)
{
  center += (dt / mass) * momentum;
  Vec omega = spin(matrix(quaternion));
  for (int i = 0; i < 4 && !is_prescribed; ++i)
    omega = spin(matrix(product(rotation_by(0.5 * dt * omega), quaternion)));
  quaternion = product(rotation_by(dt * omega), quaternion);
  double size = 0.;
  for (const double q : quaternion)
    size += q * q;
  for (double &q : quaternion)
    q /= std::sqrt(size);
  const Mat rotation = matrix(quaternion);
  for (std::size_t i = 0; i < nodal_state.size(); ++i)
  {
    nodal_state.position[i] = center + rotation * arm[i];
    nodal_state.force[i] = Vec{};
  }
  set_velocities();
}

StableStep RigidBody::stable_step() const
{
  // A twentieth of a radian.
  StableStep step;
  const double omega = norm(spin(matrix(quaternion)));
  if (omega > 0.)
    step = {0.05 / omega, 0};
  return step;
}

void RigidBody::add_energies(EnergyLedger &ledger) const
{
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    ledger.kinetic.add(0.5 * nodal_state.inertia[i] *
                       norm_square(nodal_state.velocity[i]));
  ledger.external.add(work);
}

BodyMeasures RigidBody::measure() const
{
  BodyMeasures measures = measure_nodes(nodal_state, communicator);
  const Vec omega = spin(matrix(quaternion));
  for (int d = 0; d < 3; ++d)
    measures.own.push_back(
        {std::string("angular velocity ") + "xyz"[d], "1/s", omega[d]});
  return measures;
}

BodyFacts RigidBody::facts() const
{
  BodyFacts facts;
  facts.material = material.get();
  facts.deforms = false;
  facts.velocity = options.initial_velocity;
  facts.moves_by_itself =
      options.angular_velocity != std::array<double, 3>{{0., 0., 0.}};
  facts.spacing.fill(options.cell_size);
  return facts;
}

void RigidBody::fill_output(OutputMesh &out) const
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const std::size_t n = nodal_state.size();
  for (std::size_t i = 0; i < n; ++i)
    for (int d = 0; d < 3; ++d)
      out.points.push_back(nodal_state.position[i][d]);
  std::size_t n_cells = 0;
  for (std::size_t e = 0; e < cells.size(); ++e)
    if (owned_cell[e])
    {
      ++n_cells;
      out.connectivity.insert(out.connectivity.end(), cells[e].begin(),
                              cells[e].end());
    }
  add_field(out.point_fields, "displacement", n,
            [&](const std::size_t i, const unsigned int c) {
              return nodal_state.position[i][c] -
                     nodal_state.reference_position[i][c];
            });
  add_field(out.point_fields, "velocity", n,
            [&](const std::size_t i, const unsigned int c)
            { return nodal_state.velocity[i][c]; });
  add_field(out.cell_fields, "body", n_cells,
            [&](std::size_t, unsigned int) { return double(id); });
  add_field(out.cell_fields, "rank", n_cells,
            [&](std::size_t, unsigned int) { return double(rank); });
}

void RigidBody::visit_state(StateVisitor &visitor)
{
  const StateItems items = nodes_of_state(*this);
  visitor.visit_keys(items);
  visitor.visit_items("position", nodal_state.position, items);
  visitor.visit_items("velocity", nodal_state.velocity, items);
  visitor.visit_items("force", nodal_state.force, items);
  visitor.visit_items("inertia", nodal_state.inertia, items);
  visitor.visit_items("rigid velocity", rigid_velocity, items);
  visitor.visit_array("quaternion", quaternion);
  visitor.visit_value("center", center);
  visitor.visit_value("momentum", momentum);
  visitor.visit_value("angular momentum", angular_momentum);
  visitor.visit_value("prescribed spin", prescribed_spin);
  visitor.visit_sum("external work", work);
  visitor.visit_sum("reaction impulse", impulse);
}
} // namespace sabot
