#ifndef sabot_geometry_shape_h
#define sabot_geometry_shape_h

#include "sabot/base/parameter_file.h"
#include "sabot/base/registry.h"
#include "sabot/geometry/carving.h"
#include "sabot/geometry/named_mesh.h"
#include "sabot/geometry/particle_cloud.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sabot
{
/** Names of a box's faces by boundary id; cut planes of other shapes are called
    the same. */
extern const std::array<const char *, 6> box_faces;

/** What a shape needs to know of the body that it is the shape of. */
struct ShapeRequest
{
  /** The body's subsection is entered. Not const: a shape may complete what the
      expanded parameters show, as the file does with its full path. */
  Parameters &prm;
  const ParameterFile &file;
  std::string path;       // of the body, "Bodies/plate", for messages
  double cell_size = 0.;  // [m]
  bool is_graded = false; // whether the entries of declare_grading() are there
  /** The zone that particles take from the body; null where there is none. */
  const Carving *carving = nullptr;
};

/**
 * A shape of bodies: entries, checks and mesh of one choice of "Geometry". The
 * same for deformable bodies of cells or particles and for rigid ones. Without
 * state: every function gets the parameters with the body's subsection
 * entered. Lengths are in meters, all results the same on every rank, and no
 * function is collective.
 *
 * A new shape is one file in source/geometry/shapes/, with this class, a static
 * function that declares its entries, and at the end its registration. Manual,
 * menus and messages follow.
 */
class BodyShape
{
public:
  static constexpr const char *kind = "shape";
  using Make = std::unique_ptr<BodyShape>();
  virtual ~BodyShape() = default;

  /** The names of the faces in words, for the meaning of entries that list
      faces; known before the parameters are. */
  virtual std::string face_names() const = 0;
  /** Entries by which cells coarsen away from a part of the body, beside those
      of the registry; only bodies of finite elements have them. */
  virtual void declare_grading(Parameters &) const {}

  /**
   * Hexahedra of about the requested cell size with the exact volume of the
   * shape, around or with the cells of the requested zone. Not collective.
   * Throws InputError, by the entry, for values that do not go together.
   */
  virtual NamedMesh mesh(const ShapeRequest &request) const = 0;

  /** The direction along which the body is speeded by "Initial speed", before
      it is turned: of unit length. */
  virtual Vec axis(const Parameters &) const { return vec(0., 0., 1.); }

  /** Whether the cells of mesh() have the requested size, and not one of their
      own. */
  virtual bool follows_cell_size() const { return true; }

  /** Whether particles stand on a lattice() of the shape, and are not the nodes
      of mesh(). */
  virtual bool has_lattice() const { return false; }
  /** Particles with the nearest distances to these along the axes [m] that
      divide the shape; none where it has no lattice. */
  virtual ParticleCloud lattice(const Parameters &,
                                const std::array<double, 3> & /*spacing*/) const
  {
    return {};
  }

  /** The part of another body that this shape describes; nothing where it
      cannot. Throws InputError for entries that have no effect on it. */
  virtual std::optional<ZoneShape> zone(const Parameters &,
                                        const std::string & /*path*/) const
  {
    return std::nullopt;
  }
};

/** The shape that the entry @p path, of the value @p name, chooses. */
inline std::unique_ptr<BodyShape> make_shape(const std::string &path,
                                             const std::string &name)
{
  return Registry<BodyShape>::get(path, name).make();
}
} // namespace sabot

#endif
