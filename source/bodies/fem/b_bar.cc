// Hexahedra with eight points and the mean volumetric strain (B-bar).
#include "sabot/bodies/fem/b_bar.h"

#include "sabot/base/registry.h"

#include <cmath>

namespace sabot
{
namespace
{
inline double sum_lanes(const Pack a)
{
  return a[0] + a[1] + a[2] + a[3];
}

/** The sums over the lanes of three packs, by shuffles of all three at once. */
inline Vec sum_lanes(const Pack a[3])
{
  Vec lane[n_lanes];
  unpack(a[0], a[1], a[2], lane);
  return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

/** Signs of the corners of the reference cell, VTK order. */
constexpr int corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},
                              {-1, 1, -1},  {-1, -1, 1}, {1, -1, 1},
                              {1, 1, 1},    {-1, 1, 1}};
} // namespace

void BBar::set_up(LocalCells cells, const AlignedVector<Vec> &X)
{
  take(std::move(cells));
  geometry.resize(size());
  motion.resize(size());
  for (std::size_t e = 0; e < size(); ++e)
  {
    // That of the points, to the last bit.
    volume[e] = 0.;
    for (int q = 0; q < 8; ++q)
      volume[e] += set_up_point(corners_of(e, X), q, geometry[e]);
    for (PackMat &F : motion[e].F)
    {
      F = {};
      for (int d = 0; d < 3; ++d)
        F.m[d][d] += 1.;
    }
  }
}

/** Gradients at Gauss point @p q of a cell with the corners @p X.
    @return its volume [m^3]. */
double BBar::set_up_point(const std::array<Vec, 8> &X, const int q, Geometry &g)
{
  const double at = 1. / std::sqrt(3.);
  Vec derivative[8]; // in the reference cell
  Mat J = Mat::zero();
  for (int a = 0; a < 8; ++a)
  {
    double f[3];
    for (int d = 0; d < 3; ++d)
      f[d] = 0.5 * (1. + corner[a][d] * corner[q][d] * at);
    derivative[a] =
        vec(0.5 * corner[a][0] * f[1] * f[2], 0.5 * corner[a][1] * f[0] * f[2],
            0.5 * corner[a][2] * f[0] * f[1]);
    add_outer(J, X[a], derivative[a]);
  }
  double det;
  const Mat to_space = transpose(inverse(J, det));
  for (int a = 0; a < 8; ++a)
  {
    const Vec B = to_space * derivative[a];
    for (int d = 0; d < 3; ++d)
      g.B[q / n_lanes][a][d][q % n_lanes] = B[d];
  }
  g.volume[q / n_lanes][q % n_lanes] = det;
  return det;
}

void BBar::keep(const std::vector<std::size_t> &kept)
{
  for (std::size_t e = 0; e < kept.size(); ++e)
  {
    geometry[e] = geometry[kept[e]];
    motion[e] = motion[kept[e]];
  }
  geometry.resize(kept.size());
  motion.resize(kept.size());
  keep_points(kept);
}

void BBar::add_forces(NodalState &nodes, const double dt)
{
  reset_steps();
  const CellConstants constants = cell_constants();
  const std::size_t n = size();
  for (std::size_t begin = 0; begin < n; begin += cells_per_batch)
  {
    const std::size_t end = std::min(begin + cells_per_batch, n);
    for (std::size_t e = begin; e < end; ++e)
      kinematics(constants, nodes, e, dt);
    update_points(8 * begin, 8 * (end - begin), dt, batch);
    for (std::size_t e = begin; e < end; ++e)
    {
      Vec force[8];
      cell_forces(nodes, e, force);
      for (int a = 0; a < 8; ++a)
        nodes.force[connectivity[e][a]] += force[a];
    }
  }
}

