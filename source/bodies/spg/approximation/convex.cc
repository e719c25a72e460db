// Convex (generalized meshfree) functions: gradients per bond, second
// derivatives, masses.
#include "sabot/base/nodal_state.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_exchange.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/kernels/convex_functions.h"
#include "sabot/kernels/kernel_function.h"
#include "sabot/kernels/principal.h"

namespace sabot
{
namespace
{
/** The functions of the neighbors of a particle, itself first. */
template <typename Kernel>
class Neighborhood
{
public:
  Neighborhood(const BondList &bonds, const ParticleFields &fields,
               const LagrangianKernel &kernel,
               const ConvexFunctions::Basis basis)
      : functions(basis), bonds(bonds),
        X(fields.kernel_reference_position.data()), kernel(kernel),
        to_kernel(fields.kernel.size()), to_space(fields.kernel.size())
  {
    for (std::size_t i = 0; i < to_kernel.size(); ++i)
    {
      to_kernel[i] = inverse(fields.kernel[i]);
      to_space[i] = transpose(to_kernel[i]);
    }
  }

  /** Evaluate at owned particle @p i plus @p shift; false where there are no
      such functions. */
  bool evaluate(const std::size_t i, const Vec shift)
  {
    functions.clear();
    const auto add = [&](const std::size_t j)
    {
      const Vec D = X[i] + shift - X[j];
      const Vec xi_i = to_kernel[i] * D, xi_j = to_kernel[j] * D;
      functions.add(D, 0.5 * (Kernel::weight(xi_i) + Kernel::weight(xi_j)),
                    0.5 * (to_space[i] * Kernel::slope(xi_i) +
                           to_space[j] * Kernel::slope(xi_j)));
    };
    add(i);
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      add(bonds.neighbor[b]);
    return functions.evaluate(kernel.local_spacing(i));
  }

  /**
   * b = A grad grad Psi_J of the bonds of particle @p i into @p result, by
   * bonds; nothing where the functions do not exist all around. A is the square
   * root of the second moment of the zeroth-order functions; derivatives are
   * central differences of the exact gradients: each of these reproduces linear
   * fields, hence so do their differences.
   */
  void second_derivatives(const std::size_t i, AlignedVector<Mat> &result)
  {
    const std::size_t begin = bonds.begin(i), end = bonds.end(i);
    double total = Kernel::weight(Vec{});
    Mat moment = Mat::zero();
    for (std::size_t b = begin; b < end; ++b)
    {
      const Vec dX = X[bonds.neighbor[b]] - X[i];
      total += bonds.weight[b];
      add_outer(moment, bonds.weight[b] * dX, dX);
    }
    const Mat A = square_root(1. / total * moment);
    const double width = 1e-3 * kernel.local_spacing(i);
    std::vector<Mat> hessian(end - begin, Mat::zero());
    for (int d = 0; d < 3; ++d)
      for (const double sign : {1., -1.})
      {
        Vec shift = {};
        shift[d] = sign * width;
        if (!evaluate(i, shift))
          return;
        for (std::size_t b = begin; b < end; ++b)
          hessian[b - begin].row[d] +=
              sign / (2. * width) * functions.gradient[1 + b - begin];
      }
    for (std::size_t b = begin; b < end; ++b)
      result[b] = A * hessian[b - begin];
  }

  ConvexFunctions functions;

private:
  const BondList &bonds;
  const Vec *const X;
  const LagrangianKernel &kernel;
  std::vector<Mat> to_kernel, to_space; // H^-1, H^-T
};
} // namespace

void ParticleApproximation::find_gradients(
    const BondList &bonds, const ParticleFields &fields,
    const LagrangianKernel &kernel,
    AlignedVector<Mat> *const second_derivatives)
{
  has_tensor_kernel ? find_gradients_with<TensorKernel>(bonds, fields, kernel,
                                                        second_derivatives)
                    : find_gradients_with<SphericalKernel>(
                          bonds, fields, kernel, second_derivatives);
}

template <typename Kernel>
void ParticleApproximation::find_gradients_with(
    const BondList &bonds, const ParticleFields &fields,
    const LagrangianKernel &kernel,
    AlignedVector<Mat> *const second_derivatives)
{
  const std::size_t n = moment_inverse.size();
  const Vec *const X = fields.kernel_reference_position.data();
  // Values are for the masses, which are set once and for ever.
  const bool sets_masses = !has_masses;
  shape_gradient.assign(bonds.n_with_ghosts(), Vec{});
  shape_value.assign(sets_masses ? bonds.n_with_ghosts() : 0, 0.);
  own_shape_value.assign(sets_masses ? n : 0, 1.);
  if (second_derivatives != nullptr)
    second_derivatives->assign(bonds.n_with_ghosts(), Mat::zero());
  n_fallback = 0;
  Neighborhood<Kernel> around(
      bonds, fields, kernel,
      functions == SpgOptions::Approximation::convex_exponential
          ? ConvexFunctions::Basis::exponential
          : ConvexFunctions::Basis::arctangent);
  const ConvexFunctions &f = around.functions;
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::size_t begin = bonds.begin(i), end = bonds.end(i);
    const bool solved = !lost_direction[i] && around.evaluate(i, Vec{});
    for (std::size_t b = begin; b < end; ++b)
    {
      // Fallback of deficient neighborhoods: damped least squares.
      shape_gradient[b] =
          solved ? f.gradient[1 + b - begin]
                 : bonds.weight[b] *
                       (moment_inverse[i] * (X[bonds.neighbor[b]] - X[i]));
      if (!shape_value.empty())
        shape_value[b] = solved ? f.value[1 + b - begin] : 0.;
    }
    if (solved && !own_shape_value.empty())
      own_shape_value[i] = f.value[0];
    n_fallback += !solved && end > begin;
    if (second_derivatives != nullptr && solved)
      around.second_derivatives(i, *second_derivatives);
  }
  bonds.update_ghosts(shape_gradient.data());
  if (sets_masses)
    bonds.update_ghosts(shape_value.data());
  if (second_derivatives != nullptr)
    bonds.update_ghosts(second_derivatives->data());
}

void ParticleApproximation::set_convex_masses(NodalState &nodes,
                                              const BondList &bonds,
                                              const ParticleExchange &exchange)
{
  has_masses = true;
  std::vector<double> nodal_mass(nodes.lumped_mass);
  exchange.make_whole(nodal_mass.data());
  exchange.update(nodal_mass.data());
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    double mass = nodal_mass[i] * own_shape_value[i];
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      mass += nodal_mass[bonds.neighbor[b]] * shape_value[bonds.reverse[b]];
    nodes.lumped_mass[i] = nodes.inertia[i] = mass;
  }
  exchange.take_shares(nodes.lumped_mass.data());
  exchange.take_shares(nodes.inertia.data());
}
} // namespace sabot
