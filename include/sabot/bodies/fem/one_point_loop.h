#ifndef sabot_bodies_fem_one_point_loop_h
#define sabot_bodies_fem_one_point_loop_h

#include "sabot/bodies/fem/cell_kernels.h"
#include "sabot/bodies/fem/hourglass.h"
#include "sabot/bodies/fem/one_point.h"

#include <algorithm>

namespace sabot
{
/**
 * The loop over one-point hexahedra with a form of hourglass control compiled
 * in. @p Form derives from this class and has
 *
 *     static constexpr bool needs_velocities;
 *     template <bool is_crooked>
 *     void hourglass(const CellConstants &, const FourCells &,
 *                    const double dt, const std::size_t pack, Pending &out);
 *
 * always inlined, which sets the modal forces [N], their part of P [N m] and
 * the hourglass energy [J] of four cells.
 *
 * Run-time choices are made outside: materials per batch of points, the form by
 * the class, crooked cells by the body. What is inside is straight arithmetic
 * on packs of four cells.
 */
template <typename Form>
class OnePointLoop : public OnePoint
{
public:
  using OnePoint::OnePoint;

  /** Kinematics, stress and forces, batch by batch. What a batch needs stays
      in the first-level cache between the three. Nodal forces are
      -f_internal [N], added to nodes.force; dt [s] leads from the last
      positions to these, no_step at the start. Cells of other ranks' nodes are
      here as well, so nothing is exchanged. Throws PhysicsError where a cell
      inverts and the option says stop. */
  void add_forces(NodalState &nodes, const double dt) override
  {
    warp.empty() ? add_forces_of<false>(nodes, dt)
                 : add_forces_of<true>(nodes, dt);
  }

protected:
  template <bool is_crooked>
  void add_forces_of(NodalState &nodes, const double dt)
  {
    reset_steps();
    const CellConstants constants = cell_constants();
    const std::size_t n = size();
    for (std::size_t begin = 0; begin < n; begin += batch_size)
    {
      const std::size_t m = std::min(batch_size, round_up(n - begin, 8)),
                        first = begin / n_lanes, last = first + m / n_lanes;
      for (std::size_t pack = first; pack < last; ++pack)
        kinematics<is_crooked>(constants, nodes, pack, dt);
      update_points(begin, m, dt, batch);
      for (std::size_t pack = first; pack < last; ++pack)
        scatter<is_crooked>(nodes, pack);
    }
  }

