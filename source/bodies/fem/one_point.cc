// One-point hexahedra apart from their loop: set-up, erosion of cells, and the
// way back from stress to nodal forces.
#include "sabot/bodies/fem/one_point.h"

#include "sabot/base/registry.h"
#include "sabot/bodies/fem/cell_kernels.h"
#include "sabot/bodies/fem/hourglass.h"
#include "sabot/geometry/hex_mesh.h"

#include <cmath>
#include <cstring>
#include <type_traits>

namespace sabot
{
namespace
{
/** One lane of a struct made of packs of @p Number. */
template <typename Number, typename Packs>
void copy_lane(const Packs &from, const std::size_t from_lane, Packs &to,
               const std::size_t to_lane)
{
  const auto *const source = reinterpret_cast<const Number *>(&from);
  auto *const target = reinterpret_cast<Number *>(&to);
  for (std::size_t i = 0; i < sizeof(Packs) / sizeof(Number); i += n_lanes)
    target[i + to_lane] = source[i + from_lane];
}

/** The vector of one lane. */
Vec lane_of(const Pack v[3], const std::size_t lane)
{
  return vec(v[0][lane], v[1][lane], v[2][lane]);
}

/** An array of packs with room for @p n of them, new ones zero. */
template <typename Packs>
void make_room(AlignedVector<Packs> &packs, const std::size_t n)
{
  packs.resize(n);
  std::memset(static_cast<void *>(packs.data()), 0, n * sizeof(Packs));
}
} // namespace

void OnePoint::set_up(LocalCells cells, const AlignedVector<Vec> &X)
{
  take(std::move(cells));
  const std::size_t n_packs = round_up(size(), batch_size) / n_lanes;
  make_room(geometry, n_packs);
  make_room(motion, n_packs);
  if (!keeps_reference_modes())
    make_room(last_forces, n_packs);
  for (std::size_t e = 0; e < size(); ++e)
  {
    set_gradients(e, corners_of(e, X));
    for (int d = 0; d < 3; ++d)
      motion[e / n_lanes].m[d][d][e % n_lanes] = 1.;
  }
  fill_up();
}

void OnePoint::set_gradients(const std::size_t e, const std::array<Vec, 8> &X)
{
  // Beyond round-off of the positions; where there is less, the gradients of a
  // parallelepiped, which are exact for linear fields.
  constexpr double crooked = 1e-11;
  const std::size_t pack = e / n_lanes, lane = e % n_lanes;
  Vec edge[3], modes[4], linear[3], mode[4];
  corner_sums(X.data(), edge, modes);
  double largest = 0.;
  for (const Vec m : modes)
    largest = std::max(largest, norm(m));
  const bool is_crooked = largest > crooked * std::cbrt(volume[e]);
  if (is_crooked)
  {
    const MeanGradients mean = mean_gradients(X);
    Vec B[8];
    for (int a = 0; a < 8; ++a)
      B[a] = 0.125 * vec(mean.B[a][0], mean.B[a][1], mean.B[a][2]);
    corner_sums(B, linear, mode);
    if (warp.empty())
      make_room(warp, geometry.size());
    if (keeps_reference_modes() && reference_modes.empty())
      make_room(reference_modes, geometry.size());
  }
  else
  {
    const Mat by_edges = inverse(Mat{{edge[0], edge[1], edge[2]}});
    for (int k = 0; k < 3; ++k)
      linear[k] = vec(by_edges(0, k), by_edges(1, k), by_edges(2, k));
  }
  for (int d = 0; d < 3; ++d)
  {
    for (int k = 0; k < 3; ++k)
      geometry[pack].linear[k][d][lane] = linear[k][d];
    for (int m = 0; m < 4 && is_crooked; ++m)
    {
      warp[pack].mode[m][d][lane] = mode[m][d];
      if (keeps_reference_modes())
        reference_modes[pack].mode[m][d][lane] = modes[m][d];
    }
  }
}

void OnePoint::copy_cell(const std::size_t from, const std::size_t to)
{
  const std::size_t a = from / n_lanes, a_lane = from % n_lanes,
                    b = to / n_lanes, b_lane = to % n_lanes;
  const auto copy = [&](auto &packs, const auto number)
  {
    using Number = std::remove_const_t<decltype(number)>;
    if (!packs.empty())
      copy_lane<Number>(packs[a], a_lane, packs[b], b_lane);
  };
  copy(geometry, 0.);
  copy(warp, 0.);
  copy(motion, 0.);
  copy(reference_modes, 0.);
  copy(last_forces, 0.f);
}

void OnePoint::fill_up()
{
  // Lanes without a cell repeat the last one; its volume is not repeated.
  const std::size_t n = size();
  for (std::size_t e = n; n > 0 && e < round_up(n, batch_size); ++e)
    copy_cell(n - 1, e);
}

void OnePoint::keep(const std::vector<std::size_t> &kept)
{
  for (std::size_t e = 0; e < kept.size(); ++e)
    copy_cell(kept[e], e);
  keep_points(kept);
  const std::size_t n_packs = round_up(size(), batch_size) / n_lanes;
  const auto shorten = [n_packs](auto &packs)
  {
    if (!packs.empty())
      packs.resize(n_packs);
  };
  shorten(geometry);
  shorten(warp);
  shorten(motion);
  shorten(reference_modes);
  shorten(last_forces);
  fill_up();
}

template <bool is_crooked>
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
    const Pack linear[3] = {dot(P.m[i], g.linear[0]), dot(P.m[i], g.linear[1]),
                            dot(P.m[i], g.linear[2])};
    Pack mode[4] = {in.mode[0][i], in.mode[1][i], in.mode[2][i], in.mode[3][i]};
    if constexpr (is_crooked)
      for (int m = 0; m < 4; ++m)
        mode[m] += dot(P.m[i], warp[pack].mode[m]);
    corner_spread(linear, mode, corner[i]);
  }
  Vec force[8][n_lanes];
  for (int a = 0; a < 8; ++a)
    unpack(corner[0][a], corner[1][a], corner[2][a], force[a]);
  const std::size_t n =
      std::min(n_lanes, size() > pack * n_lanes ? size() - pack * n_lanes : 0);
  for (std::size_t lane = 0; lane < n; ++lane)
  {
    const auto &corner_nodes = connectivity[pack * n_lanes + lane];
    for (int a = 0; a < 8; ++a)
      nodes.force[corner_nodes[a]] -= force[a][lane];
  }
}
template void OnePoint::scatter<false>(NodalState &, const std::size_t);
template void OnePoint::scatter<true>(NodalState &, const std::size_t);

