#ifndef sabot_bodies_spg_spg_views_h
#define sabot_bodies_spg_spg_views_h

#include "sabot/base/memory_table.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/spg/failure/known_pieces.h"
#include "sabot/bodies/spg/particle_surface.h"
#include "sabot/bodies/spg/spg_parts.h"

#include <mpi.h>

#include <vector>

namespace sabot
{
class Stabilization;

/**
 * An SPG body as couplings and reports see particles: parts of a surface and of
 * a volume without faces and cells, what has come loose, and the pieces that
 * bonds still hold together. Doc of the functions: body.h.
 *
 * Each answer is made from the body's present state; nothing is stored but the
 * pieces, which are kept until bonds change.
 * References only, so it must not outlive the body.
 */
class SpgViews : public ParticleView, public FragmentView, public MemoryView
{
public:
  /** Of a body that outlives this. */
  SpgViews(const SpgParts &body, const ParticleSurface &surface,
           const Stabilization &form, const std::vector<int> &rank_of,
           const MPI_Comm &communicator)
      : body(body), surface(surface), form(form), rank_of(rank_of),
        communicator(communicator)
  {
  }

  // Owned particles by local index, now
  /** Zero normal where it does not lie on the surface of the start. Normal
      and area follow the total F. Normal and spacing [m] follow the total F. */
  SurfacePoint surface_point(const std::size_t i) const override;
  /** The kernel's ellipsoid, carried on by F_inc since the last kernel
      update. */
  VolumePoint volume_point(const std::size_t i) const override;
  /** By the total F. */
  Vec present_area(const std::size_t i, const Vec area) const override;
  /** All that have a failed bond: they may meet others again. Bulk modulus
      [Pa] at rest and mean spacing of the start [m] for the stiffness of
      their contact. */
  Vec own_force(const std::size_t i) const override;
  DebrisView debris() const override;
  /** i local and owned, j global; a walk along the row of i. */
  bool are_bonded(const std::size_t i, const GlobalIndex j) const override;
  bool are_bonded(const std::size_t i, const GlobalIndex j,
                  const Vec place) const override;
  /** Of this rank, every bond at each owned end. */
  std::size_t n_bonds() const override;
  /** By piece_labels(); collective. */
  std::vector<Fragment> connected_pieces() const override;

  /** Label of the piece of each owned particle, see fragment_labels().
      Collective. [n_owned]; pieces by bonds that have not failed. */
  std::vector<GlobalIndex> piece_labels() const override;
  void list_memory(MemoryTable &table) const override;

private:
  const SpgParts &body;
  const ParticleSurface &surface;
  const Stabilization &form;
  const std::vector<int> &rank_of;
  const MPI_Comm &communicator;
  mutable KnownPieces known_pieces; // a copy of what the body's state says
};
} // namespace sabot

#endif
