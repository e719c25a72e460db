#ifndef sabot_bodies_spg_linearized_body_h
#define sabot_bodies_spg_linearized_body_h

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_exchange.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/bodies/spg/stiffness_bound.h"

namespace sabot
{
/** Elastic stress of a small displacement gradient @p slope, with the moduli
    at rest: 2 mu sym L + lambda tr L 1 [Pa]. lambda = K - 2 mu/3. The skew
    part of the slope has no stress: the reference state is free of stress,
    so rotations are free. mu and lambda in Pa, slope without unit where the
    motion is a displacement [m]; linear, so any unit goes through. Pressure
    and deviator are those of the tangent at rest: equations of state are
    linearized at zero pressure. */
struct ElasticResponse
{
  explicit ElasticResponse(const Material &law)
      : mu(law.shear_modulus()), lambda(law.bulk_modulus() - 2. / 3. * mu)
  {
  }
  /** Symmetric; in the frame of the configuration of the last kernel update. */
  Mat operator()(const Mat &slope) const
  {
    const Mat strain = 0.5 * (slope + transpose(slope));
    return 2. * mu * strain + lambda * trace(strain) * Mat::identity();
  }
  const double mu, lambda;
};

/** apply_linearized_body() with least squares, where M^-1 comes out of the sums
    over bonds: with r = v_J - v_N, m_N the moment, Q_N = m_N M_N^-1,

      L_N = [ sum phi r (x) dX ] M_N^-1,
      m_N = V_N sigma(L_N) - k_N ( sum w r (x) dX - L_N sum w dX (x) dX ),
      f_N = sum [ phi (Q_N + Q_J) - w (k_N L_N + k_J L_J) ] dX
            + w (k_N + k_J) r.

    Collective. Q stands where the step has its own, which it finds anew before
    it reads it: 100 bytes per particle at the peak of memory. */
template <typename Form>
void apply_linearized_moments(const SpgParts &body, Form &form,
                              const AlignedVector<Vec> &motion,
                              AlignedVector<Vec> &force)
{
  const std::size_t n = body.nodes.n_owned;
  const BondList &bonds = body.bonds;
  const std::uint32_t *const neighbor = bonds.neighbor.data();
  const float *const weight = bonds.weight.data();
  const float *const scaled_weight = bonds.scaled_weight.data();
  const Vec *const X = body.fields.kernel_reference_position.data();
  const Mat *const inverse_moment = body.approximation.moment_inverse.data();
  const ElasticResponse stress(body.points.law());
  // By columns; k in the fourth lane of the first one of kL.
  Mat *const Q = body.fields.generalized_stress.data();
  AlignedVector<Mat> kL(Form::has_bond_forces ? body.nodes.size() : 0);
  for (std::size_t i = 0; i < n; ++i)
  {
    Mat by_weight = Mat::zero(), by_scaled = by_weight, second = by_weight;
    const Vec Xi = X[i], vi = motion[i];
    for (std::size_t b = bonds.begin(i), last = bonds.end(i); b < last; ++b)
    {
      const std::uint32_t j = neighbor[b];
      const Vec dX = X[j] - Xi, r = motion[j] - vi;
      add_outer(by_weight, r, weight[b] * dX);
      if constexpr (Form::has_bond_forces)
      {
        const Vec w_dX = scaled_weight[b] * dX;
        add_outer(by_scaled, r, w_dX);
        add_outer(second, dX, w_dX);
      }
    }
    const Mat L = by_weight * inverse_moment[i];
    const double share = stiffness_share(body, i),
                 k = share * form.linear_stiffness(i);
    Mat moment = share * body.fields.kernel_reference_volume[i] * stress(L);
    if constexpr (Form::has_bond_forces)
      moment = moment - k * (by_scaled - L * second);
    Q[i] = transpose(moment * inverse_moment[i]);
    if constexpr (Form::has_bond_forces)
    {
      kL[i] = k * transpose(L);
      kL[i].row[0][3] = k;
    }
  }
  body.exchange.make_whole(Q);
  body.exchange.update(Q);
  if constexpr (Form::has_bond_forces)
  {
    body.exchange.make_whole(kL.data());
    body.exchange.update(kL.data());
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    Vec f = {};
    const Mat Q_here = Q[i];
    const Vec Xi = X[i], vi = motion[i];
    for (std::size_t b = bonds.begin(i), last = bonds.end(i); b < last; ++b)
    {
      const std::uint32_t j = neighbor[b];
      const Vec dX = X[j] - Xi;
      f += multiply_columns(Q_here + Q[j], weight[b] * dX);
      if constexpr (Form::has_bond_forces)
      {
        const Mat both = kL[i] + kL[j];
        f += scaled_weight[b] *
             (both.row[0][3] * (motion[j] - vi) - multiply_columns(both, dX));
      }
    }
    f[3] = 0.; // of the stiffness
    force[i] = f;
  }
  body.exchange.take_shares(force.data());
  form.add_linearized(body, motion, force);
}

/** What a particle does to its neighbors with stored gradients. */
struct LinearizedParticle
{
  Mat moment, slope; // sum over bonds of what multiplies g; grad of motion
  double stiffness;
};
inline void mirror(LinearizedParticle &p, const unsigned int axes)
{
  mirror(p.moment, axes);
  mirror(p.slope, axes);
}
/** Of a share to the whole: the motion is the same. */
inline LinearizedParticle operator*(const double copies,
                                    const LinearizedParticle &p)
{
  return {copies * p.moment, p.slope, copies * p.stiffness};
}

/**
 * f = -K v of the body at rest in the configuration of the last kernel update,
 *
 *   L_N = sum (v_J - v_N) (x) g_NJ,
 *   f_N = sum [ V_N sigma(L_N) g_NJ - V_J sigma(L_J) g_JN ],
 *
 * and with bond forces, e = v_J - v_N - L_N dX, k_N of the form and the scaled
 * weights w, the moment less sum k w e (x) dX and the force
 * w (k_N e_NJ - k_J e_JN). Instantiated by the forms as the step is, with
 *
 *   double linear_stiffness(i);  // k_N [N m], 0 without bond forces
 *   void add_linearized(body, motion, force);  // what is not of this form
 *
 * @p motion [n_local], @p force [n_owned]. Collective.
 *
 * K is symmetric and positive semidefinite, so that Lanczos on M^-1 K finds the
 * largest frequency of the body (largest_frequency()). Stress, damage and
 * plastic flow of now are not in it: the step has to bear the elastic body,
 * which is the stiffest; only failed metal that gapes has next to none of it
 * (stiffness_share()). [N] for a motion in m, [N/s] for one in m/s.
 *
 * Of particles on planes of symmetry force and K are those of the model's
 * share; the motion must not leave the planes, else K is not symmetric.
 *
 * Ghosts: the motion's must be up to date; moments, slopes and stiffnesses of
 * this rank's particles are exchanged once in between. Failed bonds are not in
 * the list and thus not in K. Neighbors add up in global order: the result has
 * the same bits for every number of ranks.
 */
template <typename Form>
void apply_linearized_body(const SpgParts &body, Form &form,
                           const AlignedVector<Vec> &motion,
                           AlignedVector<Vec> &force)
{
  // First what every particle's strain does to it, then, with that of the
  // neighbors, their forces: the step itself for a small motion, where it
  // comes down to sums over bonds with constant factors.
  const ParticleApproximation &functions = body.approximation;
  if (!functions.stores_gradients())
    return apply_linearized_moments(body, form, motion, force);
  const std::size_t n = body.nodes.n_owned;
  const BondList &bonds = body.bonds;
  const Vec *const X = body.fields.kernel_reference_position.data();
  const double *const volume = body.fields.kernel_reference_volume.data();
  const ElasticResponse stress(body.points.law());
  AlignedVector<LinearizedParticle> particle(body.nodes.size());
  const Vec *const g = functions.shape_gradient.data();
  for (std::size_t i = 0; i < n; ++i)
  {
    Mat L = Mat::zero();
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec relative = motion[j] - motion[i];
      add_outer(L, relative, g[b]);
    }
    const double share = stiffness_share(body, i);
    Mat moment = share * volume[i] * stress(L);
    const double stiffness = share * form.linear_stiffness(i);
    if constexpr (Form::has_bond_forces)
      for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      {
        const std::uint32_t j = bonds.neighbor[b];
        const Vec dX = X[j] - X[i], e = motion[j] - motion[i] - L * dX;
        add_outer(moment, -stiffness * bonds.scaled_weight[b] * e, dX);
      }
    particle[i] = {moment, L, stiffness};
  }
  body.exchange.make_whole(particle.data());
  body.exchange.update(particle.data());
  for (std::size_t i = 0; i < n; ++i)
  {
    Vec f = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      f += particle[i].moment * g[b] - particle[j].moment * g[bonds.reverse[b]];
      if constexpr (Form::has_bond_forces)
      {
        const Vec dX = X[j] - X[i], relative = motion[j] - motion[i];
        f += bonds.scaled_weight[b] *
             (particle[i].stiffness * (relative - particle[i].slope * dX) +
              particle[j].stiffness * (relative - particle[j].slope * dX));
      }
    }
    force[i] = f;
  }
  body.exchange.take_shares(force.data());
  form.add_linearized(body, motion, force);
}
} // namespace sabot

#endif
