#ifndef sabot_materials_flow_return_h
#define sabot_materials_flow_return_h

#include "sabot/kernels/pack_math.h"
#include "sabot/materials/material.h"

#include <cstddef>

namespace sabot
{
/**
 * The return of all points of a batch that yield, for a Flow as
 * RateDependentPlasticity has it: d of
 *
 *   f(d) = q - 3 G d - sigma_y(eps + d, d/dt) = 0.
 *
 * f falls with d, as sigma_y does not: there is one root, between 0 and
 * q/(3 G), and Newton's steps are taken while they stay within the bracket that
 * is known to hold it, else halved. They start at the increment of strain
 * itself, which steady flow would make plastic, and with it at a rate that is
 * nearly the one sought; a point with q above sigma_y there yields, so that the
 * flow stress at rate 0 is asked for where that is in doubt only. At eps = 0
 * the slope of a power of eps is left out, as it has no bound.
 *
 * Points that may yield are packed into registers and iterated together. A lane
 * that is done stays as it is, and none sees another: a point's result does not
 * depend on the batch that it is in.
 */
template <typename Flow>
class FlowReturn
{
public:
  /** None so far; @p dt [s] > 0 of the step. */
  FlowReturn(const Flow &flow, const double dt) : flow(flow), dt(dt) {}

  /** Take point @p k in if it may yield: the square of its q, @p square [Pa^2],
      is above that of @p bound [Pa], which no yield stress is below. Each point
      once. */
  void ask(const std::size_t k, const double square, const double bound)
  {
    point[n] = k;
    q[n] = square;
    n += square > bound * bound;
  }
  /** What a batch has at the number of each point. */
  struct Values
  {
    const double *eps, *temperature, *pressure; // [K], [Pa]
    const double *jacobian, *modulus;           // G [Pa]
    const double *strain_square; // 2/3 of that of the strain's increment
  };
  /** Increment, q and theta of the points taken in. @return whether any
      yields. */
  bool find(const Values &values);

  std::size_t n = 0;
  /** Numbers of the points. The rest is 0 and 1 where they do not yield. */
  std::size_t point[max_batch_points + 1];
  double q[max_batch_points + n_wide];         // of the trial [Pa]
  double increment[max_batch_points + n_wide]; // d
  double theta[max_batch_points + n_wide];     // 1 - 3 G d/q

private:
  /** The points of one register. */
  struct Lanes
  {
    typename Flow::template Point<WidePack> at;
    WidePack q, three_G, eps;
    WidePack d, low, high; // the root so far, and what holds it
    WideMask yields;
    WideMask limp;   // without modulus or strength: nothing stays
    WideMask active; // neither done nor without a root
  };
  static constexpr std::size_t most_registers =
      (max_batch_points + n_wide - 1) / n_wide;

  WidePack load(const double *const values, const std::size_t i) const
  {
    WidePack a;
    for (std::size_t lane = 0; lane < n_wide; ++lane)
      a[lane] = values[point[i + lane < n ? i + lane : n - 1]];
    return a;
  }
  void read(const Values &values, const std::size_t i, Lanes &lanes) const;
  /** Whether they yield, and the first step from d on. */
  void start(Lanes &lanes) const;
  /** All of the deviator of the lanes that have no strength at the end. */
  void let_go(Lanes &lanes) const;
  /** A step of Newton's or of bisection. */
  void advance(Lanes &lanes) const;
  void step(Lanes &lanes, const WidePack stress, const WidePack slope) const;

