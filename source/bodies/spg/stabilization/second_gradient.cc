// Stabilization by second gradients (the reference paper's, with history).
#include "sabot/base/error.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/spg/linearized_body.h"
#include "sabot/bodies/spg/spg_step.h"
#include "sabot/bodies/spg/stabilization/stabilization.h"
#include "sabot/kernels/stress_update.h"

#include <cmath>

namespace sabot
{
namespace
{
/** J V s^k F^-T of a particle, by columns. */
struct HigherStresses
{
  Mat columns[3];
};
/** A tensor of third order. */
void mirror(HigherStresses &s, const unsigned int axes)
{
  const Vec signs = mirror_signs(axes);
  for (int k = 0; k < 3; ++k)
  {
    mirror(s.columns[k], axes);
    s.columns[k] = signs[k] * s.columns[k];
  }
}
HigherStresses operator*(const double copies, const HigherStresses &s)
{
  return {
      {copies * s.columns[0], copies * s.columns[1], copies * s.columns[2]}};
}

/**
 * The reference paper's stabilization (Wu & Wu 2018, Eqs. 3, 8, 13, 15) read as
 * a second-gradient form with history: with b_NJ^k = (grad grad Psi_J A)_k, A
 * the square root of the second moment of the zeroth-order functions,
 *
 *   F^k = sum dx (x) b^k,  D^k = sym(dF^k F^-1 - l F^k F^-1),
 *   s^k += rotation + C : D^k,
 *
 * k = 1..3, l = F_new F_old^-1 - 1. The three stresses s^k share the yield
 * condition of the particle and return with it.
 */
class SecondGradient : public Stabilization
{
public:
  bool needs_second_derivatives() const override { return true; }
  AlignedVector<Mat> *second_derivatives() override { return &bond_gradient; }
  void allocate(const SpgParts &body) override
  {
    Stabilization::allocate(body);
    higher_gradient.assign(3 * done.size(), Mat::zero());
    stress.assign(3 * done.size(), Mat::zero());
    K = body.points.law().bulk_modulus();
    G = body.points.law().shear_modulus();
  }
  void extend(const std::size_t n) override
  {
    Stabilization::extend(n);
    higher_gradient.resize(3 * n, Mat::zero());
    stress.resize(3 * n, Mat::zero());
  }
  void renew_ghosts(const SpgParts &body) override
  {
    generalized_stress.resize(body.nodes.size());
  }
  void compute_forces(SpgParts &body, const double dt) override;
  void end_kernel_update(const SpgParts &, const std::vector<char> &) override
  {
    // F^k start anew, stresses stay: sum dX (x) b^k = 0, as first-order
    // functions reproduce linear fields.
    std::fill(higher_gradient.begin(), higher_gradient.end(), Mat::zero());
  }
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
    table.add("bonds: second gradients", bond_gradient);
    table.add("second gradients", higher_gradient);
    table.add("second gradients: stress", stress);
    table.add("second gradients: generalized stress", generalized_stress);
  }

  // Of the step, see spg_step.h
  static constexpr bool has_bond_forces = false;
  void trial(const ParticleRange &range, SpgParts &body);
  double add_stress(const std::size_t i, const std::size_t k, const double V,
                    const StepWork &work, Mat &spatial);
  void exchange(const SpgParts &) {}
  int bond_forces(const BondList &) const { return 0; }
  void add_forces(SpgParts &body)
  {
    gather(body, generalized_stress, body.nodes.force.data());
  }
  double linear_stiffness(const std::size_t) const { return 0.; }
  void add_linearized(const SpgParts &body, const AlignedVector<Vec> &motion,
                      AlignedVector<Vec> &force);

private:
  double trial_of_particle(const std::size_t i, const std::size_t k,
                           const SpgParts &body, const Mat &l,
                           const Mat &F_inverse);
  /** Add the forces of @p generalized stresses on owned nodes. Collective. */
  void gather(const SpgParts &body, AlignedVector<HigherStresses> &generalized,
              Vec *force) const;

