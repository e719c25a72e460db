// Folders, and files that are whole at any moment.
#include "sabot/output/file_tools.h"

#include "sabot/base/error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace sabot
{
void make_folder(const std::string &folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error && !std::filesystem::is_directory(folder))
    throw IOError("cannot create folder \"" + folder +
                  "\": " + error.message());
}

void remove_file(const std::string &file)
{
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error)
    throw IOError("cannot remove \"" + file + "\": " + error.message());
}

void write_atomically(const std::string &file,
                      const std::function<void(const std::string &)> &write)
{
  const std::string temporary = file + ".part";
  try
  {
    write(temporary);
    if (std::rename(temporary.c_str(), file.c_str()) != 0)
      throw IOError("cannot write \"" + file + "\": " + std::strerror(errno));
  }
  catch (...)
  {
    std::remove(temporary.c_str());
    throw;
  }
}

void write_text(const std::string &file, const std::string &text)
{
  write_atomically(
      file,
      [&](const std::string &temporary)
      {
        errno = 0;
        std::ofstream stream(temporary, std::ios::binary);
        stream << text;
        stream.close();
        if (!stream)
        {
          const std::string reason =
              errno != 0 ? std::strerror(errno) : "the write failed";
          throw IOError("cannot write \"" + file + "\": " + reason);
        }
      });
}
} // namespace sabot
