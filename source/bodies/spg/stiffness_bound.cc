// Bounds of the elastic stiffness that a particle's motion meets, for the
// stable step.
#include "sabot/bodies/spg/stiffness_bound.h"
#include "sabot/bodies/spg/particle_exchange.h"

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/approximation/lagrangian_kernel.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/failure/gaping_volume.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_options.h"
#include "sabot/bodies/spg/spg_parts.h"
#include "sabot/kernels/bond_pack.h"
#include "sabot/kernels/symmetric.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
double stiffness_share(const SpgParts &body, const std::size_t i)
{
  // Of what a step may take from a volume beyond the largest compression.
  constexpr double margin = 1.13, closing_speed = 0.1; // over the wave speed
  if (!gapes(body, i))
    return 1.;
  const double V = body.fields.kernel_reference_volume[i],
               V_0 = body.fields.reference_volume[i];
  if (!(V > margin * body.kernel.largest_compression() * V_0))
    return 1.;
  return std::min(1.,
                  4. *
                      (body.options.bulk_viscosity_linear +
                       closing_speed * body.options.bulk_viscosity_quadratic) *
                      V_0 / V);
}

namespace
{
/** Symmetric matrices of particles, by entries (xx, yy, zz, xy, yz, xz). */
class Matrices
{
public:
  explicit Matrices(const std::size_t n)
  {
    for (AlignedVector<double> &e : entry)
      e.resize((n + n_lanes - 1) / n_lanes * n_lanes);
  }
  void set(const std::size_t i, const Pack diagonal, const Pack mixed)
  {
    for (int c = 0; c < 3; ++c)
    {
      entry[c][i] = diagonal[c];
      entry[3 + c][i] = mixed[c];
    }
  }
  /** Add @p factor v (x) v. */
  void add_outer(const std::size_t i, const double factor, const Vec v)
  {
    for (int c = 0; c < 6; ++c)
      entry[c][i] += factor * v[row[c]] * v[column[c]];
  }
  /** Bounds of the largest eigenvalues, into the first entry. */
  const AlignedVector<double> &find_largest()
  {
    for (std::size_t i = 0; i < entry[0].size(); i += n_lanes)
    {
      const double *const trace = &entry[0][i];
      if (!(trace[0] > 0. || trace[1] > 0. || trace[2] > 0. || trace[3] > 0.))
        continue; // nothing was asked of these
      Pack s[6];
      for (int c = 0; c < 6; ++c)
        s[c] = load_pack(&entry[c][i]);
      store_pack(&entry[0][i], largest_eigenvalue_bound(s));
    }
    return entry[0];
  }
  static constexpr int row[6] = {0, 1, 2, 0, 1, 0},
                       column[6] = {0, 1, 2, 1, 2, 2};

private:
  AlignedVector<double> entry[6];
};

/** Sums over the bonds of a particle of g (x) g/|g|, |g| and g, one bond in
    each lane. Lengths are good to seven digits: any weights would do that are
    the same from both ends. */
struct GradientSums
{
  Pack outer[6] = {}, length = {}, vector[3] = {};

  /** @p factor, @p share: of the two first. */
  void add(const Pack g[3], const Pack factor, const Pack share)
  {
    const HalfPack least = {1e-30f, 1e-30f, 1e-30f, 1e-30f};
    HalfPack norm =
        half_sqrt(to_float(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]));
    norm = norm > least ? norm : least;
    const Pack part = factor * to_double(1.f / norm);
    Pack scaled[3];
    for (int d = 0; d < 3; ++d)
    {
      scaled[d] = part * g[d];
      vector[d] += g[d];
    }
    for (int c = 0; c < 6; ++c)
      outer[c] += scaled[Matrices::row[c]] * g[Matrices::column[c]];
    length += share * to_double(norm);
  }
  void keep_matrix(const std::size_t i, Matrices &matrices) const
  {
    const Pack zero = {};
    matrices.set(i, sum_lanes(outer[0], outer[1], outer[2], zero),
                 sum_lanes(outer[3], outer[4], outer[5], zero));
  }
};

