#include "sabot/bodies/spg/spg_options.h"

#include "sabot/base/error.h"
#include "sabot/base/parameters.h"

namespace sabot
{
void SpgOptions::declare_parameters(Parameters &prm)
{
  prm.declare_entry(
      "Approximation", "least squares",
      one_of("least squares|convex exponential|convex arctangent"),
      "First-order functions of the particles. least squares: linearly "
      "corrected, the unknowns are the particles' positions; convex: "
      "generalised meshfree functions (Wu, Park & Chen 2011) with exponential "
      "or inverse-tangent basis, the unknowns are generalised positions.");
  prm.declare_entry("Kernel shape", "spherical", one_of("spherical|tensor"),
                    "Cubic spline of the radius, or product of cubic splines "
                    "along the axes of the kernel.");
  prm.declare_entry("Normalised support size", "2.0",
                    quantity(Dimension::none, 1.0, 2.8),
                    "Kernel radius (tensor: half width) over nodal spacing. "
                    "Spherical least squares needs 1.8 or more.");
  prm.declare_entry(
      "Stabilisation", "bond residual",
      one_of("bond residual|second gradient|velocity smoothing|none"),
      "What keeps the sawtooth modes of direct nodal integration under "
      "control. second gradient needs a convex approximation; its stable "
      "step is 2 to 3 times shorter.");
  prm.declare_entry("Stabilisation coefficient", "4",
                    quantity(Dimension::none, 0., 20.),
                    "Stiffness of the bond residual in shear moduli; 3 to 5 "
                    "give the same answers.");
  prm.declare_entry("Smoothing coefficient", "0.1",
                    quantity(Dimension::none, 0., 1.),
                    "Part of the doubly smoothed difference that velocity "
                    "smoothing takes out each time.");
  prm.declare_entry("Smoothing interval", "5", integer(1),
                    "Steps between velocity smoothings.");
  prm.declare_entry(
      "Neighbour policy", "Lagrangian list",
      one_of("Lagrangian list|search undamaged|search"),
      "Lagrangian list: bonds of the start, only ever removed; search "
      "undamaged: kernel updates add bonds between particles without a failed "
      "bond; search: between all pairs but those whose bond failed.");
  prm.declare_entry("Kernel update interval", "30", integer(1),
                    "Steps between updates of the Lagrangian kernel.");
  prm.declare_entry("Kernel update strain", "0.02",
                    quantity(Dimension::none, 0., 1.),
                    "An interval passes without update when no particle has "
                    "strained by more than this since the last one; rotation "
                    "needs none. 0: every interval.");
  prm.declare_entry("Kernel update change", "1.1",
                    quantity(Dimension::none, 1.01, 10.),
                    "A particle that has been stretched or flattened by about "
                    "this factor since the last update calls for an update at "
                    "once.");
  prm.declare_entry("Failure check interval", "5", integer(1),
                    "Steps between checks of the bonds; where any fails, the "
                    "kernel is updated at once.");
  prm.declare_entry("Failure criterion", "effective plastic strain",
                    one_of("effective plastic strain|maximum principal "
                           "stress|maximum shear strain"),
                    "A bond fails for ever when the mean of this over its two "
                    "ends exceeds the critical value and its stretch exceeds "
                    "the critical stretch.");
  prm.declare_entry("Critical effective plastic strain", "1e10",
                    quantity(Dimension::none, 0.), "1e10: bonds never fail.");
  prm.declare_entry("Critical principal stress", "1e15",
                    quantity(Dimension::pressure, 0.),
                    "Tensile. 1e15: bonds never fail.");
  prm.declare_entry("Critical shear strain", "1e10",
                    quantity(Dimension::none, 0.),
                    "Largest difference of two principal logarithmic strains. "
                    "1e10: bonds never fail.");
  prm.declare_entry("Critical stretch", "1", quantity(Dimension::none, 1., 10.),
                    "Distance over original distance above which a bond may "
                    "fail; at least 1, so that none fails in compression.");
  prm.declare_entry("Linear bulk viscosity", "0.06",
                    quantity(Dimension::none, 0., 1.),
                    "Coefficient of rho c h |div v| in compression.");
  prm.declare_entry("Quadratic bulk viscosity", "1.5",
                    quantity(Dimension::none, 0., 10.),
                    "Coefficient of rho h^2 (div v)^2 in compression.");
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

/** An entry that has no effect with the choice made is a mistake. */
void refuse_unused(const Parameters &prm, const std::string &path,
                   const std::string &entry, const double value,
                   const double unset, const std::string &selector,
                   const std::string &needed)
{
  if (value != unset && prm.get(selector) != needed)
    throw InputError(path + "/" + entry, "has no effect with " + selector +
                                             " = " + prm.get(selector) +
                                             "; remove it or set " + selector +
                                             " = " + needed);
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
  o.normalized_support = get_quantity(prm, "Normalised support size");
  o.stabilization = choice<Stabilization>(
      prm, "Stabilisation",
      {"bond residual", "second gradient", "velocity smoothing", "none"});
  o.stabilization_coefficient = get_quantity(prm, "Stabilisation coefficient");
  o.smoothing_coefficient = get_quantity(prm, "Smoothing coefficient");
  o.smoothing_interval = prm.get_integer("Smoothing interval");
  o.neighbor_policy =
      choice<NeighborPolicy>(prm, "Neighbour policy",
                             {"Lagrangian list", "search undamaged", "search"});
  o.kernel_update_interval = prm.get_integer("Kernel update interval");
  o.kernel_update_strain = get_quantity(prm, "Kernel update strain");
  o.kernel_update_change = get_quantity(prm, "Kernel update change");
  o.failure_check_interval = prm.get_integer("Failure check interval");
  o.failure_criterion = choice<FailureCriterion>(prm, "Failure criterion",
                                                 {"effective plastic strain",
                                                  "maximum principal stress",
                                                  "maximum shear strain"});
  o.critical_effective_plastic_strain =
      get_quantity(prm, "Critical effective plastic strain");
  o.critical_principal_stress = get_quantity(prm, "Critical principal stress");
  o.critical_shear_strain = get_quantity(prm, "Critical shear strain");
  o.critical_stretch = get_quantity(prm, "Critical stretch");
  o.bulk_viscosity_linear = get_quantity(prm, "Linear bulk viscosity");
  o.bulk_viscosity_quadratic = get_quantity(prm, "Quadratic bulk viscosity");
  o.conducts_heat = prm.get_bool("Heat conduction");
  o.conduction_interval = get_quantity(prm, "Conduction interval");

  refuse_unused(prm, path, "Critical effective plastic strain",
                o.critical_effective_plastic_strain, never, "Failure criterion",
                "effective plastic strain");
  refuse_unused(prm, path, "Critical principal stress",
                o.critical_principal_stress, never_stress, "Failure criterion",
                "maximum principal stress");
  refuse_unused(prm, path, "Critical shear strain", o.critical_shear_strain,
                never, "Failure criterion", "maximum shear strain");
  refuse_unused(prm, path, "Stabilisation coefficient",
                o.stabilization_coefficient, 4., "Stabilisation",
                "bond residual");
  refuse_unused(prm, path, "Smoothing coefficient", o.smoothing_coefficient,
                0.1, "Stabilisation", "velocity smoothing");
  if (o.stabilization == Stabilization::second_gradient &&
      o.approximation == Approximation::least_squares)
    throw InputError(path + "/Stabilisation",
                     "second gradient needs second derivatives of the shape "
                     "functions: set Approximation = convex exponential");
  const double least = o.approximation != Approximation::least_squares ? 1.05
                       : o.kernel_shape == KernelShape::spherical      ? 1.8
                                                                       : 1.2;
  if (o.normalized_support < least)
    throw InputError(
        path + "/Normalised support size",
        "is " + prm.get("Normalised support size") +
            "; this approximation and kernel shape need at least " +
            std::to_string(least) + ", else particles have too few neighbours");
  return o;
}

double SpgOptions::critical_value() const
{
  return failure_criterion == FailureCriterion::effective_plastic_strain
             ? critical_effective_plastic_strain
         : failure_criterion == FailureCriterion::principal_stress
             ? critical_principal_stress
             : critical_shear_strain;
}

bool SpgOptions::can_fail() const
{
  return critical_value() <
         (failure_criterion == FailureCriterion::principal_stress ? never_stress
                                                                  : never);
}
} // namespace sabot
