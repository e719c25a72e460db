// Particles beyond planes of symmetry: parts of models against wholes.
#include "sabot/base/choice.h"
#include "verification/halves.h"
#include "verification/problem.h"
#include "verification/world.h"

#include <functional>

namespace sabot
{
namespace
{
constexpr double h = 1e-3; // spacing [m]

/** Three planes, a bit each: what of a block is there. */
struct Cut
{
  unsigned int axes;
  double plane = 0.; // all cut at this coordinate [m]
};

/** A box of half-edges 4, 3 and 3 spacings around @p plane on each axis, or the
    part of it that is above it. */
ParticleCloud block(const Cut &cut)
{
  std::array<double, 3> center, size{{8 * h, 6 * h, 6 * h}};
  for (int d = 0; d < 3; ++d)
  {
    center[d] = cut.plane;
    if (cut.axes >> d & 1)
    {
      size[d] *= 0.5;
      center[d] += 0.5 * size[d];
    }
  }
  return make_box_cloud(center, size, h);
}

/** Faces of symmetry of its parts: -x, -y, -z. */
std::uint32_t lower_faces(const unsigned int axes)
{
  return (axes & 1) | (axes & 2) << 1 | (axes & 4) << 2;
}

/** Each particle flies away from the planes and towards them, by where it is;
    the same in all parts [m/s]. */
void stir(Body &body, const double plane, const double speed)
{
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.n_owned; ++i)
    for (int d = 0; d < 3; ++d)
    {
      double v = speed;
      for (int e = 0; e < 3; ++e)
      {
        const double x = (n.reference_position[i][e] - plane) / (3. * h);
        v *= d == e ? std::sin(2.2 * x) : std::cos((1. + 0.3 * e) * x);
      }
      n.velocity[i][d] = v;
    }
}

using Change = std::function<void(SpgOptions &)>;

std::unique_ptr<SpgBody> stirred(const Cut &cut, const Change &change)
{
  SpgOptions options;
  options.symmetry_faces = lower_faces(cut.axes);
  change(options);
  return std::make_unique<SpgBody>("block", 0, block(cut), taylor_copper(),
                                   options);
}

/** Aluminum, in which heat flows fast. */
std::unique_ptr<SpgBody> stirred_hot(const Cut &cut)
{
  SpgOptions options;
  options.symmetry_faces = lower_faces(cut.axes);
  options.conducts_heat = true;
  options.conduction_interval = 1e-7;
  return std::make_unique<SpgBody>(
      "block", 0, block(cut),
      metal("al6061-t6", {change("Johnson-Cook/Thermal conductivity", 1e4)}),
      options);
}

struct Differences
{
  double position = 0., energy = 0., step = 0., failed = 0.;
};

/** A part against the whole, of which there are @p copies, by steps of the same
    size, over @p end [s]; @p stir: sets their motion. */
Differences compare(std::unique_ptr<SpgBody> of_whole,
                    std::unique_ptr<SpgBody> of_part, const double copies,
                    const double end, const std::function<void(Body &)> &stir)
{
  World whole, part;
  whole.bodies.push_back(std::move(of_whole));
  part.bodies.push_back(std::move(of_part));
  Differences worst;
  for (World *const world : {&whole, &part})
  {
    world->distribute();
    stir(*world->bodies[0]);
    world->stepper.initialize();
  }
  while (whole.stepper.time() < end)
  {
    const double a = whole.stepper.propose(false).dt,
                 b = part.stepper.propose(false).dt;
    worst.step = std::max(worst.step, std::abs(b / a - 1.));
    for (World *const world : {&whole, &part})
    {
      world->stepper.advance(0.8 * std::min(a, b));
      world->stepper.update();
    }
  }
  worst.position = largest_difference(*part.bodies[0], *whole.bodies[0]) / h;
  worst.energy =
      std::abs(copies * part.internal_energy() / whole.internal_energy() - 1.);
  worst.failed = measure(*whole.bodies[0], "bonds broken fraction");
  return worst;
}

/** Of a block, cut across @p axes at @p plane. */
Differences compare(const unsigned int axes, const double plane,
                    const double speed, const double end, const Change &change)
{
  return compare(stirred({0, plane}, change), stirred({axes, plane}, change),
                 1 << __builtin_popcount(axes), end,
                 [=](Body &body) { stir(body, plane, speed); });
}

std::vector<Check> checks(const std::string &what, const Differences &worst,
                          const double tolerance)
{
  return {{what + ": positions over spacing", 0., worst.position, tolerance,
           "1", "symmetry of the problem"},
          {what + ": internal energy of all parts", 0., worst.energy, tolerance,
           "1", "symmetry"}};
}

void append(std::vector<Check> &all, const std::vector<Check> &some)
{
  all.insert(all.end(), some.begin(), some.end());
}

std::vector<Check> elastic_plastic()
{
  std::vector<Check> all;
  for (const unsigned int axes : {1u, 2u, 4u, 3u, 7u})
  {
    const Differences worst =
        compare(axes, 0., 150., 4e-6, [](SpgOptions &) {});
    append(all, checks("cut " + std::to_string(axes), worst, 1e-9));
    all.push_back({"cut " + std::to_string(axes) + ": stable step", 0.,
                   worst.step, 1e-3, "1",
                   "symmetry; measured by Lanczos from another start"});
  }
  append(all,
         checks("planes at 1.7 mm",
                compare(3, 1.7e-3, 150., 4e-6, [](SpgOptions &) {}), 1e-6));
  return all;
}

/** A slab of @p n spacings between two planes, and three of them side by side:
    images of images. @p n also below the support. */
std::vector<Check> slabs()
{
  std::vector<Check> all;
  for (const int n : {1, 2, 4})
  {
    const auto slab = [n](const int copies)
    {
      SpgOptions options;
      options.symmetry_faces = 3; // -x, +x
      const double length = copies * n * h;
      return std::make_unique<SpgBody>(
          "slab", 0,
          make_box_cloud({{0.5 * length, 0., 0.}}, {{length, 3 * h, 3 * h}}, h),
          taylor_copper(), options);
    };
    append(all, checks("slab of " + std::to_string(n),
                       compare(slab(3), slab(1), 3., 4e-6,
                               [n](Body &body)
                               {
                                 NodalState &nodes = body.nodes();
                                 for (std::size_t i = 0; i < nodes.n_owned; ++i)
                                 {
                                   const Vec X = nodes.reference_position[i];
                                   const double phase = M_PI * X[0] / (n * h);
                                   nodes.velocity[i] =
                                       vec(100. * std::sin(phase),
                                           150. * (X[1] / h) * std::cos(phase),
                                           80. * std::sin(1e3 * X[2]));
                                 }
                               }),
                       1e-9));
  }
  return all;
}

/** Particles at the nodes of the mesh of a cylinder, which is not a lattice. */
std::vector<Check> cylinders()
{
  const auto cylinder = [](const unsigned int n_cuts)
  {
    SpgOptions options;
    for (unsigned int cut = 0; cut < n_cuts; ++cut)
      options.symmetry_faces |= 8u << cut;
    return std::make_unique<SpgBody>(
        "cylinder", 0,
        make_mesh_cloud(
            make_cylinder(4e-3, 6e-3, 2, {{0, 0, 3e-3}}, h, n_cuts)),
        taylor_copper(), options);
  };
  std::vector<Check> all;
  for (const unsigned int n_cuts : {1u, 2u})
    append(all,
           checks(n_cuts == 1 ? "half of a cylinder" : "quarter of a cylinder",
                  compare(cylinder(0), cylinder(n_cuts), 1 << n_cuts, 4e-6,
                          [](Body &body) { stir(body, 0., 150.); }),
                  1e-9));
  return all;
}

std::vector<Check> methods()
{
  std::vector<Check> all;
  append(all, checks("tensor kernel",
                     compare(3, 0., 150., 3e-6,
                             [](SpgOptions &o) {
                               o.kernel_shape = SpgOptions::KernelShape::tensor;
                             }),
                     1e-9));
  append(all, checks("search",
                     compare(3, 0., 150., 3e-6,
                             [](SpgOptions &o) {
                               o.neighbor_policy =
                                   SpgOptions::NeighborPolicy::search;
                             }),
                     1e-9));
  for (const char *const form : {"none", "second gradient"})
    append(all,
           checks("convex functions, stabilization " + std::string(form),
                  compare(3, 0., 100., 1e-6,
                          [form](SpgOptions &o)
                          {
                            o.approximation =
                                SpgOptions::Approximation::convex_exponential;
                            o.normalized_support = 1.6;
                            o.stabilization = choose<Stabilization>(form);
                            // Its length is at most 2 c times the step, which
                            // is measured to a percent, and that form's is so
                            // short that this counts.
                            if (std::string(form) == "second gradient")
                              o.bulk_viscosity_linear =
                                  o.bulk_viscosity_quadratic = 0.;
                          }),
                  1e-7));
  append(all, checks("velocity smoothing",
                     compare(3, 0., 150., 2e-6,
                             [](SpgOptions &o) {
                               o.stabilization =
                                   choose<Stabilization>("velocity smoothing");
                             }),
                     1e-9));
  append(all, checks("heat",
                     compare(stirred_hot({0}), stirred_hot({3}), 4., 4e-6,
                             [](Body &body) { stir(body, 0., 300.); }),
                     1e-8));
  return all;
}

std::vector<Check> failing()
{
  std::vector<Check> all;
  for (const char *const rule : {"friction", "compression", "everything"})
  {
    const Differences worst = compare(3, 0., 500., 3e-6,
                                      [rule](SpgOptions &o)
                                      {
                                        o.set_critical_plastic_strain(0.2);
                                        o.residual_strength =
                                            choose<ResidualStrength>(rule);
                                      });
    append(all, checks(rule, worst, 1e-6));
    all.push_back({std::string(rule) + ": share of failed bonds", 0.05,
                   worst.failed, 0., "1", "so that metal fails",
                   Check::Kind::at_least});
  }
  return all;
}

const RegisterProblem a({"spg-images",
                         "parts of blocks of particles against the whole",
                         "quick", elastic_plastic}),
    s({"spg-images-slabs", "slabs between two planes against three of them",
       "quick", slabs}),
    m({"spg-images-meshes", "parts of cylinders against the whole", "quick",
       cylinders}),
    b({"spg-images-methods",
       "the same with other functions, kernels and stabilizations", "quick",
       methods}),
    c({"spg-images-failure", "the same with metal that fails", "quick",
       failing});
} // namespace
} // namespace sabot
