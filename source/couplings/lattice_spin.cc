// Angular momentum that cells had beyond that of their lattices.
#include "sabot/couplings/lattice_spin.h"

#include "sabot/base/gather_all.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sabot
{
namespace
{
/** Column @p k of the six motions of one point: along axes, then about them. */
Vec motion(const int k, const Vec r)
{
  Vec axis = {};
  axis[k % 3] = 1.;
  return k < 3 ? axis : cross(axis, r);
}
} // namespace

LatticeSpin::LatticeSpin(const LatticeFollowers::Parts &parts,
                         const std::vector<GlobalIndex> &followers,
                         const std::vector<LatticeFollowers::Turning> &turned)
    : body(parts), lattices(*parts.sink.lattices()), followers(followers),
      turned(turned)
{
  const std::vector<GlobalIndex> &sites = body.sink.sites();
  for (std::size_t k = 0; k < sites.size(); ++k)
    number_of_site[sites[k]] = k;
  find_pieces();
}

void LatticeSpin::find_pieces()
{
  std::vector<std::size_t> parent(turned.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::size_t k)
  {
    while (parent[k] != k)
      k = parent[k] = parent[parent[k]];
    return k;
  };
  std::unordered_map<GlobalIndex, std::size_t> first; // cell of a node
  for (std::size_t k = 0; k < turned.size(); ++k)
    for (const GlobalIndex a : lattices.nodes_of(turned[k].cell))
    {
      const std::size_t mine = root(k),
                        other = root(first.emplace(a, k).first->second);
      parent[std::max(mine, other)] = std::min(mine, other);
    }
  std::unordered_map<std::size_t, std::size_t> number;
  for (std::size_t k = 0; k < turned.size(); ++k)
  {
    const auto [found, is_new] = number.emplace(root(k), pieces.size());
    if (is_new)
      pieces.emplace_back();
    piece_of.push_back(found->second);
    Piece &piece = pieces[found->second];
    piece.center += turned[k].center;
    piece.n += 1.;
    piece.size += lattices.volume(turned[k].cell);
  }
  for (Piece &piece : pieces)
  {
    piece.center *= 1. / piece.n;
    piece.size = std::cbrt(piece.size);
  }
}

bool LatticeSpin::is_known(const std::size_t k) const
{
  const auto &corners = lattices.nodes_of(turned[k].cell);
  return std::any_of(
      corners.begin(), corners.end(),
      [&](const GlobalIndex a)
      { return body.source.local_node(a) < body.host.nodes().n_owned; });
}

std::vector<LatticeSpin::Member> LatticeSpin::members(const std::size_t k) const
{
  const NodalState &nodes = body.host.nodes();
  const Vec center = pieces[piece_of[k]].center;
  std::vector<Member> all;
  for (const SplitMesh::Member &one : lattices.members(turned[k].cell))
  {
    Member member;
    member.site = one.site;
    member.number = number_of_site.at(one.site);
    member.follows = std::binary_search(followers.begin(), followers.end(),
                                        GlobalIndex(member.number));
    member.mass = one.share * lattices.volume(turned[k].cell);
    member.on = lattices.carrier(one.site);
    member.r = -1. * center;
    member.free = body.sink.free_components(member.number);
    for (int a = 0; a < member.on.n; ++a)
    {
      const GlobalIndex node = member.on.node[a];
      member.r +=
          member.on.weight[a] * nodes.position[body.source.local_node(node)];
      if (member.follows) // where a node is held, so is what it would get
        member.free =
            member.free * body.sink.free_components(number_of_site.at(node));
    }
    all.push_back(member);
  }
  return all;
}

std::vector<LatticeSpin::Part> LatticeSpin::moments() const
{
  std::vector<Part> mine;
  const NodalState &nodes = body.host.nodes();
  for (std::size_t k = 0; k < turned.size(); ++k)
  {
    const auto &corners = lattices.nodes_of(turned[k].cell);
    const GlobalIndex lowest =
        *std::min_element(corners.begin(), corners.end());
    if (body.source.local_node(lowest) >= nodes.n_owned)
      continue;
    Part part{k, {}};
    const double scale = 1. / pieces[piece_of[k]].size;
    for (const Member &member : members(k))
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          part.moment[i][j] +=
              member.mass * dot(motion(i, scale * member.r),
                                member.free * motion(j, scale * member.r));
    mine.push_back(part);
  }
  std::vector<Part> parts = gather_all(mine, body.communicator);
  std::sort(parts.begin(), parts.end(),
            [](const Part &a, const Part &b) { return a.k < b.k; });
  return parts;
}

void LatticeSpin::solve(const std::vector<Missing> &missing)
{
  using Matrix = Eigen::Matrix<double, 6, 6>;
  using Column = Eigen::Matrix<double, 6, 1>;
  std::vector<Matrix> moment(pieces.size(), Matrix::Zero());
  std::vector<Column> lack(pieces.size(), Column::Zero());
  for (const Part &part : moments())
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        moment[piece_of[part.k]](i, j) += part.moment[i][j];
  for (const Missing &one : missing)
  {
    const std::size_t k =
        std::lower_bound(turned.begin(), turned.end(), one.cell,
                         [](const LatticeFollowers::Turning &t,
                            const GlobalIndex cell) { return t.cell < cell; }) -
        turned.begin();
    const Piece &piece = pieces[piece_of[k]];
    const Vec about = one.moment - cross(piece.center, one.momentum);
    for (int d = 0; d < 3; ++d)
    {
      lack[piece_of[k]](d) += one.momentum[d];
      lack[piece_of[k]](3 + d) += about[d] / piece.size;
    }
  }
  // Motions that planes and clamps hold have no moment.
  constexpr double held = 1e-10;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    const Eigen::SelfAdjointEigenSolver<Matrix> modes(moment[p]);
    Column x = Column::Zero();
    for (int m = 0; m < 6; ++m)
      if (modes.eigenvalues()(m) > held * modes.eigenvalues()(5))
        x +=
            modes.eigenvectors().col(m) *
            (modes.eigenvectors().col(m).dot(lack[p]) / modes.eigenvalues()(m));
    pieces[p].u = vec(x(0), x(1), x(2));
    pieces[p].theta = (1. / pieces[p].size) * vec(x(3), x(4), x(5));
  }
}

