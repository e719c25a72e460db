#ifndef sabot_output_file_lock_h
#define sabot_output_file_lock_h

#include <mpi.h>

#include <memory>
#include <string>

namespace sabot
{
/**
 * The right to something that one process may have at a time, as a file that is
 * locked while it lives. The system gives it back when the process ends, killed
 * or not, so that no lock is left over. Where a file system knows no locks,
 * everybody gets it.
 */
class FileLock
{
public:
  /** Makes @p file and locks it, unless somebody has; is not waited for.
      IOError where the file cannot be made. */
  explicit FileLock(const std::string &file);
  /** Gives it back and removes the file. */
  ~FileLock();
  FileLock(const FileLock &) = delete;

  bool is_held() const { return descriptor >= 0; }
  /** Who has it instead, as far as is known: "process 1234". */
  const std::string &holder() const { return other; }
  /** A program that is started with this descriptor open has the lock, too, for
      as long as it runs. */
  int open_descriptor() const { return descriptor; }

private:
  const std::string file;
  std::string other;
  int descriptor = -1;
};

/**
 * A run's folder, for one program at a time: two that write into one would mix
 * their files. Rank 0 locks for all.
 */
class FolderLock
{
public:
  /** IOError on all ranks when another program has @p folder, which is waited
      for two seconds, as one that was told to stop may be writing its last
      files. A folder that does not exist is made if @p makes_folder, and else
      nothing is locked. Collective. */
  FolderLock(const std::string &folder, const bool makes_folder,
             MPI_Comm communicator);

private:
  std::unique_ptr<FileLock> lock; // rank 0
};
} // namespace sabot

#endif
