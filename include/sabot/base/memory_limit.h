#ifndef sabot_base_memory_limit_h
#define sabot_base_memory_limit_h

namespace sabot
{
/** The memory that this process may have at most [bytes]: of the machine, of
    the control group that it runs in, or by the limits of the shell (ulimit -v
    and -d), whatever is least. */
double memory_limit();
/** Give what has been freed back to the system. A library that deal.II brings
    along (SuperLU_DIST) forbids the C library to do so by itself, and all that
    set-up took for a while would stay with the process. Costs a walk through
    the free parts: where much has been let go, not in steps. */
void give_back_memory();
} // namespace sabot

#endif
