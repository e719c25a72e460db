// How much memory a process may take.
#include "sabot/base/memory_limit.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace sabot
{
double memory_limit()
{
  double limit =
      double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA})
  {
    rlimit shell;
    if (getrlimit(resource, &shell) == 0 && shell.rlim_cur != RLIM_INFINITY)
      limit = std::min(limit, double(shell.rlim_cur));
  }
  // Of version 2 and of version 1; "max" is no number.
  for (const char *const file : {"/sys/fs/cgroup/memory.max",
                                 "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
  {
    double group;
    if (std::ifstream(file) >> group)
      limit = std::min(limit, group);
  }
  return limit;
}

void give_back_memory()
{
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}
} // namespace sabot
