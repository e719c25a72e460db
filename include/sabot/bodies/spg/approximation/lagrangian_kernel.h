#ifndef sabot_bodies_spg_approximation_lagrangian_kernel_h
#define sabot_bodies_spg_approximation_lagrangian_kernel_h

#include "sabot/base/memory_table.h"
#include "sabot/base/types.h"
#include "sabot/bodies/spg/spg_options.h"
#include "sabot/geometry/particle_cloud.h"

#include <algorithm>
#include <array>

namespace sabot
{
class ParticleExchange;
struct ParticleFields;

/**
 * The kernels of the particles as they move with the material: H = F H_0, with
 * limits of the stretch that only catch degenerate particles, updated from time
 * to time. Between updates the functions are those of the last one (adaptive
 * anisotropic Lagrangian kernel, Wu & Wu 2018, section 3).
 */
class LagrangianKernel
{
public:
  LagrangianKernel(const SpgOptions &options, const ParticleCloud &cloud);

  /** Semi-axes of the kernels at the start: one matrix for all particles of
      a regular lattice, else one each. Support times S [m]: spacings on the
      diagonal in a lattice; on a mesh S^2 is the mean over the cells around
      of a (x) a + b (x) b + c (x) c with the cells' mean edges, with the
      images of the cells beyond planes of symmetry. Of all particles, by global
      number. */
  AlignedVector<Mat> initial_kernels(const ParticleCloud &cloud) const;
  /** Keep those of the owned particles, unless one does for all. */
  void distribute(const AlignedVector<Mat> &kernels,
                  const std::vector<GlobalIndex> &owned);
  /** Those of some of the cloud's particles; and more owned ones with these,
      of bodies that grow. */
  AlignedVector<Mat>
  initial_kernels_of(const ParticleCloud &cloud,
                     const std::vector<GlobalIndex> &some) const;
  void extend(const AlignedVector<Mat> &kernels);
  /** F H_0 of owned particle @p i within the limits of the stretch [m]. */
  Mat carried_kernel(const std::size_t i, const Mat &F) const;
  /** Kernels of owned and ghost particles at the start. Collective. */
  void start(ParticleFields &fields, const ParticleExchange &exchange) const;

  /** Whether a regular update is due by @p step. */
  bool is_regular_step(const unsigned int step) const
  {
    return step % interval == 0;
  }
  /** Between two regular updates: where cracks call for an update, kernels
      follow as well, so that crumbled metal has its neighbors found anew. */
  bool is_half_way(const unsigned int step) const
  {
    return step % std::max(1u, interval / 2) == 0;
  }
  /** Whether any owned particle's Green strain since the last update reaches
      the limit; rotation needs no update. On this rank; the caller asks the
      others. */
  bool has_strained(const ParticleFields &fields) const;
  /** Whether a particle has been stretched or flattened by so much that the
      update cannot wait. @p change: largest of |F|^2 - 2 and |F^-1|^2 - 2.
      sqrt(change) against the entry "Kernel update change"; on this rank. */
  bool has_changed(const double change) const;
  /** The largest ratio of volumes, that of the last update over now, which is
      no reason for has_changed(): ((c^2 + 2)/3)^(3/2), c "Kernel update
      change". */
  double largest_compression() const;
  /** Let kernels, volumes and F of the owned particles follow what happened
      since the last update, which starts anew. Wu & Wu 2018, Eq. 16: H :=
      F_inc H, V_ref := J_inc V_ref, F_ref := F_inc F_ref, F_inc := 1.
      Ghosts' kernels have to be exchanged afterwards. Singular values of H
      over that of the start are kept within 0.15 and 6. */
  void follow(ParticleFields &fields) const;

  /** Kernel of metal without memory: a ball of the support of the mean spacing
      [m]. */
  Mat round_kernel() const
  {
    return normalized_support * mean * Mat::identity();
  }

  /** Edge of the cube as large as the cell of an owned particle's lattice at
      the start [m]; mean_spacing() in a regular lattice. det(S)^(1/3). Does
      not follow the motion. */
  double local_spacing(const std::size_t i) const;
  double mean_spacing() const { return mean; }
  void list_memory(MemoryTable &table) const
  {
    table.add("kernels of the start", initial);
  }
  const std::array<double, 3> &axis_spacing() const { return spacing; }
  double support() const { return normalized_support; } // radius over spacing

private:
  const std::array<double, 3> spacing; // [m] per axis
  const double mean;                   // [m]
  const double normalized_support;
  const bool is_regular; // one kernel at the start for all
  const unsigned int interval;
  const double least_strain, largest_stretch;
  const std::uint32_t symmetry_faces; // of the cloud, a bit each
  AlignedVector<Mat> initial;         // H of the start, owned, unless regular
};
} // namespace sabot

#endif
