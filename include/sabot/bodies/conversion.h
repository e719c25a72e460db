#ifndef sabot_bodies_conversion_h
#define sabot_bodies_conversion_h

#include "sabot/base/exact_sum.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/types.h"
#include "sabot/bodies/conversion_criterion.h"
#include "sabot/geometry/split_mesh.h"
#include "sabot/kernels/vec.h"
#include "sabot/materials/material.h"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sabot
{
/**
 * What cells hand over when they turn into particles: an eighth of each to
 * every corner, or to every site of its lattice the share that SplitMesh says.
 * One entry per site that is owned here and takes part, ascending by number;
 * sites are the nodes of the host, or those of its lattices. SI units.
 *
 * Mass, energies and extensive quantities are sums over the cells that go;
 * deformation, stress and state are their means, so that they lie between those
 * of the cells. F is scaled to det F = volume/reference volume, the volume
 * ratio that the cells had together, by which no pressure jumps.
 */
struct NodalMatter
{
  static constexpr std::size_t no_node = -1;
  struct Entry
  {
    GlobalIndex site = 0;
    std::size_t node = no_node; // local, of the host, where the site is one
    GlobalIndex cell = 0;       // lowest of the mesh that has handed to it
    Vec position = {}, velocity = {};               // [m], [m/s]
    double mass = 0.;                               // [kg]
    double reference_volume = 0., volume = 0.;      // V_0, V [m^3]
    double internal_energy = 0., plastic_work = 0.; // [J]
    double hourglass_energy = 0.;                   // [J]
    /** Recoverable energy of the cells' stresses at elastic moduli [J]. */
    double elastic_energy = 0.;
    double viscous_pressure = 0.;             // [Pa]
    Mat gradient = Mat::zero();               // F
    std::array<double, n_symmetric> stress{}; // [Pa]
    /** The site has no cell left in the host. */
    bool is_bare = false;
  };
  std::vector<Entry> entries;
  /** States of the law, [entries][n_rows] in the order of its variables. */
  std::vector<double> states;
  std::size_t n_rows = 0;

  /** Add what one cell hands to entry @p k: extensive quantities as sums, F and
      states weighted by V_0, stress and viscous pressure by V. */
  void add(const std::size_t k, const Entry &share, const double *share_states);
  /** After the last share: sums become means. */
  void finish();
};

/** Mean of two gradients with weights, scaled to the volume ratio @p J. */
Mat mean_gradient(const Mat &a, const double weight_a, const Mat &b,
                  const double weight_b, const double J);

/** p^2/(2 K) + s : s/(4 G) [J/m^3], of stress components in the order of
    n_symmetric. */
double elastic_energy_density(const std::array<double, n_symmetric> &stress,
                              const Material &law);

/**
 * A body of cells that may turn into particles. What of it other
 * bodies see, as Body::cell_source().
 */
class CellSource
{
public:
  virtual ~CellSource() = default;

  /** Before distribute(): cells will be asked for. @p criteria say which. */
  virtual void convert_by(
      std::vector<std::shared_ptr<const ConversionCriterion>> criteria) = 0;
  /** Cells turn into the lattices of this mesh, whose nodes and cells are the
      body's; null: into particles at their nodes. After distribute(). */
  virtual void split_by(std::shared_ptr<const SplitMesh> mesh) = 0;
  /** Cells never turn that have one of these nodes, by number in the body:
     those of ties, of loaded faces, and what moves by prescription. The same on
     every rank. */
  virtual void keep_around(const std::vector<GlobalIndex> &nodes) = 0;
  /** Numbers of this rank's cells that shall turn now. @p is_failed [all local
      nodes]: beside broken bonds; ghosts are filled here. Collective; ranks
      that have a cell agree on it. */
  virtual std::vector<std::size_t>
  unfit_cells(std::vector<char> &is_failed) = 0;
  /** Of the undeformed mesh, those that may turn and whose center
      @p is_inside. */
  virtual std::vector<std::size_t>
  cells_in(const std::function<bool(const std::array<double, 3> &)> &is_inside)
      const = 0;
  /** Take these cells out, with their forces on the nodes, their faces and
      their part of the nodes' masses. Inertia is left as it is: it moves only
      where a node is bare, which is up to the caller. @p particles: that share
      nodes with cells, of which node, volumes and stress are asked.
      Collective. */
  virtual NodalMatter
  give(const std::vector<std::size_t> &cells,
       const std::vector<NodalMatter::Entry> &particles) = 0;
  /** Local number of a node of the mesh; that of no node where this rank does
      not have it. A rank has all nodes of all cells around those it owns. */
  virtual std::size_t local_node(const GlobalIndex node) const = 0;
  /** Number in the mesh of this rank's cell @p e. */
  virtual GlobalIndex cell_number(const std::size_t e) const = 0;
  /** Velocities of ghost nodes from their owners. Collective. */
  virtual void refresh_velocities() = 0;
};

/**
 * A body of particles that grows by what cells give. Particle number k of the
 * body is the site sites()[k] of the host: numbers go up in the order in
 * which particles came, so that those that are there keep theirs.
 */
class ParticleSink
{
public:
  virtual ~ParticleSink() = default;

  /** Before the first particle: each is on the rank that has its node, or the
      lowest of its carrier. @p owner: of the host's nodes; outlives this. */
  virtual void live_with(const std::vector<int> &owner) = 0;
  /** Make particles of matter, or let those that are there take it; then
      kernels, bonds and forces of now. Adds to @p lost what of the elastic
     energy is gone by taking means [J]. Collective; @p step: the number of the
     step that ended. */
  virtual void take(const NodalMatter &matter, const unsigned int step,
                    ExactSum &lost) = 0;
  /** Of every particle of the body, by its number; the same on all ranks. */
  virtual const std::vector<GlobalIndex> &sites() const = 0;
  /** Of whose lattices the sites are; null: of the host's nodes alone. */
  virtual const std::shared_ptr<const SplitMesh> &lattices() const = 0;
  /** Local number of the owned particle at a site; nothing: none is. */
  virtual std::optional<std::size_t>
  particle_at(const GlobalIndex site) const = 0;
  /** Of particle number @p k, whatever rank owns it: 1 where a component of its
      velocity is free, 0 where planes of symmetry and clamps hold it. With
      lattices only. */
  virtual Vec free_components(const std::size_t k) const = 0;
  /** Local numbers of owned particles beside broken bonds. */
  virtual std::vector<std::size_t> failed_particles() const = 0;
  /** Volumes and stress of an owned particle now. */
  virtual NodalMatter::Entry content(const std::size_t i) const = 0;
  /** The particle moves by its own forces from now on: its site has no
      cells any more. @p i: owned. */
  virtual void set_free(const std::size_t i) = 0;
};
} // namespace sabot

#endif
