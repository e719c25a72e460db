#include "sabot/bodies/fem/one_point.h"

#include "sabot/bodies/fem/hourglass.h"

#include <cmath>
#include <cstring>

namespace sabot
{
namespace
{
/** The doubles of one lane of a struct made of packs. */
template <typename Packs>
void copy_lane(const Packs &from, const std::size_t from_lane, Packs &to,
               const std::size_t to_lane)
{
  const auto *const source = reinterpret_cast<const double *>(&from);
  auto *const target = reinterpret_cast<double *>(&to);
  for (std::size_t i = 0; i < sizeof(Packs) / sizeof(double); i += n_lanes)
    target[i + to_lane] = source[i + from_lane];
}

/** Ask for all cache lines of a struct that is needed soon. */
template <typename T>
inline void prefetch(const T &data)
{
  const auto *const bytes = reinterpret_cast<const char *>(&data);
  for (std::size_t i = 0; i < sizeof(T); i += 64)
    __builtin_prefetch(bytes + i);
}

inline Pack dot(const Pack a[3], const Pack b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
} // namespace

void OnePoint::set_up(const HexMesh &mesh, const std::vector<GlobalIndex> &ids,
                      const std::vector<std::array<std::uint32_t, 8>> &nodes)
{
  connectivity = nodes;
  cell_id = ids;
  constexpr int h[4][8] = {{1, 1, -1, -1, -1, -1, 1, 1},
                           {1, -1, -1, 1, -1, 1, 1, -1},
                           {1, -1, 1, -1, 1, -1, 1, -1},
                           {-1, 1, -1, 1, 1, -1, 1, -1}};
  const std::size_t n_packs = round_up(size(), batch_size) / n_lanes;
  geometry.resize(n_packs);
  motion.resize(n_packs);
  std::memset(static_cast<void *>(geometry.data()), 0,
              n_packs * sizeof(Geometry));
  std::memset(static_cast<void *>(motion.data()), 0, n_packs * sizeof(Motion));
  for (std::size_t e = 0; e < size(); ++e)
  {
    Geometry &g = geometry[e / n_lanes];
    Motion &m = motion[e / n_lanes];
    const std::size_t lane = e % n_lanes;
    const GlobalIndex c = ids[e];
    volume.push_back(mesh.volume[c]);
    g.volume[lane] = mesh.volume[c];
    g.size_square[lane] = std::pow(mesh.volume[c], 2. / 3.);
    constexpr int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int a = 0; a < 8; ++a)
    {
      const auto &B = mesh.mean_gradient[c][a];
      const auto &X = mesh.nodes[mesh.cells[c][a]];
      g.node[a][lane] = nodes[e][a];
      for (int d = 0; d < 3; ++d)
      {
        g.B[a][d][lane] = B[d];
        if (options.hourglass == FemOptions::Hourglass::stiffness)
          for (int k = 0; k < 4; ++k)
            m.mode[k][d][lane] += h[k][a] * X[d];
      }
      for (int s = 0; s < 6; ++s)
        g.square[s][lane] += B[row[s]] * B[column[s]];
    }
    for (int d = 0; d < 3; ++d)
      m.F.m[d][d][lane] = 1.;
  }
  allocate_points();
  fill_up();
}

void OnePoint::fill_up()
{
  // Lanes without a cell repeat the last one, without volume.
  const std::size_t n = size();
  if (n == 0)
    return;
  for (std::size_t e = n; e < round_up(n, batch_size); ++e)
  {
    const std::size_t last = (n - 1) / n_lanes, last_lane = (n - 1) % n_lanes,
                      pack = e / n_lanes, lane = e % n_lanes;
    Geometry &g = geometry[pack];
    copy_lane(motion[last], last_lane, motion[pack], lane);
    for (int a = 0; a < 8; ++a)
    {
      g.node[a][lane] = geometry[last].node[a][last_lane];
      for (int d = 0; d < 3; ++d)
        g.B[a][d][lane] = geometry[last].B[a][d][last_lane];
    }
    for (int s = 0; s < 6; ++s)
      g.square[s][lane] = geometry[last].square[s][last_lane];
    g.volume[lane] = g.size_square[lane] = 0.;
  }
}

void OnePoint::keep(const std::vector<std::size_t> &kept)
{
  for (std::size_t e = 0; e < kept.size(); ++e)
  {
    const std::size_t from = kept[e] / n_lanes, from_lane = kept[e] % n_lanes,
                      to = e / n_lanes, lane = e % n_lanes;
    copy_lane(motion[from], from_lane, motion[to], lane);
    const Geometry &source = geometry[from];
    Geometry &g = geometry[to];
    for (int a = 0; a < 8; ++a)
    {
      g.node[a][lane] = source.node[a][from_lane];
      for (int d = 0; d < 3; ++d)
        g.B[a][d][lane] = source.B[a][d][from_lane];
    }
    for (int s = 0; s < 6; ++s)
      g.square[s][lane] = source.square[s][from_lane];
    g.volume[lane] = source.volume[from_lane];
    g.size_square[lane] = source.size_square[from_lane];
  }
  keep_points(kept);
  geometry.resize(round_up(size(), batch_size) / n_lanes);
  motion.resize(geometry.size());
  fill_up();
}

void OnePoint::add_forces(NodalState &nodes, const double dt)
{
  if (options.hourglass == FemOptions::Hourglass::viscous)
    compute<true>(nodes, dt);
  else
    compute<false>(nodes, dt);
}

template <bool viscous>
void OnePoint::compute(NodalState &nodes, const double dt)
{
  reset_steps();
  const std::size_t n = size();
  for (std::size_t begin = 0; begin < n; begin += batch_size)
  {
    const std::size_t m = std::min(batch_size, round_up(n - begin, 8)),
                      first = begin / n_lanes, last = first + m / n_lanes;
    for (std::size_t pack = first; pack < last; ++pack)
      kinematics<viscous>(nodes, pack, dt);
    update_points(begin, m, dt, batch);
    for (std::size_t pack = first; pack < last; ++pack)
      scatter(nodes, pack);
  }
}

template <bool viscous>
void OnePoint::kinematics(const NodalState &nodes, const std::size_t pack,
                          const double dt)
{
  const double c = material->sound_speed(), density = material->density(),
               mu = material->shear_modulus(),
               lambda = material->bulk_modulus() - 2. / 3. * mu;
  const Geometry &g = geometry[pack];
  Motion &old = motion[pack];
  if (pack + 1 < geometry.size())
  {
    prefetch(geometry[pack + 1]);
    prefetch(motion[pack + 1]);
  }
  const std::size_t k = pack % packs_per_batch * n_lanes;
  Pending &out = pending[pack % packs_per_batch];

  Pack x[3][8]; // by component, for the hourglass sums
  PackMat F = {};
  for (int a = 0; a < 8; ++a)
  {
    Pack p[3];
    gather(nodes.position.data(), g.node[a], p);
    for (int i = 0; i < 3; ++i)
    {
      x[i][a] = p[i];
      for (int j = 0; j < 3; ++j)
        F.m[i][j] += p[i] * g.B[a][j];
    }
  }
  const Pack J_old = determinant(old.F);
  Pack J = determinant(F);
  const auto lost = !(J > 2. / 3. * J_old);
  if (lost[0] | lost[1] | lost[2] | lost[3])
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
    {
      const std::size_t e = pack * n_lanes + lane;
      if (lost[lane] && e < size() &&
          avoid_inversion(nodes, e, J_old[lane], J[lane]))
      {
        copy_lane(old.F, lane, F, lane);
        J[lane] = J_old[lane];
      }
    }

  // Increment of the displacement gradient in the mid configuration.
  PackMat change, middle;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      change.m[i][j] = F.m[i][j] - old.F.m[i][j];
      middle.m[i][j] = 0.5 * (F.m[i][j] + old.F.m[i][j]);
    }
  const Pack middle_factor = 1. / determinant(middle);
  PackMat l = multiply(change, adjugate(middle));
  for (auto &row : l.m)
    for (Pack &entry : row)
      entry *= middle_factor;
  old.F = F;
  const Pack trace = l.m[0][0] + l.m[1][1] + l.m[2][2];
  for (int d = 0; d < 3; ++d)
    store_pack(&batch.strain[d][k], l.m[d][d]);
  store_pack(&batch.strain[3][k], 0.5 * (l.m[0][1] + l.m[1][0]));
  store_pack(&batch.strain[4][k], 0.5 * (l.m[1][2] + l.m[2][1]));
  store_pack(&batch.strain[5][k], 0.5 * (l.m[0][2] + l.m[2][0]));
  store_pack(&batch.spin[0][k], 0.5 * (l.m[0][1] - l.m[1][0]));
  store_pack(&batch.spin[1][k], 0.5 * (l.m[1][2] - l.m[2][1]));
  store_pack(&batch.spin[2][k], 0.5 * (l.m[0][2] - l.m[2][0]));
  store_pack(&batch.jacobian[k], J);
  store_pack(&batch.half_volume[k], 0.25 * g.volume * (J + J_old));

