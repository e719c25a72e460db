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
  const std::string origin = file.origin(path);
  const std::string from =
      origin.compare(0, 5, "--set") == 0 ? file.file_name : origin;
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
    prm.declare_entry("Mesh file", "", any_text(),
                      "Hexahedra from gmsh (.msh), Abaqus (.inp) or VTK "
                      "(.vtk), looked up beside the parameter file; its origin "
                      "is put at the center. Faces are named by the file's "
                      "boundary ids.");
    prm.declare_entry("Mesh unit", "1 m",
                      quantity(Dimension::length, 1e-9, 1e3),
                      "Length of a unit of the file's coordinates.");
    prm.declare_entry("Mesh material id", "all", word_or("all", integer(-1)),
                      "Only cells with this material id of the file.");
  }

  std::string face_names() const override
  {
    return "the boundary ids of the file";
  }

  NamedMesh mesh(const ShapeRequest &request) const override
  {
    Parameters &prm = request.prm;
    const std::string entry = request.path + "/Mesh file";
    const std::string resolved =
        beside(request.file, entry, prm.get("Mesh file"));
    prm.set("Mesh file", resolved); // for the expanded parameters
    NamedMesh made;
    made.mesh = read_mesh(resolved, get_quantity(prm, "Mesh unit"),
                          get_vector(prm, "Center"), material_id(prm), entry);
    for (const unsigned int id : made.mesh.boundary_id)
      while (made.faces.size() <= id)
        made.faces.push_back(std::to_string(made.faces.size()));
    return made;
  }

  bool follows_cell_size() const override { return false; }

private:
  static std::optional<unsigned int> material_id(const Parameters &prm)
  {
    const std::string text = prm.get("Mesh material id");
    // -1 was a word for all.
    return text == "all" || text == "-1"
               ? std::nullopt
               : std::optional<unsigned int>(std::stoul(text));
  }
};

const Registry<BodyShape>::Add file({"file", "a mesh of hexahedra from a file.",
                                     File::declare,
                                     [] { return std::make_unique<File>(); }});
} // namespace
} // namespace sabot
