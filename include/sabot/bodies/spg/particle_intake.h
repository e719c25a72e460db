#ifndef sabot_bodies_spg_particle_intake_h
#define sabot_bodies_spg_particle_intake_h

#include "sabot/base/state_visitor.h"
#include "sabot/bodies/conversion.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_surface.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/geometry/particle_cloud.h"

#include <mpi.h>

#include <functional>
#include <unordered_map>
#include <vector>

namespace sabot
{
class Stabilization;

/**
 * How an SPG body grows by what cells of its host give. Particle k is the site
 * sites()[k] of the host, a node or a point of the lattices of its cells;
 * numbers go up in the order in which particles came, and by the sites' numbers
 * among those that came together, so that local numbers of those that are there
 * never change and every rank agrees.
 *
 * New particles come with F, state, volume and energies of their cells and with
 * the kernel H = F H_0 that they would have, had they been there since the
 * start; bonds join all that the kernels of the undeformed lattice reach, as in
 * a zone of the start. A particle that has a share of its node's cells already
 * takes the rest by means. The energy of elastic stresses that means do not
 * have is handed back as lost and leaves the internal energy.
 */
class ParticleIntake : public ParticleSink
{
public:
  /** The rooms of the body, as whoever makes it grow needs them; they outlive
      this. */
  struct Rooms : SpgParts
  {
    /** Of all nodes of the host; with lattices of the particles that there
        are, by number, as there may be sites without end. Stays. */
    ParticleCloud &cloud;
    std::shared_ptr<const SplitMesh> lattices; // null: none
    LagrangianKernel &kernel;
    ParticleApproximation &approximation;
    SpgStableStep &stable_step;
    ParticleSurface &surface;
    Stabilization &stabilization;
    std::vector<int> &rank_of, &node_owner; // of every particle
    GlobalIndex &n_global;
    MPI_Comm &communicator;
    /** A kernel update with the forces of now, which calls grow(). */
    const std::function<void(const unsigned int step)> update;
  };
  ParticleIntake(const Rooms &rooms) : body(rooms) {}

  /** After distribute(): normals of the host's surface, and which planes and
      clamps may hold particles. */
  void set_up();

  void live_with(const std::vector<int> &owner) override
  {
    host_owner = &owner;
  }
  void take(const NodalMatter &matter, const unsigned int step,
            ExactSum &lost) override;
  const std::vector<GlobalIndex> &sites() const override { return site; }
  const std::shared_ptr<const SplitMesh> &lattices() const override
  {
    return body.lattices;
  }
  std::optional<std::size_t> particle_at(const GlobalIndex at) const override;
  Vec free_components(const std::size_t k) const override;
  std::vector<std::size_t> failed_particles() const override;
  NodalMatter::Entry content(const std::size_t i) const override;
  void set_free(const std::size_t i) override;

  /** Whether matter waits for the kernel update that is under way. */
  bool is_waiting() const { return matter != nullptr; }
  /** Room for it in all arrays, and rows of bonds for SpgBody::renumber().
      Collective. */
  BondList::Rows grow();

  /** Goes up whenever matter has been taken. */
  unsigned int version() const { return n_taken; }
  /** Whether so many have come since the last call that said so that the stable
      step must be measured anew; the same on all ranks. */
  bool has_grown_much();

  /** Before anything else of the body: how many particles there are. Restored,
      they are where the host's nodes are. */
  void visit_state(StateVisitor &visitor);

private:
  /** Numbers for the sites among the matter that are no particles yet; the
      entries of those of this rank are returned. Collective. */
  std::vector<std::size_t> number_new();
  void forget_places();
  /** Places, kernels and skin of particles from @p first on, where they are not
      known yet; and who owns them. */
  void learn_places(const std::size_t first);
  /** Index in the cloud of particle number @p k. */
  GlobalIndex place_of(const std::size_t k) const
  {
    return body.lattices ? GlobalIndex(k) : site[k];
  }
  /** Those of all particles. */
  std::vector<GlobalIndex> places() const;
  /** Arrays for the owned particles @p fresh, by number, at rest and
      undeformed. */
  void extend(const std::vector<GlobalIndex> &fresh);
  /** What cells give to owned particle @p i, with what their images give beyond
      planes of symmetry that it lies on. */
  struct Gift
  {
    NodalMatter::Entry entry;
    std::vector<double> states; // [n_rows]
  };
  Gift gift_to(const std::size_t i, const std::size_t entry) const;
  void fill_new(const std::size_t i, const std::size_t entry);
  void merge(const std::size_t i, const std::size_t entry);
  /** The present rows, and all pairs with a particle from @p first_new on. */
  BondList::Rows rows_with(const GlobalIndex first_new) const;

  const Rooms body;
  std::vector<GlobalIndex> site; // of every particle, by number
  std::unordered_map<GlobalIndex, std::size_t> local_of_site; // owned
  ParticleSurface::Skin skin;                                 // of the cloud
  double largest_spacing = 0.; // along the skin, of all particles [m]
  unsigned int n_taken = 0;
  GlobalIndex n_measured = 0; // particles at the last has_grown_much()
  const std::vector<int> *host_owner = nullptr;
  // While matter is taken
  const NodalMatter *matter = nullptr;
  ExactSum *lost = nullptr;
};
} // namespace sabot

#endif
