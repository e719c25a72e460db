#ifndef sabot_bodies_spg_failure_repeated_update_h
#define sabot_bodies_spg_failure_repeated_update_h

#include "sabot/materials/material.h"

#include <optional>
#include <vector>

namespace sabot
{
/**
 * A law's update of a batch that can be taken back and made again with another
 * strain increment: rules for failed metal learn the pressure of the step from
 * the first update, and what of the strain the metal itself bears from the
 * pressure. Scratch space of a rule; local.
 */
class RepeatedUpdate
{
public:
  /** law.update(@p points), after a copy of their stress and state. */
  void first(const Material &law, const MaterialBatch &points);
  /** Stress and state as before first(), then law.update() with the strain
      increments @p strain [n_symmetric] (tensor components) and the squares
      @p extra_square [n] in place of the batch's. */
  void again(const Material &law, const MaterialBatch &points,
             const double (*strain)[max_batch_points],
             const double *extra_square);

  /**
   * After the law: @p heat [J/m^3 of now] to a point, and @p tension [Pa], a
   * mean stress that the law has in its energy and the rule takes away. The
   * temperature follows the heat; the equation of state's energy, too, and
   * without the tension's half of the work,
   *
   *   rho_0 de = J heat - J_mid tension tr d_eps/2.
   *
   * Left in, it would heat metal that gapes by the work of a stress that is not
   * there, and grow without bound as its volume goes up and down.
   */
  void add_heat(const Material &law, const MaterialBatch &points,
                const std::size_t k, const double heat,
                const double tension) const;

  /** Cauchy stress at the start of the step, in the frame of its end [Pa]. */
  double old_stress[n_symmetric][max_batch_points];

private:
  void find_rows(const Material &law);

  std::vector<double> old_states; // [row][max_batch_points]
  /** Rows that follow heat; nothing where the law has none. */
  std::optional<std::size_t> temperature, energy; // of an equation of state
};

/** Mean of the normal components of a stress or strain. */
inline double mean_part(const double s[n_symmetric])
{
  return (s[0] + s[1] + s[2]) / 3.;
}

/** Add @p part to the normal components. */
inline void add_mean_part(double s[n_symmetric], const double part)
{
  for (int c = 0; c < 3; ++c)
    s[c] += part;
}
} // namespace sabot

#endif
