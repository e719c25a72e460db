#ifndef sabot_base_message_count_h
#define sabot_base_message_count_h

#include <cstdint>

namespace sabot
{
/**
 * What a rank has told others through MPI: messages to one rank each,
 * reductions, and what else all ranks do together (gathers, broadcasts, all to
 * all). Those on a communicator of one rank tell nobody anything and are not
 * counted.
 */
struct MessageCount
{
  std::int64_t messages = 0;
  std::int64_t message_bytes = 0; // sent
  std::int64_t reductions = 0;
  std::int64_t reduction_bytes = 0; // of the vector that is reduced
  std::int64_t gathers = 0;
  std::int64_t gathered_bytes = 0; // received here, of all ranks

  void add(const MessageCount &o);
  /** What came after @p earlier. */
  MessageCount since(const MessageCount &earlier) const;
};

/**
 * Of this rank since its start: every call, whoever made it, libraries
 * included, by the profiling interface of MPI (PMPI), whose functions stand
 * between program and MPI. Not collective.
 */
const MessageCount &messages_so_far();
} // namespace sabot

#endif
