// Plain loops to compare the steps with, on fixed neighborhoods and without all
// that makes a program of them: what straight C++ reaches on this machine.
// build/release/benchmark_plain_loops; see doc/performance.md
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace
{
// Copper, linear hardening; mm, s, MPa, tonne.
constexpr double young_modulus = 117e3, poisson_ratio = 0.35,
                 bulk_modulus =
                     young_modulus / (3. * (1. - 2. * poisson_ratio)),
                 shear_modulus = young_modulus / (2. * (1. + poisson_ratio)),
                 yield_stress = 400., hardening = 100., density = 8.93e-9,
                 spacing = 0.25, dt = 1e-9;

/** Inverse and determinant of a 3 x 3 matrix by rows. */
inline double invert(const double *const A, double *const inverse)
{
  const double c0 = A[4] * A[8] - A[5] * A[7], c1 = A[5] * A[6] - A[3] * A[8],
               c2 = A[3] * A[7] - A[4] * A[6],
               determinant = A[0] * c0 + A[1] * c1 + A[2] * c2,
               r = 1. / determinant;
  inverse[0] = c0 * r;
  inverse[1] = (A[2] * A[7] - A[1] * A[8]) * r;
  inverse[2] = (A[1] * A[5] - A[2] * A[4]) * r;
  inverse[3] = c1 * r;
  inverse[4] = (A[0] * A[8] - A[2] * A[6]) * r;
  inverse[5] = (A[2] * A[3] - A[0] * A[5]) * r;
  inverse[6] = c2 * r;
  inverse[7] = (A[1] * A[6] - A[0] * A[7]) * r;
  inverse[8] = (A[0] * A[4] - A[1] * A[3]) * r;
  return determinant;
}

/** Stress xx, yy, zz, xy, yz, zx after the increment @p l of the displacement
    gradient: Jaumann's rate, radial return. */
inline void update_stress(double *const s, double &plastic_strain,
                          const double *const l)
{
  const double w_xy = 0.5 * (l[1] - l[3]), w_yz = 0.5 * (l[5] - l[7]),
               w_xz = 0.5 * (l[2] - l[6]), volume = l[0] + l[4] + l[8],
               lame = bulk_modulus - 2. / 3. * shear_modulus;
  const double G2 = 2. * shear_modulus;
  double n[6] = {
      s[0] + 2. * (s[3] * w_xy + s[5] * w_xz) + lame * volume + G2 * l[0],
      s[1] + 2. * (s[4] * w_yz - s[3] * w_xy) + lame * volume + G2 * l[4],
      s[2] - 2. * (s[5] * w_xz + s[4] * w_yz) + lame * volume + G2 * l[8],
      s[3] + (s[1] - s[0]) * w_xy + s[4] * w_xz + s[5] * w_yz +
          shear_modulus * (l[1] + l[3]),
      s[4] + (s[2] - s[1]) * w_yz - s[3] * w_xz - s[5] * w_xy +
          shear_modulus * (l[5] + l[7]),
      s[5] + (s[2] - s[0]) * w_xz + s[4] * w_xy - s[3] * w_yz +
          shear_modulus * (l[2] + l[6])};
  const double mean = (n[0] + n[1] + n[2]) / 3.;
  for (int c = 0; c < 3; ++c)
    n[c] -= mean;
  const double q =
      std::sqrt(1.5 * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2] +
                       2. * (n[3] * n[3] + n[4] * n[4] + n[5] * n[5])));
  const double beyond = q - yield_stress - hardening * plastic_strain,
               flow =
                   beyond > 0. ? beyond / (3. * shear_modulus + hardening) : 0.,
               scale = beyond > 0. ? 1. - 3. * shear_modulus * flow / q : 1.;
  plastic_strain += flow;
  for (int c = 0; c < 6; ++c)
    s[c] = n[c] * scale + (c < 3 ? mean : 0.);
}

