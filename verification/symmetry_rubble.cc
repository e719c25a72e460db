// A punch drives into a column of metal that crumbles: a quarter and a half of
// it against the whole.
#include "sabot/base/choice.h"
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/couplings/symmetry_walls.h"
#include "verification/problem.h"
#include "verification/rubble.h"

namespace sabot
{
namespace
{
constexpr double spacing = 1e-3, half_width = 4e-3, height = 24e-3,
                 half_punch = 1e-3, speed = 600., way = 10e-3;

/** What a punch meets on its way, of the whole. */
struct Pressed
{
  double impulse; // along its way [N s]
  double ahead;   // of the punch, of the farthest piece half as fast [m]
  double spread;  // to the sides, root of the mean square [m]
};

/** The column lies at x, y >= 0 where cut by planes across these axes (bits),
    its sides and its lower end are held, the punch is a square of its own
    particles on its upper end. */
class PunchedColumn
{
public:
  /** @p shaken: start with random velocities of this size [m/s], so that a
      whole need not stay as symmetric as it is. */
  PunchedColumn(const unsigned int planes, const double shaken);
  Pressed run();

private:
  bool is_punch(const Vec X) const
  {
    constexpr double edge = half_punch + 0.1 * spacing;
    return std::abs(X[0]) < edge && std::abs(X[1]) < edge &&
           X[2] > -1.1 * spacing;
  }
  const double images;
  World world;
  DrivenSpgBody *body = nullptr;
};

PunchedColumn::PunchedColumn(const unsigned int planes, const double shaken)
    : images(1 << __builtin_popcount(planes))
{
  SpgOptions options;
  options.set_critical_plastic_strain(0.3);
  options.residual_strength = choose<ResidualStrength>("friction");
  std::array<double, 3> size = {{2. * half_width, 2. * half_width, height}},
                        center = {{0., 0., -0.5 * height}};
  options.clamped_faces = 1 | 2 | 4 | 8 | 16;
  for (int d = 0; d < 2; ++d)
    if (planes >> d & 1)
    {
      size[d] = half_width;
      center[d] = 0.5 * half_width;
      options.symmetry_faces |= 1u << 2 * d;
    }
  options.clamped_faces &= ~options.symmetry_faces;
  auto made = std::make_unique<DrivenSpgBody>(
      "column", make_box_cloud(center, size, spacing), hardening_aluminum(),
      options);
  body = made.get();
  world.bodies.push_back(std::move(made));
  body->set_internal_friction(0.3);
  SelfContactOptions contact;
  contact.friction = coulomb(0.3);
  world.couplings.push_back(std::make_unique<SelfContact>(
      "debris", world.pointers(), std::vector<std::pair<int, int>>{{0, 0}},
      contact, MPI_COMM_WORLD));
  world.couplings.push_back(
      std::make_unique<SymmetryWalls>(world.pointers(), MPI_COMM_WORLD));
  world.distribute();
  shake(*body, shaken);
  body->drive = [this](NodalState &nodes, const double)
  {
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
      if (is_punch(nodes.reference_position[i]))
        nodes.velocity[i] = vec(0., 0., -speed);
  };
  world.stepper.initialize();
}

Pressed PunchedColumn::run()
{
  Pressed pressed{};
  const NodalState &n = body->nodes();
  while (world.stepper.time() < way / speed)
  {
    const double dt = world.advance(0.8);
    for (std::size_t i = 0; i < n.n_owned; ++i)
      if (is_punch(n.reference_position[i]))
        pressed.impulse += dt * images * n.force[i][2];
  }
  double mass = 0.;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Vec X = n.reference_position[i], u = n.position[i] - X;
    if (is_punch(X))
      continue;
    if (n.velocity[i][2] < -0.5 * speed)
      pressed.ahead =
          std::max(pressed.ahead, -spacing - way - n.position[i][2]);
    pressed.spread += n.lumped_mass[i] * (u[0] * u[0] + u[1] * u[1]);
    mass += n.lumped_mass[i];
  }
  pressed.spread = std::sqrt(pressed.spread / mass);
  return pressed;
}

/** Mean of four starts: what debris does is chance, by 5 % of the impulse and 2
    spacings ahead. */
Pressed mean_of_starts(const unsigned int planes)
{
  Pressed mean{};
  for (const double shaken : {0.1, 0.2, 0.3, 0.4})
  {
    const Pressed one = PunchedColumn(planes, shaken).run();
    mean.impulse += one.impulse / 4.;
    mean.ahead += one.ahead / 4.;
    mean.spread += one.spread / 4.;
  }
  return mean;
}

std::vector<Check> punched_column()
{
  const Pressed whole = mean_of_starts(0), half = mean_of_starts(1),
                quarter = mean_of_starts(3);
  std::vector<Check> checks;
  const std::pair<std::string, Pressed> parts[] = {{"half", half},
                                                   {"quarter", quarter}};
  for (const auto &[who, part] : parts)
  {
    checks.push_back({who + ": impulse of the punch over that of the whole", 1.,
                      part.impulse / whole.impulse, 0.1, "1",
                      "symmetry of the problem"});
    checks.push_back({who + ": pieces ahead of the punch, more than in the "
                            "whole, over spacing",
                      0., (part.ahead - whole.ahead) / spacing, 2.5, "1",
                      "symmetry of the problem", Check::Kind::at_most});
    checks.push_back({who + ": spread to the sides over that of the whole", 1.,
                      part.spread / whole.spread, 0.15, "1",
                      "symmetry of the problem"});
  }
  return checks;
}

const RegisterProblem a({"symmetry-rubble",
                         "crumbled metal before a punch on planes of symmetry",
                         "quick", punched_column});
} // namespace
} // namespace sabot
