#ifndef sabot_couplings_particle_search_h
#define sabot_couplings_particle_search_h

#include "sabot/couplings/node_halo.h"
#include "sabot/couplings/point_buckets.h"

#include <memory>

namespace sabot
{
/** A particle that other bodies can meet. */
struct OpenParticle
{
  NodeKey key;
  Vec x;
  double reach;          // from which nodes may touch its surface [m]
  double share;          // ContactSurface::node_share
  std::int64_t is_sound; // on the surface, all bonds whole; else loose
};

/**
 * Particles of several bodies that lie open near another body: on the surface
 * of their own, or loose. Particles inside are open only once a bond of theirs
 * failed. Cost is linear in the particles near other bodies, and a pass over
 * the positions of all. Collective.
 */
class ParticleSearch
{
public:
  /** Spacings sideways and in depth from which a surface particle counts. */
  static constexpr double reach = 1.5;

  ParticleSearch(const std::vector<Body *> &bodies,
                 const std::vector<std::pair<int, int>> &pairs,
                 const double skin, MPI_Comm communicator);

  /** Travel that bodies need to come within the skin of touching. */
  double gap() const { return smallest_gap; }
  /** Open particles owned here, by body and number. */
  const std::vector<OpenParticle> &mine() const { return my_particles; }
  /** Append the sound particles of body @p other that @p node may touch,
      ascending. */
  void near(const OpenParticle &node, const int other,
            std::vector<NodeKey> &found) const;
  const ContactSurface &surface(const int body) const { return surfaces[body]; }

private:
  std::vector<ContactSurface> surfaces;
  double smallest_gap = 0.;
  std::vector<OpenParticle> my_particles, sound;      // the latter of all ranks
  std::vector<std::unique_ptr<PointBuckets>> buckets; // per body
};
} // namespace sabot

#endif
