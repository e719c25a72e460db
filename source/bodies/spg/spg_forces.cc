#include "sabot/bodies/spg/spg_body.h"
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
  current_stable_step = std::numeric_limits<double>::max();
  stable_step_item = -1;
  std::string problem;
  evaluate_forces(dt, problem);
  // Only now: the other ranks wait for the exchanges of the loop.
  if (!problem.empty())
    throw PhysicsError(problem);
}

void SpgBody::evaluate_forces(const double dt, std::string &problem)
{
  largest_change = 1.;
  const bool convex =
      options.approximation != SpgOptions::Approximation::least_squares;
  using S = Stabilization;
  switch (options.stabilization)
  {
  case S::bond_residual:
    convex ? force_loop<true, S::bond_residual>(dt, problem)
           : force_loop<false, S::bond_residual>(dt, problem);
    break;
  case S::second_gradient:
    force_loop<true, S::second_gradient>(dt, problem);
    break;
  default:
    convex ? force_loop<true, S::none>(dt, problem)
           : force_loop<false, S::none>(dt, problem);
  }
  std::copy_n(nodal_state.force.begin(), nodal_state.n_owned,
              own_force.begin());
}

template <bool stored_gradients, SpgBody::Stabilization stabilization>
void SpgBody::force_loop(const double dt, std::string &problem)
{
  const std::size_t n = nodal_state.n_owned;
  constexpr bool has_residuals = stabilization == Stabilization::bond_residual;
  for (std::size_t begin = 0; begin < n; begin += batch_size)
  {
    const std::size_t end = std::min(begin + batch_size, n);
    gradients<stored_gradients>(begin, end, dt, problem);
    if constexpr (has_residuals)
      residuals(begin, end);
    else if constexpr (stabilization == Stabilization::second_gradient)
      for (std::size_t i = begin; i < end; ++i)
        batch.extra_square[i - begin] =
            second_gradient->trial(i, bonds, nodal_state.position.data(),
                                   batch.velocity_gradient[i - begin],
                                   transpose(batch.nominal[i - begin]));
    if (dt > 0.)
      stresses(begin, end, dt);
    else
      std::fill_n(batch.return_factor, end - begin, 1.);
    generalized_stresses<stored_gradients, stabilization>(begin, end);
  }
  node_exchange.update(generalized_stress.data());
  if constexpr (has_residuals)
  {
    bonds.update_ghosts(bonds.residual.data());
    std::copy(nodal_state.position.begin(), nodal_state.position.end(),
              previous_position.begin());
  }
  gather_forces<stored_gradients, has_residuals>();
  if constexpr (stabilization == Stabilization::second_gradient)
    second_gradient->gather(bonds, node_exchange, nodal_state.n_owned,
                            nodal_state.force.data());
}

