#ifndef sabot_geometry_named_mesh_h
#define sabot_geometry_named_mesh_h

#include "sabot/geometry/hex_mesh.h"

#include <string>
#include <vector>

namespace sabot
{
/** A mesh and the names of its faces. */
struct NamedMesh
{
  /** Faces that go by one name, as all the faces with some boundary ids; by
      none where the name means no faces of the boundary. */
  struct Group
  {
    std::string name, also; // the number of one that has a name
    std::vector<unsigned int> ids;
  };
  /** A name that the file has, but that means no faces; and why. */
  struct Unusable
  {
    std::string name, reason;
  };

  HexMesh mesh;
  /** By boundary id; where a file's sets of faces overlap, each id is what
      some sets have in common, and its name only good for messages. */
  std::vector<std::string> faces{};
  std::vector<Group> groups{}; // further names
  std::vector<Unusable> unusable{};
  // Of the making, one line each.
  std::vector<std::string> notes{}, warnings{};
};

/**
 * Makes the planes known that @p text, a list of faces, has among its names:
 * "x = 0 mm" is all boundary faces in that plane, to a millionth of the mesh's
 * size. Splits boundary ids of which only some faces are meant; with
 * @p is_symmetry also those that lie in several planes across the axes. Has to
 * be told of all lists before find_face_ids() is asked for one. Throws
 * InputError for
 * @p path where a plane has no faces.
 */
void name_planes(NamedMesh &made, const std::string &path,
                 const std::string &text, const bool is_symmetry);

/** Boundary ids of the faces that @p text lists: names of groups or faces, and
    planes that name_planes() was told of. Upper and lower case count, unless
    only one name is meant without. Throws InputError for @p path with what is
    allowed. */
std::vector<unsigned int> find_face_ids(const std::string &path,
                                        const std::string &text,
                                        const NamedMesh &made);
} // namespace sabot

#endif