  /** Four cells as they are now; sums over the corners with the base vectors
      h_m are [component][mode]. Set step by step by kinematics(). */
  struct FourCells
  {
    Pack volume; // V_0 [m^3]
    /** F = sum x_a (x) B_a, the mean of the deformation gradient over the
        cell (Flanagan & Belytschko 1981), from the undeformed state. */
    PackMat F, inverse; // F^-1
    PackMat S;          // sum B_a (x) B_a [1/m^2]
    PackMat L;          // sum v_a (x) B_a [1/s], where velocities are needed
    Pack J, J_inverse;
    Pack edge;        // (V_0 J)^(1/3) [m]
    Pack modal[3][4]; // sum h_a x_a [m]
    Pack rate[3][4];  // sum h_a v_a [m/s], where velocities are needed
  };

private:
  /** From the positions of the corners of four cells to strain, spin, stable
      step and hourglass forces, on one page; advances what they keep. In the
      order of what depends on what: F, J; what inverts; l; strain for the
      material; F^-1; stable step and viscosity; modes; hourglass forces. k =
      4 (pack mod packs per batch) is the first point in the batch. */
  template <bool is_crooked>
  void kinematics(const CellConstants &constants, const NodalState &nodes,
                  const std::size_t pack, const double dt);
  template <bool is_crooked>
  void ask_for(const std::size_t pack) const;
  template <bool is_crooked>
  PackMat nodal_gradient(const std::size_t pack, const Corners &corners,
                         const Vec *nodal, Pack modal[3][4]) const;
  template <bool is_crooked>
  PackMat squares(const std::size_t pack) const;
  void rest_what_inverts(const NodalState &nodes, const std::size_t pack,
                         const Pack J_old, FourCells &cells);
  void store_strain(const PackMat &l, const FourCells &cells, const Pack J_old,
                    const std::size_t k);
  static void invert(FourCells &cells, Pending &out);
  static void present_squares(const FourCells &cells, Pack G[6]);
  Pack stable_step(const CellConstants &constants, const FourCells &cells,
                   const Pack trace, const double dt, const std::size_t k);
  static Pack step_of_quarter_volume(const FourCells &cells);
};

/** All cache lines of the pack that comes next: four cells have some 700 bytes
    of data, which the hardware's prefetcher finds too late. */
template <typename Form>
template <bool is_crooked>
SABOT_IN_LOOP void OnePointLoop<Form>::ask_for(const std::size_t pack) const
{
  if (pack >= geometry.size())
    return;
  const auto ask = [](const auto &data)
  {
    const auto *const bytes = reinterpret_cast<const char *>(&data);
    for (std::size_t i = 0; i < sizeof(data); i += 64)
      __builtin_prefetch(bytes + i);
  };
  ask(geometry[pack]);
  ask(motion[pack]);
  if constexpr (is_crooked)
    ask(warp[pack]);
}

/** sum a_a (x) B_a of nodal vectors, whose hourglass sums go to @p modal: F of
    positions, L of velocities. Rigid motion gives a rotation, since sum B_a =
    0. */
template <typename Form>
template <bool is_crooked>
SABOT_IN_LOOP PackMat OnePointLoop<Form>::nodal_gradient(const std::size_t pack,
                                                         const Corners &corners,
                                                         const Vec *const nodal,
                                                         Pack modal[3][4]) const
{
  Pack value[3][8];
  for (int a = 0; a < 8; ++a)
  {
    Pack p[3];
    const std::uint32_t node[n_lanes] = {corners.of[0][a], corners.of[1][a],
                                         corners.of[2][a], corners.of[3][a]};
    gather(nodal, node, p);
    for (int i = 0; i < 3; ++i)
      value[i][a] = p[i];
  }
  const Geometry &g = geometry[pack];
  PackMat sum = {};
  for (int i = 0; i < 3; ++i)
  {
    Pack linear[3];
    corner_sums(value[i], linear, modal[i]);
    for (int j = 0; j < 3; ++j)
    {
      for (int k = 0; k < 3; ++k)
        sum.m[i][j] += linear[k] * g.linear[k][j];
      if constexpr (is_crooked)
        for (int m = 0; m < 4; ++m)
          sum.m[i][j] += modal[i][m] * warp[pack].mode[m][j];
    }
  }
  return sum;
}

/** S = sum B_a (x) B_a [1/m^2], 8 times the squares by base vectors: cheaper
    than to read what they give. */
template <typename Form>
template <bool is_crooked>
SABOT_IN_LOOP PackMat OnePointLoop<Form>::squares(const std::size_t pack) const
{
  PackMat S = {};
  const auto add = [&S](const Pack B[3])
  {
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        S.m[i][j] += B[i] * B[j];
  };
  for (const auto &B : geometry[pack].linear)
    add(B);
  if constexpr (is_crooked)
    for (const auto &B : warp[pack].mode)
      add(B);
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
    {
      S.m[i][j] *= 8.;
      S.m[j][i] = S.m[i][j];
    }
  return S;
}

/** Cells that lost a third of their volume in one step are judged, see
    Hexahedra::avoid_inversion(). Out of the way of all others: one comparison
    for four cells. */
template <typename Form>
SABOT_IN_LOOP void
OnePointLoop<Form>::rest_what_inverts(const NodalState &nodes,
                                      const std::size_t pack, const Pack J_old,
                                      FourCells &cells)
{
  const auto lost = !(cells.J > 2. / 3. * J_old);
  if (lost[0] | lost[1] | lost[2] | lost[3])
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
    {
      const std::size_t e = pack * n_lanes + lane;
      if (lost[lane] && e < size() &&
          avoid_inversion(nodes, e, J_old[lane], cells.J[lane]))
      {
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            cells.F.m[i][j][lane] = motion[pack].m[i][j][lane];
        cells.J[lane] = J_old[lane];
      }
    }
}

/** What the material needs: strain increment sym l, spin increment skew l, J
    = det F and half of the mid volume V_0 (J + J_old)/2 [m^3]. Increments
    without unit in the middle configuration, into the points k to k + 3 of
    the batch. */
template <typename Form>
SABOT_IN_LOOP void
OnePointLoop<Form>::store_strain(const PackMat &l, const FourCells &cells,
                                 const Pack J_old, const std::size_t k)
{
  for (int d = 0; d < 3; ++d)
    store_pack(&batch.strain[d][k], l.m[d][d]);
  store_shear_and_spin(l, batch, k);
  store_pack(&batch.jacobian[k], cells.J);
  store_pack(&batch.half_volume[k], 0.25 * cells.volume * (cells.J + J_old));
}

/** F^-1, and V_0 J F^-T, by which stress becomes nodal forces: f_a = -(V_0 J
    sigma F^-T) B_a. Both come from the adjugate, J F^-1 = adj F, so that a
    division by J is needed for the inverse only. The unit of the second is
    [m^3]. */
template <typename Form>
SABOT_IN_LOOP void OnePointLoop<Form>::invert(FourCells &cells, Pending &out)
{
  const PackMat adjoint = adjugate(cells.F);
  cells.J_inverse = 1. / cells.J;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      cells.inverse.m[i][j] = cells.J_inverse * adjoint.m[i][j];
      out.stress_to_force.m[j][i] = cells.volume * adjoint.m[i][j];
    }
}

