#ifndef sabot_bodies_spg_crack_forces_h
#define sabot_bodies_spg_crack_forces_h

#include "sabot/bodies/spg/spg_step.h"

#include <cstdint>
#include <vector>

namespace sabot
{
/** What cracks have changed while kernels stay as they are. */
struct CrackedParticles
{
  /** Owned particles that have lost bonds or bear less than before, ascending.
   */
  std::vector<std::uint32_t> changed;
  /** [n_local] Whether a particle is one of these, of any rank, or their
      neighbor. */
  std::vector<char> beside;
};

/** Call @p visit(range) for stretches of owned particles of which @p wanted(i)
    is true, of at most one batch each. */
template <typename Wanted, typename Visit>
inline void for_each_range(const std::size_t n_owned, const Wanted &wanted,
                           const Visit &visit)
{
  for (std::size_t begin = 0; begin < n_owned; ++begin)
  {
    std::size_t end = begin;
    while (end < n_owned && end - begin < spg_batch_size && wanted(end))
      ++end;
    if (end > begin)
    {
      visit(ParticleRange{begin, end});
      begin = end - 1;
    }
  }
}

/** Start the forces of particles with what their own stress does to them,
    which is as it was: what generalize_stress() does for those that have
    changed. After follow_motion(). Local. */
template <typename Form>
inline void start_forces(const ParticleRange &range, SpgParts &body,
                         const Form &form)
{
  for (std::size_t i = range.begin; i < range.end; ++i)
  {
    const Mat &Q = body.fields.generalized_stress[i];
    Vec &f = body.nodes.force[i];
    f = multiply_columns(Q,
                         body.work.bond_sums[i - range.begin].function_sum());
    if constexpr (Form::has_bond_forces)
      f += form.bond_forces_as_they_are(body.bonds, i, Q.row[0][3]);
  }
}

/**
 * spg_step() at rest for @p cracked alone: the changed ones go through all of
 * its stages, their neighbors gather their forces anew. What a neighbor's own
 * stress and residuals do, to it and to others, stays as it was to the bit, so
 * that pairs of forces stay equal and opposite. Nothing else is touched.
 * Collective; positions are those of the last evaluation.
 */
template <typename Form>
void renew_crack_forces(SpgParts &body, Form &form,
                        const CrackedParticles &cracked)
{
  const std::size_t n = body.nodes.n_owned;
  StepWork &work = body.work;
  const MotionViews motion = motion_views(body, no_step);
  const auto follow = [&](const ParticleRange &range)
  {
    follow_motion<false>(range, motion, work, body.watch);
    if (!body.fields.own_step.empty())
      keep_steps(range, work, body.fields);
  };
  std::vector<char> others(cracked.beside.begin(), cracked.beside.begin() + n);
  for (const std::uint32_t i : cracked.changed)
    others[i] = 0;
  const auto is_beside = [&](const std::size_t i) { return cracked.beside[i]; };
  const auto has_changed = [&](const std::size_t i)
  { return cracked.beside[i] && !others[i]; };
  for_each_range(n, has_changed,
                 [&](const ParticleRange &range)
                 {
                   follow(range);
                   form.trial(range, body);
                   std::fill_n(work.return_factor, range.size(), 1.);
                   generalize_stress<false>(range, work, body, form);
                 });
  // What neighbors know of the others is that of the wholes already.
  body.exchange.make_whole(body.fields.generalized_stress.data(), has_changed);
  body.exchange.make_whole(body.nodes.force.data(), has_changed);
  // Their stable steps may be shorter by now.
  for_each_range(
      n, [&](const std::size_t i) { return others[i]; },
      [&](const ParticleRange &range)
      {
        follow(range);
        start_forces(range, body, form);
      });
  body.exchange.update(body.fields.generalized_stress.data());
  form.exchange(body);
  gather_forces<false>(
      ForceViews{body.bonds, body.fields.kernel_reference_position.data(),
                 body.fields.generalized_stress.data(), nullptr, n},
      form, body.nodes.force.data(), is_beside);
  body.exchange.take_shares(body.nodes.force.data(), is_beside);
  form.add_forces(body);
}
} // namespace sabot

#endif
