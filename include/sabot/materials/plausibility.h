#ifndef sabot_materials_plausibility_h
#define sabot_materials_plausibility_h

#include <string>
#include <vector>

namespace sabot
{
class Material;
class Parameters;
struct ElasticConstants;

/**
 * What looks like a unit gone wrong in the values of a material: each a line
 * "path of the entry: what was found, what is usual". Values that no solid has
 * are told from those that are merely odd by wide margins, so that cards of
 * real materials pass: yield stresses over Young's modulus from 1e-5 to 0.2,
 * densities of solids, temperatures in kelvin, melting points of the common
 * metals (told by density and modulus) that are not those in degrees Celsius.
 * Melting points: ASM Handbook vol. 1 and 2, liquidus; customary cards round
 * them by a few degrees.
 *
 * @p prm: the material's subsection is entered, that of its law is not.
 */
std::vector<std::string> implausible_values(Parameters &prm,
                                            const std::string &path,
                                            const ElasticConstants &elastic,
                                            const Material &material);
} // namespace sabot

#endif
