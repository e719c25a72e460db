// Stabilization by the residual of each bond, with history (doc/theory-spg.md):
// what a bond's vector differs from F X, as a spring that yields with the
// metal.
#include "sabot/base/registry.h"
#include "sabot/bodies/spg/crack_forces.h"
#include "sabot/bodies/spg/linearized_body.h"
#include "sabot/bodies/spg/spg_step.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"
#include "sabot/bodies/spg/stiffness_bound.h"

namespace sabot
{
namespace
{
/** Sums over the bonds of one particle. */
struct ResidualSums
{
  Pack on_bond[3][3] = {};  // w e (x) dx
  Pack on_residual[6] = {}; // w e (x) e: xx, yy, zz, xy, yz, xz
  Pack residual[3] = {};    // w e
  Pack old_trial = {}, old_square = {};

  void add(const Pack w, const Pack e[3], const Pack e_old[3], const Pack dx[3])
  {
    const Pack we[3] = {w * e[0], w * e[1], w * e[2]};
    for (int d = 0; d < 3; ++d)
    {
      residual[d] += we[d];
      on_residual[d] += we[d] * e[d];
      on_residual[3 + d] += we[d == 1] * e[d == 0 ? 1 : 2];
      for (int c = 0; c < 3; ++c)
        on_bond[d][c] += we[d] * dx[c];
    }
    old_trial += we[0] * e_old[0] + we[1] * e_old[1] + we[2] * e_old[2];
    old_square +=
        w * (e_old[0] * e_old[0] + e_old[1] * e_old[1] + e_old[2] * e_old[2]);
  }
};

/**
 * Per bond the residual e = dx - F dX, by increments with the history of theta;
 * per particle the energy 1/2 k sum w |theta e|^2 with
 *
 *   k = alpha mu V / S,  S = sum phi |xi|^2,
 *
 * w the scaled weight. As a stress of the modulus mu whose energy is W, their
 * mean square 3 mu (2 W/V) yields together with the deviator, and theta is what
 * the return leaves of it.
 */
class BondResidual : public Stabilization
{
public:
  explicit BondResidual(const double coefficient) : coefficient(coefficient) {}

  void allocate(const SpgParts &body) override
  {
    Stabilization::allocate(body);
    stiffness.resize(done.size());
    factor.assign(done.size(), 1.);
  }
  void extend(const std::size_t n) override
  {
    Stabilization::extend(n);
    stiffness.resize(n);
    factor.resize(n, 1.);
  }
  void carry_bonds(const BondList &bonds) override { bonds.carry(residual); }
  void renew_ghosts(const SpgParts &body) override
  {
    previous_position = body.nodes.position;
  }
  void renew_images(const SpgParts &body) override
  {
    body.exchange.update_positions(previous_position.data());
  }
  void compute_forces(SpgParts &body, const double dt) override;
  void begin_kernel_update(const SpgParts &body) override;
  void follow_functions(const SpgParts &body) override;
  void end_kernel_update(const SpgParts &body,
                         const std::vector<char> &was_lost) override;
  void begin_crack_update(const SpgParts &body,
                          const std::vector<std::uint32_t> &some) override
  {
    for (const std::uint32_t i : some)
      settle_factor(body.bonds, i);
  }
  void carry_rows(const BondList &bonds,
                  const std::vector<std::uint32_t> &rows) override
  {
    bonds.carry_rows(residual, rows);
  }
  void end_crack_update(const SpgParts &body,
                        const std::vector<std::uint32_t> &rows) override
  {
    for (const std::uint32_t i : rows)
    {
      find_stiffness(body, i);
      take_linear_part(body, i);
    }
  }
  bool renew_forces(SpgParts &body, const CrackedParticles &cracked) override;
  double held_energy(const SpgParts &body, const std::size_t i) const override;
  void add_row_sums(const SpgParts &body,
                    std::vector<double> &sums) const override;
  void apply_linearized(const SpgParts &body, const AlignedVector<Vec> &motion,
                        AlignedVector<Vec> &force) override;
  void visit_bonds(StateVisitor &visitor, const SpgParts &body,
                   const StateRows &rows) override;
  void visit_state(StateVisitor &visitor, const StateItems &items) override;
  void list_memory(MemoryTable &table) const override
  {
    Stabilization::list_memory(table);
    table.add("bonds: residuals", residual);
    table.add("positions of the last step", previous_position);
    table.add("stabilization: stiffness", stiffness);
    table.add("stabilization: return factors", factor);
  }