  const PackMat adjoint = adjugate(F);
  const Pack J_inverse = 1. / J;
  PackMat inverse;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      inverse.m[i][j] = J_inverse * adjoint.m[i][j];
      out.stress_to_force.m[j][i] = g.volume * adjoint.m[i][j];
    }

  // omega^2 <= 8 V/m (lambda tr G + 2 mu lambda_max G), G = F^-T S F^-1 with
  // the present gradients (doc/theory-fem.md). A slab of thickness h has
  // lambda_max = 1/(2 h^2).
  const Pack *const s = g.square;
  const PackMat S = {
      {{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}}};
  const PackMat half = multiply(S, inverse);
  Pack G[6];
  constexpr int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int n = 0; n < 6; ++n)
    G[n] = inverse.m[0][row[n]] * half.m[0][column[n]] +
           inverse.m[1][row[n]] * half.m[1][column[n]] +
           inverse.m[2][row[n]] * half.m[2][column[n]];
  const Pack trace_G = G[0] + G[1] + G[2];
  const Pack largest = pack_min(
      trace_G, pack_sqrt(G[0] * G[0] + G[1] * G[1] + G[2] * G[2] +
                         2. * (G[3] * G[3] + G[4] * G[4] + G[5] * G[5])));
  const Pack thickness = pack_sqrt(0.5 / largest);
  const Pack elastic_step =
      2. / pack_sqrt(8. * J / density *
                     (std::max(0., lambda) * trace_G + 2. * mu * largest));

  // Bulk viscosity, q = rho h (c1 c |d| + c2 h d^2) in compression. It shortens
  // the step: damping ratio xi of the cell's own compression.
  const double rate_factor = dt > 0. ? 1. / dt : 0.;
  const Pack zero = {};
  const Pack closing = pack_max(zero, -rate_factor * trace);
  const double c1 = options.bulk_viscosity_linear,
               c2 = options.bulk_viscosity_quadratic;
  store_pack(&batch.viscous_pressure[k],
             density * J_inverse * thickness * closing *
                 (c1 * c + c2 * thickness * closing));
  const Pack xi = c1 + c2 / c * thickness * closing;
  Pack step = elastic_step * (pack_sqrt(1. + xi * xi) - xi);

  // Flanagan & Belytschko 1981: viscosity ~ rho c V^(2/3), stiffness
  // ~ rho c^2 V^(1/3), both for base vectors of unit entries.
  const Pack root = pack_cbrt(J);
  Pack modal[3][4];
  for (int i = 0; i < 3; ++i)
    hourglass_sums(x[i], modal[i]);
  out.hourglass = {};
  PackMat L = {}; // velocity gradient by reference gradients
  if (viscous || options.inversion == FemOptions::Inversion::shrink)
  {
    for (int a = 0; a < 8; ++a)
    {
      Pack v[3];
      gather(nodes.velocity.data(), g.node[a], v);
      for (int i = 0; i < 3; ++i)
      {
        x[i][a] = v[i];
        for (int j = 0; j < 3; ++j)
          L.m[i][j] += v[i] * g.B[a][j];
      }
    }
    if (options.inversion == FemOptions::Inversion::shrink)
    {
      Pack rate = zero;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          rate += L.m[i][j] * inverse.m[j][i];
      step = pack_min(step, 0.25 / pack_max(-rate, 1e-300 + zero));
    }
  }
  Pack work = zero;
  if (viscous)
  {
    const Pack coefficient = options.hourglass_coefficient * 0.25 * density *
                             c * g.size_square * root * root;
    Pack pulled[4][3], overlap = zero;
    for (int m = 0; m < 4; ++m)
    {
      const Pack mode[3] = {modal[0][m], modal[1][m], modal[2][m]};
      for (int i = 0; i < 3; ++i)
        pulled[m][i] = dot(inverse.m[i], mode);
      const Pack S_pulled[3] = {dot(S.m[0], pulled[m]), dot(S.m[1], pulled[m]),
                                dot(S.m[2], pulled[m])};
      overlap += dot(pulled[m], S_pulled);
    }
    // gamma_a = h_a - p.B_a: in a flattened, crooked cell the part along B is
    // large. There the viscosity stops at what ends the motion of the h in a
    // step, and that along B, which strains the cell as well, in four.
    const Pack strongest = (dt > 0. ? 0.125 * density / dt : 1e100) * g.volume /
                           (8. + 4. * overlap);
    const Pack bounded = pack_min(coefficient, strongest);
    Pack rate[3][4];
    for (int i = 0; i < 3; ++i)
      hourglass_sums(x[i], rate[i]);
    for (int m = 0; m < 4; ++m)
    {
      for (int i = 0; i < 3; ++i)
      {
        const Pack r = rate[i][m] - dot(L.m[i], pulled[m]);
        const Pack f = bounded * r;
        work += (f + old.mode[m][i]) * r;
        old.mode[m][i] = f;
        out.mode[m][i] = f;
        for (int j = 0; j < 3; ++j)
          out.hourglass.m[i][j] -= f * pulled[m][j];
      }
    }
    double *const energy = &hourglass_energy[pack * n_lanes];
    store_pack(energy, load_pack(energy) + 0.5 * dt * work);
  }
  else
  {
    const Pack coefficient = options.hourglass_coefficient * 0.125 * density *
                             c * c * pack_sqrt(g.size_square) * root;
    for (int m = 0; m < 4; ++m)
      for (int i = 0; i < 3; ++i)
      {
        const Pack q = modal[i][m] - dot(F.m[i], old.mode[m]);
        const Pack f = coefficient * q;
        work += f * q;
        out.mode[m][i] = f;
        for (int j = 0; j < 3; ++j)
          out.hourglass.m[i][j] -= f * old.mode[m][j];
      }
    store_pack(&hourglass_energy[pack * n_lanes], 0.5 * work);
  }
  store_pack(&batch.step[k], step);
}

