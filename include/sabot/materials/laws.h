#ifndef sabot_materials_laws_h
#define sabot_materials_laws_h

#include "sabot/materials/elastic_base.h"
#include "sabot/materials/johnson_cook.h"
#include "sabot/materials/mie_gruneisen.h"
#include "sabot/materials/steinberg_guinan.h"
#include "sabot/materials/zerilli_armstrong.h"

namespace sabot
{
/**
 * Hypoelastic deviator: the objective rate of s is 2 G dev(D). Which rate is
 * the body's business, as it rotates the stress before. For strains of metals;
 * along closed cycles of large shear the Jaumann rate leaves stress behind. It
 * never yields.
 *   s <- s + 2 G dev(D dt),
 * s in the frame of the end of the step; no state of its own. For small strains
 * it is Hooke's law. Pressure is the equation of state's.
 */
class Elastic : public ElasticBase
{
public:
  using ElasticBase::ElasticBase;

protected:
  void update_deviator(const MaterialBatch &batch,
                       Scratch &scratch) const override;
};

/** J2 plasticity with mixed hardening: a line, or a table. */
struct HardeningParameters
{
  double yield_stress = 0.;       // [Pa]
  double hardening_modulus = 0.;  // d sigma_y / d eps_p [Pa]
  double isotropic_fraction = 1.; // 1: isotropic, 0: kinematic
  /** When not empty, stress in monotonic loading against effective plastic
      strain, in place of yield stress and modulus; constant beyond its end. */
  std::vector<double> table_strain = {}, table_stress = {};
};

/**
 * Radial return in closed form (J. C. Simo and T. J. R. Hughes, Computational
 * Inelasticity, 1998, box 3.2): with
 * xi = s - alpha, the hardening curve Y(eps) in monotonic loading and the
 * isotropic fraction beta,
 *
 *   q(xi) - 3 G d - (1 - beta)(Y(eps + d) - Y(eps))
 *         = Y(0) + beta (Y(eps + d) - Y(0)),
 *   d_alpha = (1 - beta)(Y(eps + d) - Y(eps)) xi/q.
 *
 * Y is a line or piecewise linear; the return walks through its pieces. States:
 * the effective plastic strain, and where beta < 1 the back stress alpha
 * (deviatoric, rotated with the stress). No effect of rate or temperature.
 */
class HardeningPlasticity : public ElasticBase
{
public:
  /** Tables must have been checked: strains from 0 on, increasing; stresses
      not decreasing. */
  HardeningPlasticity(const ElasticConstants &elastic,
                      const HardeningParameters &parameters,
                      const Eos &eos = {});

  /** Y(0) [Pa]. */
  std::optional<double> initial_yield_stress() const override
  {
    return pieces[0].stress;
  }

protected:
  std::vector<StateVariable> law_variables() const override;
  void update_deviator(const MaterialBatch &batch,
                       Scratch &scratch) const override;

private:
  /**
   * A part of Y on which it is a line.
   * Y(eps) = stress + slope (eps - strain) up to the strain of the next piece
   * [Pa].
   */
  struct Piece
  {
    double strain, stress, slope; // at the start of the piece
  };
  /** The piece that holds @p eps. */
  std::size_t piece_at(const double eps) const;
  /** d for the trial @p q [Pa] at strain @p eps, 0 below yield, and what Y
     grows by [Pa]. */
  double increment(const double q, const double eps, double &hardening) const;
  /** s - alpha of a pack of points from @p k on. */
  template <bool kinematic>
  void relative_stress(const MaterialBatch &batch, const std::size_t k,
                       WidePack xi[6]) const;
  /** The return of a trial deviator, with or without a back stress. */
  template <bool kinematic>
  void return_deviator(const MaterialBatch &batch) const;

  std::vector<Piece> pieces; // at least one, by strain
  const double isotropic_fraction;
};

/**
 * Compressible neo-Hookean (J. C. Simo and K. S. Pister, Comput. Methods Appl.
 * Mech. Eng. 46 (1984) 201, doi 10.1016/0045-7825(84)90062-8): deviator of the
 * Cauchy stress G J^(-5/3) dev(F F^T), from U = G/2 (J^(-2/3) tr F F^T - 3);
 * with the pressure -K ln J of the bulk modulus U has the volumetric part K (J
 * ln J - J + 1). Path-independent: needs the deformation gradient, and the old
 * stress does not count. Stiffens with stretch: `stiffening` bounds the largest
 * eigenvalue of F F^T by its row sums (Gershgorin).
 */
class NeoHookean : public ElasticBase
{
public:
  using ElasticBase::ElasticBase;
  bool needs_deformation_gradient() const override { return true; }
  bool stiffens() const override { return true; }

protected:
  void update_deviator(const MaterialBatch &batch,
                       Scratch &scratch) const override;
  void after_pressure(const MaterialBatch &batch,
                      const Scratch &scratch) const override;
};
} // namespace sabot

#endif
