// Entries of SPG bodies: what all of them have; choices from registries bring
// their own.
#include "sabot/bodies/spg/spg_options.h"

#include "sabot/base/choice.h"
#include "sabot/base/error.h"

namespace sabot
{
namespace
{
constexpr const char *standard_form = "bond residual",
                     *standard_criterion = "effective plastic strain",
                     *standard_rule = "friction";
} // namespace

SpgOptions::SpgOptions()
    : stabilization(choose<Stabilization>(standard_form)),
      failure_criterion(choose<FailureCriterion>(standard_criterion)),
      residual_strength(choose<ResidualStrength>(standard_rule))
{
}

void SpgOptions::set_critical_plastic_strain(const double critical)
{
  failure_criterion = choose<FailureCriterion>(
      "effective plastic strain",
      {{"Critical effective plastic strain", exact_text(critical)}});
}

namespace
{
void declare_kernel(Parameters &prm)
{
  prm.declare_knob("Kernel update interval", "30", integer(1),
                   "Steps between updates of the Lagrangian kernel.");
  prm.declare_knob("Kernel update strain", "0.02",
                   quantity(Dimension::none, 0., 1.),
                   "An interval passes without update when no particle has "
                   "strained by more than this since the last one; rotation "
                   "needs none. 0: every interval.");
  prm.declare_knob("Kernel update change", "1.1",
                   quantity(Dimension::none, 1.01, 10.),
                   "A particle that has been stretched or flattened by about "
                   "this factor since the last update calls for an update at "
                   "once.");
}

void declare_failure(Parameters &prm)
{
  prm.declare_knob("Failure check interval", "5", integer(1),
                   "Steps between checks of the bonds; where any fails, the "
                   "kernel is updated at once.");
  Registry<FailureCriterion>::declare_choice(
      prm, "Failure criterion", standard_criterion,
      "A bond fails for ever when the mean of this over its two ends exceeds "
      "the critical value and its stretch exceeds the critical stretch.");
  Registry<FailureCriterion>::declare_entries(prm, "");
  prm.declare_entry("Critical stretch", "1", quantity(Dimension::none, 1., 10.),
                    "Distance over original distance above which a bond may "
                    "fail; at least 1, so that none fails in compression.");
  prm.declare_entry("Nonlocal length", "none",
                    word_or("none", quantity(Dimension::length, 1e-9, 1e2)),
                    "Length l over which the measure of failure is averaged "
                    "along the bonds, m - l^2 div grad m = local measure: the "
                    "width of a failing band where it is above the spacing.");
  Registry<ResidualStrength>::declare_choice(
      prm, "Failed metal carries", standard_rule,
      "Stress of particles that have failed: whose remaining bonds no longer "
      "span "
      "space, or, for friction, whose metal has failed itself.");
  Registry<ResidualStrength>::declare_entries(prm, "");
}
} // namespace

void SpgOptions::declare_parameters(Parameters &prm)
{
  prm.declare_knob(
      "Approximation", "least squares",
      one_of("least squares|convex exponential|convex arctangent"),
      "First-order functions of the particles. least squares: linearly "
      "corrected, the unknowns are the particles' positions; convex: "
      "generalized meshfree functions (Wu, Park & Chen 2011) with exponential "
      "or inverse-tangent basis, the unknowns are generalized positions.");
  prm.declare_knob("Kernel shape", "spherical", one_of("spherical|tensor"),
                   "Cubic spline of the radius, or product of cubic splines "
                   "along the axes of the kernel.");
  prm.declare_knob("Normalized support size", "2.0",
                   quantity(Dimension::none, 1.0, 2.8),
                   "Kernel radius (tensor: half width) over nodal spacing. "
                   "Spherical least squares needs 1.8 or more.");
  Registry<Stabilization>::declare_knob(
      prm, "Stabilization", standard_form,
      "What keeps the sawtooth modes of direct nodal integration under "
      "control.");
  Registry<Stabilization>::declare_entries(prm, "");
  prm.declare_knob(
      "Neighbor policy", "Lagrangian list",
      one_of("Lagrangian list|search undamaged|search"),
      "Lagrangian list: bonds of the start, only ever removed; search "
      "undamaged: kernel updates add bonds between particles without a failed "
      "bond; search: between all pairs but those whose bond failed.");
  declare_kernel(prm);
  declare_failure(prm);
  prm.declare_knob("Linear bulk viscosity", "0.06",
                   quantity(Dimension::none, 0., 1.),
                   "Coefficient of rho c h |div v| in compression.");
  prm.declare_knob("Quadratic bulk viscosity", "1.5",
                   quantity(Dimension::none, 0., 10.),
                   "Coefficient of rho h^2 (div v)^2 in compression.");
  MassScalingOptions::declare_parameters(prm);
  prm.declare_entry("Heat conduction", "false", boolean(),
                    "Implicit conduction between bonded particles, surfaces "
                    "and cracks insulated. Needs a law with temperature and "
                    "conductivity.");
  prm.declare_entry("Conduction interval", "1 us",
                    quantity(Dimension::time, 0., 1e3),
                    "Time between conduction steps.");
}

namespace
{
/** Position of the entry's value in a list of names. */
template <typename Choice>
Choice choice(const Parameters &prm, const std::string &entry,
              const std::initializer_list<const char *> names)
{
  int i = 0;
  for (const char *const name : names)
  {
    if (prm.get(entry) == name)
      break;
    ++i;
  }
  return static_cast<Choice>(i);
}

/** What the registry makes of the choice in the entry @p selector. */
template <typename Product>
auto chosen(const Parameters &prm, const std::string &path,
            const std::string &selector)
{
  refuse_unused<Product>(prm, path, selector);
  return Registry<Product>::get(path + "/" + selector, prm.get(selector))
      .make(prm, path);
}

void check_support(const SpgOptions &o, const Parameters &prm,
                   const std::string &path)
{
  const double least = o.stores_gradients()     ? 1.05
                       : !o.has_tensor_kernel() ? 1.8
                                                : 1.2;
  if (o.normalized_support < least)
    throw InputError(
        path + "/Normalized support size",
        "is " + prm.get("Normalized support size") +
            "; this approximation and kernel shape need at least " +
            std::to_string(least) + ", else particles have too few neighbors");
}
} // namespace

SpgOptions SpgOptions::parse(const Parameters &prm, const std::string &path)
{
  SpgOptions o;
  o.approximation = choice<Approximation>(
      prm, "Approximation",
      {"least squares", "convex exponential", "convex arctangent"});
  o.kernel_shape =
      choice<KernelShape>(prm, "Kernel shape", {"spherical", "tensor"});
  o.normalized_support = get_quantity(prm, "Normalized support size");
  o.neighbor_policy =
      choice<NeighborPolicy>(prm, "Neighbor policy",
                             {"Lagrangian list", "search undamaged", "search"});
  o.kernel_update_interval = prm.get_integer("Kernel update interval");
  o.kernel_update_strain = get_quantity(prm, "Kernel update strain");
  o.kernel_update_change = get_quantity(prm, "Kernel update change");
  o.failure_check_interval = prm.get_integer("Failure check interval");
  o.failure_criterion =
      chosen<FailureCriterion>(prm, path, "Failure criterion");
  o.critical_stretch = get_quantity(prm, "Critical stretch");
  o.nonlocal_length = get_optional_quantity(prm, "Nonlocal length");
  o.residual_strength =
      chosen<ResidualStrength>(prm, path, "Failed metal carries");
  o.stabilization = chosen<Stabilization>(prm, path, "Stabilization");
  o.bulk_viscosity_linear = get_quantity(prm, "Linear bulk viscosity");
  o.bulk_viscosity_quadratic = get_quantity(prm, "Quadratic bulk viscosity");
  o.mass_scaling = MassScalingOptions::parse(prm, path);
  o.conducts_heat = prm.get_bool("Heat conduction");
  o.conduction_interval = get_quantity(prm, "Conduction interval");
  if (!o.stores_gradients() && o.stabilization()->needs_second_derivatives())
    throw InputError(path + "/Stabilization",
                     prm.get("Stabilization") +
                         " needs second derivatives of the shape functions: "
                         "set Approximation = convex exponential");
  check_support(o, prm, path);
  return o;
}
} // namespace sabot
