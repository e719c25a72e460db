// One-point hexahedra apart from their loop: set-up, erosion of cells, and the
// way back from stress to nodal forces.
#include "sabot/bodies/fem/one_point.h"

#include "sabot/base/registry.h"
#include "sabot/bodies/fem/cell_kernels.h"
#include "sabot/bodies/fem/hourglass.h"

#include <cmath>
#include <cstring>

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

/** An array of packs with room for @p n of them, new ones zero. */
template <typename Packs>
void make_room(AlignedVector<Packs> &packs, const std::size_t n)
{
  packs.resize(n);
  std::memset(static_cast<void *>(packs.data()), 0, n * sizeof(Packs));
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
  make_room(geometry, n_packs);
  make_room(motion, n_packs);
  if (keeps_reference_modes())
    make_room(reference_modes, n_packs);
  else
    make_room(last_forces, n_packs);
  volume.resize(size());
  for (std::size_t e = 0; e < size(); ++e)
  {
    Geometry &g = geometry[e / n_lanes];
    const std::size_t lane = e % n_lanes;
    const GlobalIndex c = ids[e];
    g.volume[lane] = volume[e] = mesh.volume[c];
    const MeanGradients mean = mean_gradients(mesh, c);
    for (int a = 0; a < 8; ++a)
    {
      const auto &X = mesh.nodes[mesh.cells[c][a]];
      for (int d = 0; d < 3; ++d)
      {
        g.B[a][d][lane] = mean.B[a][d];
        if (keeps_reference_modes())
          for (int k = 0; k < 4; ++k)
            reference_modes[e / n_lanes].mode[k][d][lane] += h[k][a] * X[d];
      }
    }
    for (int d = 0; d < 3; ++d)
      motion[e / n_lanes].m[d][d][lane] = 1.;
  }
  allocate_points();
  fill_up();
}

void OnePoint::copy_cell(const std::size_t from, const std::size_t to)
{
  const std::size_t a = from / n_lanes, a_lane = from % n_lanes,
                    b = to / n_lanes, b_lane = to % n_lanes;
  copy_lane<double>(geometry[a], a_lane, geometry[b], b_lane);
  copy_lane<double>(motion[a], a_lane, motion[b], b_lane);
  if (keeps_reference_modes())
    copy_lane<double>(reference_modes[a], a_lane, reference_modes[b], b_lane);
  else
    copy_lane<float>(last_forces[a], a_lane, last_forces[b], b_lane);
}

void OnePoint::fill_up()
{
  // Lanes without a cell repeat the last one, without volume.
  const std::size_t n = size();
  for (std::size_t e = n; n > 0 && e < round_up(n, batch_size); ++e)
  {
    copy_cell(n - 1, e);
    geometry[e / n_lanes].volume[e % n_lanes] = 0.;
  }
}

void OnePoint::keep(const std::vector<std::size_t> &kept)
{
  for (std::size_t e = 0; e < kept.size(); ++e)
    copy_cell(kept[e], e);
  keep_points(kept);
  const std::size_t n_packs = round_up(size(), batch_size) / n_lanes;
  geometry.resize(n_packs);
  motion.resize(n_packs);
  if (keeps_reference_modes())
    reference_modes.resize(n_packs);
  else
    last_forces.resize(n_packs);
  fill_up();
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
  {
    const auto &corner_nodes = connectivity[pack * n_lanes + lane];
    for (int a = 0; a < 8; ++a)
      nodes.force[corner_nodes[a]] -= force[a][lane];
  }
}

void OnePoint::kept_modes(const std::size_t e, Vec kept[4]) const
{
  const std::size_t pack = e / n_lanes, lane = e % n_lanes;
  const auto modes = [&](const auto &mode)
  {
    for (int k = 0; k < 4; ++k)
      kept[k] = vec(mode[k][0][lane], mode[k][1][lane], mode[k][2][lane]);
  };
  if (keeps_reference_modes())
    modes(reference_modes[pack].mode);
  else
    modes(last_forces[pack].mode);
}

void OnePoint::cell_forces(const NodalState &nodes, const std::size_t e,
                           Vec force[8]) const
{
  const Geometry &g = geometry[e / n_lanes];
  const std::size_t lane = e % n_lanes;
  Vec kept[4];
  kept_modes(e, kept);
  const Mat F = gradient(e);
  double J;
  const Mat F_inverse = inverse(F, J);
  Mat P = (volume[e] * J) * (points.total_stress(e) * transpose(F_inverse));
  Vec x[8], mode[4];
  for (int a = 0; a < 8; ++a)
    x[a] = nodes.position[connectivity[e][a]];
  hourglass_sums(x, mode);
  modal_forces(F, F_inverse, volume[e] * J, kept, mode, P);
  hourglass_spread(mode, force);
  for (int a = 0; a < 8; ++a)
    force[a] = -(P * vec(g.B[a][0][lane], g.B[a][1][lane], g.B[a][2][lane]) +
                 force[a]);
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
