#ifndef sabot_simulation_scene_tools_h
#define sabot_simulation_scene_tools_h

#include "sabot/base/error.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/parameters.h"
#include "sabot/geometry/carving.h"
#include "sabot/simulation/scene.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
inline std::array<double, 3> get_vector(const Parameters &prm,
                                        const std::string &entry)
{
  const std::vector<double> v = get_quantities(prm, entry);
  return {{v[0], v[1], v[2]}};
}

[[noreturn]] inline void unknown_name(const std::string &path,
                                      const std::string &what,
                                      const std::string &name,
                                      const std::vector<std::string> &allowed)
{
  if (name.empty())
    throw InputError(path, "needs the name of a " + what);
  std::string message = "no " + what + " is called \"" + name + "\"";
  if (!allowed.empty())
    message += "; did you mean \"" + nearest_name(name, allowed) + "\"?";
  throw InputError(path, message);
}

inline const std::vector<std::string> box_faces = {"-x", "+x", "-y",
                                                   "+y", "-z", "+z"};

/** Numbers of the named faces (or axes) among the allowed ones. */
inline std::vector<unsigned int>
face_ids(const std::string &path, const std::string &text,
         const std::vector<std::string> &allowed)
{
  std::vector<unsigned int> ids;
  for (const std::string &face : split_names(text))
  {
    const auto found = std::find(allowed.begin(), allowed.end(), face);
    if (found == allowed.end())
    {
      std::string all;
      for (const std::string &a : allowed)
        all += (all.empty() ? "" : ", ") + a;
      throw InputError(path, "\"" + face + "\" is not a face; allowed: " + all);
    }
    ids.push_back(found - allowed.begin());
  }
  return ids;
}

/** A part cut out of a FEM body for particles. */
struct Scene::Carving
{
  std::string body, zone; // names
  ZoneShape shape;
  /** Whether the particles are nodes of the body's mesh; else the body is a box
      that is meshed around the zone, and the zone has a lattice of its own. */
  bool follows_mesh = false;

  /** Whether the zone is a cylinder with the axis of another one. */
  bool is_coaxial(const unsigned int axis,
                  const std::array<double, 3> &centre) const
  {
    bool same = shape.axis == int(axis);
    for (unsigned int d = 0; d < 3; ++d)
      same = same && (d == axis || std::abs(shape.centre[d] - centre[d]) <
                                       1e-6 * shape.size[d]);
    return same;
  }
};

/** A mesh and the names of its faces by boundary id. */
struct Scene::BodyMesh
{
  HexMesh mesh;
  std::vector<std::string> faces;
};
} // namespace sabot

#endif
