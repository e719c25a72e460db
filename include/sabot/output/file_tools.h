#ifndef sabot_output_file_tools_h
#define sabot_output_file_tools_h

#include <functional>
#include <string>

namespace sabot
{
// What a run leaves must be whole or not there, and a full disk must be told as
// such: all files of the program but log.txt go through these.

/** Create a folder and those above it; one that is there already is right.
    IOError with the system's reason. Not collective, as all of these: one rank
    calls them and tells the others. */
void make_folder(const std::string &folder);

/** Remove a file; none there is right. IOError with the system's reason. */
void remove_file(const std::string &file);

/** Call @p write with a temporary name beside @p file ("file.part"), then
    rename: whoever reads the file finds the old or the new one, whole, at any
    moment. IOError when either fails; the temporary is gone, the old file
    stays. */
void write_atomically(const std::string &file,
                      const std::function<void(const std::string &)> &write);

/** Write a file with the bytes of @p text, atomically; IOError with the
    system's reason, for example that the disk is full. */
void write_text(const std::string &file, const std::string &text);
} // namespace sabot

#endif
