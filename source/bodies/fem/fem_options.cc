// What a scene may say about a body of finite elements.
#include "sabot/bodies/fem/fem_options.h"

#include "sabot/base/error.h"
#include "sabot/base/parameters.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/fem/one_point.h"

namespace sabot
{
namespace
{
/** A limit that can be reached; 1e10 and more was a word for never. */
std::optional<double> reachable(const std::optional<double> limit)
{
  constexpr double old_never = 1e10;
  return limit && *limit < old_never ? limit : std::nullopt;
}
} // namespace

void FemOptions::declare_parameters(Parameters &prm)
{
  Registry<Hexahedra>::declare_knob(prm, "Integration", "one point",
                                    "Points of a cell.");
  Registry<OnePoint>::declare_knob(prm, "Hourglass control", hourglass_by_law,
                                   "Of cells with one point.");
  prm.declare_knob("Hourglass coefficient", "0.1",
                   quantity(Dimension::none, 0., 1.), "Usually 0.03 to 0.15.");
  prm.declare_entry("Heat conduction", "false", boolean(),
                    "Implicit conduction inside the body, faces insulated. "
                    "Needs a law with temperature and conductivity.");
  prm.declare_entry("Conduction interval", "1 us",
                    quantity(Dimension::time, 0., 1e3),
                    "Time between conduction steps.");
  prm.declare_entry(
      "Objective rate", "Jaumann", one_of("Jaumann|Green-Naghdi"),
      "Rate of the stress: with the spin of the velocity gradient, or with "
      "that of the rotation R of F = R U, which does not oscillate in large "
      "elastic shear.");
  prm.declare_knob("Linear bulk viscosity", "0.06",
                   quantity(Dimension::none, 0., 1.),
                   "Coefficient of rho c h |div v| in compression.");
  prm.declare_knob("Quadratic bulk viscosity", "1.5",
                   quantity(Dimension::none, 0., 10.),
                   "Coefficient of rho h^2 (div v)^2 in compression.");
  prm.declare_knob("Erosion plastic strain", "never",
                   word_or("never", quantity(Dimension::none, 0.)),
                   "A cell is eroded when its effective plastic strain "
                   "exceeds this.");
  prm.declare_knob("Erosion damage", "never",
                   word_or("never", quantity(Dimension::none, 0.)),
                   "A cell is eroded when the material's damage reaches this "
                   "(1: fully damaged).");
  prm.declare_knob("Erosion step", "never",
                   word_or("never", quantity(Dimension::time, 0., 1.)),
                   "A cell is eroded when its own stable step falls below "
                   "this.");
  prm.declare_knob("Inversion", "stop", one_of("stop|erode|shrink step"),
                   "What to do when a cell is about to turn inside out: stop "
                   "the run, erode the cell, or (shrink step) let no step "
                   "take more than a quarter of a cell's volume.");
  MassScalingOptions::declare_parameters(prm);
}

FemOptions FemOptions::parse(const Parameters &prm, const std::string &path)
{
  FemOptions o;
  o.integration = prm.get("Integration");
  o.hourglass = prm.get("Hourglass control");
  o.conducts_heat = prm.get_bool("Heat conduction");
  o.conduction_interval = get_quantity(prm, "Conduction interval");
  o.objective_rate = prm.get("Objective rate") == "Jaumann"
                         ? ObjectiveRate::jaumann
                         : ObjectiveRate::green_naghdi;
  o.hourglass_coefficient = get_quantity(prm, "Hourglass coefficient");
  o.bulk_viscosity_linear = get_quantity(prm, "Linear bulk viscosity");
  o.bulk_viscosity_quadratic = get_quantity(prm, "Quadratic bulk viscosity");
  o.erosion_plastic_strain =
      reachable(get_optional_quantity(prm, "Erosion plastic strain"));
  o.erosion_damage = reachable(get_optional_quantity(prm, "Erosion damage"));
  // Not less than 0 s, which was a word for never.
  o.erosion_step = get_optional_quantity(prm, "Erosion step").value_or(0.);
  const std::string inversion = prm.get("Inversion");
  o.inversion = inversion == "erode"  ? Inversion::erode
                : inversion == "stop" ? Inversion::stop
                                      : Inversion::shrink;
  o.mass_scaling = MassScalingOptions::parse(prm, path);
  if (o.mass_scaling.is_on() && o.inversion == Inversion::shrink)
    throw InputError(
        path + "/Smallest step",
        "cannot be kept with \"Inversion = shrink step\", by which "
        "steps follow the volumes of cells, whatever their mass; "
        "use stop or erode");
  if (o.mass_scaling.is_on() && o.erosion_step >= o.mass_scaling.smallest_step)
    throw InputError(path + "/Smallest step",
                     "has no effect: cells that need mass for it are eroded by "
                     "\"Erosion step\" = " +
                         prm.get("Erosion step") +
                         "; remove one of the two, or erode below a shorter "
                         "step");
  return o;
}

bool FemOptions::erodes() const
{
  return !erosion_limits().empty() || erosion_step > 0. ||
         inversion == Inversion::erode;
}

std::vector<ErosionLimit> FemOptions::erosion_limits() const
{
  std::vector<ErosionLimit> limits;
  if (erosion_plastic_strain)
    limits.push_back({"effective plastic strain", "Erosion plastic strain",
                      *erosion_plastic_strain});
  if (erosion_damage)
    limits.push_back({"damage", "Erosion damage", *erosion_damage});
  return limits;
}
} // namespace sabot