void LatticeSpin::add_impulses(const std::size_t k, Impulses &of_nodes,
                               Impulses &of_particles) const
{
  const NodalState &nodes = body.host.nodes();
  const Piece &piece = pieces[piece_of[k]];
  const auto add = [](Impulses &to, const std::size_t i, const Vec impulse)
  { to.emplace(i, Vec{}).first->second += impulse; };
  for (const Member &member : members(k))
  {
    const Vec q =
        member.mass * (member.free * (piece.u + cross(piece.theta, member.r)));
    const bool is_node = member.site < lattices.n_nodes();
    const std::size_t node = body.source.local_node(member.site);
    const auto particle = body.sink.particle_at(member.site);
    if (member.follows ||
        (is_node && node < nodes.n_owned && !nodes.is_follower(node)))
      for (int a = 0; a < member.on.n; ++a)
      {
        const std::size_t to = body.source.local_node(member.on.node[a]);
        if (to < nodes.n_owned)
          add(of_nodes, to, member.on.weight[a] * q);
      }
    else if (particle)
      add(of_particles, *particle, q);
  }
}

ExactSum LatticeSpin::give_back(const std::vector<Missing> &mine)
{
  std::vector<Missing> missing = gather_all(mine, body.communicator);
  std::sort(missing.begin(), missing.end(),
            [](const Missing &a, const Missing &b) { return a.site < b.site; });
  solve(missing);
  Impulses of_nodes, of_particles;
  for (std::size_t k = 0; k < turned.size(); ++k)
    if (is_known(k))
      add_impulses(k, of_nodes, of_particles);
  ExactSum gained;
  const auto kick = [&](NodalState &state, const Impulses &by)
  {
    for (const auto &[i, impulse] : by)
    {
      gained.add(dot(impulse, state.velocity[i]) +
                 norm_square(impulse) / (2. * state.inertia[i]));
      state.velocity[i] += (1. / state.inertia[i]) * impulse;
    }
  };
  kick(body.host.nodes(), of_nodes);
  kick(body.zone.nodes(), of_particles);
  return gained;
}
} // namespace sabot