  // Of the step, see spg_step.h
  static constexpr bool has_bond_forces = true;
  void trial(const ParticleRange &range, SpgParts &body);
  double add_stress(const std::size_t i, const std::size_t k, const double V,
                    const StepWork &work, Mat &spatial);
  void exchange(const SpgParts &body);
  /** theta k sum w e: what a particle's own ends of its bonds do to it. */
  Vec own_bond_forces(const std::size_t i, const std::size_t k) const
  {
    return factor[i] * stiffness[i] * batch.residual_sum[k];
  }
  Vec bond_forces_as_they_are(const BondList &bonds, const std::size_t i,
                              const double theta_k) const;
  struct BondForce
  {
    const float *weight;     // w [1/m^2]
    const BondVec *residual; // e [m]
    void prefetch(const std::size_t reverse) const
    {
      __builtin_prefetch(&residual[reverse]);
    }
    Vec operator()(const std::size_t b, const std::size_t reverse,
                   const double stiffness_there) const
    {
      return (weight[b] * stiffness_there) * load(residual[reverse]);
    }
  };
  BondForce bond_forces(const BondList &bonds) const
  {
    return {bonds.scaled_weight.data(), residual.data()};
  }
  void add_forces(const SpgParts &) {}
  double linear_stiffness(const std::size_t i) const { return stiffness[i]; }
  void add_linearized(const SpgParts &, const AlignedVector<Vec> &,
                      const AlignedVector<Vec> &)
  {
  }

private:
  /** theta into the residuals of particle @p i. */
  void settle_factor(const BondList &bonds, const std::size_t i);
  /** k_N of particle @p i by its present functions. */
  void find_stiffness(const SpgParts &body, const std::size_t i);
  /** The linear part of the residuals of particle @p i out of them: it belongs
      to F. */
  void take_linear_part(const SpgParts &body, const std::size_t i);
  /** Into place @p k of the batch; @p k_N: of the particle. */
  void keep(const ResidualSums &sums, const double k_N, const std::size_t k);

