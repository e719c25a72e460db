#ifndef sabot_bodies_discretization_h
#define sabot_bodies_discretization_h

#include "sabot/base/parameter_file.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/conversion_criterion.h"
#include "sabot/geometry/shape.h"
#include "sabot/geometry/turn.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace sabot
{
/** What a body is built from. Filled by whoever assembles the scene; lives
    during build() only. Lengths in m, whatever unit the file has. */
struct BodyRequest
{
  /** The body's subsection is entered. Not const: what was found out may be
      entered for the expanded parameters. */
  Parameters &prm;
  const ParameterFile &file;
  std::string path, name; // "Bodies/plate", "plate"
  int id;                 // number among the bodies
  std::shared_ptr<const Material> material;
  const BodyShape &shape;
  /** How the body is turned: for what is not made by mesh(). */
  const Turn &turn;
  std::array<double, 3> initial_velocity; // [m/s]
  /** Checked and turned mesh of the shape with about this cell size [m], around
      the zone that another body takes from it, if any. */
  std::function<NamedMesh(const double cell_size)> mesh;
  /** Makes the planes known that the scene's lists of faces of this body have
      among their names, for faces that are not mesh()'s. */
  std::function<void(NamedMesh &)> name_planes;
  /** Turned cells that exist already: those of a zone that follows the mesh of
     another body, or what such a zone has left of this one. */
  std::optional<NamedMesh> cells;
};

/**
 * How a body is made of items: one choice of "Discretization", with the entries
 * of such bodies. A new one is one folder with a body, an implementation of
 * this class, and its registration. Without state.
 *
 * Objects are made by the registry by the name in the scene: FEM, SPG, rigid.
 */
class Discretization
{
public:
  static constexpr const char *kind = "discretization";
  using Make = std::unique_ptr<Discretization>();
  virtual ~Discretization() = default;

  /** Declares the entries in the body's subsection; those that name faces
      say which by @p shape, which is null where the shape is not known.
      Called before values are read, and for the reference of entries, where
      no scene is known. */
  virtual void declare(Parameters &prm, const BodyShape *shape) const = 0;
  /** The body; not collective. Throws InputError, by the entry. Every rank
      builds the whole body, with all nodes; Body::distribute() then keeps a
      part. */
  virtual std::unique_ptr<Body> build(BodyRequest &request) const = 0;

  /** Whether particles may take the place of a part of such a body. */
  virtual bool may_be_carved() const { return false; }
  /** The name of the body in whose place, within its own shape, this one
      stands; empty: none. Of the entry "Carve from"; the host loses its
      cells in that place. */
  virtual std::string carved_from(const Parameters &) const { return ""; }
  /** When cells of the body carved_from() turn into particles of this one;
      nothing: the zone is what it is from the start. Throws InputError, by the
      entry. */
  virtual std::optional<ConversionRequest>
  conversion(const Parameters &, const std::string & /*path*/) const
  {
    return std::nullopt;
  }
  /** Size of the cells whose mesh a carved zone follows [m]. */
  virtual double cell_size(const Parameters &) const { return 0.; }
  /** A body that takes over the cells of another one has their spacing [m]:
      enters it, and refuses another one in the file. */
  virtual void follow_spacing(Parameters &, const ParameterFile &,
                              const std::string & /*path*/,
                              const double /*spacing*/) const
  {
  }
};

/** Body::find_faces of a body with these names of faces. */
inline std::function<std::vector<unsigned int>(const std::string &path,
                                               const std::string &text)>
face_finder(const NamedMesh &made)
{
  NamedMesh names; // without the mesh
  names.faces = made.faces;
  names.groups = made.groups;
  names.unusable = made.unusable;
  return [names](const std::string &path, const std::string &text)
  { return find_face_ids(path, text, names); };
}

/** The names of a shape's faces in words, and that planes are names, too; empty
    where there is no shape. */
inline std::string face_names(const BodyShape *const shape)
{
  return shape == nullptr ? "" : shape->face_names() + "; or x = 0 mm, a plane";
}
} // namespace sabot

#endif