  const Flow &flow;
  const double dt;
};

template <typename Flow>
inline void FlowReturn<Flow>::read(const Values &values, const std::size_t i,
                                   Lanes &lanes) const
{
  WidePack square;
  std::memcpy(&square, &q[i], sizeof(square));
  lanes.q = pack_sqrt(square);
  lanes.at = flow.at(load(values.temperature, i), load(values.pressure, i),
                     load(values.jacobian, i));
  lanes.eps = load(values.eps, i);
  const WidePack G = load(values.modulus, i), zero = {};
  // Without shear modulus there is nothing but to let go.
  lanes.limp = G <= zero;
  lanes.three_G = lanes.limp ? splat<WidePack>(1.) : 3. * G;
  lanes.low = zero;
  lanes.high = lanes.q / lanes.three_G;
  lanes.d = pack_min(pack_sqrt(load(values.strain_square, i)), lanes.high);
}

template <typename Flow>
inline void FlowReturn<Flow>::start(Lanes &lanes) const
{
  const WidePack zero = {};
  const WideMask may = lanes.q > flow.lower_bound(lanes.at);
  lanes.yields = lanes.active = WideMask{};
  if (any_of(may))
  {
    WidePack slope, other;
    const WidePack eps = lanes.eps + lanes.d,
                   stress = flow.stress(lanes.at, eps, lanes.d * (1. / dt), dt,
                                        slope);
    lanes.yields = may & (lanes.q > stress);
    if (any_of(may & ~lanes.yields))
      lanes.yields |=
          may & (lanes.q > flow.stress(lanes.at, lanes.eps, zero, dt, other));
    lanes.active = lanes.yields & ~lanes.limp;
    lanes.d = lanes.active ? lanes.d : zero;
    if (any_of(lanes.active & (stress <= zero)))
      let_go(lanes);
    step(lanes, stress, eps > 1e-8 ? slope : zero);
  }
  else
    lanes.d = zero;
}

template <typename Flow>
void FlowReturn<Flow>::let_go(Lanes &lanes) const
{
  WidePack slope;
  const WideMask limp =
      lanes.active &
      (flow.stress(lanes.at, lanes.eps + lanes.high, lanes.high * (1. / dt), dt,
                   slope) <= WidePack{});
  lanes.d = limp ? lanes.high : lanes.d;
  lanes.active &= ~limp;
  lanes.limp |= limp;
}

template <typename Flow>
inline void FlowReturn<Flow>::advance(Lanes &lanes) const
{
  WidePack slope;
  const WidePack stress = flow.stress(lanes.at, lanes.eps + lanes.d,
                                      lanes.d * (1. / dt), dt, slope);
  step(lanes, stress, slope);
}

template <typename Flow>
inline void FlowReturn<Flow>::step(Lanes &lanes, const WidePack stress,
                                   const WidePack slope) const
{
  const WidePack d = lanes.d, f = lanes.q - lanes.three_G * d - stress;
  lanes.low = f > 0. ? d : lanes.low;
  lanes.high = f > 0. ? lanes.high : d;
  const WidePack change = f / (lanes.three_G + slope), next = d + change;
  lanes.active &= ~((pack_max(f, -f) <= 1e-12 * lanes.q) |
                    (lanes.high - lanes.low <= 1e-15 * lanes.high));
  const WideMask trusted = (next > lanes.low) & (next <= lanes.high);
  lanes.d =
      lanes.active ? (trusted ? next : 0.5 * (lanes.low + lanes.high)) : d;
  // Convergence is quadratic: what remains is below 1e-8 of the stress.
  lanes.active &= ~(trusted & (pack_max(change, -change) <= 1e-4 * d));
}

template <typename Flow>
bool FlowReturn<Flow>::find(const Values &values)
{
  Lanes all[most_registers];
  std::size_t active[most_registers + 1], n_active = 0, n_all = 0;
  WideMask yields = {};
  for (std::size_t i = n; i < n + n_wide && n > 0; ++i)
    q[i] = q[n - 1]; // lanes without a point repeat the last
  for (std::size_t i = 0; i < n; i += n_wide)
  {
    Lanes &lanes = all[n_all];
    read(values, i, lanes);
    start(lanes);
    yields |= lanes.yields;
    active[n_active] = n_all++;
    n_active += any_of(lanes.active);
  }
  if (!any_of(yields))
    return false;
  // All registers once and again: their long chains of operations overlap.
  for (int iteration = 0; iteration < 100 && n_active > 0; ++iteration)
  {
    const std::size_t m = n_active;
    n_active = 0;
    for (std::size_t j = 0; j < m; ++j)
    {
      Lanes &lanes = all[active[j]];
      advance(lanes);
      active[n_active] = active[j];
      n_active += any_of(lanes.active);
    }
  }
  const WidePack zero = {}, one = splat<WidePack>(1.);
  for (std::size_t r = 0; r < n_all; ++r)
  {
    const Lanes &lanes = all[r];
    const WidePack shrunk =
        pack_max(zero, 1. - lanes.three_G * lanes.d / lanes.q);
    const WidePack factor = lanes.yields ? (lanes.limp ? zero : shrunk) : one;
    std::memcpy(&q[r * n_wide], &lanes.q, sizeof(WidePack));
    std::memcpy(&increment[r * n_wide], &lanes.d, sizeof(WidePack));
    std::memcpy(&theta[r * n_wide], &factor, sizeof(WidePack));
  }
  return true;
}
} // namespace sabot

#endif
