#ifndef sabot_bodies_fem_fem_options_h
#define sabot_bodies_fem_fem_options_h

#include "sabot/bodies/mass_scaling.h"

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
/** A cell goes when a state variable of its material, the mean over the
    cell's points, reaches the value. The entry is what messages name when a
    law does not have the variable. */
struct ErosionLimit
{
  std::string variable; // "damage"
  std::string entry;    // of the parameters, "Erosion damage"
  double value;
};

/** The choice of hourglass control that leaves it to the material's law. */
constexpr const char *hourglass_by_law = "automatic";

/**
 * What a scene says about a body of finite elements, beside shape, material and
 * names. SI units. Boundary ids are those of the body's mesh.
 */
struct FemOptions
{
  // Names of choices; the body's constructor looks them up.
  std::string integration = "one point";    // of Registry<Hexahedra>
  std::string hourglass = hourglass_by_law; // of Registry<OnePoint>
  /** Which rotation the stress follows: by the spin of the velocity
      gradient, or by R of F = R U, without oscillation in large elastic
      shear. Jaumann: Hughes & Winget's spin of the step. Green-Naghdi: costs
      a polar decomposition per point and step. Both turn stress exactly
      under rigid rotation. */
  enum class ObjectiveRate
  {
    jaumann,
    green_naghdi
  };
  ObjectiveRate objective_rate = ObjectiveRate::jaumann;
  /** Dimensionless, of the viscous and the stiffness form alike; 0.03 to
      0.15 are usual. */
  double hourglass_coefficient = 0.1; // of Flanagan & Belytschko's forms
  /** q = rho h (c1 c |d| + c2 h d^2) in compression (von Neumann & Richtmyer
      1950 for the square, Landshoff 1955 for the linear term); c1 also damps
      and shortens the step. */
  double bulk_viscosity_linear = 0.06;   // c1, see bulk_viscosity_pressure()
  double bulk_viscosity_quadratic = 1.5; // c2
  /** A cell is eroded when one of these is passed; nothing: never. Compared
      with the mean over a cell's points, reached or passed. */
  std::optional<double> erosion_plastic_strain, erosion_damage;
  double erosion_step = 0.; // [s], the cell's own stable step falls below
  /** What to do with a cell that the last step brought half way to a volume
      of zero: two more like it would turn it inside out. Asked where one
      step left less than two thirds of the volume; shrink also bounds every
      step by 0.25/|tr L|. */
  enum class Inversion
  {
    stop,  // with the name and place of the cell
    erode, // it rests as it was until the end of the step
    shrink // no step may take more than a quarter of a cell's volume
  };
  Inversion inversion = Inversion::stop;
  MassScalingOptions mass_scaling;
  std::array<double, 3> initial_velocity{{0., 0., 0.}}; // [m/s]
  double cell_size = 0.; // that the mesh was asked for [m]
  /** Faces held fixed, faces in planes of symmetry, faces that are driven.
     Where they share nodes the first of clamped, driven, symmetric counts. */
  std::vector<unsigned int> clamped_boundary_ids, symmetry_boundary_ids,
      driven_boundary_ids;
  /** Of the nodes of driven faces; only the held components count. */
  std::array<double, 3> driven_velocity{{0., 0., 0.}}; // [m/s]
  std::array<bool, 3> driven_components{{true, true, true}};
  /** Conduct heat between the cells, after every interval. Backward Euler,
      faces insulated; not together with erosion. The first step past the
      interval conducts for all the time since the last. */
  bool conducts_heat = false;
  double conduction_interval = 1e-6; // [s]

  /** Whether anything can take a cell out of the body. Inversion = erode
      counts, too. */
  bool erodes() const;
  /** The state variables that end the life of a cell. Without the limit of
      the step, which is no state of the law. */
  std::vector<ErosionLimit> erosion_limits() const;

  /** Whether the step of each cell is kept, not just the least. */
  bool keeps_steps() const { return erosion_step > 0. || mass_scaling.is_on(); }

  /** The entries of the body's subsection, and their values; @p path: of the
      body, for messages. Throws InputError for entries that do not fit
      together. Neither knows
      of boundary ids and velocities, which are the body's. Values of 1e10
      and more in old files mean never. */
  static void declare_parameters(Parameters &prm);
  static FemOptions parse(const Parameters &prm, const std::string &path);
};
} // namespace sabot

#endif
