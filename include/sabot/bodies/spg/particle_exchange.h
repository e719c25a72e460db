#ifndef sabot_bodies_spg_particle_exchange_h
#define sabot_bodies_spg_particle_exchange_h

#include "sabot/base/ghost_exchange.h"
#include "sabot/kernels/mirrored.h"
#include "sabot/kernels/vec.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace sabot
{
class MirrorPlanes;
struct NodalState;

/** Copies of items (particles, bonds) as GhostExchange has them, of which some
    are mirror images: what has a direction is turned (mirror()). */
class MirroredExchange
{
public:
  /** Ghost number, counted from the first one, and its turned axes. */
  using Turned = std::pair<std::uint32_t, std::uint32_t>;

  MirroredExchange() = default;
  MirroredExchange(GhostExchange exchange, const std::size_t n_owned,
                   std::vector<Turned> turned)
      : exchange(std::move(exchange)), n_owned(n_owned),
        turned(std::move(turned))
  {
  }

  /** GhostExchange::update(), with images turned. Collective. */
  template <typename T>
  void update(T *data) const
  {
    exchange.update(data);
    for (const auto &[ghost, axes] : turned)
      mirror(data[n_owned + ghost], axes);
  }
  std::size_t n_ghosts() const { return exchange.n_ghosts(); }
  bool is_trivial() const { return exchange.is_trivial(); }

protected:
  GhostExchange exchange;
  std::size_t n_owned = 0;
  std::vector<Turned> turned; // images only
};

/** That of the particles of a body: ghosts of other ranks, and images beyond
    planes of symmetry; and which owned particles lie on such planes, of which
    the model has a share only. */
class ParticleExchange : public MirroredExchange
{
public:
  /** An owned particle on planes of symmetry. */
  struct OnPlane
  {
    std::uint32_t particle;
    std::uint32_t held_axes; // a bit for each across which it lies on one
    double copies;           // of the share, that make the whole
  };

  ParticleExchange() = default;
  /** @p nodes: owned ones with their numbers and places of the start; @p
      ghosts: numbers of ghosts and images, ascending, with the ranks that own
      the particles. Collective. */
  ParticleExchange(const MirrorPlanes &mirror, const NodalState &nodes,
                   const std::vector<GlobalIndex> &ghosts,
                   const std::vector<int> &ghost_owner, MPI_Comm communicator);

  /** Of positions, which images have turned and shifted. Collective. */
  void update_positions(Vec *data) const
  {
    update(data);
    for (const auto &[ghost, shift] : offset)
      data[n_owned + ghost] += shift;
  }

  // What the model has of a particle on planes of symmetry is a share of the
  // whole particle that its neighbors see; all of a whole that acts on it acts
  // on the share in proportion.
  /** Owned entries of @p data that count the share to those of the whole; of
      particles that @p wanted says. */
  template <typename T, typename Wanted>
  void make_whole(T *data, const Wanted &wanted) const
  {
    for (const OnPlane &p : on_plane)
      if (wanted(p.particle))
        data[p.particle] = p.copies * data[p.particle];
  }
  template <typename T>
  void make_whole(T *data) const
  {
    make_whole(data, [](std::size_t) { return true; });
  }
  /** Back. */
  template <typename T, typename Wanted>
  void take_shares(T *data, const Wanted &wanted) const
  {
    for (const OnPlane &p : on_plane)
      if (wanted(p.particle))
        data[p.particle] = 1. / p.copies * data[p.particle];
  }
  template <typename T>
  void take_shares(T *data) const
  {
    take_shares(data, [](std::size_t) { return true; });
  }
  /** Take away what planes hold of a motion of owned particles. */
  void hold(Vec *motion) const
  {
    for (const OnPlane &p : on_plane)
      for (int d = 0; d < 3; ++d)
        if (p.held_axes >> d & 1)
          motion[p.particle][d] = 0.;
  }
  std::size_t n_images() const { return offset.size(); }

private:
  std::vector<std::pair<std::uint32_t, Vec>> offset; // ghost, [m]
  std::vector<OnPlane> on_plane;
};
} // namespace sabot

#endif
