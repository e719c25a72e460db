// Blocks that slide on flat walls without friction: nothing acts along them.
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/contact.h"
#include "verification/heavy.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
enum class Kind
{
  cells,
  b_bar,
  rigid,
  particles
};

std::string name_of(const Kind kind)
{
  return kind == Kind::cells   ? "cells"
         : kind == Kind::b_bar ? "B-bar"
         : kind == Kind::rigid ? "rigid"
                               : "particles";
}

HexMesh brick(const std::array<double, 3> &size,
              const std::array<double, 3> &center, const double h)
{
  BoxSpecification b;
  b.size = size;
  b.center = center;
  b.cell_size = h;
  return make_graded_box(b);
}

/** A block above a wall whose upper face is z = 0, held at its lower face. */
struct Slide
{
  Kind block = Kind::cells, wall = Kind::rigid;
  double ratio = 1.;  // of the wall's cells to the block's, 1 mm
  double gap = 0.;    // [m]
  double offset = 0.; // of the two meshes, in cells of the block
  double factor = 0.9;
  Vec velocity = vec(100., 0., -20.);
  bool is_symmetric = false; // about y = 0
  bool is_cut = false;       // there
};

void add_block(World &world, const Slide &s)
{
  const std::array<double, 3> size{{4e-3, s.is_cut ? 2e-3 : 4e-3, 3e-3}},
      center{{s.offset * 1e-3 - 1e-3,
              s.is_cut         ? 1e-3
              : s.is_symmetric ? 0.
                               : 0.7e-3 * s.offset,
              1.5e-3 + s.gap}},
      velocity{{s.velocity[0], s.velocity[1], s.velocity[2]}};
  if (s.block == Kind::particles)
  {
    SpgOptions options;
    options.initial_velocity = velocity;
    world.bodies.push_back(std::make_unique<SpgBody>(
        "block", 0, make_box_cloud(center, size, 1e-3), elastic(), options));
    return;
  }
  FemOptions options;
  options.initial_velocity = velocity;
  if (s.block == Kind::b_bar)
    options.integration = "B-bar";
  if (s.is_cut)
    options.symmetry_boundary_ids = {2};
  world.bodies.push_back(std::make_unique<FemBody>(
      "block", 0, brick(size, center, 1e-3), elastic(), options));
}

void add_wall(World &world, const Slide &s)
{
  // A rigid wall is not cut: it reaches beyond the plane.
  const bool is_cut = s.is_cut && s.wall != Kind::rigid;
  const std::array<double, 3> size{{12e-3, is_cut ? 5e-3 : 10e-3, 2e-3}},
      center{{1e-3, is_cut ? 2.5e-3 : 0., -1e-3}};
  const double h = s.ratio * 1e-3;
  if (s.wall == Kind::rigid)
  {
    RigidOptions options;
    options.is_prescribed = true;
    world.bodies.push_back(std::make_unique<RigidBody>(
        "wall", 1, brick(size, center, h), elastic(), options));
  }
  else if (s.wall == Kind::particles)
  {
    SpgOptions options;
    options.symmetry_faces = 0b011111; // but for +z
    world.bodies.push_back(std::make_unique<SpgBody>(
        "wall", 1, make_box_cloud(center, size, h), elastic(), options));
  }
  else
  {
    FemOptions options;
    options.clamped_boundary_ids = {4};
    if (is_cut)
      options.symmetry_boundary_ids = {2};
    if (s.wall == Kind::b_bar)
      options.integration = "B-bar";
    world.bodies.push_back(std::make_unique<FemBody>(
        "wall", 1, brick(size, center, h), elastic(), options));
  }
}

void add_contact(World &world, const Kind first, const Kind second)
{
  std::vector<ContactPair> pairs;
  if (first != Kind::particles)
    pairs.push_back({0, 1, false});
  if (second != Kind::particles)
    pairs.push_back({1, 0, false});
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(), pairs, ContactOptions(), MPI_COMM_WORLD));
  world.distribute();
  world.stepper.initialize();
}

std::array<double, 3> velocity_of(const World &world)
{
  return world.bodies[0]->measure().velocity;
}

struct Outcome
{
  double along = 0., sideways = 0., across = 0.; // change of velocity [m/s]
  double highest = 0.;                           // energy gained over the first
};

Outcome slide(const Slide &s, const double end)
{
  World world;
  add_block(world, s);
  add_wall(world, s);
  add_contact(world, s.block, s.wall);
  const double energy = world.total_energy();
  Outcome outcome;
  while (world.stepper.time() < end)
  {
    world.advance(s.factor);
    outcome.highest =
        std::max(outcome.highest, world.total_energy() / energy - 1.);
  }
  const auto v = velocity_of(world);
  outcome.along = v[0] - s.velocity[0];
  outcome.sideways = v[1];
  outcome.across = v[2] - s.velocity[2];
  return outcome;
}

