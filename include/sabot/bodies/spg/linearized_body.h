#ifndef sabot_bodies_spg_linearized_body_h
#define sabot_bodies_spg_linearized_body_h

#include "sabot/base/ghost_exchange.h"
#include "sabot/base/nodal_state.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_parts.h"

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
 * which is the stiffest. [N] for a motion in m, [N/s] for one in m/s.
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
  const std::size_t n = body.nodes.n_owned;
  const BondList &bonds = body.bonds;
  const ParticleApproximation &functions = body.approximation;
  const Vec *const X = body.fields.kernel_reference_position.data();
  const double *const volume = body.fields.kernel_reference_volume.data();
  const ElasticResponse stress(body.points.law());
  struct Particle
  {
    Mat moment, slope; // sum over bonds of what multiplies g; grad of motion
    double stiffness;
  };
  AlignedVector<Particle> particle(body.nodes.size());
  AlignedVector<Mat> inverse_moment(functions.moment_inverse);
  inverse_moment.resize(body.nodes.size());
  body.exchange.update(inverse_moment.data());
  const auto g = [&](const std::size_t i, const std::size_t j,
                     const std::size_t bond, const double weight)
  { return functions.gradient(bond, weight, inverse_moment[i], X[j] - X[i]); };
  for (std::size_t i = 0; i < n; ++i)
  {
    Mat L = Mat::zero();
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec relative = motion[j] - motion[i];
      add_outer(L, relative, g(i, j, b, bonds.weight[b]));
    }
    Mat moment = volume[i] * stress(L);
    const double stiffness = form.linear_stiffness(i);
    if constexpr (Form::has_bond_forces)
      for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      {
        const std::uint32_t j = bonds.neighbor[b];
        const Vec dX = X[j] - X[i], e = motion[j] - motion[i] - L * dX;
        add_outer(moment, -stiffness * bonds.scaled_weight[b] * e, dX);
      }
    particle[i] = {moment, L, stiffness};
  }
  body.exchange.update(particle.data());
  for (std::size_t i = 0; i < n; ++i)
  {
    Vec f = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      f += particle[i].moment * g(i, j, b, bonds.weight[b]) -
           particle[j].moment * g(j, i, bonds.reverse[b], bonds.weight[b]);
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
  form.add_linearized(body, motion, force);
}
} // namespace sabot

#endif
