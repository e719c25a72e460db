#include "sabot/bodies/spg/spg_body.h"
#include "sabot/kernels/convex_functions.h"
#include "sabot/kernels/kernel_function.h"

#include <Eigen/Eigenvalues>

namespace sabot
{
namespace
{
/** Square root of a symmetric positive matrix. */
Mat square_root(const Mat &a)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(to_eigen(a));
  return from_eigen(solver.operatorSqrt());
}
} // namespace

template <typename Kernel>
void SpgBody::compute_shape_gradients()
{
  const std::size_t n = nodal_state.n_owned;
  const bool sets_mass = n_updates == 0;
  shape_gradient.assign(bonds.n_with_ghosts(), Vec{});
  shape_value.assign(sets_mass ? bonds.n_with_ghosts() : 0, 0.);
  own_shape_value.assign(sets_mass ? n : 0, 1.);
  if (second_gradient)
    second_gradient->bond_gradient.assign(bonds.n_with_ghosts(), Mat::zero());
  n_fallback = 0;

  std::vector<Mat> to_kernel(kernel.size()), to_space(kernel.size());
  for (std::size_t i = 0; i < kernel.size(); ++i)
  {
    to_kernel[i] = inverse(kernel[i]);
    to_space[i] = transpose(to_kernel[i]);
  }
  ConvexFunctions functions(
      options.approximation == SpgOptions::Approximation::convex_exponential
          ? ConvexFunctions::Basis::exponential
          : ConvexFunctions::Basis::arctangent);
  // Functions at the particle's position plus @p shift.
  const auto evaluate = [&](const std::size_t i, const Vec shift)
  {
    functions.clear();
    const auto add = [&](const std::size_t j)
    {
      const Vec D = kernel_position[i] + shift - kernel_position[j];
      const Vec xi_i = to_kernel[i] * D, xi_j = to_kernel[j] * D;
      functions.add(D, 0.5 * (Kernel::weight(xi_i) + Kernel::weight(xi_j)),
                    0.5 * (to_space[i] * Kernel::slope(xi_i) +
                           to_space[j] * Kernel::slope(xi_j)));
    };
    add(i);
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      add(bonds.neighbor[b]);
    return functions.evaluate(local_spacing(i));
  };

  for (std::size_t i = 0; i < n; ++i)
  {
    const std::size_t begin = bonds.begin(i), end = bonds.end(i);
    const bool solved = !weak[i] && evaluate(i, Vec{});
    for (std::size_t b = begin; b < end; ++b)
    {
      // Fallback of deficient neighbourhoods: damped least squares.
      shape_gradient[b] =
          solved
              ? functions.gradient[1 + b - begin]
              : bonds.weight[b] *
                    (moment_inverse[i] *
                     (kernel_position[bonds.neighbor[b]] - kernel_position[i]));
      if (!shape_value.empty())
        shape_value[b] = solved ? functions.value[1 + b - begin] : 0.;
    }
    if (solved && !own_shape_value.empty())
      own_shape_value[i] = functions.value[0];
    n_fallback += !solved && end > begin;

    if (!second_gradient || !solved)
      continue;
    // A: square root of the second moment of the zeroth-order functions.
    double total = Kernel::weight(Vec{});
    Mat moment = Mat::zero();
    for (std::size_t b = begin; b < end; ++b)
    {
      const Vec dX = kernel_position[bonds.neighbor[b]] - kernel_position[i];
      total += bonds.weight[b];
      add_outer(moment, bonds.weight[b] * dX, dX);
    }
    const Mat A = square_root(1. / total * moment);
    // Second derivatives as central differences of the exact gradients: each
    // of these reproduces linear fields, hence so do their differences.
    const double width = 1e-3 * local_spacing(i);
    std::vector<Mat> hessian(end - begin, Mat::zero());
    bool complete = true;
    for (int d = 0; d < 3; ++d)
      for (const double sign : {1., -1.})
      {
        Vec shift = {};
        shift[d] = sign * width;
        complete = complete && evaluate(i, shift);
        for (std::size_t b = begin; complete && b < end; ++b)
          hessian[b - begin].row[d] +=
              sign / (2. * width) * functions.gradient[1 + b - begin];
      }
    if (complete)
      for (std::size_t b = begin; b < end; ++b)
        second_gradient->bond_gradient[b] = A * hessian[b - begin];
  }
  bonds.update_ghosts(shape_gradient.data());
  if (!shape_value.empty())
    bonds.update_ghosts(shape_value.data());
  if (second_gradient)
    bonds.update_ghosts(second_gradient->bond_gradient.data());
}

void SpgBody::set_convex_masses()
{
  // Row sums (Wu & Wu 2018, Eq. 11), once and for ever.
  std::vector<double> nodal_mass(nodal_state.size());
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    nodal_mass[i] = material->density() * reference_volume[i];
  node_exchange.update(nodal_mass.data());
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    double mass = nodal_mass[i] * own_shape_value[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      mass += nodal_mass[bonds.neighbor[b]] * shape_value[bonds.reverse[b]];
    nodal_state.lumped_mass[i] = nodal_state.inertia[i] = mass;
  }
}

template void SpgBody::compute_shape_gradients<SphericalKernel>();
template void SpgBody::compute_shape_gradients<TensorKernel>();
} // namespace sabot
