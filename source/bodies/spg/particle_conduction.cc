// Heat between particles: conductances of bonds, heat flow, backward Euler.

#include "sabot/bodies/spg/particle_conduction.h"

#include "sabot/bodies/conduction_solver.h"

#include <algorithm>

namespace sabot
{
ParticleConduction::ParticleConduction(const double conductivity,
                                       const Cloud &cloud,
                                       std::vector<double> capacity,
                                       MPI_Comm communicator)
    : conductivity(conductivity), cloud(cloud), capacity(std::move(capacity)),
      communicator(communicator)
{
  for (const double c : this->capacity)
    largest_capacity = std::max(largest_capacity, c);
  MPI_Allreduce(MPI_IN_PLACE, &largest_capacity, 1, MPI_DOUBLE, MPI_MAX,
                communicator);
}

void ParticleConduction::assemble()
{
  const BondList &bonds = cloud.bonds;
  const std::size_t n = capacity.size();
  stiffness.assign(n, 0.);
  for (std::size_t i = 0; i < n; ++i)
  {
    double spread = 0.;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
      spread +=
          bonds.weight[b] *
          norm_square(cloud.position[bonds.neighbor[b]] - cloud.position[i]);
    if (spread > 0.)
      stiffness[i] = 3. * conductivity * cloud.volume[i] / spread;
  }
}

void ParticleConduction::heat_flow(std::vector<double> &temperature,
                                   std::vector<double> &flow)
{
  const BondList &bonds = cloud.bonds;
  const std::size_t n = capacity.size();
  temperature.resize(cloud.position.size());
  cloud.exchange.update(temperature.data());
  coefficient.resize(cloud.position.size());
  for (std::size_t i = 0; i < n; ++i)
  {
    Vec sum = {};
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      sum += (bonds.weight[b] * (temperature[j] - temperature[i])) *
             (cloud.position[j] - cloud.position[i]);
    }
    Vec a = {};
    if (!cloud.weak[i])
    {
      const Vec g = cloud.moment_inverse[i] * sum;
      a = (conductivity * cloud.volume[i]) * (cloud.moment_inverse[i] * g) -
          stiffness[i] * g;
    }
    a[3] = stiffness[i];
    coefficient[i] = a;
  }
  cloud.exchange.make_whole(coefficient.data());
  cloud.exchange.update(coefficient.data());
  for (std::size_t i = 0; i < n; ++i)
  {
    double heat = 0.;
    for (std::size_t b = bonds.begin(i); b < bonds.end(i); ++b)
    {
      const std::uint32_t j = bonds.neighbor[b];
      const Vec c = coefficient[i] + coefficient[j];
      heat += bonds.weight[b] * (dot(c, cloud.position[j] - cloud.position[i]) +
                                 c[3] * (temperature[j] - temperature[i]));
    }
    flow[i] = heat;
  }
  cloud.exchange.take_shares(flow.data());
}

void ParticleConduction::advance(const double dt, double *const temperature)
{
  const std::size_t n = capacity.size();
  assemble();
  // (C + dt K) change = dt q(T), over the largest capacity.
  std::vector<double> now(temperature, temperature + n), flow(n), diagonal(n),
      right(n), change(cloud.position.size());
  heat_flow(now, flow);
  const double scale = dt / largest_capacity;
  std::vector<double> sums(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    // Of the bonds' part of K, which is the larger one.
    double sum = 0.;
    for (std::size_t b = cloud.bonds.begin(i); b < cloud.bonds.end(i); ++b)
      sum += cloud.bonds.weight[b] *
             (coefficient[i][3] + coefficient[cloud.bonds.neighbor[b]][3]);
    sums[i] = sum;
  }
  cloud.exchange.take_shares(sums.data());
  for (std::size_t i = 0; i < n; ++i)
  {
    right[i] = scale * flow[i];
    diagonal[i] = capacity[i] / largest_capacity + scale * sums[i];
  }
  solve_conduction(
      diagonal, right,
      [&](std::vector<double> &x, std::vector<double> &product)
      {
        heat_flow(x, product);
        for (std::size_t i = 0; i < n; ++i)
          product[i] =
              capacity[i] / largest_capacity * x[i] - scale * product[i];
      },
      change, communicator);
  for (std::size_t i = 0; i < n; ++i)
    temperature[i] += change[i];
}
} // namespace sabot
