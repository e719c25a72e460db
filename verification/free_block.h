#ifndef verification_free_block_h
#define verification_free_block_h

#include <vector>

namespace sabot
{
/**
 * Natural angular frequencies [rad/s] of a free isotropic cube of edge
 * @p length, ascending, the six rigid modes included as zeros: Rayleigh-Ritz
 * with products of Legendre polynomials up to total @p degree (Demarest 1971;
 * Visscher et al. 1991), an upper bound that converges exponentially.
 */
std::vector<double> free_cube_frequencies(const double length,
                                          const double density,
                                          const double lambda, const double mu,
                                          const unsigned int degree);
} // namespace sabot

#endif
