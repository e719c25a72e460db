// A folder that must stay where and what it is.
#include "sabot/output/kept_folder.h"

#include "sabot/base/error.h"
#include "sabot/output/file_tools.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace sabot
{
KeptFolder::KeptFolder(const std::string &folder) : folder(folder)
{
  make_folder(folder);
  descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

KeptFolder::~KeptFolder()
{
  if (descriptor >= 0)
    ::close(descriptor);
}

std::string KeptFolder::trouble() const
{
  struct stat held, present;
  if (descriptor < 0 || ::fstat(descriptor, &held) != 0)
    return "";
  if (::stat(folder.c_str(), &present) != 0)
    return "the run's folder \"" + folder +
           "\" is gone: " + std::strerror(errno);
  if (present.st_dev != held.st_dev || present.st_ino != held.st_ino)
    return "the run's folder \"" + folder +
           "\" has been replaced by another of this name";
  return "";
}

void KeptFolder::check() const
{
  const std::string what = trouble();
  if (!what.empty())
    throw IOError(what);
}
} // namespace sabot
