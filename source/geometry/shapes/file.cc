// The shape "file": a mesh of hexahedra that another program has made.
#include "sabot/geometry/mesh_import.h"
#include "sabot/geometry/shape.h"

#include <filesystem>

namespace sabot
{
namespace
{
/** A file that an entry names, looked up in the folder of the parameter file
    that sets it (of the scene, for an override). */
std::string beside(const ParameterFile &file, const std::string &path,
                   const std::string &name)
{
  if (name.empty())
    throw InputError(path, "needs the name of a mesh file");
  if (name[0] == '/')
    return name;
  const std::string from = file.file_of(path);
  const std::size_t slash = from.find_last_of('/');
  const std::string relative =
      slash == std::string::npos ? name : from.substr(0, slash + 1) + name;
  return std::filesystem::absolute(relative).string();
}

class File : public BodyShape
{
public:
  static void declare(Parameters &prm)
  {
    std::string formats;
    for (const auto &format : Registry<MeshReader>::entries())
      formats += " " + format.name + ": " + format.description;
    prm.declare_entry("Mesh file", "", any_text(),
                      "Hexahedra, looked up beside the parameter file; the "
                      "file's origin is put at the center." +
                          formats +
                          " Others are converted by meshio, where it is "
                          "installed.");
    prm.declare_entry("Mesh unit", "1 m",
                      quantity(Dimension::length, 1e-9, 1e3),
                      "Length of a unit of the file's coordinates.");
    prm.declare_entry(
        "Mesh material id", "all", any_text(),
        "Only cells of this part of the file, by number or name: "
        "physical volume of gmsh; set of elements, part, instance "
        "or section's material of Abaqus; id of VTK; 0: in none.");
    prm.declare_entry("Join nodes within", "never",
                      word_or("never", quantity(Dimension::length, 1e-12, 1.)),
                      "Nodes of the file that are nearer to each other become "
                      "one: joins halves whose common nodes are doubled.");
  }

  std::string face_names() const override
  {
    return "the names or numbers of the file: physical surfaces of gmsh, "
           "surfaces and sets of nodes of Abaqus, ids of VTK, 0 for faces in "
           "none";
  }

  NamedMesh mesh(const ShapeRequest &request) const override
  {
    Parameters &prm = request.prm;
    const std::string entry = request.path + "/Mesh file";
    const std::string resolved =
        beside(request.file, entry, prm.get("Mesh file"));
    prm.set("Mesh file", resolved); // for the expanded parameters
    MeshWish wish;
    wish.unit = get_quantity(prm, "Mesh unit");
    wish.origin = get_vector(prm, "Center");
    wish.part = prm.get("Mesh material id");
    wish.part_path = request.path + "/Mesh material id";
    wish.joining = get_optional_quantity(prm, "Join nodes within");
    return read_mesh({resolved, entry}, wish);
  }

  bool follows_cell_size() const override { return false; }
};

const Registry<BodyShape>::Add file({"file", "a mesh of hexahedra from a file.",
                                     File::declare,
                                     [] { return std::make_unique<File>(); }});
} // namespace
} // namespace sabot
