#ifndef sabot_base_memory_limit_h
#define sabot_base_memory_limit_h

namespace sabot
{
/** The memory that this process may have at most [bytes]: of the machine, of
    the control group that it runs in, or by the limits of the shell (ulimit -v
    and -d), whatever is least. */
double memory_limit();
} // namespace sabot

#endif
