#ifndef verification_metals_h
#define verification_metals_h

#include "sabot/materials/elastic_base.h"

#include <memory>
#include <string>
#include <vector>

namespace sabot
{
struct JohnsonCookParameters;
struct MieGruneisenParameters;

/**
 * The law of prm/materials/@p name.prm, read as a scene reads it, so that a
 * problem judges the metal that users get. @p changes are entries below the
 * material in SI or with a unit, e.g. "Johnson-Cook/Damage=true" or
 * "Model=Elastic". Laws have no state of their own: equal calls share one.
 * Not collective. Throws InputError for a missing file or entry.
 */
std::shared_ptr<const Material>
metal(const std::string &name, const std::vector<std::string> &changes = {});

/** Density [kg/m^3], Young's modulus [Pa] and Poisson's ratio of that file. */
const ElasticConstants &elastic_constants(const std::string &name);

/** Value in SI units of an entry of that file, e.g. of "Johnson-Cook/Specific
    heat" [J/kg/K]; for the exact answer that a problem compares with. */
double metal_entry(const std::string &name, const std::string &entry);

/** Parameters of the Johnson-Cook law of that file, fracture included but
    damage off; for variants and exact answers. */
JohnsonCookParameters johnson_cook_parameters(const std::string &name);

/** Shock data of that file. */
MieGruneisenParameters mie_gruneisen_parameters(const std::string &name);

/** "Entry=value" with all digits of @p value (SI), as a change of metal(). */
std::string change(const std::string &entry, const double value);

/** Elastic constants of 6061-T6 aluminum, the metal of most problems. */
const ElasticConstants &aluminum();

/** Its yield stress [Pa], slow and at room temperature. */
double aluminum_yield_stress();

/** Hypoelastic, with density and Young's modulus of 6061-T6 and any Poisson's
    ratio: 0 makes a bar one-dimensional. */
std::shared_ptr<const Material> elastic(const double poisson_ratio = 0.33);

/**
 * J2 plasticity with the elastic constants of 6061-T6: sigma_y = @p yield +
 * @p modulus eps_p [Pa], the isotropic fraction of the hardening from 0
 * (kinematic) to 1.
 */
std::shared_ptr<const Material>
hardening_aluminum(const double yield, const double modulus,
                   const double isotropic_fraction = 1.);

/** The same that yields where 6061-T6 does, with 150 MPa of hardening: what
    problems of failure and debris are made of. */
std::shared_ptr<const Material> hardening_aluminum();

/** Copper of the Taylor bar benchmark, prm/materials/copper-taylor.prm. */
std::shared_ptr<const Material> taylor_copper();
} // namespace sabot

#endif
