#include "sabot/bodies/fem/fem_body.h"
#include "sabot/bodies/fem/hourglass.h"
#include "sabot/kernels/stress_update.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Hexahedra have no stress beside the stress. */
const double no_extra[64] = {};
} // namespace

void FemBody::update_ghosts()
{
  node_exchange.update(nodal_state.position.data());
  node_exchange.update(nodal_state.velocity.data());
}

void FemBody::compute_forces(const double /*time*/, const double dt)
{
  std::fill(nodal_state.force.begin(), nodal_state.force.end(), Vec{});
  current_stable_step = std::numeric_limits<double>::max();
  stable_step_item = -1;
  const std::size_t n = connectivity.size();
  for (std::size_t begin = 0; begin < n; begin += batch_size)
  {
    const std::size_t end = std::min(begin + batch_size, n);
    kinematics(begin, end, dt);
    if (dt > 0.)
      stresses(begin, end, dt);
    scatter_forces(begin, end, dt);
  }
}

void FemBody::kinematics(const std::size_t begin, const std::size_t end,
                         const double dt)
{
  const double c = material->sound_speed(), density = material->density();
  const bool keep_steps = options.erosion_step > 0.;
  for (std::size_t e = begin; e < end; ++e)
  {
    const auto &nodes = connectivity[e];
    const CellGeometry &g = geometry[e];
    Mat F = Mat::zero();
    for (int a = 0; a < 8; ++a)
      add_outer(F, nodal_state.position[nodes[a]], g.mean_gradient[a]);
    const Mat F_old = gradient[e];
    const double J_old = determinant(F_old);
    if (!(determinant(F) > 2. / 3. * J_old))
      F = avoid_inversion(e, F);
    gradient[e] = F;
    const Mat l = (F - F_old) * inverse(0.5 * (F + F_old));
    double J;
    const Mat F_inverse = inverse(F, J);

    const std::size_t k = e - begin;
    batch.strain[0][k] = l(0, 0);
    batch.strain[1][k] = l(1, 1);
    batch.strain[2][k] = l(2, 2);
    batch.strain[3][k] = 0.5 * (l(0, 1) + l(1, 0));
    batch.strain[4][k] = 0.5 * (l(1, 2) + l(2, 1));
    batch.strain[5][k] = 0.5 * (l(0, 2) + l(2, 0));
    batch.spin[0][k] = 0.5 * (l(0, 1) - l(1, 0));
    batch.spin[1][k] = 0.5 * (l(1, 2) - l(2, 1));
    batch.spin[2][k] = 0.5 * (l(0, 2) - l(2, 0));
    batch.jacobian[k] = J;
    batch.half_volume[k] = 0.25 * volume[e] * (J + J_old);
    batch.inverse_transposed[k] = transpose(F_inverse);
    // Eigenvalue bound of the cell, and its smallest dimension with it.
    double thickness;
    const double elastic_step = cell_stable_step(e, F_inverse, J, thickness);
    const double rate = dt > 0. ? trace(l) / dt : 0.;
    batch.viscous_pressure[k] = bulk_viscosity_pressure(
        density / J, c, thickness, rate, options.bulk_viscosity_linear,
        options.bulk_viscosity_quadratic);
    // Bulk viscosity shortens the step: damping ratio xi of the cell's own
    // compression.
    const double xi =
        options.bulk_viscosity_linear +
        options.bulk_viscosity_quadratic * thickness * std::max(0., -rate) / c;
    double step = elastic_step * (std::sqrt(1. + xi * xi) - xi);
    if (options.inversion == FemOptions::Inversion::shrink && J < J_old)
      step = std::min(step, 0.25 * dt * J / (J_old - J));
    if (keep_steps)
      erosion->step[e] = step;
    if (step < current_stable_step)
    {
      current_stable_step = step;
      stable_step_item = cell_id[e];
    }
  }
}

Mat FemBody::avoid_inversion(const std::size_t e, const Mat &F)
{
  const double J = determinant(F);
  using Inversion = FemOptions::Inversion;
  if (options.inversion == Inversion::erode)
  {
    erosion->inverting.push_back(e);
    // Already beyond: the cell rests as it was until it goes.
    return J > 0. ? F : gradient[e];
  }
  if (options.inversion == Inversion::shrink && J > 0.)
    return F;
  const Vec x = nodal_state.position[connectivity[e][0]];
  throw PhysicsError(
      "body " + name + ", cell " + std::to_string(cell_id[e]) + " near (" +
      std::to_string(x[0]) + ", " + std::to_string(x[1]) + ", " +
      std::to_string(x[2]) +
      ") m is about to turn inside out: one step took its det F from " +
      std::to_string(determinant(gradient[e])) + " to " + std::to_string(J) +
      "; take a smaller step factor, or set the body's \"Inversion\" to erode "
      "or shrink step");
}

double FemBody::hourglass_stiffness(const std::size_t e, const double J) const
{
  const double c = material->sound_speed();
  return options.hourglass_coefficient * 0.125 * material->density() * c * c *
         std::cbrt(volume[e] * J);
}

