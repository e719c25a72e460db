#ifndef sabot_bodies_spg_stiffness_bound_h
#define sabot_bodies_spg_stiffness_bound_h

#include <cstddef>
#include <vector>

namespace sabot
{
struct SpgParts;

/**
 * Which part of its elastic stiffness owned particle @p i has in the bound of
 * the stable step, and in the linearized body: 1, but for failed metal that
 * gapes. Where the rule for failed metal leaves no tension, a particle
 * without stress whose volume is well above that of the start bears nothing
 * before it has closed; its bulk viscosity is left, stable with
 *
 *   min(1, 4 (c1 + c2/10) V_0/V)
 *
 * of the stiffness. Well above: by a quarter as a rule. A kernel update, at
 * which this is asked anew, comes before the volume has fallen by a tenth
 * (LagrangianKernel::largest_compression()), and 13 % are left for the step in
 * which that is seen. c2/10: for what closes by a tenth of the wave speed.
 * Local.
 */
double stiffness_share(const SpgParts &body, const std::size_t i);

/**
 * Rows r_I [N/m] that bound the elastic part of the linearized body,
 *
 *   u . K u <= sum r_I |u_I|^2,
 *
 * so that any frequency is at most the largest sqrt(r_I/m_I). By Cauchy and
 * Schwarz for each particle's displacement gradient L_N = sum u_I (x) g_NI,
 * the particle itself included, with s_N = sum |g_NI| and l_N the largest
 * eigenvalue of G_N = sum g_NI (x) g_NI/|g_NI|,
 *
 *   (tr L_N)^2 <= s_N sum (g_NI . u_I)^2/|g_NI|,  |L_N|^2 <= l_N sum |g_NI|
 *   |u_I|^2,
 *   r_I = largest eigenvalue of
 *         sum over N of V_N ( lambda s_N g (x) g/|g| + 2 mu l_N |g| 1 ).
 *
 * In a cloud whose neighbors lie all around that is a third of the rows of
 * absolute values, V_N rho c^2 s_N |g|, which a neighborhood on a line has.
 * V_N times stiffness_share(). Owned particles; collective: inverse moments of
 * ghosts are exchanged. Equal bits on every number of ranks.
 * @param wanted  [n_local] whose rows are asked for; zero for all others
 * @param spends_stress  the generalized stress is found anew afterwards, and
 * moments of ghosts may stand in its place
 */
std::vector<double> elastic_row_bounds(const SpgParts &body,
                                       const std::vector<char> &wanted,
                                       const bool spends_stress = true);

/** Of owned particles and ghosts, those that are marked and those that share a
    bond with one. @p marked [n_local], of owned particles. Collective. */
std::vector<char> with_neighbors(const SpgParts &body,
                                 std::vector<char> marked);
/** The same of those with cracks. Collective. */
std::vector<char> beside_cracks(const SpgParts &body);
} // namespace sabot

#endif
