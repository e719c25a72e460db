#ifndef sabot_couplings_particle_search_h
#define sabot_couplings_particle_search_h

#include "sabot/couplings/box_buckets.h"
#include "sabot/couplings/node_halo.h"

#include <memory>

namespace sabot
{
/** A particle near other bodies, as ranks send it to each other. Reaches hold
    until the bodies have moved by the skin. */
struct SearchedParticle
{
  NodeKey key;
  Vec x;
  double reach;               // from which its surface may be met [m]
  Mat to_unit;                // of its ellipsoid, VolumePoint
  double unit_reach;          // from which that may be met [1]; 0: never
  double share;               // ContactSurface::node_share
  std::int32_t is_on_surface; // all bonds whole
  std::int32_t is_open;       // on the surface, or loose
};

/** A particle that a node may touch; goes into checkpoints. */
struct Member
{
  NodeKey key;
  std::int64_t is_on_surface;
};

/**
 * Particles of several bodies near another body. Those on the surface of their
 * own, and loose ones, lie open; particles inside do only once a bond of theirs
 * failed. Cost is linear in the particles near other bodies, and a pass over
 * the positions of all. Collective.
 */
class ParticleSearch
{
public:
  /** Spacings sideways and in depth from which a surface particle counts. */
  static constexpr double reach = 1.5;

  /** @p bodies: all of the scene, by number, those in @p pairs of particles;
      @p skin: that bodies may move against each other until the next search
      [m]. Collective. */
  ParticleSearch(const std::vector<Body *> &bodies,
                 const std::vector<std::pair<int, int>> &pairs,
                 const double skin, MPI_Comm communicator);

  /** Travel that bodies need to come within the skin of touching [m], by their
      boxes; above 0 nothing else was looked for. */
  double gap() const { return smallest_gap; }
  /** Particles owned here, by body and number. */
  const std::vector<SearchedParticle> &mine() const { return my_particles; }
  /** Append the particles of body @p other that @p node may touch, ascending.
   */
  void near(const SearchedParticle &node, const int other,
            std::vector<Member> &found) const;
  /** Body::contact_surface() of a body in a pair. */
  const ContactSurface &surface(const int body) const { return surfaces[body]; }

private:
  /** The particles of a body that are owned here and lie within the extents of
      the others. */
  void find_mine(const Body &body, const std::int32_t number,
                 const std::vector<int> &others, const std::vector<Box> &extent,
                 const double skin);
  /** What particles owned here may touch, in buckets. Collective. */
  void gather_touchable(MPI_Comm communicator);

  std::vector<ContactSurface> surfaces;
  double smallest_gap = 0.;
  std::vector<SearchedParticle> my_particles;
  std::vector<SearchedParticle> touchable;          // of all ranks, near mine
  std::vector<std::unique_ptr<BoxBuckets>> buckets; // per body
  std::vector<std::size_t> first; // of each body's particles in touchable
};
} // namespace sabot

#endif
