// Contact where no node meets a face: crossed edges, thin plates, oblique shots
#include "sabot/couplings/contact.h"
#include "sabot/couplings/friction/coulomb.h"
#include "verification/meshes.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
HexMesh brick(const std::array<double, 3> &size,
              const std::array<double, 3> &center, const double h)
{
  BoxSpecification b;
  b.size = size;
  b.center = center;
  b.cell_size = h;
  return make_graded_box(b);
}

void add_fem(World &world, const HexMesh &mesh,
             const std::array<double, 3> &velocity, const double nu = 0.33)
{
  FemOptions options;
  options.initial_velocity = velocity;
  world.bodies.push_back(std::make_unique<FemBody>(
      "fem" + std::to_string(world.bodies.size()), world.bodies.size(), mesh,
      elastic(nu), options));
}

void add_spg(World &world, const std::array<double, 3> &size,
             const std::array<double, 3> &center, const double h,
             const std::array<double, 3> &velocity, const double nu = 0.33)
{
  SpgOptions options;
  options.initial_velocity = velocity;
  world.bodies.push_back(std::make_unique<SpgBody>(
      "spg" + std::to_string(world.bodies.size()), world.bodies.size(),
      make_box_cloud(center, size, h), elastic(nu), options));
}

/** Bodies 0 and 1 touch; only hexahedra have faces. */
void add_contact(World &world, const bool particles,
                 const ContactOptions &options = ContactOptions())
{
  std::vector<ContactPair> pairs = {{0, 1, false}};
  if (!particles)
    pairs.push_back({1, 0, false});
  world.couplings.push_back(std::make_unique<Contact>(
      "contact", world.pointers(), pairs, options, MPI_COMM_WORLD));
}

/** Lowest node of body 0 below the highest of 1 along x, in spacings of 1 mm.
 */
double overlap(const World &world)
{
  double low = 1e300, high = -1e300;
  const NodalState &a = world.bodies[0]->nodes(), &b = world.bodies[1]->nodes();
  for (std::size_t i = 0; i < a.n_owned; ++i)
    low = std::min(low, a.position[i][0]);
  for (std::size_t i = 0; i < b.n_owned; ++i)
    high = std::max(high, b.position[i][0]);
  return (high - low) / 1e-3;
}

/** Equal cross-sections with their edges aligned meet, nodes on nodes. */
std::vector<Check> aligned()
{
  std::vector<Check> checks;
  for (const bool particles : {false, true})
    for (const int width : {1, 2, 4})
    {
      World world;
      const double w = width * 1e-3, v = 100.;
      add_fem(world, brick({{10e-3, w, w}}, {{5.02e-3, 0, 0}}, 1e-3),
              {{-v, 0, 0}});
      if (particles)
        add_spg(world, {{10e-3, w, w}}, {{-5.02e-3, 0, 0}}, 1e-3, {{v, 0, 0}});
      else
        add_fem(world, brick({{10e-3, w, w}}, {{-5.02e-3, 0, 0}}, 1e-3),
                {{v, 0, 0}});
      add_contact(world, particles);
      world.distribute();
      world.stepper.initialize();
      const double energy = world.total_energy();
      double deepest = 0.;
      while (world.stepper.time() < 12e-6)
      {
        world.advance(0.5);
        deepest = std::max(deepest, overlap(world));
      }
      const std::string where =
          std::string(particles ? "particles, " : "cells, ") +
          std::to_string(width) + " wide: ";
      checks.push_back({where + "deepest overlap over the spacing", 0.25,
                        deepest, 0., "1", "they do not pass",
                        Check::Kind::at_most});
      checks.push_back(
          {where + "momentum over one bar's", 0.,
           world.momenta()[0] / (world.bodies[0]->measure().mass * v), 1e-11,
           "1", "conservation"});
      checks.push_back({where + "gain of energy after parting", 0.,
                        world.total_energy() / energy - 1., 1e-3, "1",
                        "energy balance", Check::Kind::at_most});
      checks.push_back({where + "velocity of rebound over the first", 0.9,
                        world.bodies[0]->measure().velocity[0] / v, 0., "1",
                        "equal bars exchange velocities",
                        Check::Kind::at_least});
    }
  return checks;
}

