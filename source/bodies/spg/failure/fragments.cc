// The pieces that bonds still hold together.
#include "sabot/bodies/spg/failure/fragments.h"

#include "sabot/base/exact_sum.h"
#include "sabot/base/gather_all.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/particle_exchange.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sabot
{
namespace
{
/** Crumbled metal without cohesion is dust: it holds no two pieces together,
    also where a sound one still has a bond to it. */
bool joins_pieces(const BondFailure &failure, const std::size_t i,
                  const std::uint32_t j)
{
  return !(failure.keeps_crumbled() &&
           (failure.has_crumbled(i) || failure.has_crumbled(j)));
}
} // namespace

std::vector<GlobalIndex> fragment_labels(const NodalState &nodes,
                                         const BondList &bonds,
                                         const BondFailure &failure,
                                         const ParticleExchange &exchange,
                                         MPI_Comm communicator)
{
  // Within the rank by joining, then across ranks until nothing changes.
  const std::size_t n = nodes.n_owned;
  std::vector<std::uint32_t> parent(n);
  for (std::size_t i = 0; i < n; ++i)
    parent[i] = i;
  const auto root = [&](std::uint32_t i)
  {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> border;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      // A bond stands at both ends; most are between two that are known to be
      // of one piece.
      if ((j < n && (j < i || parent[i] == parent[j])) ||
          !joins_pieces(failure, i, j))
        continue;
      if (j < n)
      {
        const std::uint32_t a = root(i), c = root(j);
        parent[std::max(a, c)] = std::min(a, c);
      }
      else
        border.push_back({i, j});
    }
  // Owned numbers ascend, so a root bears the least number of its piece.
  std::vector<GlobalIndex> label(nodes.global_id);
  for (int changed = 1; changed != 0;)
  {
    changed = 0;
    for (std::size_t i = 0; i < n; ++i)
      label[i] = label[root(i)];
    exchange.update(label.data());
    for (const auto &[i, ghost] : border)
      if (label[ghost] < label[root(i)])
      {
        label[root(i)] = label[ghost];
        changed = 1;
      }
    MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, communicator);
  }
  for (std::size_t i = 0; i < n; ++i)
    label[i] = label[root(i)];
  label.resize(n);
  return label;
}

namespace
{
struct Sums
{
  GlobalIndex n = 0;
  ExactSum mass, momentum[3];
  unsigned int planes = 0; // bits of those that cut the piece
};

/** Bits of the planes in which a particle lies. */
unsigned int planes_at(const Vec &reference,
                       const std::vector<SymmetryPlane> &planes,
                       const double tolerance)
{
  unsigned int bits = 0;
  for (std::size_t p = 0; p < planes.size(); ++p)
    if (std::abs(reference[planes[p].axis] - planes[p].coordinate) < tolerance)
      bits |= 1u << p;
  return bits;
}

/** What the particles of each piece add up to, by ascending label. */
class PieceSums
{
public:
  explicit PieceSums(const std::vector<GlobalIndex> &label)
  {
    for (std::size_t i = 0; i < label.size(); ++i)
      if (i == 0 || label[i] != label[i - 1])
        labels.push_back(label[i]);
    make_places();
  }
  Sums &of(const GlobalIndex label)
  {
    return sums[std::lower_bound(labels.begin(), labels.end(), label) -
                labels.begin()];
  }
  /** Add up over ranks: all learn all labels, then add in their order. */
  void reduce(MPI_Comm communicator);

  std::vector<GlobalIndex> labels;
  std::vector<Sums> sums;

private:
  void make_places()
  {
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    sums.assign(labels.size(), Sums());
  }
};

void PieceSums::reduce(MPI_Comm communicator)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks == 1)
    return;
  const std::vector<GlobalIndex> mine = std::move(labels);
  const std::vector<Sums> of_mine = std::move(sums);
  labels = gather_all(mine, communicator);
  make_places();
  for (std::size_t k = 0; k < mine.size(); ++k)
    of(mine[k]) = of_mine[k];
  std::vector<ExactSum *> exact;
  std::vector<GlobalIndex> sizes;
  std::vector<unsigned int> planes;
  for (Sums &piece : sums)
  {
    exact.push_back(&piece.mass);
    for (ExactSum &s : piece.momentum)
      exact.push_back(&s);
    sizes.push_back(piece.n);
    planes.push_back(piece.planes);
  }
  ExactSum::reduce(exact, communicator);
  MPI_Allreduce(MPI_IN_PLACE, sizes.data(), sizes.size(), MPI_INT64_T, MPI_SUM,
                communicator);
  MPI_Allreduce(MPI_IN_PLACE, planes.data(), planes.size(), MPI_UNSIGNED,
                MPI_BOR, communicator);
  for (std::size_t k = 0; k < sums.size(); ++k)
  {
    sums[k].n = sizes[k];
    sums[k].planes = planes[k];
  }
}

/** The whole piece of what the model holds of it. */
Fragment piece_of(const GlobalIndex label, const Sums &sums,
                  const std::vector<SymmetryPlane> &planes)
{
  Fragment piece;
  piece.label = label;
  piece.n_particles = sums.n;
  piece.mass = sums.mass.value();
  for (int d = 0; d < 3; ++d)
    piece.velocity[d] = sums.momentum[d].value() / piece.mass;
  for (std::size_t p = 0; p < planes.size(); ++p)
    if (sums.planes & 1u << p)
    {
      piece.mass *= 2.;
      piece.velocity[planes[p].axis] = 0.;
    }
    else
      piece.copies *= 2;
  return piece;
}
} // namespace

std::vector<unsigned int> planes_of_particles(
    const NodalState &nodes, const BondList &bonds, const BondFailure &failure,
    const std::vector<SymmetryPlane> &planes, const double tolerance)
{
  std::vector<unsigned int> bits(nodes.n_owned);
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
    bits[i] = planes_at(nodes.reference_position[i], planes, tolerance);
  const std::size_t first_image = nodes.size() - nodes.n_images;
  for (const std::uint32_t i : bonds.rows_at_ghosts())
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      if (j < first_image || !joins_pieces(failure, i, j))
        continue;
      for (std::size_t p = 0; p < planes.size(); ++p)
      {
        const int d = planes[p].axis;
        const double X = planes[p].coordinate;
        if ((nodes.reference_position[i][d] - X) *
                (nodes.reference_position[j][d] - X) <=
            0.)
          bits[i] |= 1u << p;
      }
    }
  return bits;
}

std::vector<Fragment> find_fragments(const NodalState &nodes,
                                     const std::vector<GlobalIndex> &label,
                                     const std::vector<unsigned int> &at_planes,
                                     const std::vector<SymmetryPlane> &planes,
                                     MPI_Comm communicator)
{
  PieceSums all(label);
  Sums *last = nullptr; // most particles are in the piece of the one before
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    if (last == nullptr || label[i] != label[i - 1])
      last = &all.of(label[i]);
    Sums &s = *last;
    ++s.n;
    s.planes |= at_planes[i];
    s.mass.add(nodes.lumped_mass[i]);
    for (int d = 0; d < 3; ++d)
      s.momentum[d].add(nodes.lumped_mass[i] * nodes.velocity[i][d]);
  }
  all.reduce(communicator);
  std::vector<Fragment> pieces;
  pieces.reserve(all.labels.size());
  for (std::size_t k = 0; k < all.labels.size(); ++k)
    pieces.push_back(piece_of(all.labels[k], all.sums[k], planes));
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Fragment &a, const Fragment &b)
                   { return a.mass > b.mass; });
  return pieces;
}
} // namespace sabot