/** F, l and the sums over the cell that the points of pack @p p add to. */
SABOT_IN_LOOP void BBar::add_points(const NodalState &nodes,
                                    const std::size_t e, const int p,
                                    const Vec x[8], Moving &cell)
{
  const Geometry &g = geometry[e];
  PackMat &F = cell.F[p];
  F = {};
  for (int a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        F.m[i][j] += x[a][i] * g.B[p][a][j];
  const PackMat &old = motion[e].F[p];
  const Pack J_old = determinant(old);
  Pack J = determinant(F);
  const auto lost = !(J > 2. / 3. * J_old);
  if (lost[0] | lost[1] | lost[2] | lost[3])
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
      if (lost[lane] && avoid_inversion(nodes, e, J_old[lane], J[lane]))
      {
        // The cell goes at the end of the step; until then it stays as it was.
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            F.m[i][j][lane] = old.m[i][j][lane];
        J[lane] = J_old[lane];
      }
  const PackMat &l = cell.l[p] = midpoint_increment(old, F);
  const Pack weight = 0.5 * g.volume[p] * (J + J_old);
  store_pack(&batch.half_volume[e % cells_per_batch * 8 + p * n_lanes],
             0.5 * weight);
  cell.middle_volume += sum_lanes(weight);
  cell.expansion += sum_lanes(weight * (l.m[0][0] + l.m[1][1] + l.m[2][2]));
  cell.volume += sum_lanes(g.volume[p] * J);
  add_present_gradients(g, p, J, cell);
}

/** Present gradients of the points of pack @p p: their mean over the cell, and
    the squares that bound the shear. */
SABOT_IN_LOOP void BBar::add_present_gradients(const Geometry &g, const int p,
                                               const Pack J, Moving &cell)
{
  const PackMat adjoint = adjugate(cell.F[p]);
  const Pack J_inverse = 1. / J;
  Pack G[6] = {};
  for (int a = 0; a < 8; ++a)
  {
    Pack b[3];
    for (int i = 0; i < 3; ++i)
    {
      const Pack vb = adjoint.m[0][i] * g.B[p][a][0] +
                      adjoint.m[1][i] * g.B[p][a][1] +
                      adjoint.m[2][i] * g.B[p][a][2];
      cell.mean[a][i] += g.volume[p] * vb;
      b[i] = J_inverse * vb;
    }
    G[0] += b[0] * b[0];
    G[1] += b[1] * b[1];
    G[2] += b[2] * b[2];
    G[3] += b[0] * b[1];
    G[4] += b[1] * b[2];
    G[5] += b[0] * b[2];
  }
  cell.shear_bound += sum_lanes(g.volume[p] * J * largest_eigenvalue_bound(G));
}

/**
 * Stable step, and the bulk viscosity @p q that shortens it:
 *
 *   omega^2 <= 8/m sum_q v_q (lambda tr G + 2 mu lambda_max G_q)
 *
 * with the mean gradients in the first term (doc/theory-fem.md); viscosity as
 * in one-point cells, by the mean rate of the volume.
 */
SABOT_IN_LOOP double BBar::stable_step(const CellConstants &constants,
                                       const double reference_volume,
                                       const double dt, const Moving &cell,
                                       double &q)
{
  const double c = constants.sound_speed, density = constants.density,
               c1 = constants.linear_bulk, c2 = constants.quadratic_bulk;
  Mat mean_square = Mat::zero();
  for (const auto &lanes : cell.mean)
  {
    const Vec b = sum_lanes(lanes);
    add_outer(mean_square, b, (1. / (cell.volume * cell.volume)) * b);
  }
  const double trace_G = trace(mean_square);
  const double thickness = std::sqrt(
      0.5 / std::min(trace_G, std::sqrt(norm_square(mean_square.row[0]) +
                                        norm_square(mean_square.row[1]) +
                                        norm_square(mean_square.row[2]))));
  const double elastic_step =
      2. / std::sqrt(8. / (density * reference_volume) *
                     (cell.volume * std::max(0., constants.lambda) * trace_G +
                      2. * constants.mu * cell.shear_bound));
  const double mean_trace = cell.expansion / cell.middle_volume,
               closing = is_step(dt) ? std::max(0., -mean_trace / dt) : 0.,
               J_mean = cell.volume / reference_volume;
  q = density / J_mean * thickness * closing *
      (c1 * c + c2 * thickness * closing);
  const double xi = c1 + c2 / c * thickness * closing;
  return elastic_step * (std::sqrt(1. + xi * xi) - xi);
}

/** In which the present velocities take a quarter of a point's volume. */
double BBar::step_of_quarter_volume(const NodalState &nodes,
                                    const std::size_t e,
                                    const Moving &cell) const
{
  const Geometry &g = geometry[e];
  double fastest = 1e-300; // [1/s], so that nothing divides by zero
  for (int p = 0; p < n_packs; ++p)
  {
    const PackMat adjoint = adjugate(cell.F[p]);
    const Pack J = determinant(cell.F[p]);
    Pack rate = {};
    for (int a = 0; a < 8; ++a)
    {
      const Vec v = nodes.velocity[connectivity[e][a]];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          rate += v[i] * adjoint.m[j][i] * g.B[p][a][j];
    }
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
      fastest = std::max(fastest, -rate[lane] / J[lane]);
  }
  return 0.25 / fastest;
}

void BBar::kinematics(const CellConstants &constants, const NodalState &nodes,
                      const std::size_t e, const double dt)
{
  const std::size_t first = e % cells_per_batch * 8;
  Vec x[8];
  for (int a = 0; a < 8; ++a)
    x[a] = nodes.position[connectivity[e][a]];
  Moving cell = {};
  for (int p = 0; p < n_packs; ++p)
    add_points(nodes, e, p, x, cell);

  double q;
  double step = stable_step(constants, volume[e], dt, cell, q);
  if (options.inversion == FemOptions::Inversion::shrink)
    step = std::min(step, step_of_quarter_volume(nodes, e, cell));
  batch.step[first] = step;

  const double mean_trace = cell.expansion / cell.middle_volume,
               J_mean = cell.volume / volume[e];
  for (int p = 0; p < n_packs; ++p)
  {
    const std::size_t k = first + p * n_lanes;
    const auto &m = cell.l[p].m;
    const Pack shift = (mean_trace - (m[0][0] + m[1][1] + m[2][2])) / 3.;
    for (int d = 0; d < 3; ++d)
      store_pack(&batch.strain[d][k], m[d][d] + shift);
    store_shear_and_spin(cell.l[p], batch, k);
    store_pack(&batch.jacobian[k], J_mean + Pack{});
    store_pack(&batch.viscous_pressure[k], q + Pack{});
    motion[e].F[p] = cell.F[p];
  }
}

void BBar::cell_forces(const NodalState &, const std::size_t e,
                       Vec force[8]) const
{
  const Geometry &g = geometry[e];
  PackMat adjoint[n_packs];
  Pack stress[n_packs][6];
  double mean = 0., cell_volume = 0.;
  for (int p = 0; p < n_packs; ++p)
  {
    const std::size_t point = 8 * e + p * n_lanes;
    const PackMat &F = motion[e].F[p];
    adjoint[p] = adjugate(F);
    for (int s = 0; s < 6; ++s)
      stress[p][s] = load_pack(points.stress_row(s) + point);
    const Pack v = g.volume[p] * determinant(F);
    const Pack pressure = (stress[p][0] + stress[p][1] + stress[p][2]) / 3.;
    cell_volume += sum_lanes(v);
    mean +=
        sum_lanes(v * (pressure - load_pack(&points.viscous_pressure[point])));
    for (int d = 0; d < 3; ++d)
      stress[p][d] -= pressure;
  }
  mean /= cell_volume;
  PackMat P[n_packs]; // V_q J sigma F^-T
  for (int p = 0; p < n_packs; ++p)
  {
    const Pack *const s = stress[p];
    const PackMat sigma = {{{s[0] + mean, s[3], s[5]},
                            {s[3], s[1] + mean, s[4]},
                            {s[5], s[4], s[2] + mean}}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P[p].m[i][j] = g.volume[p] * (sigma.m[i][0] * adjoint[p].m[j][0] +
                                      sigma.m[i][1] * adjoint[p].m[j][1] +
                                      sigma.m[i][2] * adjoint[p].m[j][2]);
  }
  for (int a = 0; a < 8; ++a)
  {
    Pack sum[3] = {};
    for (int p = 0; p < n_packs; ++p)
      for (int i = 0; i < 3; ++i)
        sum[i] += dot(P[p].m[i], g.B[p][a]);
    force[a] = -sum_lanes(sum);
  }
}

Mat BBar::gradient(const std::size_t point) const
{
  return lane_of(motion[point / 8].F[point % 8 / n_lanes], point % n_lanes);
}

double BBar::volume_ratio(const std::size_t e) const
{
  double present = 0.;
  for (int p = 0; p < n_packs; ++p)
    present += sum_lanes(geometry[e].volume[p] * determinant(motion[e].F[p]));
  return present / volume[e];
}

void BBar::visit_state(StateVisitor &visitor, const StateItems &of_cells)
{
  visitor.visit_items("motion", motion, of_cells);
  Hexahedra::visit_state(visitor, of_cells);
}

namespace
{
const Registry<Hexahedra>::Add
    b_bar({"B-bar",
           "eight points with the mean volumetric strain: no hourglass modes, "
           "no volumetric locking, several times the cost.",
           {},
           [](const std::string &body_name, const FemOptions &options,
              std::shared_ptr<const Material> material) {
             return std::make_unique<BBar>(body_name, options,
                                           std::move(material));
           }});
} // namespace
} // namespace sabot