/** A stiff thin plate: a node that passes its middle in one step is still
    driven back through the side it came by. */
std::vector<Check> deep()
{
  World world;
  // Thin cells make small steps; a soft penalty makes the depth.
  ContactOptions options;
  options.stiffness_scale = 0.02;
  add_fem(world, brick({{0.6e-3, 8e-3, 8e-3}}, {{-0.3e-3, 0, 0}}, 1e-3),
          {{0, 0, 0}});
  add_fem(world, brick({{4e-3, 4e-3, 4e-3}}, {{2.02e-3, 0.3e-3, 0.2e-3}}, 1e-3),
          {{-100., 0, 0}});
  add_contact(world, false, options);
  world.distribute();
  world.stepper.initialize();
  const double energy = world.total_energy();
  const NodalState &plate = world.bodies[0]->nodes(),
                   &block = world.bodies[1]->nodes();
  double deepest = 0., highest = 0.;
  const auto gap = [&]
  {
    double front = -1e300, low = 1e300;
    for (std::size_t i = 0; i < plate.n_owned; ++i)
      if (std::abs(plate.reference_position[i][0]) < 1e-9 &&
          std::abs(plate.reference_position[i][1]) < 3.5e-3 &&
          std::abs(plate.reference_position[i][2]) < 3.5e-3)
        front = std::max(front, plate.position[i][0]);
    for (std::size_t i = 0; i < block.n_owned; ++i)
      low = std::min(low, block.position[i][0]);
    return low - front;
  };
  while (world.stepper.time() < 60e-6)
  {
    world.advance(0.9);
    deepest = std::max(deepest, -gap());
    highest = std::max(highest, world.total_energy() / energy - 1.);
  }
  return {{"deepest penetration over the plate's thickness", 0.5,
           deepest / 0.6e-3, 0., "1", "past the middle", Check::Kind::at_least},
          {"gap after", 0., gap(), 0., "m", "recovered", Check::Kind::at_least},
          {"momentum, change over the first", 0.,
           world.momenta()[0] / (-100. * world.bodies[1]->measure().mass) - 1.,
           1e-11, "1", "conservation"},
          {"largest gain of energy", 0., highest, 1e-3, "1", "energy balance",
           Check::Kind::at_most}};
}

/** A beam with square cross-section of 2 mm, on one of its edges; its cells of
    1 mm are turned by 45 degrees about the axis y or z. */
HexMesh beam_on_edge(const unsigned int axis, const double x)
{
  const double half = 1e-3;
  return mapped_block(
      {{{2, 2, 8}}, {{-half, -half, -4e-3}}, {{half, half, 4e-3}}},
      [&](const MeshPoint &p)
      {
        const double s = std::sqrt(0.5), a = s * (p[0] - p[1]),
                     b = s * (p[0] + p[1]);
        return axis == 2 ? MeshPoint{{x + a, b, p[2]}}
                         : MeshPoint{{x - a, p[2], b}};
      });
}

/** Two beams cross, edge on edge, between their nodes: only nodes are held,
    so the edges go in until nodes meet faces. A limit, measured. */
std::vector<Check> crossed()
{
  World world;
  const double r = std::sqrt(2.) * 1e-3, v = 20.;
  HexMesh first = beam_on_edge(2, r + 0.01e-3), second = beam_on_edge(1, -r);
  for (auto &p : first.nodes)
  {
    p[1] += 0.5e-3;
    p[2] += 0.5e-3;
  }
  add_fem(world, first, {{-v, 0, 0}});
  add_fem(world, second, {{v, 0, 0}});
  add_contact(world, false);
  world.distribute();
  world.stepper.initialize();
  const double energy = world.total_energy();
  double deepest = 0., highest = 0.;
  while (world.stepper.time() < 150e-6)
  {
    world.advance(0.9);
    deepest = std::max(deepest, overlap(world));
    highest = std::max(highest, world.total_energy() / energy - 1.);
  }
  return {{"deepest overlap of the edges over the spacing", 0., deepest, 0.,
           "1", "limit: edges meet through nodes", Check::Kind::reported},
          {"velocity after over the first", 0.,
           world.bodies[0]->measure().velocity[0] / v, 0., "1", "they part",
           Check::Kind::at_least},
          {"largest gain of energy", 0., highest, 1e-3, "1", "energy balance",
           Check::Kind::at_most}};
}

