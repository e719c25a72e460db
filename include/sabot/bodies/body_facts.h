#ifndef sabot_bodies_body_facts_h
#define sabot_bodies_body_facts_h

#include "sabot/materials/material.h"

#include <array>
#include <optional>
#include <string>

namespace sabot
{
/** A body before the run, as estimates of physics and cost see it. Filled by
    Body::facts() from the options alone, so that a scene can be judged
    without a step: speeds of impact, shock pressure, the stable step by
    spacing over wave speed. Borrowed material: valid while the body lives. */
struct BodyFacts
{
  const Material *material = nullptr; // of a rigid body: its density only
  /** Rigid bodies do not: they have neither wave speed nor stress. */
  bool deforms = true;
  /** Its items are particles and not cells: they cost more and may come
      apart. */
  bool is_particles = false;
  /** Faces of symmetry and driven ones do not count. */
  bool is_clamped = false;          // somewhere
  std::array<double, 3> velocity{}; // at the start [m/s]
  /** Of the part that is driven, where one is [m/s]. */
  std::optional<std::array<double, 3>> driven_velocity;
  /** Whether it moves otherwise than with its velocity at the start before
      anything meets it: driven, loaded, spinning, or held while it flies. */
  bool moves_by_itself = false;
  /** Distance of nodes that was asked for along the axes; the finest where it
      varies [m]. */
  std::array<double, 3> spacing{};
  /** Form of hourglass control, of one-point cells only. */
  std::string hourglass_control;
  bool may_fail = false; // by a criterion, whichever
  /** Effective plastic strain at which it fails, by damage that in shear;
      nothing where another measure decides, or where nothing fails. */
  std::optional<double> failure_strain;
  /** Pressure of an impact, v Z1 Z2/(Z1 + Z2), over the bulk modulus up to
      which plane shocks were seen not to shake its particles; nothing where no
      bound was found (decision 60). */
  std::optional<double> largest_shock;
  /** That of least-squares functions, and with a support of wide_support
      spacings or more: none shook at 0.17 and 0.35, all at 0.22 and 0.47. */
  static constexpr double narrow_shock = 0.2, wide_shock = 0.4,
                          wide_support = 2.5;
};
} // namespace sabot

#endif
