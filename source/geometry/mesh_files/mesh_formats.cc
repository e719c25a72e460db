// Which reader a mesh file needs; meshio's command line for all other formats.
#include "sabot/geometry/file_mesh.h"

#include "sabot/base/text.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace sabot
{
namespace
{
std::string ending_of(const std::string &file)
{
  std::string ending = std::filesystem::path(file).extension().string();
  if (!ending.empty())
    ending.erase(0, 1);
  return lower_case(ending);
}

/** A folder that goes with its content. */
class TemporaryFolder
{
public:
  explicit TemporaryFolder(const MeshFile &file)
  {
    std::error_code error;
    const auto base = std::filesystem::temp_directory_path(error);
    std::string pattern = (base / "sabot-mesh-XXXXXX").string();
    if (error || mkdtemp(&pattern[0]) == nullptr)
      file.refuse("no temporary folder for meshio: " +
                  std::string(std::strerror(errno)));
    path = pattern;
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;
  std::string path;
};

/** Runs a program with its output in @p log; its exit code, or -1 where it
    cannot be started. */
int run_program(const std::vector<std::string> &words, const std::string &log)
{
  std::vector<char *> arguments;
  for (const std::string &word : words)
    arguments.push_back(const_cast<char *>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null",
                                   O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, arguments[0], &actions, nullptr,
                                 arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    return -1;
  int status = 0;
  while (waitpid(pid, &status, 0) < 0)
    if (errno != EINTR)
      return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string known_formats()
{
  std::vector<std::string> all;
  for (const auto &format : Registry<MeshReader>::entries())
    all.push_back(format.name + " (" +
                  format.description.substr(
                      0, format.description.find_first_of(", ", 1)) +
                  ")");
  return join(all, ", ");
}

std::unique_ptr<MeshReader> reader_for(const std::string &ending)
{
  for (const auto &format : Registry<MeshReader>::entries())
  {
    auto reader = format.make();
    if (reader->takes(ending))
      return reader;
  }
  return nullptr;
}

/** By way of a .vtu that meshio makes of the file. */
FileMesh read_by_meshio(const MeshFile &file)
{
  const TemporaryFolder folder(file);
  const std::string made = folder.path + "/mesh.vtu",
                    log = folder.path + "/log.txt";
  const int code = run_program({"meshio", "convert", file.name, made}, log);
  if (code == 127 || (code < 0 && !std::filesystem::exists(log)) ||
      (code < 0 && lines_of(log).empty()))
    throw InputError(file.path,
                     "\"" + file.name + "\": the ending names none of " +
                         known_formats() +
                         "; other formats are converted by meshio, which is "
                         "not installed (pip install meshio)");
  if (code != 0 || !std::filesystem::exists(made))
  {
    const std::vector<std::string> lines = lines_of(log);
    file.refuse("its ending names none of " + known_formats() +
                ", and meshio cannot convert it" +
                (lines.empty() ? std::string() : ": " + trim(lines.back())));
  }
  try
  {
    FileMesh mesh = reader_for("vtu")->read({made, file.path});
    mesh.notes.push_back("converted by meshio; names of sets do not come with "
                         "it");
    return mesh;
  }
  catch (const InputError &)
  {
    file.refuse("what meshio makes of it has no hexahedra that can be read");
  }
}
/** What a damaged file may make of a reader's numbers, before anybody takes
    them for an index. */
void check_numbers(const FileMesh &mesh, const MeshFile &file)
{
  const auto check = [&](const auto &numbers, const std::size_t n)
  {
    for (const FileIndex number : numbers)
      if (number >= n)
        file.refuse("a set or cell has a member that is not there; a part or "
                    "an instance may have no end");
  };
  for (const auto &cell : mesh.cells)
    check(cell, mesh.vertices.size());
  for (const auto &set : mesh.cell_sets)
    check(set.cells, mesh.cells.size());
  for (const auto &set : mesh.node_sets)
    check(set.nodes, mesh.vertices.size());
  for (const auto &set : mesh.face_sets)
    for (const FileFace &face : set.faces)
      check(face, mesh.vertices.size());
}
} // namespace

FileMesh read_mesh_file(const MeshFile &file)
{
  const auto reader = reader_for(ending_of(file.name));
  if (!reader)
    file.text(); // is it there at all?
  FileMesh mesh = reader ? reader->read(file) : read_by_meshio(file);
  check_numbers(mesh, file);
  const auto clean = [](auto &sets)
  {
    for (auto &set : sets)
      set.name = printable(set.name);
  };
  clean(mesh.cell_sets);
  clean(mesh.face_sets);
  clean(mesh.node_sets);
  clean(mesh.unusable);
  for (auto *const lines : {&mesh.notes, &mesh.warnings, &mesh.prefixes})
    for (std::string &line : *lines)
      line = printable(line);
  return mesh;
}
} // namespace sabot
