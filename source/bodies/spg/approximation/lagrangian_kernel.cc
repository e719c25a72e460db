// Kernels that move with the material, and when they are due.
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"

#include "sabot/bodies/spg/particle_exchange.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/particle_surface.h"
#include "sabot/kernels/kernel_function.h"
#include "sabot/kernels/mirrored.h"
#include "sabot/kernels/principal.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Limits of the kernel's stretch, beyond those of 500 % shear: a kernel that
    moves with the material keeps its weights under any uniform deformation;
    the limits only catch degenerate particles. */
constexpr double least_stretch = 0.15, most_stretch = 6.;

/** Shape S of a particle of a mesh, of which the cloud knows the cells on the
    model's side of planes of symmetry only: S^2 without what links directions
    along and across a plane, which images cancel. */
Mat shape_with_images(const ParticleCloud &cloud, const std::size_t i,
                      const std::uint32_t symmetry_faces)
{
  const Mat &S = cloud.shape[i];
  const unsigned int axes =
      axes_across(cloud.on_face[i] & symmetry_faces, cloud.face_axis);
  if (axes == 0)
    return S;
  constexpr double round_off = 1e-12;
  const Mat square = S * transpose(S);
  Mat mean = square;
  take_mean_of_images(mean, axes);
  const Mat links = square - mean;
  double largest = 0.;
  for (int d = 0; d < 3; ++d)
    largest = std::max(largest, norm(links.row[d]));
  return largest > round_off * trace(square) ? square_root(mean) : S;
}
} // namespace

LagrangianKernel::LagrangianKernel(const SpgOptions &options,
                                   const ParticleCloud &cloud)
    : spacing(cloud.spacing),
      mean(std::cbrt(spacing[0] * spacing[1] * spacing[2])),
      normalized_support(options.normalized_support),
      is_regular(cloud.shape.empty()), interval(options.kernel_update_interval),
      least_strain(options.kernel_update_strain),
      largest_stretch(options.kernel_update_change),
      symmetry_faces(options.symmetry_faces)
{
}

AlignedVector<Mat>
LagrangianKernel::initial_kernels(const ParticleCloud &cloud) const
{
  AlignedVector<Mat> kernels;
  for (std::size_t i = 0; i < cloud.shape.size(); ++i)
    kernels.push_back(shape_with_images(cloud, i, symmetry_faces));
  if (is_regular)
    kernels.push_back(Mat{
        {vec(spacing[0], 0, 0), vec(0, spacing[1], 0), vec(0, 0, spacing[2])}});
  for (Mat &H : kernels)
    H = normalized_support * H;
  return kernels;
}

void LagrangianKernel::distribute(const AlignedVector<Mat> &kernels,
                                  const std::vector<GlobalIndex> &owned)
{
  if (!is_regular)
    for (const GlobalIndex i : owned)
      initial.push_back(kernels[i]);
}

AlignedVector<Mat>
LagrangianKernel::initial_kernels_of(const ParticleCloud &cloud,
                                     const std::vector<GlobalIndex> &some) const
{
  AlignedVector<Mat> kernels;
  for (const GlobalIndex i : some)
    kernels.push_back(normalized_support *
                      shape_with_images(cloud, i, symmetry_faces));
  return kernels;
}

void LagrangianKernel::extend(const AlignedVector<Mat> &kernels)
{
  initial.insert(initial.end(), kernels.begin(), kernels.end());
}

Mat LagrangianKernel::carried_kernel(const std::size_t i, const Mat &F) const
{
  return clamp_kernel(F * initial[i], initial[i], least_stretch, most_stretch);
}

void LagrangianKernel::start(ParticleFields &fields,
                             const ParticleExchange &exchange) const
{
  const double support = normalized_support;
  for (Mat &H : fields.kernel)
    H = {{vec(support * spacing[0], 0, 0), vec(0, support * spacing[1], 0),
          vec(0, 0, support * spacing[2])}};
  if (!is_regular)
  {
    std::copy(initial.begin(), initial.end(), fields.kernel.begin());
    exchange.update(fields.kernel.data());
  }
}

bool LagrangianKernel::has_strained(const ParticleFields &fields) const
{
  for (const Mat &F : fields.incremental_deformation_gradient)
  {
    const Mat C = transpose(F) * F - Mat::identity();
    const double square =
        norm_square(C.row[0]) + norm_square(C.row[1]) + norm_square(C.row[2]);
    if (0.25 * square >= least_strain * least_strain)
      return true;
  }
  return false;
}

bool LagrangianKernel::has_changed(const double change) const
{
  return std::sqrt(change) > largest_stretch;
}

double LagrangianKernel::largest_compression() const
{
  // |F^-1|^2 = c^2 + 2, whose determinant is largest for equal stretches.
  return std::pow((largest_stretch * largest_stretch + 2.) / 3., 1.5);
}

void LagrangianKernel::follow(ParticleFields &fields) const
{
  const Vec axes = normalized_support * vec(spacing[0], spacing[1], spacing[2]);
  for (std::size_t i = 0; i < fields.reference_volume.size(); ++i)
  {
    const Mat F = fields.incremental_deformation_gradient[i];
    fields.kernel_reference_deformation_gradient[i] =
        F * fields.kernel_reference_deformation_gradient[i];
    fields.kernel_reference_volume[i] *= determinant(F);
    fields.kernel[i] = is_regular
                           ? clamp_kernel(F * fields.kernel[i], axes,
                                          least_stretch, most_stretch)
                           : clamp_kernel(F * fields.kernel[i], initial[i],
                                          least_stretch, most_stretch);
    fields.incremental_deformation_gradient[i] = Mat::identity();
  }
}

double LagrangianKernel::local_spacing(const std::size_t i) const
{
  return is_regular ? mean
                    : std::cbrt(determinant(initial[i])) / normalized_support;
}
} // namespace sabot
