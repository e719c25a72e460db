#ifndef sabot_bodies_spg_second_gradient_h
#define sabot_bodies_spg_second_gradient_h

#include "sabot/base/types.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/kernels/vec.h"

#include <vector>

namespace sabot
{
/**
 * The reference paper's stabilisation (Eqs. 3, 8, 13, 15) read as a
 * second-gradient form with history: with b_NJ^k = (grad grad Psi_J A)_k, A the
 * square root of the second moment of the zeroth-order functions,
 *
 *   F^k = sum dx (x) b^k,  D^k = sym(dF^k F^-1 - l F^k F^-1),
 *   s^k += rotation + C : D^k,
 *
 * k = 1..3. The three stresses s^k share the yield condition of the particle
 * and return with it. Held only by bodies that use it.
 */
class SecondGradient
{
public:
  SecondGradient(const double bulk_modulus, const double shear_modulus,
                 const std::size_t n_owned);

  /** Columns b^k per bond, over n_with_ghosts(). */
  AlignedVector<Mat> bond_gradient;
  /** J V s^k F^-T of all particles by columns. */
  struct Stresses
  {
    Mat columns[3];
  };
  AlignedVector<Stresses> generalized_stress;
  std::vector<double> work; // [J] per owned particle

  /** A kernel update: F^k start anew, stresses stay. */
  void restart();

  /** Trial stresses of particle @p i. @p l: F_new F_old^-1 - 1 of the middle,
      @p F_inverse: of the new F. @return 3/2 sum s^k : s^k (deviators). */
  double trial(const std::size_t i, const BondList &bonds, const Vec *x,
               const Mat &l, const Mat &F_inverse);

  /** Return by @p theta; @p volume: current. @return what the form adds to
      the particle's own generalised stress (before F^-T). */
  Mat finish(const std::size_t i, const double theta, const double volume,
             const Mat &F_inverse_transposed);

  /** Add the forces on owned nodes, after all particles are finished.
      Collective. */
  void gather(const BondList &bonds, const GhostExchange &exchange,
              const std::size_t n_owned, Vec *force);

  template <typename Visit>
  void visit_state(const Visit &visit)
  {
    visit("second gradient", higher_gradient);
    visit("second gradient stress", stress);
    visit("second gradient work", work);
  }

private:
  const double K, G;
  AlignedVector<Mat> higher_gradient; // F^k, [3 i + k]
  AlignedVector<Mat> stress;          // s^k, [3 i + k]
  Mat old_stress[3], strain[3], spatial[3];
};
} // namespace sabot

#endif
