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
        if (keeps_reference_modes())
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
  Vec kept[4];
  for (int k = 0; k < 4; ++k)
    kept[k] = vec(m.mode[k][0][lane], m.mode[k][1][lane], m.mode[k][2][lane]);
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
  return lane_of(motion[e / n_lanes].F, e % n_lanes);
}

void OnePoint::visit_state(StateVisitor &visitor)
{
  visitor.visit_array("motion", motion);
  Hexahedra::visit_state(visitor);
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
