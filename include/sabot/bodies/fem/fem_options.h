#ifndef sabot_bodies_fem_fem_options_h
#define sabot_bodies_fem_fem_options_h

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sabot
{
class Parameters;
}

namespace sabot
{
/** A cell goes when a state variable of its material, the mean over the cell's
    points, reaches the value. */
struct ErosionLimit
{
  std::string variable; // "damage"
  std::string entry;    // of the parameters, "Erosion damage"
  double value;
};

/**
 * What a scene says about a body of finite elements, beside shape, material and
 * names. SI units. Boundary ids are those of the body's mesh.
 */
struct FemOptions
{
  // Names of choices; the body's constructor looks them up.
  std::string integration = "one point"; // of Registry<Hexahedra>
  std::string hourglass = "viscous";     // of Registry<OnePoint>
  /** Which rotation the stress follows: by the spin of the velocity gradient,
     or by R of F = R U, without oscillation in large elastic shear. */
  enum class ObjectiveRate
  {
    jaumann,
    green_naghdi
  };
  ObjectiveRate objective_rate = ObjectiveRate::jaumann;
  double hourglass_coefficient = 0.1;    // of Flanagan & Belytschko's forms
  double bulk_viscosity_linear = 0.06;   // c1, see bulk_viscosity_pressure()
  double bulk_viscosity_quadratic = 1.5; // c2
  /** A cell is eroded when one of these is passed; nothing: never. */
  std::optional<double> erosion_plastic_strain, erosion_damage;
  double erosion_step = 0.; // [s], the cell's own stable step falls below
  /** What to do with a cell that the last step brought half way to a volume of
      zero: two more like it would turn it inside out. */
  enum class Inversion
  {
    stop,  // with the name and place of the cell
    erode, // it rests as it was until the end of the step
    shrink // no step may take more than a quarter of a cell's volume
  };
  Inversion inversion = Inversion::stop;
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  double cell_size = 0.; // that the mesh was asked for [m]
  /** Faces held fixed, faces in planes of symmetry, faces that are driven.
     Where they share nodes the first of clamped, driven, symmetric counts. */
  std::vector<unsigned int> clamped_boundary_ids, symmetry_boundary_ids,
      driven_boundary_ids;
  /** Of the nodes of driven faces; only the held components count. */
  std::array<double, 3> driven_velocity{{0., 0., 0.}}; // [m/s]
  std::array<bool, 3> driven_components{{true, true, true}};
  /** Conduct heat between the cells, after every interval. */
  bool conducts_heat = false;
  double conduction_interval = 1e-6; // [s]

  /** Whether anything can take a cell out of the body. */
  bool erodes() const;
  /** The state variables that end the life of a cell. */
  std::vector<ErosionLimit> erosion_limits() const;

  /** The entries of the body's subsection, and their values. Neither knows of
      boundary ids and velocities, which are the body's. */
  static void declare_parameters(Parameters &prm);
  static FemOptions parse(const Parameters &prm);
};
} // namespace sabot

#endif
