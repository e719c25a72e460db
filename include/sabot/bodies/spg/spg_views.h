#ifndef sabot_bodies_spg_spg_views_h
#define sabot_bodies_spg_spg_views_h

#include "sabot/bodies/body.h"
#include "sabot/bodies/spg/particle_surface.h"
#include "sabot/bodies/spg/spg_parts.h"

#include <mpi.h>

#include <vector>

namespace sabot
{
/**
 * An SPG body as couplings and reports see particles: parts of a surface and of
 * a volume without faces and cells, what has come loose, and the pieces that
 * bonds still hold together. Doc of the functions: body.h.
 */
class SpgViews : public ParticleView, public FragmentView
{
public:
  /** Of a body that outlives this. */
  SpgViews(const SpgParts &body, const ParticleSurface &surface,
           const MPI_Comm &communicator)
      : body(body), surface(surface), communicator(communicator)
  {
  }

  // Owned particles by local index, now
  /** Zero normal where it does not lie on the surface of the start. */
  SurfacePoint surface_point(const std::size_t i) const override;
  VolumePoint volume_point(const std::size_t i) const override;
  /** All that have a failed bond: they may meet others again. */
  DebrisView debris() const override;
  bool are_bonded(const std::size_t i, const GlobalIndex j) const override;
  std::size_t n_bonds() const override;
  std::vector<Fragment> connected_pieces() const override;

  /** Label of the piece of each owned particle, see fragment_labels().
      Collective. */
  std::vector<GlobalIndex> labels() const;

private:
  const SpgParts &body;
  const ParticleSurface &surface;
  const MPI_Comm &communicator;
};
} // namespace sabot

#endif
