#ifndef sabot_materials_material_h
#define sabot_materials_material_h

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sabot
{
class EquationOfState;
class Parameters;
struct ElasticConstants;

/** Order of symmetric tensors everywhere: xx, yy, zz, xy, yz, xz; tensor
    components, no engineering shears. */
constexpr int n_symmetric = 6;

/** Bodies hand over at most this many points at a time. */
constexpr std::size_t max_batch_points = 64;

/**
 * Views of @p n material points, quadrature points or particles alike, as
 * structure of arrays: entry [c][k] is component c at point k. Tensors are
 * already rotated by the increment of rotation (Jaumann, Hughes-Winget) when a
 * material sees them, so that a law may forget about frames: it works in the
 * current one. SI throughout; stresses are positive in tension. The body owns
 * the arrays.
 */
struct MaterialBatch
{
  std::size_t n = 0;
  double dt = 0.;                              // [s] > 0
  const double *strain_increment[n_symmetric]; // D dt, tensor components
  const double *jacobian;                      // det F total, new
  double *stress[n_symmetric];                 // Cauchy [Pa], in/out
  double *state(const std::size_t i) const { return states[i]; }
  double *const *states; // the material's own, n_states() arrays
  /** Square of a stress that a body carries besides @p stress and that shares
      its yield condition [Pa^2], e.g. of the stabilization: the yield function
      sees q = sqrt(3/2 s:s + extra_square) and both are returned by theta. */
  const double *extra_square;
  /** out: factor theta by which the return scaled the trial deviator, 1 where
      the step was elastic: theta = 1 - 3 G d_eps / q_trial. */
  double *return_factor;
  /** out: plastic work of the step per current volume [J/m^3] */
  double *plastic_work;

  // What only some laws need (see Material::needs_...); null otherwise.
  /** Mean of the artificial viscous pressure over the step [Pa]. */
  const double *viscous_pressure = nullptr;
  /** F, new, entry 3 i + j = dx_i/dX_j. */
  const double *deformation_gradient[9] = {};
  /** out: dilatational modulus K + 4/3 G of the current state over the one at
      rest, for the stable step. */
  double *stiffening = nullptr;
};

/** A state variable of a material: an array per point, or six. */
struct StateVariable
{
  /** Of a scalar also the name of an output field: it must be described
      (base/output_fields.h), where its unit stands. */
  std::string name;
  double initial_value = 0.;
  /** A symmetric tensor (six consecutive arrays) is rotated with the stress. */
  bool is_tensor = false;
};

/**
 * A constitutive law for batches of points, the same for FEM and SPG: from
 * stress, state and strain increment of a step to stress and state at its end.
 * A new one is one file with a class, its entries and its registration, as
 * source/materials/elastic.cc is; most derive from ElasticBase, which leaves
 * them the deviator, or are a Flow of RateDependentPlasticity. Its entries
 * stand in a subsection of its name, below the material's.
 *
 * In a parameter file, with the law's own entries in a subsection of its name:
 *
 *     subsection Materials
 *       subsection al6061-t6
 *         set Model           = Johnson-Cook
 *         set Density         = 2700 kg/m^3
 *         set Young's modulus = 68.9 GPa
 *         set Poisson's ratio = 0.33
 *         subsection Johnson-Cook
 *           set Initial yield stress = 324 MPa
 *         end
 *       end
 *     end
 *
 * Objects do not change once made and hold no state of points, so that one
 * serves all bodies and threads. No function is collective.
 */
class Material
{
public:
  static constexpr const char *kind = "material law";
  /** Makes one from the entries that its subsection holds, which the caller
      has entered; @p path of that subsection, for messages. InputError for
      values that cannot be. */
  using Make = std::unique_ptr<Material>(
      const Parameters &prm, const std::string &path,
      const ElasticConstants &elastic,
      const std::shared_ptr<const EquationOfState> &equation_of_state);

  virtual ~Material() = default;
  virtual double density() const = 0;       // rho_0, stress-free [kg/m^3]
  virtual double bulk_modulus() const = 0;  // K at rest [Pa]
  virtual double shear_modulus() const = 0; // G at rest [Pa]
  /** Stress at which it first yields, uniaxial, slow, at the initial
     temperature [Pa]; nothing for laws that never yield. */
  virtual std::optional<double> initial_yield_stress() const
  {
    return std::nullopt;
  }
  /** Effective plastic strain at which the state "damage" reaches 1, slow, at
      the initial temperature and a @p triaxiality (mean over von Mises stress)
      that does not change; nothing for laws that gather no damage. */
  virtual std::optional<double>
  slow_fracture_strain(const double /*triaxiality*/) const
  {
    return std::nullopt;
  }
  /** Dilatational wave speed sqrt((K + 4/3 G)/rho) [m/s]. */
  double sound_speed() const;
  /** What the body keeps for each point and hands over as batch.states: one
      entry per array, except that a tensor entry stands for six. By
      convention "effective plastic strain" and "temperature", where a law has
      them, bear these names. */
  virtual std::vector<StateVariable> state_variables() const = 0;
  /** Stress and state at the end of the step, for all of @p batch: at most
      max_batch_points points, none of which sees another. */
  virtual void update(const MaterialBatch &batch) const = 0;

  // Of laws with a state "temperature"; 0 elsewhere.
  virtual double specific_heat() const { return 0.; } // [J/kg/K]
  virtual double conductivity() const { return 0.; }  // [W/m/K]

  // Entries of MaterialBatch that a body fills only for laws that need them.
  virtual bool needs_viscous_pressure() const { return false; }
  virtual bool needs_deformation_gradient() const { return false; }
  /** Whether `stiffening` may leave 1. */
  virtual bool stiffens() const { return false; }

  /** Its subsection in the scene. */
  std::string name;
  /** Whether the pressure follows an equation of state, and not a constant
      bulk modulus. */
  virtual bool has_equation_of_state() const { return false; }

  /** What looks odd in the values, for the log. */
  std::vector<std::string> warnings;

  /** Declare the entries of one material in the present subsection; "Model"
      selects the law and "Equation of state" the pressure, only their
      subsections are declared. Names that are empty or unknown declare all, as
      the manual does. */
  static void declare_parameters(Parameters &prm, const std::string &model = "",
                                 const std::string &equation_of_state = "");
  /** Throw InputError for the first of @p subsections that @p model and
      @p equation_of_state do not read. */
  static void check_subsections(const std::string &path,
                                const std::vector<std::string> &subsections,
                                const std::string &model,
                                const std::string &equation_of_state);
  /** The material that the present subsection describes; @p path is where it
      stands, for messages. InputError. */
  static std::unique_ptr<Material> make(Parameters &prm,
                                        const std::string &path);
};
} // namespace sabot

#endif