/** G = F^-T S F^-1, the sum over the corners of b_a (x) b_a with the present
    gradients b_a = F^-T B_a [1/m^2]; xx, yy, zz, xy, yz, xz. S = sum B_a (x)
    B_a is constant, so the eight corners are not visited again. G measures
    how thin the cell is now: a slab of thickness h has lambda_max G = 1/(2
    h^2). */
template <typename Form>
SABOT_IN_LOOP void OnePointLoop<Form>::present_squares(const FourCells &cells,
                                                       Pack G[6])
{
  const PackMat &inverse = cells.inverse;
  const PackMat half = multiply(cells.S, inverse);
  constexpr int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int n = 0; n < 6; ++n)
    G[n] = inverse.m[0][row[n]] * half.m[0][column[n]] +
           inverse.m[1][row[n]] * half.m[1][column[n]] +
           inverse.m[2][row[n]] * half.m[2][column[n]];
}

/**
 * Stable step, and the bulk viscosity that shortens it:
 *
 *   omega^2 <= 8 V/m (lambda tr G + 2 mu lambda_max G)  (doc/theory-fem.md),
 *   q = rho h (c1 c |d| + c2 h d^2) in compression,
 *
 * with the thickness h = (2 lambda_max G)^(-1/2), that of a slab. The damping
 * ratio of the cell's own compression is xi = c1 + c2 h |d|/c.
 *
 * Lame's constants are those at rest; Hexahedra shortens the step where the
 * material has stiffened. d = tr l / dt [1/s], negative when closing; at dt = 0
 * there is no rate and no viscosity. A negative lambda counts as 0, which keeps
 * the bound safe. Writes q [Pa] into the batch and returns the step [s] of each
 * lane.
 */