double FemBody::cell_stable_step(const std::size_t e, const Mat &F_inverse,
                                 const double J, double &thickness) const
{
  // omega^2 <= 8 V/m (lambda tr G + 2 mu lambda_max G), G = sum b_a b_a^T with
  // the present gradients b_a = F^-T B_a (doc/theory-fem.md).
  const Mat G = transpose(F_inverse) * geometry[e].gradient_square * F_inverse;
  const double mu = material->shear_modulus(),
               lambda = material->bulk_modulus() - 2. / 3. * mu;
  const double largest = std::min(trace(G), std::sqrt(norm_square(G.row[0]) +
                                                      norm_square(G.row[1]) +
                                                      norm_square(G.row[2])));
  // A slab of thickness h has lambda_max = 1/(2 h^2).
  thickness = std::sqrt(0.5 / largest);
  const double omega_square =
      8. * J / material->density() *
      (std::max(0., lambda) * trace(G) + 2. * mu * largest);
  return 2. / std::sqrt(omega_square);
}

void FemBody::stresses(const std::size_t begin, const std::size_t end,
                       const double dt)
{
  const std::size_t n = connectivity.size(), m = end - begin;
  double *stress[6];
  const double *strain[6], *spin[3];
  for (int c = 0; c < 6; ++c)
  {
    stress[c] = &stress_data[c * n + begin];
    strain[c] = batch.strain[c];
  }
  for (int c = 0; c < 3; ++c)
    spin[c] = batch.spin[c];
  for (std::size_t s = 0; s < n_states; ++s)
    batch_states[s] = &state_data[s * n + begin];

  rotate_symmetric(m, spin, stress);
  std::size_t first = 0;
  for (const StateVariable &variable : state_variables)
  {
    if (variable.is_tensor)
      rotate_symmetric(m, spin, &batch_states[first]);
    first += variable.is_tensor ? 6 : 1;
  }
  const double *now[6] = {stress[0], stress[1], stress[2],
                          stress[3], stress[4], stress[5]};
  half_work(m, now, strain, batch.half_volume, &internal_energy[begin]);
  MaterialBatch points;
  points.n = m;
  points.dt = dt;
  std::copy(strain, strain + 6, points.strain_increment);
  points.jacobian = batch.jacobian;
  std::copy(stress, stress + 6, points.stress);
  points.states = batch_states.data();
  points.extra_square = no_extra;
  points.return_factor = batch.return_factor;
  points.plastic_work = batch.plastic_work;
  material->update(points);
  half_work(m, now, strain, batch.half_volume, &internal_energy[begin]);
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

void FemBody::scatter_forces(const std::size_t begin, const std::size_t end,
                             const double dt)
{
  const std::size_t n = connectivity.size();
  const bool viscous = options.hourglass == FemOptions::Hourglass::viscous;
  const double c = material->sound_speed(), density = material->density();
  for (std::size_t e = begin; e < end; ++e)
  {
    const std::size_t k = e - begin;
    const CellGeometry &g = geometry[e];
    const auto &nodes = connectivity[e];
    const double q = batch.viscous_pressure[k];
    const double *const s = &stress_data[e];
    const Mat sigma = {{vec(s[0] - q, s[3 * n], s[5 * n]),
                        vec(s[3 * n], s[n] - q, s[4 * n]),
                        vec(s[5 * n], s[4 * n], s[2 * n] - q)}};
    // V_0 P, then the part of the hourglass forces that acts through B.
    Mat P =
        (volume[e] * batch.jacobian[k]) * (sigma * batch.inverse_transposed[k]);

    // Flanagan & Belytschko 1981: viscosity ~ rho c V^(2/3), stiffness
    // ~ rho c^2 V^(1/3), both for base vectors of unit entries.
    Vec x[8], mode[4], corner[8];
    for (int a = 0; a < 8; ++a)
      x[a] = nodal_state.position[nodes[a]];
    hourglass_sums(x, mode);
    HourglassModes &modes = hourglass_modes[e];
    if (viscous)
    {
      const Mat F_inverse = transpose(batch.inverse_transposed[k]);
      const double size = std::cbrt(volume[e] * batch.jacobian[k]);
      const double coefficient =
          options.hourglass_coefficient * 0.25 * density * c * size * size;
      Vec v[8], rate[4];
      Mat L = Mat::zero();
      for (int a = 0; a < 8; ++a)
      {
        v[a] = nodal_state.velocity[nodes[a]];
        add_outer(L, v[a], g.mean_gradient[a]);
      }
      hourglass_sums(v, rate);
      double work = 0.;
      for (int m = 0; m < 4; ++m)
      {
        const Vec pulled_back = F_inverse * mode[m];
        rate[m] -= L * pulled_back;
        mode[m] = coefficient * rate[m];
        work += dot(mode[m] + modes.mode[m], rate[m]);
        modes.mode[m] = mode[m];
        add_outer(P, -mode[m], pulled_back);
      }
      hourglass_energy[e] += 0.5 * dt * work;
    }
    else
    {
      const double coefficient = hourglass_stiffness(e, batch.jacobian[k]);
      double energy = 0.;
      for (int m = 0; m < 4; ++m)
      {
        mode[m] -= gradient[e] * modes.mode[m];
        energy += coefficient * norm_square(mode[m]);
        mode[m] = coefficient * mode[m];
        add_outer(P, -mode[m], modes.mode[m]);
      }
      hourglass_energy[e] = 0.5 * energy;
    }
    hourglass_spread(mode, corner);
    for (int a = 0; a < 8; ++a)
      nodal_state.force[nodes[a]] -= P * g.mean_gradient[a] + corner[a];
  }
}

StableStep FemBody::stable_step() const
{
  return {current_stable_step, stable_step_item};
}
} // namespace sabot
