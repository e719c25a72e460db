#ifndef sabot_bodies_flow_stress_h
#define sabot_bodies_flow_stress_h

#include "sabot/materials/material.h"

#include <vector>

namespace sabot
{
/**
 * Asks a law for the flow stress of copies of material points as they are now.
 * Points of any bodies of the material are collected by add() and answered
 * together, a batch at a time. Costs some tens of updates of the law per point:
 * for some points of a surface, not for every point in every step.
 */
class FlowStressProbe
{
public:
  explicit FlowStressProbe(const Material &material);
  /** Append a point: pressure [Pa], positive in compression, det F, and
      @p state(row) of the material's arrays. */
  template <typename State>
  void add(const double pressure, const double jacobian, const State &state)
  {
    pressures.push_back(pressure);
    jacobians.push_back(jacobian);
    for (std::size_t s = 0; s < is_tensor.size(); ++s)
      states.push_back(is_tensor[s] ? 0. : state(s));
  }
  /**
   * Uniaxial stress at which each point flows at rest [Pa]: with its plastic
   * strain, temperature, pressure and volume, at no rate; of kinematic
   * hardening the size of the yield surface. Any law is asked by what its
   * return makes of trial stresses q: theta q = Y(eps + (1 - theta) q/(3 G))
   * where it yields, theta = 1 where q <= Y. To 1e-6. Laws whose return never
   * acts have their initial yield stress.
   *
   * Found by bracketing Y between a stress that is borne and one that flows, at
   * most 60 trials; above the shear modulus a point counts as one that never
   * yields: 1e300. Local.
   */
  std::vector<double> flow_stress() const;

private:
  /** Points begin to begin + n of those collected, n <= max_batch_points.
      Tensor states are set to zero: they are stresses of their own, of
      kinematic hardening, and the trial has no direction. */
  void flow_stress_of_batch(const std::size_t begin, const std::size_t n,
                            double *result) const;
  const Material &material;
  std::vector<char> is_tensor; // per array of states: a stress of its own
  std::vector<double> pressures, jacobians, states; // states: [point][array]
};
} // namespace sabot

#endif