template <bool stored_gradients>
void SpgBody::gradients(const std::size_t begin, const std::size_t end,
                        const double dt, std::string &problem)
{
  const Vec *const x = nodal_state.position.data();
  const Vec *const X = kernel_position.data();
  const std::uint32_t *const neighbor = bonds.neighbor.data();
  const double *const weight = bonds.weight.data();
  const double c = material->sound_speed();
  for (std::size_t i = begin; i < end; ++i)
  {
    Mat A = Mat::zero();
    const Vec xi = x[i], Xi = X[i];
    const std::size_t last = bonds.end(i);
    for (std::size_t b = bonds.begin(i); b < last; ++b)
    {
      const std::uint32_t j = neighbor[b];
      const Vec dX = X[j] - Xi;
      if constexpr (stored_gradients)
        add_outer(A, x[j] - xi - dX, shape_gradient[b]);
      else
        add_outer(A, x[j] - xi - dX, weight[b] * dX);
    }
    if constexpr (!stored_gradients)
      A = A * moment_inverse[i];
    const Mat F = Mat::identity() + A;
    const Mat F_old = gradient[i];
    gradient[i] = F;
    const Mat l = (F - F_old) * inverse(0.5 * (F + F_old));
    double J_old;
    const Mat F_old_inverse = inverse(F_old, J_old);
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
    batch.velocity_gradient[k] = (F - F_old) * F_old_inverse;

    // Nominal-stress factor F^-T, completed once the stress is known; its
    // size also tells how much stiffer compression has made the particle.
    double J;
    const Mat F_inverse = inverse(F, J);
    batch.nominal[k] = transpose(F_inverse);
    batch.jacobian[k] = V / V0 * J;
    batch.half_volume[k] = 0.25 * V * (J + J_old);
    const double compression = norm_square(F_inverse.row[0]) +
                               norm_square(F_inverse.row[1]) +
                               norm_square(F_inverse.row[2]) - 2.;
    double step = update_stable_step[i] / std::sqrt(std::max(1., compression));
    if (!stiffening.empty())
      step /= std::sqrt(std::max(1., stiffening[i]));
    // Bulk viscosity, as for hexahedra; a flattened particle's step tells its
    // smallest dimension.
    const double rate = dt > 0. ? trace(l) / dt : 0.;
    const double h = std::min(std::cbrt(V * J), 2. * c * step);
    // Without a step that of the last one stays.
    batch.viscous_pressure[k] = points.viscous_pressure[i];
    if (dt > 0.)
    {
      batch.viscous_pressure[k] = bulk_viscosity_pressure(
          material->density() * V0 / (V * J), c, h, rate,
          options.bulk_viscosity_linear, options.bulk_viscosity_quadratic);
      const double l_norm =
          std::sqrt(norm_square(l.row[0]) + norm_square(l.row[1]) +
                    norm_square(l.row[2]));
      // The bulk viscosity's damping ratio acts in compression only.
      step /= 1. + (rate < 0. ? options.bulk_viscosity_linear : 0.) +
              h * l_norm / (c * dt);
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
    largest_change = std::max({largest_change, compression,
                               norm_square(F.row[0]) + norm_square(F.row[1]) +
                                   norm_square(F.row[2]) - 2.});
  }
}

void SpgBody::residuals(const std::size_t begin, const std::size_t end)
{
  // Trial residuals e = dx - F Xi by increments, which needs no Xi:
  //   e = dx - F_new F_old^-1 (dx_old - theta_old e_old).
  // As a stress of the modulus mu whose energy is W, their mean square,
  // 3 mu (2 W / V), yields together with the deviator.
  const Vec *const x = nodal_state.position.data();
  const Vec *const x_old = previous_position.data();
  const std::uint32_t *const neighbor = bonds.neighbor.data();
  const double *const weight = bonds.residual_weight.data();
  StoredVec *const residual = bonds.residual.data();
  const double modulus = 3. * material->shear_modulus();
  for (std::size_t i = begin; i < end; ++i)
  {
    const std::size_t k = i - begin;
    const Mat l = transpose(batch.velocity_gradient[k]);
    const Vec xi = x[i], xi_old = x_old[i];
    const double theta = residual_factor[i];
    Vec trial_square = {}, old_trial = {}, old_square = {};
    Mat on_bond = Mat::zero(), on_residual = Mat::zero();
    const std::size_t last = bonds.end(i);
    for (std::size_t b = bonds.begin(i); b < last; ++b)
    {
      const std::uint32_t j = neighbor[b];
      const Vec dx = x[j] - xi, dx_old = x_old[j] - xi_old;
      const Vec e_old = theta * load(residual[b]);
      const StoredVec stored =
          store(dx - dx_old + e_old - multiply_columns(l, dx_old - e_old));
      residual[b] = stored;
      // As stored: forces along e itself keep the angular momentum exact.
      const Vec e = load(stored);
      const Vec we = weight[b] * e;
      trial_square += we * e;
      old_trial += we * e_old;
      old_square += weight[b] * e_old * e_old;
      add_outer(on_bond, we, dx);
      add_outer(on_residual, we, e);
    }
    const auto sum = [](const Vec v) { return v[0] + v[1] + v[2]; };
    const double stiffness = bond_stiffness[i];
    batch.trial_square[k] = stiffness * sum(trial_square);
    batch.old_trial[k] = stiffness * sum(old_trial);
    batch.old_square[k] = stiffness * sum(old_square);
    batch.residual_on_bond[k] = on_bond;
    batch.residual_on_residual[k] = on_residual;
    batch.extra_square[k] = modulus * batch.trial_square[k] / kernel_volume[i];
  }
}

void SpgBody::stresses(const std::size_t begin, const std::size_t end,
                       const double dt)
{
  if (material->needs_deformation_gradient())
    for (std::size_t i = begin; i < end; ++i)
    {
      const Mat F = deformation_gradient(i);
      for (int c = 0; c < 9; ++c)
        batch.deformation_gradient[c][i - begin] = F(c / 3, c % 3);
    }
  PointStep step = batch.views(begin, end - begin, dt);
  step.extra_square = batch.extra_square;
  if (!stiffening.empty())
    step.stiffening = &stiffening[begin];
  update_material(points.rotate(step), begin);
  points.finish(step);
}

template <bool stored_gradients, SpgBody::Stabilization stabilization>
void SpgBody::generalized_stresses(const std::size_t begin,
                                   const std::size_t end)
{
  for (std::size_t i = begin; i < end; ++i)
  {
    const std::size_t k = i - begin;
    const Mat sigma = points.total_stress(i, batch.viscous_pressure[k]);
    const double V = batch.jacobian[k] * reference_volume[i]; // J V
    const double theta = batch.return_factor[k];
    Mat spatial = V * sigma;
    double stiffness = 0.;
    if constexpr (stabilization == Stabilization::bond_residual)
    {
      stiffness = theta * bond_stiffness[i];
      // sum t (x) F Xi with F Xi = dx - e, t = k phi theta e_trial: the
      // residuals' part of the stress.
      spatial = spatial - stiffness * (batch.residual_on_bond[k] -
                                       theta * batch.residual_on_residual[k]);
      // Work of the mean of old and new bond forces along the change of e.
      bond_work[i] +=
          0.5 * ((1. - theta) * batch.old_trial[k] - batch.old_square[k] +
                 theta * batch.trial_square[k]);
      residual_factor[i] = theta;
    }
    else if constexpr (stabilization == Stabilization::second_gradient)
      spatial =
          spatial + second_gradient->finish(i, theta, V, batch.nominal[k]);
    Mat moment = spatial * batch.nominal[k];
    if constexpr (!stored_gradients)
      moment = moment * moment_inverse[i];
    generalized_stress[i] = transpose(moment);
    generalized_stress[i].row[0][3] = stiffness;
  }
}

template <bool stored_gradients, bool has_residuals>
void SpgBody::gather_forces()
{
  const Vec *const X = kernel_position.data();
  const std::uint32_t *const neighbor = bonds.neighbor.data(), *const reverse =
                                                                   bonds.reverse
                                                                       .data();
  const double *const weight = bonds.weight.data();
  const double *const residual_weight = bonds.residual_weight.data();
  const StoredVec *const residual = bonds.residual.data();
  const Mat *const stress = generalized_stress.data();
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    const Mat Q = stress[i];
    const double own_stiffness = Q.row[0][3];
    const Vec Xi = X[i];
    Vec f = {};
    const std::size_t last = bonds.end(i);
    for (std::size_t b = bonds.begin(i); b < last; ++b)
    {
      const std::uint32_t j = neighbor[b];
      const Mat &QJ = stress[j];
      if constexpr (stored_gradients)
        f += multiply_columns(Q, shape_gradient[b]) -
             multiply_columns(QJ, shape_gradient[reverse[b]]);
      else
        f += multiply_columns(Q + QJ, weight[b] * (X[j] - Xi));
      if constexpr (has_residuals)
        f += residual_weight[b] * (own_stiffness * load(residual[b]) -
                                   QJ.row[0][3] * load(residual[reverse[b]]));
    }
    f[3] = 0.;
    nodal_state.force[i] = f;
  }
}

StableStep SpgBody::stable_step() const
{
  return {current_stable_step, stable_step_item};
}
} // namespace sabot