/** @p s as a matrix by rows. */
inline void to_matrix(const double *const s, double *const m)
{
  const int entry[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
  for (int c = 0; c < 9; ++c)
    m[c] = s[entry[c]];
}

/** Falls, a bit faster in each layer. */
double start_velocity(const int layer)
{
  return -1e3 * (1. + 0.1 * std::sin(0.1 * layer));
}

/** Particles on a lattice that know 27 neighbors, themselves among them, with
    stored gradients; the velocity gradient adds to F, forces are gathered. */
class Particles
{
public:
  explicit Particles(const int n)
      : n_particles(std::size_t(n) * n * n), neighbor(n_particles * m),
        gradient(3 * n_particles * m), weight(n_particles * m, 1. / m),
        u(3 * n_particles), v(3 * n_particles), F(9 * n_particles),
        P(9 * n_particles), Z(9 * n_particles), stress(6 * n_particles),
        plastic_strain(n_particles), force(3 * n_particles)
  {
    for (int k = 0, a = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i, ++a)
        {
          v[3 * a + 2] = start_velocity(k);
          F[9 * a] = F[9 * a + 4] = F[9 * a + 8] = 1.;
          for (int b = 0; b < m; ++b)
          {
            const int offset[3] = {b % 3 - 1, b / 3 % 3 - 1, b / 9 - 1},
                      at[3] = {i, j, k};
            int cell[3];
            for (int d = 0; d < 3; ++d)
            {
              cell[d] = std::clamp(at[d] + offset[d], 0, n - 1);
              gradient[3 * (std::size_t(a) * m + b) + d] =
                  offset[d] * 1.5 / spacing / m;
            }
            neighbor[std::size_t(a) * m + b] =
                (cell[2] * n + cell[1]) * n + cell[0];
          }
        }
  }
  std::size_t size() const { return n_particles; }

  /** One step; @p is_stabilized: with a penalty on F less its mean around. */
  void step(const bool is_stabilized)
  {
    for (std::size_t a = 0; a < n_particles; ++a)
      follow(a);
    if (is_stabilized)
    {
      for (std::size_t a = 0; a < n_particles; ++a)
        penalize(a);
      for (std::size_t c = 0; c < P.size(); ++c)
        P[c] += Z[c];
    }
    for (std::size_t a = 0; a < n_particles; ++a)
      gather(a);
    constexpr double per_mass = dt / (density * volume);
    for (std::size_t c = 0; c < u.size(); ++c)
    {
      v[c] += per_mass * force[c];
      u[c] += dt * v[c];
    }
  }

private:
  static constexpr int m = 27;
  static constexpr double volume = spacing * spacing * spacing;

  /** F, stress and nominal stress times volume of one particle. */
  void follow(const std::size_t a)
  {
    double L[9] = {}, inverse[9], l[9], sigma[9];
    for (std::size_t b = a * m; b < (a + 1) * m; ++b)
    {
      const double *const vb = &v[3 * std::size_t(neighbor[b])];
      const double *const g = &gradient[3 * b];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          L[3 * i + j] += vb[i] * g[j];
    }
    double *const Fa = &F[9 * a];
    for (int c = 0; c < 9; ++c)
    {
      L[c] *= dt;
      Fa[c] += L[c];
    }
    const double J = invert(Fa, inverse);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        l[3 * i + j] = L[3 * i] * inverse[j] + L[3 * i + 1] * inverse[3 + j] +
                       L[3 * i + 2] * inverse[6 + j];
    update_stress(&stress[6 * a], plastic_strain[a], l);
    to_matrix(&stress[6 * a], sigma);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P[9 * a + 3 * i + j] = J * volume *
                               (sigma[3 * i] * inverse[3 * j] +
                                sigma[3 * i + 1] * inverse[3 * j + 1] +
                                sigma[3 * i + 2] * inverse[3 * j + 2]);
  }

  void penalize(const std::size_t a)
  {
    double mean[9] = {};
    for (std::size_t b = a * m; b < (a + 1) * m; ++b)
    {
      const double *const Fb = &F[9 * std::size_t(neighbor[b])];
      const double w = weight[b];
      for (int c = 0; c < 9; ++c)
        mean[c] += w * Fb[c];
    }
    for (int c = 0; c < 9; ++c)
      Z[9 * a + c] =
          2. * shear_modulus * 0.1 * volume * (F[9 * a + c] - mean[c]);
  }

  void gather(const std::size_t a)
  {
    double f[3] = {};
    const double *const Pa = &P[9 * a];
    for (std::size_t b = a * m; b < (a + 1) * m; ++b)
    {
      const double *const Pb = &P[9 * std::size_t(neighbor[b])];
      const double *const g = &gradient[3 * b];
      for (int i = 0; i < 3; ++i)
        f[i] += (Pa[3 * i] + Pb[3 * i]) * g[0] +
                (Pa[3 * i + 1] + Pb[3 * i + 1]) * g[1] +
                (Pa[3 * i + 2] + Pb[3 * i + 2]) * g[2];
    }
    for (int i = 0; i < 3; ++i)
      force[3 * a + i] = f[i];
  }

  const std::size_t n_particles;
  std::vector<int> neighbor;
  std::vector<double> gradient, weight, u, v, F, P, Z, stress, plastic_strain,
      force;
};

constexpr int corner_x[8] = {0, 1, 1, 0, 0, 1, 1, 0},
              corner_y[8] = {0, 0, 1, 1, 0, 0, 1, 1},
              corner_z[8] = {0, 0, 0, 0, 1, 1, 1, 1};
constexpr double mode[4][8] = {{1, 1, -1, -1, -1, -1, 1, 1},
                               {1, -1, -1, 1, -1, 1, 1, -1},
                               {1, -1, 1, -1, 1, -1, 1, -1},
                               {-1, 1, -1, 1, 1, -1, 1, -1}};

/** One-point hexahedra (Flanagan & Belytschko 1981) with viscous hourglass
    control; forces are scattered, cell by cell. */
class Cells
{
public:
  explicit Cells(const int n)
      : n_cells(std::size_t(n) * n * n), corners(8 * n_cells),
        x(3 * count_nodes(n)), v(x.size()), force(x.size()),
        mass(count_nodes(n)), stress(6 * n_cells), plastic_strain(n_cells)
  {
    for (int k = 0, a = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i, ++a)
        {
          x[3 * a] = i * spacing;
          x[3 * a + 1] = j * spacing;
          x[3 * a + 2] = k * spacing;
          v[3 * a + 2] = start_velocity(k);
        }
    for (std::size_t e = 0; e < n_cells; ++e)
      for (int c = 0; c < 8; ++c)
      {
        const int i = e % n + corner_x[c], j = e / n % n + corner_y[c],
                  k = e / (n * n) + corner_z[c];
        corners[8 * e + c] = (k * (n + 1) + j) * (n + 1) + i;
        mass[corners[8 * e + c]] += density * spacing * spacing * spacing / 8.;
      }
  }
  std::size_t size() const { return n_cells; }

  void step()
  {
    std::fill(force.begin(), force.end(), 0.);
    for (std::size_t e = 0; e < n_cells; ++e)
      add_forces(e);
    for (std::size_t a = 0; a < mass.size(); ++a)
      for (int d = 0; d < 3; ++d)
      {
        v[3 * a + d] += dt / mass[a] * force[3 * a + d];
        x[3 * a + d] += dt * v[3 * a + d];
      }
  }

private:
  static std::size_t count_nodes(const int n)
  {
    return std::size_t(n + 1) * (n + 1) * (n + 1);
  }

  void add_forces(const std::size_t e)
  {
    const int *const corner = &corners[8 * e];
    double xe[3][8], ve[3][8], B[3][8], f[3][8], J[9], inverse[9], l[9],
        sigma[9];
    for (int c = 0; c < 8; ++c)
      for (int i = 0; i < 3; ++i)
      {
        xe[i][c] = x[3 * std::size_t(corner[c]) + i];
        ve[i][c] = v[3 * std::size_t(corner[c]) + i];
      }
    for (int i = 0; i < 3; ++i)
    {
      const double *const q = xe[i];
      J[3 * i] =
          0.125 * (-q[0] + q[1] + q[2] - q[3] - q[4] + q[5] + q[6] - q[7]);
      J[3 * i + 1] =
          0.125 * (-q[0] - q[1] + q[2] + q[3] - q[4] - q[5] + q[6] + q[7]);
      J[3 * i + 2] =
          0.125 * (-q[0] - q[1] - q[2] - q[3] + q[4] + q[5] + q[6] + q[7]);
    }
    const double volume = 8. * invert(J, inverse);
    for (int c = 0; c < 8; ++c)
      for (int i = 0; i < 3; ++i)
        B[i][c] = 0.125 * ((2 * corner_x[c] - 1) * inverse[i] +
                           (2 * corner_y[c] - 1) * inverse[3 + i] +
                           (2 * corner_z[c] - 1) * inverse[6 + i]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        double sum = 0.;
        for (int c = 0; c < 8; ++c)
          sum += ve[i][c] * B[j][c];
        l[3 * i + j] = sum * dt;
      }
    update_stress(&stress[6 * e], plastic_strain[e], l);
    to_matrix(&stress[6 * e], sigma);
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 8; ++c)
        f[i][c] =
            -volume * (sigma[3 * i] * B[0][c] + sigma[3 * i + 1] * B[1][c] +
                       sigma[3 * i + 2] * B[2][c]);
    resist_hourglass(xe, ve, B, volume, f);
    for (int c = 0; c < 8; ++c)
      for (int i = 0; i < 3; ++i)
        force[3 * std::size_t(corner[c]) + i] += f[i][c];
  }

  static void resist_hourglass(const double xe[3][8], const double ve[3][8],
                               const double B[3][8], const double volume,
                               double f[3][8])
  {
    static const double speed_of_sound =
        std::sqrt((bulk_modulus + 4. / 3. * shear_modulus) / density);
    const double Q =
        0.25 * 0.1 * density * speed_of_sound * std::cbrt(volume * volume);
    for (int k = 0; k < 4; ++k)
    {
      double shape[8], along[3];
      for (int i = 0; i < 3; ++i)
      {
        along[i] = 0.;
        for (int c = 0; c < 8; ++c)
          along[i] += mode[k][c] * xe[i][c];
      }
      for (int c = 0; c < 8; ++c)
        shape[c] = mode[k][c] - (B[0][c] * along[0] + B[1][c] * along[1] +
                                 B[2][c] * along[2]);
      for (int i = 0; i < 3; ++i)
      {
        double rate = 0.;
        for (int c = 0; c < 8; ++c)
          rate += shape[c] * ve[i][c];
        for (int c = 0; c < 8; ++c)
          f[i][c] -= Q * rate * shape[c];
      }
    }
  }

  const std::size_t n_cells;
  std::vector<int> corners;
  std::vector<double> x, v, force, mass, stress, plastic_strain;
};

void particles(benchmark::State &state)
{
  Particles all(state.range(0));
  for (auto _ : state)
    all.step(false);
  state.counters["items"] = all.size();
}
void particles_stabilized(benchmark::State &state)
{
  Particles all(state.range(0));
  for (auto _ : state)
    all.step(true);
  state.counters["items"] = all.size();
}
void cells(benchmark::State &state)
{
  Cells all(state.range(0));
  for (auto _ : state)
    all.step();
  state.counters["items"] = all.size();
}
BENCHMARK(particles)->Arg(22)->Arg(47);
BENCHMARK(particles_stabilized)->Arg(10)->Arg(22)->Arg(47)->Arg(100);
BENCHMARK(cells)->Arg(10)->Arg(22)->Arg(47)->Arg(100);
} // namespace

BENCHMARK_MAIN();
