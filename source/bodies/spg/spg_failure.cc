#include "sabot/bodies/spg/spg_body.h"

#include "sabot/base/exact_sum.h"
#include "sabot/kernels/kernel_function.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>

namespace sabot
{
void SpgBody::update_failure_measure()
{
  const std::size_t n = nodal_state.n_owned;
  using Criterion = SpgOptions::FailureCriterion;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  switch (options.failure_criterion)
  {
  case Criterion::effective_plastic_strain:
  {
    const double *const eps = points.state("effective plastic strain");
    std::copy(eps, eps + n, failure_measure.begin());
    break;
  }
  case Criterion::principal_stress:
    for (std::size_t i = 0; i < n; ++i)
    {
      double s[6];
      for (int c = 0; c < 6; ++c)
        s[c] = stress(c, i);
      Eigen::Matrix3d m;
      m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
      failure_measure[i] =
          solver.compute(m, Eigen::EigenvaluesOnly).eigenvalues()[2];
    }
    break;
  case Criterion::shear_strain:
    for (std::size_t i = 0; i < n; ++i)
    {
      const Mat F = deformation_gradient(i);
      const Mat C = transpose(F) * F;
      Eigen::Matrix3d m;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          m(a, b) = C(a, b);
      const auto e = solver.compute(m, Eigen::EigenvaluesOnly).eigenvalues();
      failure_measure[i] =
          0.5 * std::log(std::max(1e-300, e[2]) / std::max(1e-300, e[0]));
    }
    break;
  }
  node_exchange.update(failure_measure.data());
}

bool SpgBody::find_failed_bonds()
{
  if (!options.can_fail())
    return false;
  update_failure_measure();
  // Only bonds with a strained end can fail (their mean exceeds the limit).
  const double critical = options.critical_value(),
               square = options.critical_stretch * options.critical_stretch;
  failed.assign(bonds.capacity(), 0);
  bool any = false;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      if (failure_measure[i] + failure_measure[j] <= 2. * critical)
        continue;
      const Vec now = nodal_state.position[j] - nodal_state.position[i],
                original = nodal_state.reference_position[j] -
                           nodal_state.reference_position[i];
      if (norm_square(now) > square * norm_square(original))
        failed[b] = any = true;
    }
  return any;
}

std::size_t SpgBody::fail_bonds()
{
  if (!find_failed_bonds())
    failed.assign(bonds.capacity(), 0);
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      if (failed[b])
      {
        ++n_failed[i];
        if (!failed_pairs.empty())
          failed_pairs[i].push_back(nodal_state.global_id[bonds.neighbor[b]]);
      }
  return bonds.remove(failed);
}

double SpgBody::residual_energy(const std::size_t i) const
{
  double square = 0.;
  for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    square += bonds.residual_weight[b] * norm_square(load(bonds.residual[b]));
  const double theta = residual_factor[i];
  return 0.5 * bond_stiffness[i] * theta * theta * square;
}

void SpgBody::release_tension(const std::size_t i)
{
  const double K = material->bulk_modulus(), G = material->shear_modulus();
  const auto elastic_energy = [&](const double s[6])
  {
    const double mean = (s[0] + s[1] + s[2]) / 3.;
    double square = 0.;
    for (int c = 0; c < 3; ++c)
      square += (s[c] - mean) * (s[c] - mean) + 2. * s[3 + c] * s[3 + c];
    return mean * mean / (2. * K) + square / (4. * G);
  };
  double s[6];
  for (int c = 0; c < 6; ++c)
    s[c] = stress(c, i);
  const double before = elastic_energy(s);
  cut_tension(s);
  for (int c = 0; c < 6; ++c)
    set_stress(c, i, s[c]);
  failure_loss[i] += kernel_volume[i] * (before - elastic_energy(s));
}

std::vector<GlobalIndex> SpgBody::fragment_labels() const
{
  // The least global number of each connected piece: within the rank by
  // joining, then across ranks until nothing changes.
  const std::size_t n = nodal_state.n_owned;
  std::vector<std::uint32_t> parent(n);
  for (std::size_t i = 0; i < n; ++i)
    parent[i] = i;
  const auto root = [&](std::uint32_t i)
  {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      if (bonds.neighbor[b] < n)
      {
        const std::uint32_t a = root(i), c = root(bonds.neighbor[b]);
        parent[std::max(a, c)] = std::min(a, c);
      }
  // Owned numbers ascend, so a root bears the least number of its piece.
  std::vector<GlobalIndex> label(nodal_state.global_id);
  for (int changed = 1; changed != 0;)
  {
    changed = 0;
    for (std::size_t i = 0; i < n; ++i)
      label[i] = label[root(i)];
    node_exchange.update(label.data());
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
        if (label[bonds.neighbor[b]] < label[root(i)])
        {
          label[root(i)] = label[bonds.neighbor[b]];
          changed = 1;
        }
    MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, communicator);
  }
  for (std::size_t i = 0; i < n; ++i)
    label[i] = label[root(i)];
  label.resize(n);
  return label;
}

std::vector<Fragment> SpgBody::connected_pieces() const
{
  const std::vector<GlobalIndex> label = fragment_labels();
  struct Sums
  {
    GlobalIndex n = 0;
    ExactSum mass, momentum[3];
  };
  std::map<GlobalIndex, Sums> local;
  for (std::size_t i = 0; i < nodal_state.n_owned; ++i)
  {
    Sums &s = local[label[i]];
    ++s.n;
    s.mass.add(nodal_state.lumped_mass[i]);
    for (int d = 0; d < 3; ++d)
      s.momentum[d].add(nodal_state.lumped_mass[i] *
                        nodal_state.velocity[i][d]);
  }
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks > 1)
  {
    // All ranks learn all labels, then add up in the order of labels.
    std::vector<GlobalIndex> mine;
    for (const auto &entry : local)
      mine.push_back(entry.first);
    std::vector<int> counts(n_ranks), starts(n_ranks, 0);
    const int n_mine = mine.size();
    MPI_Allgather(&n_mine, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
    for (int r = 1; r < n_ranks; ++r)
      starts[r] = starts[r - 1] + counts[r - 1];
    std::vector<GlobalIndex> all(starts.back() + counts.back());
    MPI_Allgatherv(mine.data(), n_mine, MPI_INT64_T, all.data(), counts.data(),
                   starts.data(), MPI_INT64_T, communicator);
    std::sort(all.begin(), all.end());
    std::vector<ExactSum *> sums;
    std::vector<GlobalIndex> sizes;
    for (const GlobalIndex l : all)
      local[l];
    for (auto &entry : local)
    {
      sums.push_back(&entry.second.mass);
      for (ExactSum &s : entry.second.momentum)
        sums.push_back(&s);
      sizes.push_back(entry.second.n);
    }
    ExactSum::reduce(sums, communicator);
    MPI_Allreduce(MPI_IN_PLACE, sizes.data(), sizes.size(), MPI_INT64_T,
                  MPI_SUM, communicator);
    std::size_t k = 0;
    for (auto &entry : local)
      entry.second.n = sizes[k++];
  }
  std::vector<Fragment> pieces;
  for (const auto &entry : local)
  {
    Fragment f;
    f.n_particles = entry.second.n;
    f.mass = entry.second.mass.value();
    for (int d = 0; d < 3; ++d)
      f.velocity[d] = entry.second.momentum[d].value() / f.mass;
    pieces.push_back(f);
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Fragment &a, const Fragment &b)
                   { return a.mass > b.mass; });
  return pieces;
}
} // namespace sabot