void OnePoint::scatter(NodalState &nodes, const std::size_t pack)
{
  const Geometry &g = geometry[pack];
  const Pending &in = pending[pack % packs_per_batch];
  Pack s[6];
  for (int i = 0; i < 6; ++i)
    s[i] = load_pack(points.stress_row(i) + pack * n_lanes);
  const std::size_t k = pack % packs_per_batch * n_lanes;
  const Pack q = load_pack(&batch.viscous_pressure[k]);
  const PackMat sigma = {
      {{s[0] - q, s[3], s[5]}, {s[3], s[1] - q, s[4]}, {s[5], s[4], s[2] - q}}};
  PackMat P = multiply(sigma, in.stress_to_force);
  Pack corner[3][8];
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
      P.m[i][j] += in.hourglass.m[i][j];
    const Pack mode[4] = {in.mode[0][i], in.mode[1][i], in.mode[2][i],
                          in.mode[3][i]};
    hourglass_spread(mode, corner[i]);
  }
  Vec force[8][n_lanes];
  for (int a = 0; a < 8; ++a)
    unpack(dot(P.m[0], g.B[a]) + corner[0][a],
           dot(P.m[1], g.B[a]) + corner[1][a],
           dot(P.m[2], g.B[a]) + corner[2][a], force[a]);
  const std::size_t n =
      std::min(n_lanes, size() > pack * n_lanes ? size() - pack * n_lanes : 0);
  for (std::size_t lane = 0; lane < n; ++lane)
    for (int a = 0; a < 8; ++a)
      nodes.force[g.node[a][lane]] -= force[a][lane];
}