template <typename Form>
SABOT_IN_LOOP Pack OnePointLoop<Form>::stable_step(
    const CellConstants &constants, const FourCells &cells, const Pack trace,
    const double dt, const std::size_t k)
{
  const double c = constants.sound_speed, density = constants.density,
               c1 = constants.linear_bulk, c2 = constants.quadratic_bulk;
  Pack G[6];
  present_squares(cells, G);
  const Pack trace_G = G[0] + G[1] + G[2];
  const Pack largest = largest_eigenvalue_bound(G);
  const Pack thickness = pack_sqrt(0.5 / largest);
  const Pack elastic_step =
      2. / pack_sqrt(8. * cells.J / density *
                     (std::max(0., constants.lambda) * trace_G +
                      2. * constants.mu * largest));
  const double rate_factor = is_step(dt) ? 1. / dt : 0.;
  const Pack zero = {};
  const Pack closing = pack_max(zero, -rate_factor * trace);
  store_pack(&batch.viscous_pressure[k],
             density * cells.J_inverse * thickness * closing *
                 (c1 * c + c2 * thickness * closing));
  return damped_step(elastic_step, c1 + c2 / c * thickness * closing);
}

/** In which the present velocities take a quarter of the volume, the rate of
    which is J tr(L F^-1) with L = sum v_a (x) B_a. For the option shrink: dt
    <= 0.25/|tr L F^-1| [s] of each lane; about infinite for cells that
    expand. */
template <typename Form>
SABOT_IN_LOOP Pack
OnePointLoop<Form>::step_of_quarter_volume(const FourCells &cells)
{
  constexpr double slowest = 1e-300; // [1/s], so that nothing divides by zero
  const Pack zero = {};
  Pack rate = zero;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      rate += cells.L.m[i][j] * cells.inverse.m[j][i];
  return 0.25 / pack_max(-rate, slowest + zero);
}

/**
 * One step of four cells:
 *
 *   F = sum x_a (x) B_a                      deformation gradient
 *   l = (F - F_old) F_m^-1                   strain and spin increment
 *   V_0 J F^-T                               from stress to forces
 *   dt, q                                    stable step, bulk viscosity
 *   sum h_a x_a                              hourglass modes, by the form
 *
 * The stress follows for a whole batch (update_points), then the forces
 * (scatter).
 */
template <typename Form>
template <bool is_crooked>
void OnePointLoop<Form>::kinematics(const CellConstants &constants,
                                    const NodalState &nodes,
                                    const std::size_t pack, const double dt)
{
  const bool shrinks = options.inversion == FemOptions::Inversion::shrink;
  Motion &F_old = motion[pack];
  Pending &out = pending[pack % packs_per_batch];
  const std::size_t k = pack % packs_per_batch * n_lanes;
  FourCells cells;
  cells.volume = load_pack(&volume[pack * n_lanes]);
  const Corners nodes_of = corners(pack);
  ask_for<is_crooked>(pack + 1);

  cells.F = nodal_gradient<is_crooked>(pack, nodes_of, nodes.position.data(),
                                       cells.modal);
  const Pack J_old = determinant(F_old);
  cells.J = determinant(cells.F);
  rest_what_inverts(nodes, pack, J_old, cells);
  const PackMat l = midpoint_increment(F_old, cells.F);
  F_old = cells.F;
  const Pack trace = l.m[0][0] + l.m[1][1] + l.m[2][2];
  store_strain(l, cells, J_old, k);
  invert(cells, out);
  cells.S = squares<is_crooked>(pack);
  Pack step = stable_step(constants, cells, trace, dt, k);

  cells.edge = pack_cbrt(cells.volume * cells.J);
  if (Form::needs_velocities || shrinks)
    cells.L = nodal_gradient<is_crooked>(pack, nodes_of, nodes.velocity.data(),
                                         cells.rate);
  if (shrinks)
    step = pack_min(step, step_of_quarter_volume(cells));
  static_cast<Form *>(this)->template hourglass<is_crooked>(constants, cells,
                                                            dt, pack, out);
  store_pack(&batch.step[k], step);
}
} // namespace sabot

#endif
