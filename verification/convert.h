#ifndef verification_convert_h
#define verification_convert_h

#include "sabot/couplings/self_finding_zone.h"
#include "verification/world.h"

#include <functional>

namespace sabot
{
/** Where cells shall turn into particles at the next look. */
using Place = std::array<double, 3>;
using PlaceTest = std::function<bool(const Place &)>;

/** Turns the cells whose undeformed center a test names. */
class WhereTold : public ConversionCriterion
{
public:
  explicit WhereTold(std::shared_ptr<PlaceTest> where) : where(std::move(where))
  {
  }
  Onset onset() const override { return {}; }
  void mark(CellConditions &cells, std::vector<char> &unfit) const override
  {
    const auto centers = cells.centers();
    for (std::size_t e = 0; *where && e < centers.size(); ++e)
      unfit[e] |= (*where)(centers[e]);
  }

private:
  const std::shared_ptr<PlaceTest> where;
};

/** What a block is made of that may convert. */
struct ConvertingOptions
{
  FemOptions fem;
  SpgOptions spg;
  std::string name = "block";
  double spacing =
      0.; // of particles [m], where cells are split; 0: they are not
};

/**
 * Adds a body of cells of @p mesh and the zone of particles that it may turn
 * into, number and number + 1; joins them after all bodies are there.
 * @return the test that the zone asks in every step; empty at first.
 */
template <typename Cells = FemBody, typename Particles = SpgBody,
          typename... Arguments>
std::shared_ptr<PlaceTest> add_converting(World &world, const HexMesh &mesh,
                                          std::shared_ptr<const Material> law,
                                          ConvertingOptions options,
                                          const Arguments &...arguments)
{
  const int host = world.bodies.size();
  const auto where = std::make_shared<PlaceTest>();
  options.spg.grows = true;
  options.spg.initial_velocity = options.fem.initial_velocity;
  for (const unsigned int id : options.fem.symmetry_boundary_ids)
    options.spg.symmetry_faces |= 1u << id;
  for (const unsigned int id : options.fem.clamped_boundary_ids)
    options.spg.clamped_faces |= 1u << id;
  world.bodies.push_back(std::make_unique<Cells>(arguments..., options.name,
                                                 host, mesh, law, options.fem));
  ParticleCloud cloud = make_mesh_cloud(mesh);
  std::shared_ptr<const SplitMesh> lattices;
  if (options.spacing > 0.)
  {
    lattices = std::make_shared<const SplitMesh>(mesh, options.spacing);
    cloud.spacing.fill(options.spacing);
  }
  world.bodies.push_back(std::make_unique<Particles>(
      arguments..., options.name + " zone", host + 1, std::move(cloud), law,
      options.spg, lattices));
  world.bodies[host]->cell_source()->convert_by(
      {std::make_shared<const WhereTold>(where)});
  return where;
}

/** The couplings of all blocks that may convert; after all bodies, before
    distribute(). */
inline void join_converting(World &world)
{
  for (std::size_t b = 0; b < world.bodies.size(); ++b)
    if (world.bodies[b]->particle_sink() != nullptr)
      world.couplings.push_back(std::make_unique<SelfFindingZone>(
          world.bodies[b]->name, world.pointers(),
          SelfFindingOptions{int(b), int(b) - 1, 1, {}}, MPI_COMM_WORLD,
          nullptr));
}

/** A block of cubes with faces 0 to 5 as boxes have them. */
inline HexMesh block_mesh(const std::array<double, 3> &size,
                          const std::array<double, 3> &center,
                          const double cell_size)
{
  BoxSpecification box;
  box.size = size;
  box.center = center;
  box.cell_size = cell_size;
  return make_graded_box(box);
}
} // namespace sabot

#endif