/** What each particle's stiffness has to do with its neighbors. */
struct Elements
{
  const Mat *inverse_moment = nullptr; // with ghosts; least squares only
  AlignedVector<Mat> with_ghosts;      // where they are if nowhere else
  std::vector<double> bulk, shear;     // V lambda s, 2 V mu l, with ghosts
  AlignedVector<Vec> own;              // g of the particle itself, owned
};

/** Gradients of the functions of four bonds, seen from particle @p i. */
void gradients_here(const SpgParts &body, const std::size_t i,
                    const std::uint32_t b, Pack g[3])
{
  const ParticleApproximation &functions = body.approximation;
  if (functions.stores_gradients())
  {
    const std::uint32_t here[n_lanes] = {b, b + 1, b + 2, b + 3};
    return gather(functions.shape_gradient.data(), here, g);
  }
  const Vec *const X = body.fields.kernel_reference_position.data();
  const Pack w = load_floats(&body.bonds.weight[b]);
  const Mat &M = functions.moment_inverse[i]; // symmetric
  Pack dX[3];
  gather(X, &body.bonds.neighbor[b], dX);
  for (int d = 0; d < 3; ++d)
    dX[d] = w * (dX[d] - X[i][d]);
  for (int d = 0; d < 3; ++d)
    g[d] = M(d, 0) * dX[0] + M(d, 1) * dX[1] + M(d, 2) * dX[2];
}

/** The same of the functions of particle @p i, seen from its neighbors. */
void gradients_there(const SpgParts &body, const Elements &elements,
                     const std::size_t i, const std::uint32_t b, Pack g[3])
{
  const ParticleApproximation &functions = body.approximation;
  if (functions.stores_gradients())
    return gather(functions.shape_gradient.data(), &body.bonds.reverse[b], g);
  const Vec *const X = body.fields.kernel_reference_position.data();
  const Vec *const rows = elements.inverse_moment[0].row;
  const std::uint32_t *const j = &body.bonds.neighbor[b];
  const Pack w = load_floats(&body.bonds.weight[b]);
  Pack dX[3], M[3];
  gather(X, j, dX);
  for (int d = 0; d < 3; ++d)
    dX[d] = w * (X[i][d] - dX[d]);
  for (std::uint32_t d = 0; d < 3; ++d)
  {
    const std::uint32_t row[n_lanes] = {3 * j[0] + d, 3 * j[1] + d,
                                        3 * j[2] + d, 3 * j[3] + d};
    gather(rows, row, M);
    g[d] = M[0] * dX[0] + M[1] * dX[1] + M[2] * dX[2];
  }
}

/** [n_local] Owned particles at which a mark stands or at one of their
    neighbors. @p marked [n_local]. */
std::vector<char> owned_near(const SpgParts &body,
                             const std::vector<char> &marked)
{
  const BondList &bonds = body.bonds;
  const std::size_t n = body.nodes.n_owned, n_local = body.nodes.size();
  // Most often few are marked, which tell their neighbors.
  std::vector<char> near(marked);
  for (std::size_t i = 0; i < n; ++i)
    if (marked[i])
      for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
        near[bonds.neighbor[b]] = 1;
  // Ghosts cannot.
  const bool any_ghost =
      std::find(marked.begin() + n, marked.end(), 1) != marked.end();
  if (any_ghost)
    for (const std::uint32_t i : bonds.rows_at_ghosts())
      for (std::size_t b = bonds.begin(i); b < bonds.end(i) && !near[i]; ++b)
        near[i] = bonds.neighbor[b] >= n && marked[bonds.neighbor[b]];
  std::fill(near.begin() + n, near.begin() + n_local, 0);
  return near;
}

/** Inverse moments, of ghosts too: in the place of the generalized stress where
    that is found anew, else in @p buffer. Collective. */
const Mat *moments_with_ghosts(const SpgParts &body, const bool spends_stress,
                               AlignedVector<Mat> &buffer)
{
  const AlignedVector<Mat> &owned = body.approximation.moment_inverse;
  if (body.exchange.is_trivial())
    return owned.data();
  AlignedVector<Mat> &place =
      spends_stress ? body.fields.generalized_stress : buffer;
  place.resize(body.nodes.size());
  std::copy(owned.begin(), owned.end(), place.begin());
  body.exchange.update(place.data());
  return place.data();
}

/** The first half: s and l of every particle that the rows of the wanted ones
    ask for. Collective. */
