#include "sabot/bodies/spg/spg_body.h"
#include "sabot/kernels/kernel_function.h"
#include "sabot/kernels/stress_update.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
void SpgBody::update_ghosts()
{
  node_exchange.update(nodal_state.position.data());
}

void SpgBody::compute_forces(const double /*time*/, const double dt)
{
  const std::size_t n = nodal_state.n_owned;
  current_stable_step = std::numeric_limits<double>::max();
  stable_step_item = -1;
  largest_change = 1.;
  std::string problem;
  for (std::size_t begin = 0; begin < n; begin += batch_size)
  {
    const std::size_t end = std::min(begin + batch_size, n);
    gradients(begin, end, dt, problem);
    residuals(begin, end);
    if (dt > 0.)
      stresses(begin, end, dt);
    generalized_stresses(begin, end);
  }
  node_exchange.update(generalized_stress.data());
  bonds.exchange_forces();
  gather_forces();
  // Only now: the other ranks wait for the exchanges above.
  if (!problem.empty())
    throw PhysicsError(problem);
}

void SpgBody::gradients(const std::size_t begin, const std::size_t end,
                        const double dt, std::string &problem)
{
  const Vec *const x = nodal_state.position.data();
  const Vec *const X = kernel_position.data();
  const double c = material->sound_speed();
  for (std::size_t i = begin; i < end; ++i)
  {
    Mat A = Mat::zero();
    const Vec xi = x[i], Xi = X[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec dX = X[j] - Xi;
      add_outer(A, x[j] - xi - dX, bonds.weight[b] * dX);
    }
    const Mat F = Mat::identity() + A * moment_inverse[i];
    const Mat F_old = gradient[i];
    gradient[i] = F;
    const Mat l = (F - F_old) * inverse(0.5 * (F + F_old));
    const double J = determinant(F), J_old = determinant(F_old);
    const double V0 = reference_volume[i], V = kernel_volume[i];

    const std::size_t k = i - begin;
    batch.strain[0][k] = l(0, 0);
    batch.strain[1][k] = l(1, 1);
    batch.strain[2][k] = l(2, 2);
    batch.strain[3][k] = 0.5 * (l(0, 1) + l(1, 0));
    batch.strain[4][k] = 0.5 * (l(1, 2) + l(2, 1));
    batch.strain[5][k] = 0.5 * (l(0, 2) + l(2, 0));
    batch.spin[0][k] = 0.5 * (l(0, 1) - l(1, 0));
    batch.spin[1][k] = 0.5 * (l(1, 2) - l(2, 1));
    batch.spin[2][k] = 0.5 * (l(0, 2) - l(2, 0));
    batch.jacobian[k] = V / V0 * J;
    batch.half_volume[k] = 0.25 * V * (J + J_old);

    // Nominal-stress factor F^-T, completed once the stress is known; its
    // size also tells how much stiffer compression has made the particle.
    const Mat F_inverse = inverse(F);
    batch.nominal[k] = transpose(F_inverse);
    const double stiffening = norm_square(F_inverse.row[0]) +
                              norm_square(F_inverse.row[1]) +
                              norm_square(F_inverse.row[2]) - 2.;
    double step = update_stable_step[i] / std::sqrt(std::max(1., stiffening));
    // Bulk viscosity, as for hexahedra; a flattened particle's step tells its
    // smallest dimension.
    const double rate = dt > 0. ? trace(l) / dt : 0.;
    const double h = std::min(std::cbrt(V * J), 2. * c * step);
    batch.viscous_pressure[k] = bulk_viscosity_pressure(
        material->density() * V0 / (V * J), c, h, rate,
        options.bulk_viscosity_linear, options.bulk_viscosity_quadratic);
    if (dt > 0.)
    {
      const double l_norm =
          std::sqrt(norm_square(l.row[0]) + norm_square(l.row[1]) +
                    norm_square(l.row[2]));
      step /= 1. + options.bulk_viscosity_linear + h * l_norm / (c * dt);
    }
    if (step < current_stable_step)
    {
      current_stable_step = step;
      stable_step_item = nodal_state.global_id[i];
    }
    if (!(J > 0.05) && problem.empty())
      problem = "body " + name + ", particle " +
                std::to_string(nodal_state.global_id[i]) + " at (" +
                std::to_string(xi[0]) + ", " + std::to_string(xi[1]) + ", " +
                std::to_string(xi[2]) +
                ") m: incremental deformation gradient has determinant " +
                std::to_string(J);
    largest_change = std::max({largest_change, J, 1. / J});
  }
}