/** Largest forces along a wall of several scenes, over those across. */
struct Worst
{
  double along = 0., sideways = 0., lift = 0.;

  void add(const Slide &s)
  {
    const Outcome o = slide(s, 8e-6);
    if (s.velocity[2] == 0.)
    {
      const double speed = norm(s.velocity);
      lift = std::max(lift, std::abs(o.across) / speed);
      along = std::max(along, std::abs(o.along) / speed);
      return;
    }
    along = std::max(along, std::abs(o.along / o.across));
    sideways = std::max(sideways, std::abs(o.sideways / o.across));
  }
};

std::vector<Check> frictionless(const std::vector<double> &ratios,
                                const std::vector<double> &offsets)
{
  std::vector<Check> checks;
  for (const Kind wall :
       {Kind::rigid, Kind::cells, Kind::b_bar, Kind::particles})
    for (const Kind block : {Kind::cells, Kind::b_bar, Kind::particles})
    {
      if (wall == Kind::particles && block == Kind::particles)
        continue; // contact-particle-smooth
      Worst worst;
      for (const double ratio : ratios)
        for (const double offset : offsets)
        {
          Slide s;
          s.block = block;
          s.wall = wall;
          s.ratio = ratio;
          s.offset = offset;
          s.gap = 0.05e-3;
          worst.add(s);
          for (const double gap : {0., 1e-9})
          {
            s.gap = gap;
            s.velocity = vec(100., 0., -20.);
            worst.add(s);
            s.velocity = vec(100., 0., 0.);
            worst.add(s);
          }
        }
      const std::string where = name_of(block) + " on " + name_of(wall) + ": ";
      // Walls that give way have a dent, and waves that come back from their
      // sides.
      const double allowed = wall == Kind::rigid       ? 1e-8
                             : wall == Kind::particles ? 2e-3
                                                       : 1e-3;
      checks.push_back({where + "force along the motion over that across", 0.,
                        worst.along, allowed, "1", "planes are smooth"});
      checks.push_back({where + "sideways over that across", 0., worst.sideways,
                        allowed, "1", "planes are smooth"});
      checks.push_back({where + "lift-off over the speed of sliding", 0.,
                        worst.lift, 1e-9, "1", "nothing presses"});
    }
  return checks;
}

/** Half a block, cut along its way, slides as the whole does. */
void add_halves(std::vector<Check> &checks)
{
  for (const Kind wall : {Kind::rigid, Kind::cells})
    for (const Kind block : {Kind::cells, Kind::b_bar})
    {
      double along = 0., difference = 0.;
      // Where a node of the wall stands on the cut and where none does.
      for (const double ratio : {0.5, 1., 10. / 7.})
      {
        Slide s;
        s.block = block;
        s.wall = wall;
        if (wall != Kind::rigid && ratio > 1.)
          continue; // no such mesh of half a wall
        s.ratio = ratio;
        s.offset = 0.3;
        s.gap = 0.05e-3;
        s.is_symmetric = true;
        const Outcome whole = slide(s, 8e-6);
        s.is_cut = true;
        const Outcome half = slide(s, 8e-6);
        along = std::max(along, std::abs(half.along / half.across));
        difference =
            std::max(difference, std::abs(half.across / whole.across - 1.));
      }
      const std::string where =
          "half of " + name_of(block) + " on " + name_of(wall) + ": ";
      checks.push_back({where + "force along the motion over that across", 0.,
                        along, wall == Kind::rigid ? 1e-8 : 1e-3, "1",
                        "planes are smooth"});
      checks.push_back({where + "change of speed across, against the whole", 0.,
                        difference, 1e-9, "1", "symmetry"});
    }
}

std::vector<Check> slide_quick()
{
  std::vector<Check> checks = frictionless({0.7, 1., 1.5}, {0.3});
  add_halves(checks);
  return checks;
}

std::vector<Check> slide_long()
{
  return frictionless({0.4, 0.5, 0.7, 0.9, 1., 1.1, 1.5, 2., 5.},
                      {0., 0.3, 0.5});
}

const RegisterProblem a({"contact-slide",
                         "a block slides on a smooth wall of other cells",
                         "quick", slide_quick}),
    b({"contact-slide-long",
       "a block slides on a smooth wall: ratios, offsets, gaps", "long",
       slide_long});
} // namespace
} // namespace sabot