void OnePoint::cell_forces(const NodalState &nodes, const std::size_t e,
                           Vec force[8]) const
{
  const Geometry &g = geometry[e / n_lanes];
  const Motion &m = motion[e / n_lanes];
  const std::size_t lane = e % n_lanes;
  const auto mode_of = [&](const int k)
  { return vec(m.mode[k][0][lane], m.mode[k][1][lane], m.mode[k][2][lane]); };
  const Mat F = gradient(e);
  double J;
  const Mat F_inverse = inverse(F, J);
  Mat P = (volume[e] * J) * (points.total_stress(e) * transpose(F_inverse));
  Vec x[8], mode[4];
  for (int a = 0; a < 8; ++a)
    x[a] = nodes.position[connectivity[e][a]];
  hourglass_sums(x, mode);
  const double c = material->sound_speed(),
               stiffness = options.hourglass_coefficient * 0.125 *
                           material->density() * c * c *
                           std::cbrt(volume[e] * J);
  for (int k = 0; k < 4; ++k)
    if (options.hourglass == FemOptions::Hourglass::viscous)
    {
      const Vec pulled = F_inverse * mode[k];
      mode[k] = mode_of(k);
      add_outer(P, -mode[k], pulled);
    }
    else
    {
      mode[k] = stiffness * (mode[k] - F * mode_of(k));
      add_outer(P, -mode[k], mode_of(k));
    }
  hourglass_spread(mode, force);
  for (int a = 0; a < 8; ++a)
    force[a] = -(P * vec(g.B[a][0][lane], g.B[a][1][lane], g.B[a][2][lane]) +
                 force[a]);
}

Mat OnePoint::gradient(const std::size_t e) const
{
  return lane_of(motion[e / n_lanes].F, e % n_lanes);
}

void OnePoint::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("motion", motion);
  Hexahedra::visit_state(visitor);
}
} // namespace sabot
