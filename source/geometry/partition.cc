// Recursive coordinate bisection by Zoltan.
#include "sabot/geometry/partition.h"

#include <algorithm>
#include <stdexcept>
#include <zoltan_cpp.h>

namespace sabot
{
namespace
{
struct Points
{
  const std::vector<std::array<double, 3>> &points;
  const std::vector<float> &weights;
  std::size_t begin, end; // the share this rank hands to Zoltan
};

int count(void *data, int *error)
{
  *error = ZOLTAN_OK;
  const Points &p = *static_cast<Points *>(data);
  return p.end - p.begin;
}

void list(void *data, int, int, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR local, int,
          float *weights, int *error)
{
  const Points &p = *static_cast<Points *>(data);
  for (std::size_t i = p.begin; i < p.end; ++i)
  {
    global[i - p.begin] = i;
    local[i - p.begin] = i - p.begin;
    weights[i - p.begin] = p.weights[i];
  }
  *error = ZOLTAN_OK;
}

int dimension(void *, int *error)
{
  *error = ZOLTAN_OK;
  return 3;
}

void coordinates(void *data, int, int, int n, ZOLTAN_ID_PTR global,
                 ZOLTAN_ID_PTR, int, double *x, int *error)
{
  const Points &p = *static_cast<Points *>(data);
  for (int i = 0; i < n; ++i)
    std::copy(p.points[global[i]].begin(), p.points[global[i]].end(),
              x + 3 * i);
  *error = ZOLTAN_OK;
}
} // namespace

std::vector<int> partition(const std::vector<std::array<double, 3>> &points,
                           const std::vector<float> &weights,
                           MPI_Comm communicator)
{
  int n_ranks, rank;
  MPI_Comm_size(communicator, &n_ranks);
  MPI_Comm_rank(communicator, &rank);
  const std::size_t n = points.size();
  std::vector<int> owner(n, 0);
  if (n_ranks == 1)
    return owner;

  float version;
  Zoltan_Initialize(0, nullptr, &version);
  Points share{points, weights, n * rank / n_ranks, n * (rank + 1) / n_ranks};
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
