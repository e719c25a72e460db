// Particles on meshes of any shape: linear fields, rotation, mass.
#include "sabot/geometry/carving.h"
#include "sabot/geometry/round_bodies.h"
#include "verification/problem.h"
#include "verification/world.h"

namespace sabot
{
namespace
{
/** Largest entry of F - A, and of the stress relative to @p scale. */
struct Errors
{
  double gradient = 0., stress = 0.;
};

Errors move(SpgBody &body, const Mat &A, const Mat &wanted_stress,
            const double scale)
{
  NodalState &n = body.nodes();
  for (std::size_t i = 0; i < n.size(); ++i)
    n.position[i] = A * n.reference_position[i];
  body.update_ghosts();
  body.compute_forces(0., 1e-8);
  constexpr int place[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  Errors errors;
  for (std::size_t i = 0; i < n.n_owned; ++i)
  {
    const Mat F = body.rooms().fields.deformation_gradient(i);
    for (int c = 0; c < 3; ++c)
      errors.gradient = std::max(errors.gradient, norm(F.row[c] - A.row[c]));
    for (int c = 0; c < 6; ++c)
      errors.stress = std::max(
          errors.stress, std::abs(body.stress(c, i) -
                                  wanted_stress(place[c][0], place[c][1])) /
                             scale);
  }
  return errors;
}

/** A linear field, a rotation, the mass and the neighbors of a cloud. */
void add_checks(std::vector<Check> &checks, const std::string &name,
                const ParticleCloud &cloud, const double exact_volume,
                const SpgOptions &options = SpgOptions())
{
  const auto material = elastic();
  double volume = 0., mean_bonds = 0., least_bonds = 1e300, n_weak = 0.;
  for (const double v : cloud.volume)
    volume += v;
  Errors patch, rotation;
  for (const bool rotate : {false, true})
  {
    World world;
    world.bodies.push_back(
        std::make_unique<SpgBody>(name, 0, cloud, material, options));
    world.distribute();
    auto &body = static_cast<SpgBody &>(*world.bodies[0]);
    Mat A = Mat::identity(), stress = Mat::zero();
    const double angle = 0.4;
    if (rotate)
      A = {{vec(std::cos(angle), -std::sin(angle), 0.),
            vec(std::sin(angle), std::cos(angle), 0.), vec(0., 0., 1.)}};
    else
    {
      // Uniaxial strain, for which D = l of the midpoint is closed.
      const double strain = 1e-3, rate = strain / (1. + 0.5 * strain),
                   K = material->bulk_modulus(), G = material->shear_modulus();
      A.set(2, 2, 1. + strain);
      // A Jaumann law: pressure from ln J, deviator from D.
      const double p = K * std::log1p(strain);
      stress.set(0, 0, p - 2. / 3. * G * rate);
      stress.set(1, 1, p - 2. / 3. * G * rate);
      stress.set(2, 2, p + 4. / 3. * G * rate);
    }
    const Errors errors =
        move(body, A, stress,
             rotate ? 1e-3 * aluminum().young_modulus : stress(2, 2));
    (rotate ? rotation : patch) = errors;
    const BondList &bonds = body.rooms().bonds;
    double n_bonds = 0.;
    const std::size_t n = body.nodes().n_owned;
    for (std::size_t i = 0; i < n; ++i)
    {
      n_bonds += bonds.n_bonds(i);
      least_bonds = std::min(least_bonds, double(bonds.n_bonds(i)));
      n_weak += body.rooms().approximation.lost_direction[i];
    }
    mean_bonds = n_bonds / n;
  }
  checks.push_back({name + ": deformation gradient, largest error", 0.,
                    patch.gradient, 1e-12, "1", "linear completeness"});
  checks.push_back({name + ": stress, largest error over the stress", 0.,
                    patch.stress, 1e-9, "1", "uniaxial strain"});
  checks.push_back({name + ": stress of a rotation over E/1000", 0.,
                    rotation.stress, 1e-9, "1", "objectivity"});
  checks.push_back({name + ": volume of the particles over the exact one", 1.,
                    volume / exact_volume, 1e-12, "1", "exact mass"});
  checks.push_back({name + ": mean number of neighbors", 32.5, mean_bonds, 0.,
                    "1", "what a ball of two spacings holds",
                    Check::Kind::at_most});
  checks.push_back({name + ": least number of neighbors", 7., least_bonds, 0.,
                    "1", "the corner of a cubic lattice",
                    Check::Kind::at_least});
  checks.push_back({name + ": particles that lack a direction", 0., n_weak, 0.,
                    "1", "intact cloud"});
}

std::vector<Check> clouds()
{
  std::vector<Check> checks;
  const double R = 4e-3, L = 8e-3, h = 1e-3, pi = M_PI;
  add_checks(checks, "cylinder",
             make_mesh_cloud(make_cylinder(R, L, 2, {{1e-3, 0., 0.}}, h)),
             pi * R * R * L);
  CylinderGrading grading;
  grading.core_radius = 1.5e-3;
  grading.growth_ratio = 1.3;
  add_checks(
      checks, "graded quarter",
      make_mesh_cloud(make_cylinder(R, L, 0, {{0., 0., 0.}}, h, 2, grading)),
      0.25 * pi * R * R * L);
  add_checks(checks, "sphere",
             make_mesh_cloud(make_sphere(R, {{0., 0., 0.}}, h)),
             4. / 3. * pi * R * R * R);
  ProjectileSpecification nose;
  nose.radius = R;
  nose.shaft_length = 6e-3;
  nose.nose_length = 8e-3;
  nose.cell_size = h;
  add_checks(checks, "cone", make_mesh_cloud(make_projectile(nose)),
             pi * R * R * (nose.shaft_length + nose.nose_length / 3.));
  add_checks(checks, "box of 0.5 x 1 x 2 mm spacing",
             make_box_cloud({{0., 0., 0.}}, {{4e-3, 8e-3, 16e-3}},
                            {{0.5e-3, 1e-3, 2e-3}}),
             4e-3 * 8e-3 * 16e-3);

  // The nodes of a sheared lattice see what those of a cube see.
  BoxSpecification box;
  box.size = {{6e-3, 6e-3, 6e-3}};
  box.cell_size = h;
  HexMesh mesh = make_graded_box(box);
  const auto count = [&](const ParticleCloud &cloud)
  {
    World world;
    world.bodies.push_back(std::make_unique<SpgBody>("lattice", 0, cloud,
                                                     elastic(), SpgOptions()));
    world.distribute();
    const auto &body = static_cast<SpgBody &>(*world.bodies[0]);
    double n = 0.;
    for (std::size_t i = 0; i < body.nodes().n_owned; ++i)
      n += body.rooms().bonds.n_bonds(i);
    return n;
  };
  const double bonds_of_cube = count(make_mesh_cloud(mesh)),
               bonds_of_lattice =
                   count(make_box_cloud({{0, 0, 0}}, box.size, h));
  for (auto &x : mesh.nodes)
    x = {{x[0] + 0.7 * x[1] - 0.4 * x[2], 2. * x[1] + 0.3 * x[2], 0.5 * x[2]}};
  checks.push_back({"bonds of a mesh of cubes over those of a box", 1.,
                    bonds_of_cube / bonds_of_lattice, 0., "1",
                    "the same lattice"});
  checks.push_back({"bonds of the sheared, stretched mesh over those of cubes",
                    1., count(make_mesh_cloud(mesh)) / bonds_of_cube, 0., "1",
                    "kernels follow the cells"});
  return checks;
}

const RegisterProblem registered(
    {"spg-clouds",
     "linear field, rotation, mass and neighbors of particles on meshes",
     "quick", clouds});
} // namespace
} // namespace sabot