  const double coefficient;             // alpha
  AlignedVector<BondVec> residual;      // e [m], over n_with_ghosts()
  AlignedVector<Vec> previous_position; // of the last evaluation, with ghosts
  std::vector<double> stiffness;        // k_N [N m]
  std::vector<double> factor;           // theta, due on residuals
  /** Sums over bonds of one batch. */
  struct Batch
  {
    // k w times the squares: trial, old with trial, old [J]
    double trial_square[spg_batch_size], old_trial[spg_batch_size],
        old_square[spg_batch_size];
    Mat residual_on_bond[spg_batch_size];     // sum w e (x) dx
    Mat residual_on_residual[spg_batch_size]; // sum w e (x) e
    Vec residual_sum[spg_batch_size];         // sum w e
  };
  Batch batch;
};

inline void BondResidual::keep(const ResidualSums &sums, const double k_N,
                               const std::size_t k)
{
  const auto &B = sums.on_bond;
  const auto &R = sums.on_residual;
  const Pack zero = {};
  for (int d = 0; d < 3; ++d)
    batch.residual_on_bond[k].row[d] =
        sum_lanes(B[d][0], B[d][1], B[d][2], zero);
  const Pack diagonal = sum_lanes(R[0], R[1], R[2], sums.old_trial),
             mixed = sum_lanes(R[3], R[4], R[5], sums.old_square);
  batch.residual_on_residual[k] = {{vec(diagonal[0], mixed[0], mixed[2]),
                                    vec(mixed[0], diagonal[1], mixed[1]),
                                    vec(mixed[2], mixed[1], diagonal[2])}};
  batch.residual_sum[k] =
      sum_lanes(sums.residual[0], sums.residual[1], sums.residual[2], zero);
  batch.trial_square[k] = k_N * (diagonal[0] + diagonal[1] + diagonal[2]);
  batch.old_trial[k] = k_N * diagonal[3];
  batch.old_square[k] = k_N * mixed[3];
}

void BondResidual::trial(const ParticleRange &range, SpgParts &body)
{
  // By increments, which needs no dX, four bonds at once:
  //   e = dx - F_new F_old^-1 (dx_old - theta_old e_old).
  StepWork &work = body.work;
  const BondList &bonds = body.bonds;
  const Vec *const x = body.nodes.position.data();
  const Vec *const x_old = previous_position.data();
  const double *const volume = body.fields.kernel_reference_volume.data();
  const std::uint32_t *const neighbor = bonds.neighbor.data();
  const float *const weight = bonds.scaled_weight.data();
  BondVec *const stored_residual = residual.data();
  const double modulus = 3. * body.points.law().shear_modulus();
  for (std::size_t i = range.begin; i < range.end; ++i)
  {
    const std::size_t k = i - range.begin;
    const Mat A = work.relative_gradient[k]; // F_new F_old^-1 - 1
    const Vec xi = x[i], xi_old = x_old[i];
    const double theta = factor[i];
    ResidualSums sums;
    const std::size_t last = bonds.packed_end(i);
    for (std::size_t b = bonds.begin(i); b < last; b += n_lanes)
    {
      Pack dx[3], carried[3], e_old[3], e[3];
      gather(x, neighbor + b, dx);
      gather(x_old, neighbor + b, carried);
      load_bonds(stored_residual + b, e_old);
      for (int d = 0; d < 3; ++d)
      {
        e_old[d] *= theta;
        dx[d] -= xi[d];
        carried[d] = carried[d] - xi_old[d] - e_old[d];
      }
      for (int d = 0; d < 3; ++d)
        e[d] = dx[d] - carried[d] -
               (A.row[d][0] * carried[0] + A.row[d][1] * carried[1] +
                A.row[d][2] * carried[2]);
      // As stored: forces along e itself keep the angular momentum exact.
      store_bonds(stored_residual + b, e);
      sums.add(load_floats(weight + b), e, e_old, dx);
    }
    keep(sums, stiffness[i], k);
    work.extra_square[k] = modulus * batch.trial_square[k] / volume[i];
  }
}

inline double BondResidual::add_stress(const std::size_t i, const std::size_t k,
                                       const double, const StepWork &work,
                                       Mat &spatial)
{
  // sum t (x) F dX with F dX = dx - e, t = k w theta e_trial: the residuals'
  // part of the stress.
  const double theta = work.return_factor[k];
  const double theta_k = theta * stiffness[i];
  spatial = spatial - theta_k * (batch.residual_on_bond[k] -
                                 theta * batch.residual_on_residual[k]);
  // Work of the mean of old and new bond forces along the change of e.
  done[i] += 0.5 * ((1. - theta) * batch.old_trial[k] - batch.old_square[k] +
                    theta * batch.trial_square[k]);
  factor[i] = theta;
  return theta_k;
}

inline Vec BondResidual::bond_forces_as_they_are(const BondList &bonds,
                                                 const std::size_t i,
                                                 const double theta_k) const
{
  Pack sum[3] = {};
  for (std::size_t b = bonds.begin(i); b < bonds.packed_end(i); b += n_lanes)
  {
    Pack e[3];
    load_bonds(&residual[b], e);
    const Pack w = load_floats(&bonds.scaled_weight[b]);
    for (int d = 0; d < 3; ++d)
      sum[d] += w * e[d];
  }
  const Pack zero = {};
  return theta_k * sum_lanes(sum[0], sum[1], sum[2], zero);
}

void BondResidual::exchange(const SpgParts &body)
{
  body.bonds.update_ghosts(residual.data());
  std::copy(body.nodes.position.begin(), body.nodes.position.end(),
            previous_position.begin());
}

inline void BondResidual::settle_factor(const BondList &bonds,
                                        const std::size_t i)
{
  if (factor[i] == 1.) // most have not yielded
    return;
  for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    residual[b] = store_bond(factor[i] * load(residual[b]));
  factor[i] = 1.;
}

void BondResidual::begin_kernel_update(const SpgParts &body)
{
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
    settle_factor(body.bonds, i);
}

inline void BondResidual::find_stiffness(const SpgParts &body,
                                         const std::size_t i)
{
  const ParticleApproximation &functions = body.approximation;
  const double mu = body.points.law().shear_modulus(),
               S = std::max(functions.spread[i],
                            0.5 * functions.intact_spread[i]);
  stiffness[i] =
      functions.lost_direction[i] || S == 0.
          ? 0.
          : coefficient * mu * body.fields.kernel_reference_volume[i] / S;
}

void BondResidual::follow_functions(const SpgParts &body)
{
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
    find_stiffness(body, i);
}

inline void BondResidual::take_linear_part(const SpgParts &body,
                                           const std::size_t i)
{
  const BondList &bonds = body.bonds;
  const std::uint32_t *const neighbor = bonds.neighbor.data();
  const Vec *const X = body.fields.kernel_reference_position.data();
  const std::size_t first = bonds.begin(i), last = bonds.packed_end(i);
  const Vec Xi = X[i];
  Pack dX[3], e[3], sum[3][3] = {};
  const auto take = [&](const std::size_t b)
  {
    gather(X, neighbor + b, dX);
    load_bonds(&residual[b], e);
    for (int d = 0; d < 3; ++d)
      dX[d] -= Xi[d];
  };
  for (std::size_t b = first; b < last; b += n_lanes)
  {
    take(b);
    const Pack w = load_floats(&bonds.weight[b]);
    for (int d = 0; d < 3; ++d)
      for (int c = 0; c < 3; ++c)
        sum[d][c] += w * e[d] * dX[c];
  }
  const Pack zero = {};
  const Mat A = Mat{{sum_lanes(sum[0][0], sum[0][1], sum[0][2], zero),
                     sum_lanes(sum[1][0], sum[1][1], sum[1][2], zero),
                     sum_lanes(sum[2][0], sum[2][1], sum[2][2], zero)}} *
                body.approximation.moment_inverse[i];
  for (std::size_t b = first; b < last; b += n_lanes)
  {
    take(b);
    for (int d = 0; d < 3; ++d)
      e[d] -= A(d, 0) * dX[0] + A(d, 1) * dX[1] + A(d, 2) * dX[2];
    store_bonds(&residual[b], e);
  }
}

void BondResidual::end_kernel_update(const SpgParts &body,
                                     const std::vector<char> &was_lost)
{
  const BondList &bonds = body.bonds;
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
  {
    take_linear_part(body, i);
    // Residuals that grew while they had no stiffness hold no energy.
    if (was_lost[i] && !body.approximation.lost_direction[i])
      std::fill(residual.begin() + bonds.begin(i),
                residual.begin() + bonds.packed_end(i), BondVec{});
  }
}

double BondResidual::held_energy(const SpgParts &body,
                                 const std::size_t i) const
{
  const BondList &bonds = body.bonds;
  if (stiffness[i] == 0.)
    return 0.;
  Pack square = {};
  for (std::size_t b = bonds.begin(i); b < bonds.packed_end(i); b += n_lanes)
  {
    Pack e[3];
    load_bonds(&residual[b], e);
    square += load_floats(&bonds.scaled_weight[b]) *
              (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
  }
  const Pack zero = {};
  const double theta = factor[i];
  return 0.5 * stiffness[i] * theta * theta *
         sum_lanes(square, zero, zero, zero)[0];
}

void BondResidual::add_row_sums(const SpgParts &body,
                                std::vector<double> &sums) const
{
  // Of the springs, as if F did not follow the particles.
  const BondList &bonds = body.bonds;
  std::vector<double> k(body.nodes.size());
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
    k[i] = stiffness[i] * stiffness_share(body, i);
  body.exchange.make_whole(k.data());
  body.exchange.update(k.data());
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
  {
    double row = 0.;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      row += 2. * bonds.scaled_weight[b] * (k[i] + k[bonds.neighbor[b]]);
    sums[i] += row;
  }
}

void BondResidual::visit_bonds(StateVisitor &visitor, const SpgParts &body,
                               const StateRows &rows)
{
  // Rows end in places of no bond, which stay zero.
  if (visitor.is_restoring())
    residual.assign(body.bonds.n_with_ghosts(), BondVec{});
  visitor.visit_rows("bond residual", residual.data(), body.bonds.capacity(),
                     rows);
  if (visitor.is_restoring())
    body.bonds.update_ghosts(residual.data());
}

void BondResidual::visit_state(StateVisitor &visitor, const StateItems &items)
{
  Stabilization::visit_state(visitor, items);
  visitor.visit_items("previous position", previous_position, items);
  visitor.visit_items("bond stiffness", stiffness, items);
  visitor.visit_items("residual factor", factor, items);
}

void BondResidual::compute_forces(SpgParts &body, const double dt)
{
  run_spg_step(body, *this, dt);
}

bool BondResidual::renew_forces(SpgParts &body, const CrackedParticles &cracked)
{
  renew_crack_forces(body, *this, cracked);
  return true;
}

void BondResidual::apply_linearized(const SpgParts &body,
                                    const AlignedVector<Vec> &motion,
                                    AlignedVector<Vec> &force)
{
  apply_linearized_body(body, *this, motion, force);
}

const Registry<Stabilization>::Add registered(
    {"bond residual",
     "springs with history against what the linear functions do not see; they "
     "yield with the metal.",
     [](Parameters &prm)
     {
       prm.declare_knob("Stabilization coefficient", "4",
                        quantity(Dimension::none, 0., 20.),
                        "Stiffness of the bond residual in shear moduli; 3 to "
                        "5 give the same answers.");
     },
     [](const Parameters &prm, const std::string &)
     {
       const double alpha = get_quantity(prm, "Stabilization coefficient");
       return [alpha] { return std::make_unique<BondResidual>(alpha); };
     }});
} // namespace
} // namespace sabot
