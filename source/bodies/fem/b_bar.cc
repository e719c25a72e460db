#include "sabot/bodies/fem/b_bar.h"

#include <cmath>

namespace sabot
{
namespace
{
inline double sum_lanes(const Pack a)
{
  return a[0] + a[1] + a[2] + a[3];
}

/** Signs of the corners of the reference cell, VTK order. */
constexpr int corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},
                              {-1, 1, -1},  {-1, -1, 1}, {1, -1, 1},
                              {1, 1, 1},    {-1, 1, 1}};
} // namespace

void BBar::set_up(const HexMesh &mesh, const std::vector<GlobalIndex> &ids,
                  const std::vector<std::array<std::uint32_t, 8>> &nodes)
{
  connectivity = nodes;
  cell_id = ids;
  geometry.resize(size());
  motion.resize(size());
  const double at = 1. / std::sqrt(3.);
  for (std::size_t e = 0; e < size(); ++e)
  {
    Geometry &g = geometry[e];
    volume.push_back(0.);
    for (int q = 0; q < 8; ++q)
    {
      Vec derivative[8]; // in the reference cell
      Mat J = Mat::zero();
      for (int a = 0; a < 8; ++a)
      {
        double f[3];
        for (int d = 0; d < 3; ++d)
          f[d] = 0.5 * (1. + corner[a][d] * corner[q][d] * at);
        derivative[a] = vec(0.5 * corner[a][0] * f[1] * f[2],
                            0.5 * corner[a][1] * f[0] * f[2],
                            0.5 * corner[a][2] * f[0] * f[1]);
        const auto &X = mesh.nodes[mesh.cells[ids[e]][a]];
        add_outer(J, vec(X[0], X[1], X[2]), derivative[a]);
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
      volume.back() += det;
    }
    for (PackMat &F : motion[e].F)
    {
      F = {};
      for (int d = 0; d < 3; ++d)
        F.m[d][d] += 1.;
    }
  }
  allocate_points();
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
  const std::size_t n = size();
  for (std::size_t begin = 0; begin < n; begin += cells_per_batch)
  {
    const std::size_t end = std::min(begin + cells_per_batch, n);
    for (std::size_t e = begin; e < end; ++e)
      kinematics(nodes, e, dt);
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

void BBar::kinematics(const NodalState &nodes, const std::size_t e,
                      const double dt)
{
  const double c = material->sound_speed(), density = material->density(),
               mu = material->shear_modulus(),
               lambda = material->bulk_modulus() - 2. / 3. * mu;
  const Geometry &g = geometry[e];
  const std::size_t first = e % cells_per_batch * 8;
  Vec x[8], mean[8] = {}; // mean: v times the mean present gradients
  for (int a = 0; a < 8; ++a)
    x[a] = nodes.position[connectivity[e][a]];

  PackMat F[n_packs], l[n_packs];
  Pack weight[n_packs];
  double cell_volume = 0., middle_volume = 0., expansion = 0., shear_bound = 0.;
  for (int p = 0; p < n_packs; ++p)
  {
    F[p] = {};
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          F[p].m[i][j] += x[a][i] * g.B[p][a][j];
    const PackMat &old = motion[e].F[p];
    const Pack J_old = determinant(old);
    Pack J = determinant(F[p]);
    const auto lost = !(J > 2. / 3. * J_old);
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
      if (lost[lane] && avoid_inversion(nodes, e, J_old[lane], J[lane]))
      {
        // The cell goes at the end of the step; until then it stays as it was.
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            F[p].m[i][j][lane] = old.m[i][j][lane];
        J[lane] = J_old[lane];
      }
    PackMat change, middle;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        change.m[i][j] = F[p].m[i][j] - old.m[i][j];
        middle.m[i][j] = 0.5 * (F[p].m[i][j] + old.m[i][j]);
      }
    const Pack factor = 1. / determinant(middle);
    l[p] = multiply(change, adjugate(middle));
    for (auto &row : l[p].m)
      for (Pack &entry : row)
        entry *= factor;
    weight[p] = 0.5 * g.volume[p] * (J + J_old);
    store_pack(&batch.half_volume[first + p * n_lanes], 0.5 * weight[p]);
    middle_volume += sum_lanes(weight[p]);
    expansion +=
        sum_lanes(weight[p] * (l[p].m[0][0] + l[p].m[1][1] + l[p].m[2][2]));
    cell_volume += sum_lanes(g.volume[p] * J);

    // Present gradients, their mean and the squares that bound the shear.
    const PackMat adjoint = adjugate(F[p]);
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
        mean[a][i] += sum_lanes(g.volume[p] * vb);
        b[i] = J_inverse * vb;
      }
      G[0] += b[0] * b[0];
      G[1] += b[1] * b[1];
      G[2] += b[2] * b[2];
      G[3] += b[0] * b[1];
      G[4] += b[1] * b[2];
      G[5] += b[0] * b[2];
    }
    const Pack largest =
        pack_min(G[0] + G[1] + G[2],
                 pack_sqrt(G[0] * G[0] + G[1] * G[1] + G[2] * G[2] +
                           2. * (G[3] * G[3] + G[4] * G[4] + G[5] * G[5])));
    shear_bound += sum_lanes(g.volume[p] * J * largest);
  }

  Mat mean_square = Mat::zero();
  for (const Vec b : mean)
    add_outer(mean_square, b, (1. / (cell_volume * cell_volume)) * b);
  const double trace_G = trace(mean_square);
  const double thickness = std::sqrt(
      0.5 / std::min(trace_G, std::sqrt(norm_square(mean_square.row[0]) +
                                        norm_square(mean_square.row[1]) +
                                        norm_square(mean_square.row[2]))));
  // omega^2 <= 8/m sum_q v_q (lambda tr G + 2 mu lambda_max G_q), with the mean
  // gradients in the first term (doc/theory-fem.md).
  const double elastic_step =
      2. / std::sqrt(8. / (density * volume[e]) *
                     (cell_volume * std::max(0., lambda) * trace_G +
                      2. * mu * shear_bound));
  const double mean_trace = expansion / middle_volume,
               closing = dt > 0. ? std::max(0., -mean_trace / dt) : 0.,
               J_mean = cell_volume / volume[e];
  const double c1 = options.bulk_viscosity_linear,
               c2 = options.bulk_viscosity_quadratic;
  const double q = density / J_mean * thickness * closing *
                   (c1 * c + c2 * thickness * closing);
  const double xi = c1 + c2 / c * thickness * closing;
  double step = elastic_step * (std::sqrt(1. + xi * xi) - xi);
  if (options.inversion == FemOptions::Inversion::shrink)
  {
    // Volume rate by the present velocities, point by point.
    double fastest = 1e-300;
    for (int p = 0; p < n_packs; ++p)
    {
      const PackMat adjoint = adjugate(F[p]);
      const Pack J = determinant(F[p]);
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
    step = std::min(step, 0.25 / fastest);
  }
  batch.step[first] = step;

  for (int p = 0; p < n_packs; ++p)
  {
    const std::size_t k = first + p * n_lanes;
    const auto &m = l[p].m;
    const Pack shift = (mean_trace - (m[0][0] + m[1][1] + m[2][2])) / 3.;
    for (int d = 0; d < 3; ++d)
      store_pack(&batch.strain[d][k], m[d][d] + shift);
    store_pack(&batch.strain[3][k], 0.5 * (m[0][1] + m[1][0]));
    store_pack(&batch.strain[4][k], 0.5 * (m[1][2] + m[2][1]));
    store_pack(&batch.strain[5][k], 0.5 * (m[0][2] + m[2][0]));
    store_pack(&batch.spin[0][k], 0.5 * (m[0][1] - m[1][0]));
    store_pack(&batch.spin[1][k], 0.5 * (m[1][2] - m[2][1]));
    store_pack(&batch.spin[2][k], 0.5 * (m[0][2] - m[2][0]));
    store_pack(&batch.jacobian[k], J_mean + Pack{});
    store_pack(&batch.viscous_pressure[k], q + Pack{});
    motion[e].F[p] = F[p];
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
  for (int a = 0; a < 8; ++a)
    force[a] = Vec{};
  for (int p = 0; p < n_packs; ++p)
  {
    const Pack *const s = stress[p];
    const PackMat sigma = {{{s[0] + mean, s[3], s[5]},
                            {s[3], s[1] + mean, s[4]},
                            {s[5], s[4], s[2] + mean}}};
    PackMat P; // V_q J sigma F^-T
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P.m[i][j] = g.volume[p] * (sigma.m[i][0] * adjoint[p].m[j][0] +
                                   sigma.m[i][1] * adjoint[p].m[j][1] +
                                   sigma.m[i][2] * adjoint[p].m[j][2]);
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i)
        force[a][i] -=
            sum_lanes(P.m[i][0] * g.B[p][a][0] + P.m[i][1] * g.B[p][a][1] +
                      P.m[i][2] * g.B[p][a][2]);
  }
}

Mat BBar::gradient(const std::size_t point) const
{
  return lane_of(motion[point / 8].F[point % 8 / n_lanes], point % n_lanes);
}

void BBar::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("motion", motion);
  Hexahedra::visit_state(visitor);
}
} // namespace sabot