void OnePoint::kept_modes(const std::size_t e, Vec kept[4]) const
{
  const std::size_t pack = e / n_lanes, lane = e % n_lanes;
  for (int m = 0; m < 4; ++m)
  {
    kept[m] = Vec{};
    if (!reference_modes.empty())
      kept[m] = lane_of(reference_modes[pack].mode[m], lane);
    for (int d = 0; d < 3 && !last_forces.empty(); ++d)
      kept[m][d] = last_forces[pack].mode[m][d][lane];
  }
}

void OnePoint::cell_forces(const NodalState &nodes, const std::size_t e,
                           Vec force[8]) const
{
  const std::size_t pack = e / n_lanes, lane = e % n_lanes;
  Vec kept[4];
  kept_modes(e, kept);
  const Mat F = gradient(e);
  double J;
  const Mat F_inverse = inverse(F, J);
  Mat P = (volume[e] * J) * (points.total_stress(e) * transpose(F_inverse));
  Vec x[8], linear[3], mode[4];
  for (int a = 0; a < 8; ++a)
    x[a] = nodes.position[connectivity[e][a]];
  corner_sums(x, linear, mode);
  modal_forces(F, F_inverse, volume[e] * J, kept, mode, P);
  for (int k = 0; k < 3; ++k)
    linear[k] = P * lane_of(geometry[pack].linear[k], lane);
  for (int m = 0; m < 4 && !warp.empty(); ++m)
    mode[m] += P * lane_of(warp[pack].mode[m], lane);
  corner_spread(linear, mode, force);
  for (int a = 0; a < 8; ++a)
    force[a] = -force[a];
}

Mat OnePoint::gradient(const std::size_t e) const
{
  return lane_of(motion[e / n_lanes], e % n_lanes);
}

void OnePoint::visit_state(StateVisitor &visitor, const StateItems &of_cells)
{
  // Each pack has four cells.
  const auto visit =
      [&](const char *const name, auto &packs, const std::size_t size)
  {
    visitor.visit_items(name, packs.data(), packs.size() * n_lanes, size,
                        of_cells, sizeof(packs[0]) / (n_lanes * size), n_lanes);
  };
  visit("motion", motion, sizeof(double));
  if (!keeps_reference_modes())
    visit("modal forces", last_forces, sizeof(float));
  Hexahedra::visit_state(visitor, of_cells);
}

namespace
{
const Registry<Hexahedra>::Add one_point(
    {"one point",
     "fast, with hourglass control.",
     {},
     [](const std::string &body_name, const FemOptions &options,
        std::shared_ptr<const Material> material)
     {
       return std::unique_ptr<Hexahedra>(
           Registry<OnePoint>::get("Bodies/" + body_name + "/Hourglass control",
                                   options.hourglass)
               .make(body_name, options, std::move(material)));
     }});
} // namespace
} // namespace sabot
