#ifndef sabot_simulation_plan_conversion_h
#define sabot_simulation_plan_conversion_h

#include "sabot/simulation/plan.h"

#include <array>
#include <string>
#include <vector>

namespace sabot
{
/**
 * Which cells of a host are expected to turn into particles, and when: from
 * boxes, velocities and the law alone; nothing of it is fitted.
 *
 * **A struck host.** What strikes, of radius a and mass m_A per area across its
 * flight, goes in against what opens a cavity in an incompressible metal
 * (Bishop, Hill & Mott, Proc. Phys. Soc. 57 (1945) 147),
 *
 *   m_A dv/dt = -(R + rho v^2),   R = 2/3 Y (1 + ln(2 E/(3 Y))),
 *
 * until it is through the box of the host. If it yields it is as wide as
 * Taylor's compression e makes it, A = a/sqrt(1 - e) <= 2 a (ImpactFacts). What
 * it pushes aside over the depth L is a line of sources: metal that was at r
 * from its path has flowed by
 *
 *   eps = 1/sqrt(3) ln(1 + A^2 c/r^2),   c = L/sqrt(4 r^2 + L^2),
 *
 * which is a hole opened from nothing in a sheet for r << L. A sheet thinner
 * than 2 A flows within 1.75 A of the path at most (Hill, The Mathematical
 * Theory of Plasticity (1950), XI.3: beyond, its thickness gives way). What
 * lies within the largest reach of all criteria has turned.
 *
 * **A host that strikes.** Its foot, by Taylor's two equations for the part X
 * that has not flowed and its velocity U against the interface (v at a rigid
 * body, v/2 at one that deforms),
 *
 *   dX/dt = -U/e,   rho X dU/dt = -Y,   rho U^2/Y = e^2/(1 - e),
 *
 * up to where -ln(1 - e) is the onset strain.
 */
class ConversionForecast
{
public:
  ConversionForecast(const Scene &scene, const PhysicsPlan &physics,
                     const GrowingZone &zone);

  /** Whether anything is expected to turn; else `basis` says why not. */
  bool exists() const { return !course.empty(); }
  /** Whether a place of the undeformed host has turned by then [s]. */
  bool has_turned(const std::array<double, 3> &place, const double time) const;
  /** Speed of what strikes over that at the start. */
  double speed_left(const double time) const;
  /** From the first contact until nothing new turns [s]. */
  double first_time() const;
  double last_time() const;

  std::string basis; // for reading
  /** Strain at which cells have turned at the latest. */
  double largest_strain = 0.;

private:
  struct Moment
  {
    double time, depth, reach, speed; // [s], [m], [m], over that of the start
  };
  void enter(const Scene &scene, const PhysicsPlan &physics,
             const PlannedBody &host, const double spacing);
  void upset(const Scene &scene, const PhysicsPlan &physics,
             const PlannedBody &host);
  /** Least onset strain of all criteria; nothing: none is about flow. */
  double least_strain() const;
  double reach_at(const double depth, const double radius,
                  const double spacing) const;
  const Moment &at(const double time) const;

  std::vector<ConversionCriterion::Onset> onsets; // with a strain each
  std::array<double, 3> entry{}, direction{};     // of the path, or the foot
  double thickness = 0.;                          // of the host along it [m]
  bool is_struck = false;
  std::vector<Moment> course; // ascending in time
};

/** Forecasts of all growing zones of the scene, in their order. */
std::vector<ConversionForecast> foresee_conversions(const Scene &scene,
                                                    const PhysicsPlan &physics);
} // namespace sabot

#endif