void SpgBody::stresses(const std::size_t begin, const std::size_t end,
                       const double dt)
{
  const std::size_t n = nodal_state.n_owned, m = end - begin;
  double *stress[6];
  const double *strain[6], *spin[3];
  for (int c = 0; c < 6; ++c)
  {
    stress[c] = &stress_data[c * n + begin];
    strain[c] = batch.strain[c];
  }
  for (int c = 0; c < 3; ++c)
    spin[c] = batch.spin[c];
  std::vector<double *> &states = batch_states;
  for (std::size_t s = 0; s < n_states; ++s)
    states[s] = &state_data[s * n + begin];

  rotate_symmetric(m, spin, stress);
  std::size_t first = 0;
  for (const StateVariable &variable : state_variables)
  {
    if (variable.is_tensor)
      rotate_symmetric(m, spin, &states[first]);
    first += variable.is_tensor ? 6 : 1;
  }

  const double *old_stress[6] = {stress[0], stress[1], stress[2],
                                 stress[3], stress[4], stress[5]};
  half_work(m, old_stress, strain, batch.half_volume, &internal_energy[begin]);

  MaterialBatch points;
  points.n = m;
  points.dt = dt;
  std::copy(strain, strain + 6, points.strain_increment);
  points.jacobian = batch.jacobian;
  std::copy(stress, stress + 6, points.stress);
  points.states = states.data();
  points.extra_square = batch.extra_square;
  points.return_factor = batch.return_factor;
  points.plastic_work = batch.plastic_work;
  material->update(points);

  // A particle that lost a direction carries no tension across the gap.
  for (std::size_t k = 0; k < m; ++k)
    if (weak[begin + k])
    {
      double s[6];
      for (int c = 0; c < 6; ++c)
        s[c] = stress[c][k];
      cut_tension(s);
      for (int c = 0; c < 6; ++c)
        stress[c][k] = s[c];
    }

  half_work(m, old_stress, strain, batch.half_volume, &internal_energy[begin]);
  for (std::size_t k = 0; k < m; ++k)
  {
    internal_energy[begin + k] -=
        (viscous_pressure[begin + k] + batch.viscous_pressure[k]) *
        batch.half_volume[k] *
        (batch.strain[0][k] + batch.strain[1][k] + batch.strain[2][k]);
    viscous_pressure[begin + k] = batch.viscous_pressure[k];
    plastic_work[begin + k] +=
        2. * batch.plastic_work[k] * batch.half_volume[k];
  }
}

void SpgBody::residuals(const std::size_t begin, const std::size_t end)
{
  // Trial residuals, kept in force[]. Their mean square as a stress,
  // 3 (alpha mu)^2 sum phi |e|^2 / S = 3 alpha mu (2 W / V), yields together
  // with the deviator (doc/theory-spg.md).
  const Vec *const x = nodal_state.position.data();
  const double modulus =
      3. * options.stabilization_coefficient * material->shear_modulus();
  for (std::size_t i = begin; i < end; ++i)
  {
    const Mat F = gradient[i];
    const Vec xi = x[i];
    double sum = 0., old_force = 0.;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const Vec e = x[bonds.neighbor[b]] - xi - F * bonds.rest[b];
      old_force += dot(bonds.force[b], e);
      bonds.force[b] = e;
      sum += bonds.weight[b] * norm_square(e);
    }
    const std::size_t k = i - begin;
    batch.old_force_on_residual[k] = old_force;
    batch.trial_residual[k] = bond_stiffness[i] * sum;
    batch.extra_square[k] =
        modulus * batch.trial_residual[k] / kernel_volume[i];
  }
}

void SpgBody::generalized_stresses(const std::size_t begin,
                                   const std::size_t end)
{
  const std::size_t n = nodal_state.n_owned;
  for (std::size_t i = begin; i < end; ++i)
  {
    const std::size_t k = i - begin;
    const double q = batch.viscous_pressure[k];
    const double *const s = &stress_data[i];
    const Mat sigma = {{vec(s[0] - q, s[3 * n], s[5 * n]),
                        vec(s[3 * n], s[n] - q, s[4 * n]),
                        vec(s[5 * n], s[4 * n], s[2 * n] - q)}};
    const double V = kernel_volume[i] * determinant(gradient[i]); // J V
    Mat moment = V * (sigma * batch.nominal[k]);

    const double theta = batch.return_factor[k];
    const double stiffness = theta * bond_stiffness[i];
    // Work of the mean of old and new bond forces along the change of e.
    const double trial = batch.trial_residual[k];
    bond_work[i] += 0.5 * ((1. - theta) * batch.old_force_on_residual[k] -
                           force_on_residual[i] + theta * trial);
    force_on_residual[i] = theta * theta * trial;
    if (theta < 1.)
    {
      // The residual flows with the deviator.
      const Mat relax = (1. - theta) * transpose(batch.nominal[k]);
      for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
        bonds.rest[b] += relax * bonds.force[b];
    }
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const Vec t = stiffness * bonds.weight[b] * bonds.force[b];
      bonds.force[b] = t;
      add_outer(moment, -t, bonds.rest[b]);
    }
    generalized_stress[i] = moment * moment_inverse[i];
  }
}

void SpgBody::gather_forces()
{
  const Vec *const X = kernel_position.data();
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    const Mat Q = generalized_stress[i];
    const Vec Xi = X[i];
    // Columns of the sum are kept apart: three multiply-adds per bond.
    Vec f = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Mat &QJ = generalized_stress[j];
      const Vec dX = bonds.weight[b] * (X[j] - Xi);
      f += (Q + QJ) * dX + bonds.force[b] - bonds.force[bonds.reverse[b]];
    }
    nodal_state.force[i] = f;
  }
}

StableStep SpgBody::stable_step() const
{
  return {current_stable_step, stable_step_item};
}
} // namespace sabot
