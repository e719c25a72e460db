#ifndef sabot_output_file_tools_h
#define sabot_output_file_tools_h

#include <functional>
#include <string>

namespace sabot
{
/** Create a folder and those above it; IOError with the system's reason. */
void make_folder(const std::string &folder);

/** Call @p write with a temporary name beside @p file, then rename: the file
    is whole at any moment. IOError when either fails; the temporary is gone. */
void write_atomically(const std::string &file,
                      const std::function<void(const std::string &)> &write);

/** Write a text file atomically; IOError with the system's reason. */
void write_text(const std::string &file, const std::string &text);
} // namespace sabot

#endif
