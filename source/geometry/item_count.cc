// Counts cells and particles before they are made, and refuses too many.
#include "sabot/geometry/item_count.h"

#include "sabot/base/memory_limit.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sabot
{
double count_of_intervals(const double length, const double spacing)
{
  return std::max(1., std::round(length / spacing));
}

double count_of_growing(const double length, const double fine,
                        const double coarsest, const double growth)
{
  const double largest = std::max(coarsest, fine);
  if (!(length > 0.))
    return 0.;
  if (!(growth > 1.))
    return std::ceil(length / fine) + 1.;
  // Sizes fine g, fine g^2, ... up to the coarsest, then that.
  const double n_while_growing = std::log(largest / fine) / std::log(growth),
               n_to_length =
                   std::log1p(length / fine * (growth - 1.)) / std::log(growth);
  if (n_to_length <= n_while_growing + 1.)
    return std::ceil(n_to_length) + 1.;
  const double grown =
      fine * growth * (std::pow(growth, n_while_growing) - 1.) / (growth - 1.);
  return std::ceil(n_while_growing) +
         std::ceil(std::max(0., length - grown) / largest) + 1.;
}

namespace
{
/** Making so many takes from half a minute to an hour, in which nothing else is
    said. */
void tell_large(const double n, const char *const items, const std::string &how,
                const double bytes)
{
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0)
    std::fprintf(stderr, "note: making %.0f %s (%s), about %.2g GB to set up\n",
                 n, items, how.c_str(), 1e-9 * bytes);
}
} // namespace

void check_memory_for(const double n, const Item item, const std::string &how)
{
  const bool are_cells = item == Item::cell;
  const double bytes = n * (are_cells ? 1200. : 3000.), limit = memory_limit();
  // Numbers of nodes on a rank have 32 bits.
  constexpr double most = 2e9, many = 3e5;
  if (bytes <= limit && n <= most)
  {
    if (n > many)
      tell_large(n, are_cells ? "cells" : "particles", how, bytes);
    return;
  }
  char text[400];
  std::snprintf(text, sizeof(text),
                "asks for %.3g %s (%s), about %.3g GB to set up, where there "
                "are %.3g GB; check the units of this and of the sizes (a "
                "number alone is in m), or choose it coarser",
                n, are_cells ? "cells" : "particles", how.c_str(), 1e-9 * bytes,
                1e-9 * limit);
  throw TooManyItems(text);
}

void check_memory_for(const std::array<double, 3> &n, const Item item)
{
  char how[100];
  std::snprintf(how, sizeof(how), "%.6g x %.6g x %.6g", n[0], n[1], n[2]);
  check_memory_for(n[0] * n[1] * n[2], item, how);
}
} // namespace sabot