/** @p n small cubes (one cell, turned at random) or single particles hit a
    plate at random places and angles. */
struct Shots
{
  int n = 0, n_through = 0;
  double momentum = 0., energy = 0.; // largest change, largest gain
  double given = 0.;                 // by the contact, largest
};

constexpr double shot_edge = 1e-3, half_plate = 20e-3; // [m]

/** What is shot at the plate: where its points start, one shot after the
    other, and the velocity of each shot. */
struct Volley
{
  std::vector<MeshPoint> points;
  std::vector<Vec> velocity;
};

/** The corners of a cube turned at random, in lexicographic order. */
template <typename Random>
std::array<MeshPoint, 8> turned_cube(const Vec middle, Random &&random)
{
  Vec a = random(), b = random();
  a *= 1. / norm(a);
  b -= dot(a, b) * a;
  b *= 1. / norm(b);
  const Vec c = cross(a, b);
  std::array<MeshPoint, 8> cell;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Vec x = middle + 0.5 * shot_edge *
                               ((corner & 1 ? 1. : -1.) * a +
                                (corner & 2 ? 1. : -1.) * b +
                                (corner & 4 ? 1. : -1.) * c);
    cell[corner] = {{x[0], x[1], x[2]}};
  }
  return cell;
}

/** Adds @p n cubes or particles as the second body of @p world. */
Volley add_shots(World &world, const bool cubes, const int n, const int seed,
                 const double speed)
{
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1., 1.);
  Volley volley;
  std::vector<std::array<MeshPoint, 8>> cells;
  ParticleCloud cloud;
  cloud.spacing.fill(0.1 * shot_edge); // no bonds
  for (int i = 0; i < n; ++i)
  {
    // Up to 80 degrees from the normal.
    const double cosine = 0.5 * (1.17 + 0.82 * uniform(generator)),
                 sine = std::sqrt(1. - cosine * cosine),
                 turn = M_PI * uniform(generator);
    const Vec direction =
        vec(sine * std::cos(turn), sine * std::sin(turn), -cosine);
    volley.velocity.push_back(speed * direction);
    const Vec aim =
        vec(12e-3 * uniform(generator), 12e-3 * uniform(generator), 0.);
    const Vec start = aim - (1e-3 / cosine) * direction;
    if (cubes)
    {
      cells.push_back(turned_cube(
          start + vec(0., 0., 0.5 * shot_edge),
          [&] {
            return vec(normal(generator), normal(generator), normal(generator));
          }));
      volley.points.insert(volley.points.end(), cells.back().begin(),
                           cells.back().end());
      continue;
    }
    cloud.position.push_back({{start[0], start[1], start[2]}});
    cloud.volume.push_back(shot_edge * shot_edge * shot_edge);
    cloud.on_face.push_back(0);
    volley.points.push_back(cloud.position.back());
  }
  if (cubes)
    add_fem(world, loose_cells(cells), {{0, 0, 0}});
  else
    world.bodies.push_back(
        std::make_unique<SpgBody>("shots", 1, cloud, elastic(), SpgOptions()));
  return volley;
}

/** Which shot each node of the second body belongs to: nodes of a body are
    reordered, so the nearest start tells. */
std::vector<int> shots_of_nodes(const World &world, const Volley &volley)
{
  const NodalState &s = world.bodies[1]->nodes();
  const std::size_t per_shot = volley.points.size() / volley.velocity.size();
  std::vector<int> shot_of(s.n_owned, -1);
  for (std::size_t i = 0; i < s.n_owned; ++i)
  {
    double best = 1e300;
    for (std::size_t k = 0; k < volley.points.size(); ++k)
    {
      const MeshPoint &p = volley.points[k];
      const double d = norm_square(vec(p[0], p[1], p[2]) - s.position[i]);
      if (d < best)
      {
        best = d;
        shot_of[i] = k / per_shot;
      }
    }
  }
  return shot_of;
}

