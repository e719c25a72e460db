// Locks that the system gives back when their process ends.
#include "sabot/output/file_lock.h"

#include "sabot/base/error.h"
#include "sabot/output/file_tools.h"
#include "sabot/output/first_rank.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

namespace sabot
{
namespace
{
/** Whether @p file is what @p descriptor has open: one that gives its lock back
    removes the file, perhaps just before it was locked here. */
bool is_same(const int descriptor, const std::string &file)
{
  struct stat held, present;
  return ::fstat(descriptor, &held) == 0 &&
         ::stat(file.c_str(), &present) == 0 && held.st_ino == present.st_ino &&
         held.st_dev == present.st_dev;
}

std::string first_line(const std::string &file)
{
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}
} // namespace

FileLock::FileLock(const std::string &file) : file(file)
{
  constexpr int mode = 0666; // what the umask leaves of it
  constexpr int most_tries = 100;
  for (int t = 0; t < most_tries; ++t)
  {
    descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, mode);
    if (descriptor < 0)
      throw IOError("cannot write \"" + file + "\": " + std::strerror(errno));
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    {
      other = first_line(file);
      ::close(descriptor);
      descriptor = -1;
      return;
    }
    if (is_same(descriptor, file))
      break;
    ::close(descriptor);
    descriptor = -1;
  }
  if (descriptor < 0)
    return;
  const std::string me = "process " + std::to_string(::getpid()) + "\n";
  // Only for the message of another: a full disk is told elsewhere.
  if (::ftruncate(descriptor, 0) != 0 ||
      ::pwrite(descriptor, me.data(), me.size(), 0) < 0)
    return;
}

FileLock::~FileLock()
{
  if (descriptor < 0)
    return;
  if (is_same(descriptor, file))
    ::unlink(file.c_str());
  ::flock(descriptor, LOCK_UN);
  ::close(descriptor);
}

FolderLock::FolderLock(const std::string &folder, const bool makes_folder,
                       MPI_Comm communicator)
{
  on_first_rank(
      communicator, "lock the folder",
      [&]()
      {
        if (makes_folder)
          make_folder(folder);
        constexpr int most_tries = 20;
        constexpr std::chrono::milliseconds pause(100);
        for (int t = 0; t < most_tries && std::filesystem::is_directory(folder);
             ++t)
        {
          lock = std::make_unique<FileLock>(folder + "/run.lock");
          if (lock->is_held())
            break;
          std::this_thread::sleep_for(pause);
        }
        if (lock && !lock->is_held())
          throw IOError(
              "folder \"" + folder + "\" is in use by another run" +
              (lock->holder().empty() ? "" : " (" + lock->holder() + ")"));
      });
}
} // namespace sabot
