#ifndef sabot_couplings_particle_standing_h
#define sabot_couplings_particle_standing_h

#include "sabot/base/types.h"
#include "sabot/bodies/body.h"

namespace sabot
{
/** Where a node stands against a body of particles. */
struct Standing
{
  double gap = 1e300;   // [m]
  double fade = 0.;     // part of the force that acts; 0: it is not met here
  Vec normal = {};      // unit, outward
  bool is_deep = false; // so far inside that no side is nearer
};

/** A particle, or its image in planes of symmetry, near a node. */
struct NearParticle
{
  std::size_t slot;    // of the caller's arrays
  unsigned int turned; // axes along which the image is turned around
  Vec offset;          // from it to the node [m]
  double weight;       // part of the node's force that it takes
};

/** A node that asks for its standing. */
struct StandingNode
{
  SurfacePoint own; // without normal where it is loose
  Vec side;         // normal that it last met
  bool is_inside;   // at the last step
};

/**
 * Standing against the surface that particles span; those without normal in
 * @p points do not belong to it. With the normals n_j, the mean of both
 * sides', and weights w_j = phi(|d_t|/R)/W of the tangential distance d_t,
 * R = 1.5 spacings: gap = sum w_j d . n_j, exact for planes wherever the node
 * stands, so that a lattice that slides on another feels no bumps. It fades
 * where the surface ends: W = sum phi falls to half of its mean over a plane
 * half a spacing beyond the rim. Sets the weights of @p near, which has the
 * images in planes of symmetry too, each particle on a plane once.
 */
Standing stand_on_surface(const StandingNode &node,
                          std::vector<NearParticle> &near,
                          const AlignedVector<SurfacePoint> &points);

/**
 * Standing against the volume that particles fill, whatever became of their
 * order: the filled part f = sum content phi(|to_unit d|) of the space at the
 * node is 1/2 on the surface of a lattice, gap = (1/2 - f)/|grad f|, normal
 * -grad f/|grad f|. Deep inside, where f is 1, no side is nearer and nothing
 * acts. Sets the weights of @p near, images as above.
 */
Standing stand_in_volume(std::vector<NearParticle> &near,
                         const AlignedVector<VolumePoint> &points);
} // namespace sabot

#endif
