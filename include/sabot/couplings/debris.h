#ifndef sabot_couplings_debris_h
#define sabot_couplings_debris_h

#include "sabot/couplings/node_halo.h"
#include "sabot/couplings/symmetry_walls.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace sabot
{
/** A loose particle as all ranks know it. */
struct LooseParticle
{
  NodeKey key;
  std::size_t local; // on its owner
  bool is_continuous;
  Vec x;
};

/**
 * Mirror images of debris in the planes of symmetry of a scene. An image is a
 * set of planes, a bit each, in which a particle is mirrored one after the
 * other; the empty set is the particle itself. What lies on a plane is its own
 * image there.
 */
class DebrisImages
{
public:
  /** A particle or an image of it. */
  struct Item
  {
    std::size_t number; // of the particle
    std::uint64_t image;
    Vec x;
  };

  /** Before the bodies are distributed. */
  explicit DebrisImages(const std::vector<Body *> &bodies);
  bool any() const { return !walls.empty(); }
  /** @p x as mirrored in @p image. */
  Vec mirrored(const std::uint64_t image, Vec x) const;
  /** Axes along which vectors of an image are turned around, for flipped(). */
  unsigned int turned_axes(const std::uint64_t image) const;
  /** From a particle to its own @p image, of which @p offset is the size. Also
      of a particle that came beyond a plane by round-off its image is on the
      other side. */
  Vec to_own_image(const std::uint64_t image, Vec offset) const;
  /** The planes that body @p body meets closer to @p x than @p reach [m]. */
  std::uint64_t near(const int body, const Vec x, const double reach) const;
  /** Number of planes that both particles lie on. The model holds half of what
      acts between them for each. */
  int n_common_planes(const LooseParticle &a, const LooseParticle &b) const;
  /** All particles, with their images in planes closer than @p reach [m]. */
  std::vector<Item> with_images(const std::vector<LooseParticle> &particles,
                                const double reach) const;

private:
  std::vector<SymmetryWall> walls;    // of all bodies
  std::vector<std::uint64_t> of_body; // a bit for each wall
};

/** The loose particles of the bodies that take part, and who meets whom. */
struct Debris
{
  std::vector<DebrisView> views; // of bodies
  std::vector<char> meet;        // two bodies, a row each
  /** Owned here; of all ranks those near one of these, these included. */
  std::vector<LooseParticle> mine, near;
  std::int64_t n_all = 0;
  double largest_spacing = 0.; // [m]

  bool may_meet(const NodeKey &a, const NodeKey &b) const
  {
    return meet[a.body * views.size() + b.body];
  }
  /** Those of the bodies in @p body_pairs that are owned here. Local. */
  Debris(const std::vector<Body *> &bodies,
         const std::vector<std::pair<int, int>> &body_pairs);
  /** Of all ranks what is, or has an image, within @p reach [m] of mine.
      Collective. */
  void gather_near(const DebrisImages &images, const double reach,
                   MPI_Comm communicator);
};
} // namespace sabot

#endif
