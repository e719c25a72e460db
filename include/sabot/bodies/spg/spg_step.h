#ifndef sabot_bodies_spg_spg_step_h
#define sabot_bodies_spg_spg_step_h

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/motion_kernels.h"
#include "sabot/bodies/spg/particle_exchange.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_parts.h"

#include <algorithm>

namespace sabot
{
/** What the first stage reads and writes of @p body. Pointers into the rooms
    of the body, valid until a kernel update; at rest: density [kg/m^3] and
    dilatational wave speed [m/s] of the law. Local. */
MotionViews motion_views(SpgParts &body, const double dt);

/** Own steps of the particles of @p range, where they are kept at all: the
   least since they were reset. Local. */
inline void keep_steps(const ParticleRange &range, const StepWork &work,
                       ParticleFields &fields)
{
  for (std::size_t i = range.begin; i < range.end; ++i)
    fields.own_step[i] =
        std::min(fields.own_step[i], work.step[i - range.begin]);
}

/** Third stage: rotation, law (or what failed metal carries) and work of the
    particles of @p range over a step @p dt. MaterialPoints::rotate(), the law's
    update() of the batch, MaterialPoints::finish(). Where a particle of the
    range lost a direction, the rule for failed metal (ResidualStrength)
    stands in for the law and counts what cracks let go [J]. Laws that need F
    get the total one. Leaves theta in work.return_factor. Local. */
void update_stress(const ParticleRange &range, SpgParts &body, const double dt);

/**
 * Fourth stage: what the stress of a particle does to its neighbors, with
 * sigma - q 1 and what the form adds to it,
 *
 *   V P = J V_ref (sigma + form) F^-T,  Q = V P M^-1   (least squares).
 *
 * J V here is the present volume: work.jacobian is the total volume ratio,
 * reference_volume that of the start, so both give J_inc V_ref. The total
 * stress is in the present frame, P maps vectors of X to forces. Stored by
 * columns, with the form's stiffness theta k in the fourth lane of the first:
 * one exchange and one load per neighbor bring both. V P [J], Q [J/m^2]. Starts
 * the particle's force with what its own stress and the form do to it, Q times
 * the sum of g' over its bonds. Local; writes owned entries.
 */
template <bool stored_gradients, typename Form>
inline void generalize_stress(const ParticleRange &range, const StepWork &work,
                              SpgParts &body, Form &form)
{
  const MaterialPoints &points = body.points;
  const double *const reference_volume = body.fields.reference_volume.data();
  const Mat *const moment_inverse = body.approximation.moment_inverse.data();
  Mat *const generalized_stress = body.fields.generalized_stress.data();
  Vec *const force = body.nodes.force.data();
  for (std::size_t i = range.begin; i < range.end; ++i)
  {
    const std::size_t k = i - range.begin;
    const Mat sigma = points.total_stress(i, work.viscous_pressure[k]);
    const double V = work.jacobian[k] * reference_volume[i]; // J V
    Mat spatial = V * sigma;
    const double stiffness = form.add_stress(i, k, V, work, spatial);
    Mat moment = spatial * work.inverse_transpose[k];
    if constexpr (!stored_gradients)
      moment = moment * moment_inverse[i];
    const Mat columns = transpose(moment);
    force[i] = multiply_columns(columns, work.bond_sums[k].function_sum());
    if constexpr (Form::has_bond_forces)
      force[i] += form.own_bond_forces(i, k);
    generalized_stress[i] = columns;
    generalized_stress[i].row[0][3] = stiffness;
  }
}

/** What gather_forces() reads; owned particles and ghosts but for bonds.
    Ghosts' entries must have been exchanged; shape_gradient includes the
    bonds of ghosts that end here, to which reverse[] leads. */
struct ForceViews
{
  const BondList &bonds;
  const Vec *kernel_position;    // X [m]
  const Mat *generalized_stress; // Q [J/m^2] or V P [J], by columns
  const Vec *shape_gradient;     // g, where gradients are stored [1/m]
  std::size_t n_owned;
};

/** Into @p product: phi dX of the four bonds of a particle at @p Xi from @p b
    on [m]. */
inline void weigh_bonds(const ForceViews &in, const Vec Xi, const std::size_t b,
                        double product[3][n_lanes])
{
  Pack dX[3];
  gather(in.kernel_position, in.bonds.neighbor.data() + b, dX);
  const Pack w = load_floats(in.bonds.weight.data() + b);
  for (int d = 0; d < 3; ++d)
    store_pack(product[d], w * (dX[d] - Xi[d]));
}

/**
 * Last stage: every owned particle gathers what its neighbors do to it, in
 * global order, so that results do not depend on the number of ranks,
 *
 *   f_N = sum_J phi (Q_N + Q_J) dX             (least squares),
 *   f_N = sum_J [ V_N P_N g_NJ - V_J P_J g_JN ]  (stored gradients),
 *
 * of which generalize_stress() has left the part of Q_N, and per bond what the
 * form adds by its neighbors' fourth lanes.
 *
 * Every term appears at the other end with the opposite sign, so the sum of all
 * forces is zero to round-off. A bond is computed twice, once from each end,
 * which needs no locks and no exchange of forces. Adds to force [n_owned] in N,
 * fourth lanes 0. Numbers of a bond go through memory, from where they are
 * spread over a register for nothing. Local. Of the particles that @p wanted
 * says.
 */
template <bool stored_gradients, typename Form, typename Wanted>
inline void gather_forces(const ForceViews &in, const Form &form,
                          Vec *const force, const Wanted &wanted)
{
  const std::uint32_t *const neighbor = in.bonds.neighbor.data();
  const std::uint32_t *const reverse = in.bonds.reverse.data();
  const Mat *const stress = in.generalized_stress;
  const auto bond_force = form.bond_forces(in.bonds);
  for (std::size_t i = 0; i < in.n_owned; ++i)
  {
    if (!wanted(i))
      continue;
    const Vec Xi = in.kernel_position[i];
    Vec f[3] = {force[i], Vec{}, Vec{}};
    const std::size_t last = in.bonds.packed_end(i);
    for (std::size_t b = in.bonds.begin(i); b < last; b += n_lanes)
    {
      alignas(32) double product[3][n_lanes];
      if constexpr (!stored_gradients)
        weigh_bonds(in, Xi, b, product);
      if constexpr (Form::has_bond_forces)
        for (std::size_t l = 0; l < n_lanes; ++l)
          bond_force.prefetch(reverse[b + BondList::look_ahead + l]);
      for (std::size_t l = 0; l < n_lanes; ++l)
      {
        const Mat &QJ = stress[neighbor[b + l]];
        if constexpr (stored_gradients)
        {
          const Vec &g = in.shape_gradient[reverse[b + l]];
          for (int d = 0; d < 3; ++d)
            f[d] -= g[d] * QJ.row[d];
        }
        else
          for (int d = 0; d < 3; ++d)
            f[d] += product[d][l] * QJ.row[d];
        if constexpr (Form::has_bond_forces)
          f[l % 3] -= bond_force(b + l, reverse[b + l], QJ.row[0][3]);
      }
    }
    f[0] += f[1] + f[2];
    f[0][3] = 0.;
    force[i] = f[0];
  }
}

/**
 * The SPG step: forces of the owned particles from the positions of all, their
 * material advanced by @p dt (0: forces only). Particles go through in batches
 * that stay in the first-level cache; a form of stabilization instantiates this
 * with itself at the bottom of its own file. Beside Stabilization it has
 *
 *   static constexpr bool has_bond_forces;
 *   void trial(range, body);         // its trial stress, extra_square
 *   double add_stress(i, k, V, work, spatial); // its part of V sigma; returns
 *                                    // what neighbors get to know
 *   void exchange(body);             // what belongs to ghosts' bonds
 *   Vec own_bond_forces(i, k);       // on its own particle, after add_stress
 *   Vec bond_forces_as_they_are(bonds, i, stiffness); // the same of particles
 *                                    // of which nothing changes
 *   auto bond_forces(bonds);         // functor of what the neighbor's end of a
 *                                    // bond takes off the force
 *   void add_forces(body);           // what is not a sum over one ring, on
 *                                    // the model's shares of particles
 *
 * Collective.
 *
 * Order: all that depends on one particle alone batch by batch, then the
 * exchange of the generalized stress, then forces. Positions of ghosts are up
 * to date on entry. body.watch gets the stable step and the first problem,
 * which the caller throws after the last exchange. At dt = 0 stress and
 * energies stay and theta = 1.
 */
template <bool stored_gradients, typename Form>
void spg_step(SpgParts &body, Form &form, const double dt)
{
  const std::size_t n = body.nodes.n_owned;
  StepWork &work = body.work;
  const MotionViews motion = motion_views(body, dt);
  for (std::size_t begin = 0; begin < n; begin += spg_batch_size)
  {
    const ParticleRange range{begin, std::min(begin + spg_batch_size, n)};
    // Positions -> gradients: strain, spin, volume, viscosity, stable step.
    follow_motion<stored_gradients>(range, motion, work, body.watch);
    if (!body.fields.own_step.empty())
      keep_steps(range, work, body.fields);
    // The stabilization's trial stress, which shares the yield condition.
    form.trial(range, body);
    // Material: rotation, law, work.
    if (is_step(dt))
      update_stress(range, body, dt);
    else
      std::fill_n(work.return_factor, range.size(), 1.);
    // Stress -> what it does to the neighbors.
    generalize_stress<stored_gradients>(range, work, body, form);
  }
  // Neighbors on other ranks and beyond planes of symmetry, who see wholes.
  body.exchange.make_whole(body.fields.generalized_stress.data());
  body.exchange.make_whole(body.nodes.force.data());
  body.exchange.update(body.fields.generalized_stress.data());
  form.exchange(body);
  // Every particle gathers its own force.
  gather_forces<stored_gradients>(
      ForceViews{body.bonds, body.fields.kernel_reference_position.data(),
                 body.fields.generalized_stress.data(),
                 body.approximation.shape_gradient.data(), n},
      form, body.nodes.force.data(), [](std::size_t) { return true; });
  body.exchange.take_shares(body.nodes.force.data());
  form.add_forces(body);
}

/** spg_step() by how the body's approximation has its gradients. One test a
    step: both ways of the loop are compiled. Collective. */
template <typename Form>
void run_spg_step(SpgParts &body, Form &form, const double dt)
{
  body.approximation.stores_gradients() ? spg_step<true>(body, form, dt)
                                        : spg_step<false>(body, form, dt);
}
} // namespace sabot

#endif
