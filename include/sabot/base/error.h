#ifndef sabot_base_error_h
#define sabot_base_error_h

#include <stdexcept>
#include <string>

namespace sabot
{
/** What the process returns to the shell. */
enum class ExitCode : int
{
  done = 0,
  bad_input = 1,
  physics_failed = 2,
  interrupted = 3,
  io_failed = 4
};

/**
 * Bad input, found while reading or checking a scene. @p parameter is the path
 * of the entry, e.g. "Bodies/plate/Size" (or empty); the reader adds file and
 * line.
 */
class InputError : public std::runtime_error
{
public:
  InputError(const std::string &parameter, const std::string &message)
      : std::runtime_error(message), parameter(parameter)
  {
  }
  const std::string parameter;
};

/** The run went wrong: not-a-number, energy blow-up, inversion. */
class PhysicsError : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/** A file could not be written or read. */
class IOError : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};
} // namespace sabot

#endif