/** Marks the shots whose center is below the middle of the plate. */
void mark_passed(const World &world, const std::vector<int> &shot_of,
                 std::vector<char> &through)
{
  const NodalState &plate = world.bodies[0]->nodes(),
                   &s = world.bodies[1]->nodes();
  double middle = 0.;
  for (std::size_t i = 0; i < plate.n_owned; ++i)
    middle += plate.position[i][2] / plate.n_owned;
  const std::size_t n = through.size(), per_shot = s.n_owned / n;
  std::vector<Vec> center(n, Vec{});
  for (std::size_t i = 0; i < s.n_owned; ++i)
    center[shot_of[i]] += (1. / per_shot) * s.position[i];
  for (std::size_t k = 0; k < n; ++k)
    if (std::abs(center[k][0]) < half_plate &&
        std::abs(center[k][1]) < half_plate && center[k][2] < middle)
      through[k] = 1;
}

void shoot(Shots &shots, const bool cubes, const int n, const int seed)
{
  // Cells that tumble faster gain energy by themselves at this step.
  const double speed = cubes ? 100. : 300.;
  World world;
  add_fem(
      world,
      brick({{2. * half_plate, 2. * half_plate, 2e-3}}, {{0, 0, -1e-3}}, 2e-3),
      {{0, 0, 0}});
  const Volley volley = add_shots(world, cubes, n, seed, speed);
  ContactOptions options;
  options.friction = coulomb(0.2);
  add_contact(world, !cubes, options);
  world.distribute();
  const std::vector<int> shot_of = shots_of_nodes(world, volley);
  NodalState &s = world.bodies[1]->nodes();
  for (std::size_t i = 0; i < s.n_owned; ++i)
    s.velocity[i] = volley.velocity[shot_of[i]];
  world.stepper.initialize();
  const double energy = world.total_energy();
  const auto before = world.momenta();
  std::vector<char> through(n, 0);
  while (world.stepper.time() < 15e-3 / speed)
  {
    for (int k = 0; k < 10; ++k)
      world.advance(cubes ? 0.4 : 0.9);
    shots.given = std::max(shots.given, -world.contact_energy() / energy);
    shots.energy = std::max(shots.energy, world.total_energy() / energy - 1.);
    mark_passed(world, shot_of, through);
  }
  const auto after = world.momenta();
  for (int d = 0; d < 3; ++d)
    shots.momentum =
        std::max(shots.momentum, std::abs((after[d] - before[d]) / before[2]));
  shots.n += n;
  for (const char t : through)
    shots.n_through += t;
}

std::vector<Check> leak(const int n_batches)
{
  std::vector<Check> checks;
  for (const bool cubes : {false, true})
  {
    Shots shots;
    for (int batch = 0; batch < n_batches; ++batch)
      shoot(shots, cubes, 100, 17 + batch);
    const std::string what = cubes ? "cubes: " : "particles: ";
    checks.push_back({what + "impacts", 100. * n_batches, double(shots.n), 0.,
                      "1", "count"});
    checks.push_back({what + "passed through", 0., double(shots.n_through), 0.,
                      "1", "none may"});
    checks.push_back({what + "momentum, change over the first", 0.,
                      shots.momentum, 1e-11, "1", "conservation"});
    checks.push_back({what + "energy given by the contact over the first", 0.,
                      shots.given, 1e-3, "1", "it only takes",
                      Check::Kind::at_most});
    // Single cells that tumble gain some by themselves.
    checks.push_back({what + "largest gain of energy", 0., shots.energy, 1e-3,
                      "1", "energy balance",
                      cubes ? Check::Kind::reported : Check::Kind::at_most});
  }
  return checks;
}

std::vector<Check> leak_quick()
{
  return leak(1);
}

std::vector<Check> leak_long()
{
  return leak(50);
}

const RegisterProblem
    a({"contact-aligned",
       "equal cross-sections with aligned edges do not slip through", "quick",
       aligned}),
    b({"contact-deep", "a node past the middle of a plate comes back", "quick",
       deep}),
    c({"contact-crossed-edges", "edge on edge: how far they overlap", "quick",
       crossed}),
    d({"contact-leak", "200 random oblique impacts", "quick", leak_quick}),
    e({"contact-leak-long", "10000 random oblique impacts", "long", leak_long});
} // namespace
} // namespace sabot
