// Recursive coordinate bisection by Zoltan.
#include "sabot/geometry/partition.h"

#include <algorithm>
#include <stdexcept>
#include <zoltan_cpp.h>

namespace sabot
{
namespace
{
int count(void *data, int *error)
{
  *error = ZOLTAN_OK;
  return static_cast<PointShare *>(data)->points.size();
}

void list(void *data, int, int, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR local, int,
          float *weights, int *error)
{
  const PointShare &share = *static_cast<PointShare *>(data);
  for (std::size_t i = 0; i < share.points.size(); ++i)
  {
    global[i] = share.begin + i;
    local[i] = i;
    weights[i] = share.weights[i];
  }
  *error = ZOLTAN_OK;
}

int dimension(void *, int *error)
{
  *error = ZOLTAN_OK;
  return 3;
}

void coordinates(void *data, int, int, int n, ZOLTAN_ID_PTR,
                 ZOLTAN_ID_PTR local, int, double *x, int *error)
{
  const PointShare &share = *static_cast<PointShare *>(data);
  for (int i = 0; i < n; ++i)
    std::copy(share.points[local[i]].begin(), share.points[local[i]].end(),
              x + 3 * i);
  *error = ZOLTAN_OK;
}
} // namespace

PointShare::PointShare(const std::size_t n, MPI_Comm communicator)
{
  int n_ranks, rank;
  MPI_Comm_size(communicator, &n_ranks);
  MPI_Comm_rank(communicator, &rank);
  begin = n_ranks == 1 ? n : n * rank / n_ranks;
  end = n * (rank + 1) / n_ranks;
}

void PointShare::add(const std::size_t first,
                     const std::vector<std::array<double, 3>> &some,
                     const float weight)
{
  for (std::size_t i = std::max(first, begin);
       i < std::min(first + some.size(), end); ++i)
  {
    points.push_back(some[i - first]);
    weights.push_back(weight);
  }
}

std::vector<int> partition(PointShare share, const std::size_t n,
                           MPI_Comm communicator)
{
  int n_ranks;
  MPI_Comm_size(communicator, &n_ranks);
  std::vector<int> owner(n, 0);
  if (n_ranks == 1)
    return owner;

  float version;
  Zoltan_Initialize(0, nullptr, &version);
  Zoltan zoltan(communicator);
  zoltan.Set_Param("DEBUG_LEVEL", "0");
  zoltan.Set_Param("LB_METHOD", "RCB");
  zoltan.Set_Param("NUM_GID_ENTRIES", "1");
  zoltan.Set_Param("NUM_LID_ENTRIES", "1");
  zoltan.Set_Param("OBJ_WEIGHT_DIM", "1");
  zoltan.Set_Param("RETURN_LISTS", "PARTS");
  zoltan.Set_Num_Obj_Fn(count, &share);
  zoltan.Set_Obj_List_Fn(list, &share);
  zoltan.Set_Num_Geom_Fn(dimension, &share);
  zoltan.Set_Geom_Multi_Fn(coordinates, &share);

  int changes, gid_size, lid_size, n_import, n_export;
  ZOLTAN_ID_PTR import_global, import_local, export_global, export_local;
  int *import_ranks, *import_parts, *export_ranks, *export_parts;
  const int result = zoltan.LB_Partition(
      changes, gid_size, lid_size, n_import, import_global, import_local,
      import_ranks, import_parts, n_export, export_global, export_local,
      export_ranks, export_parts);
  if (result != ZOLTAN_OK)
    throw std::runtime_error("Zoltan could not partition the nodes");
  for (int i = 0; i < n_export; ++i)
    owner[export_global[i]] = export_parts[i];
  Zoltan::LB_Free_Part(&import_global, &import_local, &import_ranks,
                       &import_parts);
  Zoltan::LB_Free_Part(&export_global, &export_local, &export_ranks,
                       &export_parts);
  MPI_Allreduce(MPI_IN_PLACE, owner.data(), n, MPI_INT, MPI_MAX, communicator);
  return owner;
}
} // namespace sabot