  double K = 0., G = 0.;              // [Pa]
  AlignedVector<Mat> bond_gradient;   // b^k by rows, over n_with_ghosts() [1/m]
  AlignedVector<Mat> higher_gradient; // F^k, [3 i + k]
  AlignedVector<Mat> stress;          // s^k, [3 i + k] [Pa]
  AlignedVector<HigherStresses> generalized_stress; // with ghosts [J]
  /** Between trial and return, of one batch. */
  struct Batch
  {
    Mat old_stress[3][spg_batch_size], strain[3][spg_batch_size],
        spatial[3][spg_batch_size];
  };
  Batch batch;
};

Mat symmetric(const Mat &a)
{
  return 0.5 * (a + transpose(a));
}

double contract(const Mat &a, const Mat &b)
{
  return dot(a.row[0], b.row[0]) + dot(a.row[1], b.row[1]) +
         dot(a.row[2], b.row[2]);
}

/** R s R^T with the Hughes-Winget rotation of the spin of @p l. */
Mat rotated(const Mat &s, const Mat &l)
{
  const double spin_of[3] = {0.5 * (l(0, 1) - l(1, 0)),
                             0.5 * (l(1, 2) - l(2, 1)),
                             0.5 * (l(0, 2) - l(2, 0))};
  const double *const spin[3] = {&spin_of[0], &spin_of[1], &spin_of[2]};
  double t[6] = {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
  double *const views[6] = {&t[0], &t[1], &t[2], &t[3], &t[4], &t[5]};
  rotate_symmetric(1, spin, views);
  return {
      {vec(t[0], t[3], t[5]), vec(t[3], t[1], t[4]), vec(t[5], t[4], t[2])}};
}

void SecondGradient::trial(const ParticleRange &range, SpgParts &body)
{
  StepWork &work = body.work;
  for (std::size_t i = range.begin; i < range.end; ++i)
  {
    const std::size_t k = i - range.begin;
    work.extra_square[k] =
        trial_of_particle(i, k, body, work.relative_gradient[k],
                          transpose(work.inverse_transpose[k]));
  }
}

/** Trial stresses of particle @p i, place @p k of its batch.
    @return 3/2 sum s^k : s^k of the deviators [Pa^2]. */
double SecondGradient::trial_of_particle(const std::size_t i,
                                         const std::size_t place,
                                         const SpgParts &body, const Mat &l,
                                         const Mat &F_inverse)
{
  const BondList &bonds = body.bonds;
  const Vec *const x = body.nodes.position.data();
  Mat now[3] = {Mat::zero(), Mat::zero(), Mat::zero()};
  for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
  {
    const Vec dx = x[bonds.neighbor[b]] - x[i];
    for (int k = 0; k < 3; ++k)
      add_outer(now[k], dx, bond_gradient[b].row[k]);
  }
  double square = 0.;
  for (int k = 0; k < 3; ++k)
  {
    Mat &F_k = higher_gradient[3 * i + k];
    const Mat mean = 0.5 * (F_k + now[k]);
    const Mat strain =
        symmetric((now[k] - F_k) * F_inverse - l * (mean * F_inverse));
    batch.strain[k][place] = strain;
    F_k = now[k];
    batch.spatial[k][place] = F_k * F_inverse;
    Mat &s = stress[3 * i + k];
    s = batch.old_stress[k][place] = rotated(s, l);
    const double volumetric = (K - 2. / 3. * G) * trace(strain);
    s = s + 2. * G * strain + volumetric * Mat::identity();
    const double mean_stress = trace(s) / 3.;
    square += 1.5 * (contract(s, s) - 3. * mean_stress * mean_stress);
  }
  return square;
}

double SecondGradient::add_stress(const std::size_t i, const std::size_t place,
                                  const double V, const StepWork &work,
                                  Mat &total)
{
  const double theta = work.return_factor[place];
  const Mat &F_inverse_transposed = work.inverse_transpose[place];
  Mat own = Mat::zero();
  for (int k = 0; k < 3; ++k)
  {
    Mat &s = stress[3 * i + k];
    const double mean_stress = trace(s) / 3.;
    s = theta * s + (1. - theta) * mean_stress * Mat::identity();
    done[i] += 0.5 * V *
               contract(batch.old_stress[k][place] + s, batch.strain[k][place]);
    generalized_stress[i].columns[k] =
        transpose(V * (s * F_inverse_transposed));
    own = own - V * (s * transpose(batch.spatial[k][place]));
  }
  total = total + own;
  return 0.;
}

void SecondGradient::gather(const SpgParts &body,
                            AlignedVector<HigherStresses> &generalized,
                            Vec *const force) const
{
  const BondList &bonds = body.bonds;
  body.exchange.make_whole(generalized.data());
  body.exchange.make_whole(force);
  body.exchange.update(generalized.data());
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
  {
    Vec f = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      for (int k = 0; k < 3; ++k)
        f += multiply_columns(generalized[i].columns[k],
                              bond_gradient[b].row[k]) -
             multiply_columns(generalized[bonds.neighbor[b]].columns[k],
                              bond_gradient[bonds.reverse[b]].row[k]);
    f[3] = 0.;
    force[i] += f;
  }
  body.exchange.take_shares(force);
}

namespace
{
/** Root of the sum of all squares. */
double size_of(const Mat &b)
{
  return std::sqrt(contract(b, b));
}
} // namespace

void SecondGradient::add_row_sums(const SpgParts &body,
                                  std::vector<double> &sums) const
{
  // Row i of sum_p V_p B_p^T C B_p: what particle p has of i, times what it has
  // of all. Of itself a particle has minus the sum of the others.
  const BondList &bonds = body.bonds;
  const Material &law = body.points.law();
  const double c = law.sound_speed(), modulus = law.density() * c * c;
  std::vector<double> all(body.fields.kernel_reference_volume);
  all.resize(body.nodes.size());
  body.exchange.make_whole(all.data());
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
  {
    Mat own = Mat::zero();
    double others = 0.;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      own = own + bond_gradient[b];
      others += size_of(bond_gradient[b]);
    }
    all[i] *= modulus * (size_of(own) + others);
    sums[i] += all[i] * size_of(own);
  }
  body.exchange.update(all.data());
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      sums[i] +=
          all[bonds.neighbor[b]] * size_of(bond_gradient[bonds.reverse[b]]);
}

void SecondGradient::add_linearized(const SpgParts &body,
                                    const AlignedVector<Vec> &motion,
                                    AlignedVector<Vec> &force)
{
  const BondList &bonds = body.bonds;
  const ElasticResponse response(body.points.law());
  AlignedVector<HigherStresses> higher(body.nodes.size());
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
  {
    Mat slope[3] = {Mat::zero(), Mat::zero(), Mat::zero()};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const Vec relative = motion[bonds.neighbor[b]] - motion[i];
      for (int k = 0; k < 3; ++k)
        add_outer(slope[k], relative, bond_gradient[b].row[k]);
    }
    const double V = body.fields.kernel_reference_volume[i];
    for (int k = 0; k < 3; ++k)
      higher[i].columns[k] = transpose(V * response(slope[k]));
  }
  gather(body, higher, force.data());
}

