// What the record of a run says of the program and of the machine.
#include "sabot/base/program.h"

#include <unistd.h>

#include <ctime>

namespace sabot
{
namespace
{
/** What the flags of this build let the compiler use. */
const char *vector_instructions()
{
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#elif defined(__AVX__)
  return "AVX";
#elif defined(__SSE2__)
  return "SSE2";
#elif defined(__ARM_NEON)
  return "NEON";
#else
  return "no vectors";
#endif
}
} // namespace

ProgramFacts &program_facts()
{
  static ProgramFacts facts;
  return facts;
}

std::string command_text(const int argc, const char *const *const argv)
{
  std::string text;
  for (int i = 0; i < argc; ++i)
  {
    const std::string word = argv[i];
    const bool is_plain =
        !word.empty() && word.find_first_not_of(
                             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTU"
                             "VWXYZ0123456789_-./=:,+%@") == std::string::npos;
    std::string quoted = "'";
    for (const char c : word)
      quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += (i > 0 ? " " : "") + (is_plain ? word : quoted + "'");
  }
  return text;
}

std::string build_text()
{
  return std::string(SABOT_COMPILER) + ", instruction set " + SABOT_SIMD +
         " (" + vector_instructions() + ")";
}

std::string place_text()
{
  const std::time_t now = std::time(nullptr);
  char date[64] = "", host[256] = "";
  std::tm parts;
  if (gmtime_r(&now, &parts) != nullptr)
    std::strftime(date, sizeof(date), "%Y-%m-%d %H:%M:%S UTC", &parts);
  gethostname(host, sizeof(host) - 1);
  return std::string(date) + " on " + host;
}
} // namespace sabot
