#ifndef sabot_bodies_spg_failure_residual_strength_h
#define sabot_bodies_spg_failure_residual_strength_h

#include "sabot/materials/material.h"

#include <functional>
#include <memory>
#include <string>

namespace sabot
{
class Parameters;

/** What is known of one particle's damage after a kernel update. */
struct ParticleDamage
{
  /** Its remaining bonds no longer span space, or have not closed yet
      (ParticleApproximation::lost_direction). */
  bool lost_direction = false;
  /** One of its bonds failed while its own measure of failure exceeded the
      critical value: the metal here has failed, not only beside it. Stays. */
  bool has_crumbled = false;
};

/** Which points of a batch have failed, and where their losses go: [n] each.
    Both are added to: 2 half_volume times a work per volume [J/m^3]. */
struct FailedPoints
{
  const char *is_failed;
  const double *half_volume; // half of the mean volume of the step [m^3]
  double *loss;              // energy let go, part of the internal one [J]
  /** Heat of the friction between pieces, part of internal and stabilization
      energy [J]; null for rules that have none. */
  double *friction_work;
};

/**
 * What failed metal carries, and which metal has failed. The law and the work
 * of the step are outside; a rule sees one batch with at least one failed point
 * and must leave the others exactly as the law does. It may call the law more
 * than once on copies, cut or scale the stress afterwards, and count what it
 * lets go: the work of sigma along the part of the strain increment that the
 * law did not see, for example. One file a rule.
 */
class ResidualStrength
{
public:
  static constexpr const char *kind = "rule for failed metal";
  /** Makes the rule of one body, which may keep scratch space. */
  using Maker = std::function<std::unique_ptr<ResidualStrength>()>;
  using Make = Maker(const Parameters &, const std::string &path);

  virtual ~ResidualStrength() = default;

  /** Whether a particle has failed; asked after each kernel update. A function
      of @p damage alone, so that ranks and resumed runs agree. */
  virtual bool has_failed(const ParticleDamage &damage) const = 0;
  /** Friction coefficient of the body's pieces on each other, >= 0, without
      unit; before the first step. */
  virtual void set_internal_friction(const double /*coefficient*/) {}
  /** Whether crumbled metal stays one continuum: bonds between two particles
      that have crumbled are not removed but found anew as pieces slide, since
      the rule leaves their stress no cohesion. */
  virtual bool joins_crumbled() const { return false; }
  /** Whether metal without any stress that is stretched further stays so: the
      rule leaves neither tension nor what needs pressure. */
  virtual bool bears_no_tension() const { return false; }
  /** Whether it turns work into heat of friction (FailedPoints). */
  virtual bool has_friction() const { return false; }

  /** Stress and state at the end of the step, in place of law.update().
      Stress is without bulk viscosity, in the frame of the end of the step,
      to which MaterialPoints::rotate() has turned it. Must set return factor
      and plastic work as a law does; the return factor scales the stress of
      the stabilization too. n <= max_batch_points. Local. */
  virtual void update(const Material &law, const MaterialBatch &points,
                      const FailedPoints &failed) = 0;
  /** Take away what a particle cannot bear that failed between two steps. @p
      stress in the order of n_symmetric [Pa]. In the present frame, in
      place; what is taken away is booked by release_stress(). */
  virtual void release(double stress[n_symmetric]) const = 0;
};
} // namespace sabot

#endif
