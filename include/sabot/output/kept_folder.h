#ifndef sabot_output_kept_folder_h
#define sabot_output_kept_folder_h

#include <string>

namespace sabot
{
/**
 * A folder that a run writes into over hours: check() tells when it is gone or
 * another one stands under its name, so that nothing is written where nobody
 * looks for it, or among the files of another run. It is held open, since a
 * system may give the number of a folder that is gone to a new one. One rank
 * has it.
 */
class KeptFolder
{
public:
  /** Makes @p folder and those above it where they are missing. IOError. */
  explicit KeptFolder(const std::string &folder);
  ~KeptFolder();
  KeptFolder(const KeptFolder &) = delete;

  /** What is wrong with it now, in a sentence; empty: nothing. */
  std::string trouble() const;
  /** IOError with the trouble there is. */
  void check() const;

private:
  const std::string folder;
  int descriptor; // -1: the system holds no folders open; nothing is checked
};
} // namespace sabot

#endif