Elements find_elements(const SpgParts &body, const std::vector<char> &wanted,
                       const bool spends_stress)
{
  const std::size_t n = body.nodes.n_owned;
  const BondList &bonds = body.bonds;
  const Material &law = body.points.law();
  const double mu = law.shear_modulus(),
               lambda = std::max(0., law.bulk_modulus() - 2. / 3. * mu);
  Elements elements;
  elements.own.resize(n);
  elements.bulk.resize(body.nodes.size());
  elements.shear.resize(body.nodes.size());
  Matrices G(n);
  const std::vector<char> near = owned_near(body, wanted);
  for (std::size_t i = 0; i < n; ++i)
  {
    if (!near[i])
      continue;
    GradientSums sums;
    for (std::uint32_t b = bonds.begin(i); b < bonds.packed_end(i);
         b += n_lanes)
    {
      Pack g[3];
      gradients_here(body, i, b, g);
      sums.add(g, in_all(1.), in_all(1.));
    }
    const Pack *const v = sums.vector;
    const Pack last = sum_lanes(v[0], v[1], v[2], sums.length);
    // The gradients of all add up to nothing.
    const Vec own = vec(-last[0], -last[1], -last[2]);
    const double of_own = norm(own), s = last[3] + of_own;
    sums.keep_matrix(i, G);
    if (of_own > 0.)
      G.add_outer(i, 1. / of_own, own);
    const double V =
        body.fields.kernel_reference_volume[i] * stiffness_share(body, i);
    elements.own[i] = own;
    elements.bulk[i] = V * lambda * s;
    elements.shear[i] = 2. * V * mu;
  }
  const AlignedVector<double> &l = G.find_largest();
  for (std::size_t i = 0; i < n; ++i)
    elements.shear[i] *= l[i];
  for (std::vector<double> *const values : {&elements.bulk, &elements.shear})
  {
    body.exchange.make_whole(values->data());
    body.exchange.update(values->data());
  }
  if (!body.approximation.stores_gradients())
    elements.inverse_moment =
        moments_with_ghosts(body, spends_stress, elements.with_ghosts);
  return elements;
}
} // namespace

std::vector<char> with_neighbors(const SpgParts &body, std::vector<char> marked)
{
  body.exchange.update(marked.data());
  std::vector<char> beside = owned_near(body, marked);
  body.exchange.update(beside.data());
  return beside;
}

std::vector<char> beside_cracks(const SpgParts &body)
{
  std::vector<char> cracked(body.nodes.size());
  for (std::size_t i = 0; i < body.nodes.n_owned; ++i)
    cracked[i] = body.failure.has_cracks(i);
  return with_neighbors(body, std::move(cracked));
}

std::vector<double> elastic_row_bounds(const SpgParts &body,
                                       const std::vector<char> &wanted,
                                       const bool spends_stress)
{
  const std::size_t n = body.nodes.n_owned;
  const BondList &bonds = body.bonds;
  const Elements elements = find_elements(body, wanted, spends_stress);
  std::vector<double> rows(n);
  Matrices R(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    if (!wanted[i])
      continue;
    GradientSums sums;
    for (std::uint32_t b = bonds.begin(i); b < bonds.packed_end(i);
         b += n_lanes)
    {
      const std::uint32_t *const j = &bonds.neighbor[b];
      Pack g[3];
      gradients_there(body, elements, i, b, g);
      sums.add(g,
               Pack{elements.bulk[j[0]], elements.bulk[j[1]],
                    elements.bulk[j[2]], elements.bulk[j[3]]},
               Pack{elements.shear[j[0]], elements.shear[j[1]],
                    elements.shear[j[2]], elements.shear[j[3]]});
    }
    sums.keep_matrix(i, R);
    const Vec own = elements.own[i];
    const double of_own = norm(own);
    if (of_own > 0.)
      R.add_outer(i, elements.bulk[i] / of_own, own);
    const Pack zero = {}, all = sum_lanes(sums.length, zero, zero, zero);
    rows[i] = all[0] + elements.shear[i] * of_own;
  }
  const AlignedVector<double> &largest = R.find_largest();
  for (std::size_t i = 0; i < n; ++i)
    rows[i] += largest[i];
  return rows;
}
} // namespace sabot
