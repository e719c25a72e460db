// Counts what goes through MPI: functions of its profiling interface, which
// stand in for MPI's own.
#include "sabot/base/message_count.h"

#include <mpi.h>

#include <numeric>

namespace sabot
{
namespace
{
MessageCount count;

std::int64_t size_of(const std::int64_t n, MPI_Datatype type)
{
  int size;
  PMPI_Type_size(type, &size);
  return n * size;
}

/** How many ranks hear of it; 0 where it is this one alone. */
int n_hearing(MPI_Comm communicator)
{
  int n;
  PMPI_Comm_size(communicator, &n);
  return n > 1 ? n : 0;
}

void count_message(const int n, MPI_Datatype type)
{
  ++count.messages;
  count.message_bytes += size_of(n, type);
}

void count_reduction(const int n, MPI_Datatype type, MPI_Comm communicator)
{
  if (n_hearing(communicator) == 0)
    return;
  ++count.reductions;
  count.reduction_bytes += size_of(n, type);
}

void count_gather(const std::int64_t n, MPI_Datatype type,
                  MPI_Comm communicator)
{
  if (n_hearing(communicator) == 0)
    return;
  ++count.gathers;
  count.gathered_bytes += size_of(n, type);
}

/** Sum of the @p counts of all ranks. */
std::int64_t all_of(const int counts[], MPI_Comm communicator)
{
  return std::accumulate(counts, counts + n_hearing(communicator),
                         std::int64_t(0));
}
} // namespace

void MessageCount::add(const MessageCount &o)
{
  messages += o.messages;
  message_bytes += o.message_bytes;
  reductions += o.reductions;
  reduction_bytes += o.reduction_bytes;
  gathers += o.gathers;
  gathered_bytes += o.gathered_bytes;
}

MessageCount MessageCount::since(const MessageCount &earlier) const
{
  return {messages - earlier.messages,
          message_bytes - earlier.message_bytes,
          reductions - earlier.reductions,
          reduction_bytes - earlier.reduction_bytes,
          gathers - earlier.gathers,
          gathered_bytes - earlier.gathered_bytes};
}

const MessageCount &messages_so_far()
{
  return count;
}
} // namespace sabot

extern "C"
{
  using namespace sabot;

  int MPI_Send(const void *buffer, int n, MPI_Datatype type, int to, int tag,
               MPI_Comm communicator)
  {
    count_message(n, type);
    return PMPI_Send(buffer, n, type, to, tag, communicator);
  }

  int MPI_Isend(const void *buffer, int n, MPI_Datatype type, int to, int tag,
                MPI_Comm communicator, MPI_Request *request)
  {
    count_message(n, type);
    return PMPI_Isend(buffer, n, type, to, tag, communicator, request);
  }

  int MPI_Allreduce(const void *in, void *out, int n, MPI_Datatype type,
                    MPI_Op operation, MPI_Comm communicator)
  {
    count_reduction(n, type, communicator);
    return PMPI_Allreduce(in, out, n, type, operation, communicator);
  }

  int MPI_Reduce(const void *in, void *out, int n, MPI_Datatype type,
                 MPI_Op operation, int root, MPI_Comm communicator)
  {
    count_reduction(n, type, communicator);
    return PMPI_Reduce(in, out, n, type, operation, root, communicator);
  }

  int MPI_Barrier(MPI_Comm communicator)
  {
    count_reduction(0, MPI_CHAR, communicator);
    return PMPI_Barrier(communicator);
  }

  int MPI_Bcast(void *buffer, int n, MPI_Datatype type, int root,
                MPI_Comm communicator)
  {
    count_gather(n, type, communicator);
    return PMPI_Bcast(buffer, n, type, root, communicator);
  }

  int MPI_Allgather(const void *in, int n_in, MPI_Datatype type_in, void *out,
                    int n_out, MPI_Datatype type_out, MPI_Comm communicator)
  {
    count_gather(std::int64_t(n_out) * n_hearing(communicator), type_out,
                 communicator);
    return PMPI_Allgather(in, n_in, type_in, out, n_out, type_out,
                          communicator);
  }

  int MPI_Allgatherv(const void *in, int n_in, MPI_Datatype type_in, void *out,
                     const int n_out[], const int places[],
                     MPI_Datatype type_out, MPI_Comm communicator)
  {
    count_gather(all_of(n_out, communicator), type_out, communicator);
    return PMPI_Allgatherv(in, n_in, type_in, out, n_out, places, type_out,
                           communicator);
  }

  int MPI_Alltoall(const void *in, int n_in, MPI_Datatype type_in, void *out,
                   int n_out, MPI_Datatype type_out, MPI_Comm communicator)
  {
    count_gather(std::int64_t(n_out) * n_hearing(communicator), type_out,
                 communicator);
    return PMPI_Alltoall(in, n_in, type_in, out, n_out, type_out, communicator);
  }

  int MPI_Alltoallv(const void *in, const int n_in[], const int places_in[],
                    MPI_Datatype type_in, void *out, const int n_out[],
                    const int places_out[], MPI_Datatype type_out,
                    MPI_Comm communicator)
  {
    count_gather(all_of(n_out, communicator), type_out, communicator);
    return PMPI_Alltoallv(in, n_in, places_in, type_in, out, n_out, places_out,
                          type_out, communicator);
  }
}