void SecondGradient::visit_bonds(StateVisitor &visitor, const SpgParts &body,
                                 const StateRows &rows)
{
  // Rows end in places of no bond, which stay zero.
  if (visitor.is_restoring())
    bond_gradient.assign(body.bonds.n_with_ghosts(), Mat::zero());
  visitor.visit_rows("second gradient of bonds", bond_gradient.data(),
                     body.bonds.capacity(), rows);
  if (visitor.is_restoring())
    body.bonds.update_ghosts(bond_gradient.data());
}

void SecondGradient::visit_state(StateVisitor &visitor, const StateItems &items)
{
  Stabilization::visit_state(visitor, items);
  visitor.visit_items("second gradient", higher_gradient, items, 3);
  visitor.visit_items("second gradient stress", stress, items, 3);
}

void SecondGradient::compute_forces(SpgParts &body, const double dt)
{
  spg_step<true>(body, *this, dt);
}

void SecondGradient::apply_linearized(const SpgParts &body,
                                      const AlignedVector<Vec> &motion,
                                      AlignedVector<Vec> &force)
{
  apply_linearized_body(body, *this, motion, force);
}

const Registry<Stabilization>::Add registered(
    {"second gradient",
     "the reference paper's; needs a convex approximation, and its stable step "
     "is 2 to 3 times shorter.",
     nullptr, [](const Parameters &, const std::string &) {
       return [] { return std::make_unique<SecondGradient>(); };
     }});
} // namespace
} // namespace sabot
