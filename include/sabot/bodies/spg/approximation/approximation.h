#ifndef sabot_bodies_spg_approximation_approximation_h
#define sabot_bodies_spg_approximation_approximation_h

#include "sabot/base/memory_table.h"
#include "sabot/base/state_visitor.h"
#include "sabot/base/types.h"
#include "sabot/bodies/spg/spg_options.h"
#include "sabot/kernels/vec.h"

#include <vector>

namespace sabot
{
class BondList;
class ParticleExchange;
class LagrangianKernel;
struct NodalState;
struct ParticleFields;

/**
 * First-order meshfree functions of the particles in the configuration X of the
 * last kernel update. With xi = H^-1 dX, phi the mean of the spline at both
 * ends of a bond (so that phi is symmetric):
 *
 *   M_N = sum phi dX (x) dX,  g_NJ = phi M_N^-1 dX        (least squares),
 *   g_NJ = grad Psi_J(X_N), Psi convex                    (stored gradients).
 *
 * The moment is judged as sum phi xi (x) xi, in the undeformed shape of the
 * kernel, where a compressed but complete neighborhood looks like an intact
 * one: a direction counts as lost where its eigenvalue is below a fraction of
 * the intact middle one (doc/theory-spg.md).
 *
 * First order: sum g_NJ = 0 with the particle itself, sum dX (x) g_NJ = 1 where
 * no direction is lost, so that F is exact for linear fields on any cloud.
 * Frame: X, not the present configuration; weights do not change between
 * updates.
 */
class ParticleApproximation
{
public:
  explicit ParticleApproximation(const SpgOptions &options);

  void allocate(const std::size_t n_owned);
  /** Of bodies that grow: room for more particles, and for which owned ones the
      next update() says what intact is, as their neighborhoods have grown; what
      it was before is the least. */
  void extend(const std::size_t n_owned);
  void renew_intact(const std::vector<char> &grown) { has_grown = grown; }
  /** Weights of bonds, moments, lost directions, and where they are stored
      gradients, for the kernels and positions in @p fields. The first call
      defines what intact is. @p second_derivatives: where A grad grad Psi_J
      go, or null. Collective. H and X of ghosts must be up to date. Lost
      directions: eigenvalues e below 0.15 of the intact middle one, e0, get
      the inverse e/(0.15 e0)^2 instead of 1/e; with fewer than four bonds
      M^-1 = 0 (doc/theory/spg.md). What was lost is whole again only once
      its volume has closed. */
  void update(BondList &bonds, const ParticleFields &fields,
              const LagrangianKernel &kernel,
              AlignedVector<Mat> *second_derivatives);
  /** What is left of a particle's functions where some of its bonds go and
      kernels stay as they are. */
  struct CrackedRow
  {
    Mat moment_inverse; // M^-1 [1/m^2]
    double spread;      // S
    bool is_lost;       // lost a direction, now or before
    Mat gradient;       // F since the kernel update by these functions
  };
  /** Of owned particle @p i without the bonds that are marked in @p dead, at
      the positions @p x [m]. Weights are those that are stored, so that bonds
      which stay keep theirs. Least squares only. Local; changes nothing. */
  CrackedRow without_bonds(const BondList &bonds, const ParticleFields &fields,
                           const Vec *x, const std::size_t i,
                           const std::vector<char> &dead) const;
  void take(const std::size_t i, const CrackedRow &row)
  {
    moment_inverse[i] = row.moment_inverse;
    spread[i] = row.spread;
    lost_direction[i] = row.is_lost;
  }
  /** Row sums of the mass matrix (Wu & Wu 2018, Eq. 11) of the convex
      functions as lumped masses of the owned nodes, whose present masses are
      rho V [kg]. After the first update() only. Collective. */
  void set_convex_masses(NodalState &nodes, const BondList &bonds,
                         const ParticleExchange &exchange);

  bool stores_gradients() const { return stores; }
  /** Gradient g of the function of bond @p b's neighbor at its owned
      particle, @p dX to it, @p moment_inverse of that particle [1/m]. With
      stored gradients weight and moment are not looked at. */
  Vec gradient(const std::size_t b, const double weight,
               const Mat &moment_inverse, const Vec dX) const
  {
    return stores ? shape_gradient[b] : weight * (moment_inverse * dX);
  }
  /** Particles whose convex functions did not exist at the last update and that
      got damped least squares. */
  std::size_t n_fallbacks() const { return n_fallback; }

  /** Stored gradients; those of ghosts' bonds are exchanged when restoring. */
  void visit_bonds(StateVisitor &visitor, const BondList &bonds,
                   const StateRows &rows);
  void visit_state(StateVisitor &visitor, const StateItems &items);
  void list_memory(MemoryTable &table) const
  {
    table.add("inverse moments", moment_inverse);
    table.add("lost directions", lost_direction);
    table.add("spreads", spread);
    table.add("intact spreads", intact_spread);
    table.add("intact eigenvalues", intact_eigenvalue);
    table.add("bonds: gradients", shape_gradient);
    table.add("bonds: values for masses", shape_value);
  }

  // Owned particles
  AlignedVector<Mat> moment_inverse; // M^-1, lost directions damped [1/m^2]
  /** Whether the bonds of a particle no longer span space: for what failed
      metal carries. Until its volume has come back to that of the start,
      also where its neighborhood spans space again: a crack heals only once
      it has closed. */
  std::vector<char> lost_direction;
  std::vector<double> spread;        // S = sum phi |xi|^2
  std::vector<double> intact_spread; // S of the start
  // Per bond, ghosts' bonds included; only where gradients are stored
  AlignedVector<Vec> shape_gradient; // g [1/m]

private:
  template <typename Kernel>
  void find_moments(BondList &bonds, const ParticleFields &fields);
  void find_gradients(const BondList &bonds, const ParticleFields &fields,
                      const LagrangianKernel &kernel,
                      AlignedVector<Mat> *second_derivatives);
  template <typename Kernel>
  void find_gradients_with(const BondList &bonds, const ParticleFields &fields,
                           const LagrangianKernel &kernel,
                           AlignedVector<Mat> *second_derivatives);

  const SpgOptions::Approximation functions;
  const bool stores, has_tensor_kernel, grows;
  std::vector<char> has_grown;           // owned, until the next update()
  std::vector<double> intact_eigenvalue; // middle one of the intact moment
  std::vector<double> shape_value, own_shape_value; // for masses, then empty
  bool has_masses = false; // set_convex_masses() has been
  std::size_t n_fallback = 0;
};
} // namespace sabot

#endif
