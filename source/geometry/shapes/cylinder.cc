// The shape "cylinder": along an axis, whole or a half or a quarter of it, with
// rings of cells that may grow away from a fine middle part or a zone.
#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/sector.h"
#include "sabot/geometry/shape.h"

namespace sabot
{
namespace
{
class Cylinder : public BodyShape
{
public:
  static void declare(Parameters &prm)
  {
    const Pattern length = quantity(Dimension::length, 1e-9, 1e3);
    prm.declare_entry("Radius", "1 mm", length, "Radius of the cylinder.");
    prm.declare_entry("Length", "1 mm", length, "Length of the cylinder.");
    prm.declare_entry("Axis", "z", one_of("x|y|z"),
                      "Direction of the cylinder's axis.");
    prm.declare_knob("Core radius", "automatic",
                     word_or("automatic", quantity(Dimension::length, 0., 1e3)),
                     "Radius of the middle part that has cells of the cell "
                     "size; automatic: 0.55 of the radius.");
    prm.declare_knob("Growth ratio", "1", quantity(Dimension::none, 1., 3.),
                     "Thickness of one ring of cells over the last, "
                     "outwards.");
    prm.declare_knob("Coarsest cell size", "none", word_or("none", length),
                     "Rings grow up to this thickness.");
    Sector::declare(prm, "cylinder",
                    "half keeps the positive side of the axis that follows the "
                    "cylinder's (x after z), quarter that of the other one, "
                    "too. The cut planes are called as a box's faces, e.g. -x, "
                    "-y.");
  }

  std::string face_names() const override
  {
    return "lower, upper, side and the cut planes of a sector";
  }

  NamedMesh mesh(const ShapeRequest &request) const override
  {
    const Parameters &prm = request.prm;
    const unsigned int axis = axis_of(prm);
    const Sector sector = Sector::parse(prm);
    std::vector<std::string> faces = {"lower", "upper", "side"};
    sector.name_cuts(axis + 1, faces);
    return {make_cylinder(get_quantity(prm, "Radius"),
                          get_quantity(prm, "Length"), axis,
                          get_vector(prm, "Center"), request.cell_size,
                          sector.n_cuts, grading(request)),
            std::move(faces)};
  }

  Vec axis(const Parameters &prm) const override
  {
    Vec direction = {};
    direction[axis_of(prm)] = 1.;
    return direction;
  }

  std::optional<ZoneShape> zone(const Parameters &prm,
                                const std::string &path) const override
  {
    if (!Sector::parse(prm).is_full())
      throw InputError(path + "/Sector",
                       "has no effect: the zone has the cells of the body "
                       "that it is carved from; remove the entry");
    ZoneShape zone;
    zone.center = get_vector(prm, "Center");
    zone.axis = axis_of(prm);
    zone.size.fill(2. * get_quantity(prm, "Radius"));
    zone.size[*zone.axis] = get_quantity(prm, "Length");
    return zone;
  }

private:
  static int axis_of(const Parameters &prm) { return prm.get("Axis")[0] - 'x'; }

  /** A zone that is a thinner cylinder on the same axis is the fine part. */
  static CylinderGrading grading(const ShapeRequest &request)
  {
    const Parameters &prm = request.prm;
    const unsigned int axis = axis_of(prm);
    const double radius = get_quantity(prm, "Radius");
    CylinderGrading grading;
    // A radius of 0 was a word for automatic.
    grading.core_radius = get_optional_quantity(prm, "Core radius");
    if (grading.core_radius && !(*grading.core_radius > 0.))
      grading.core_radius.reset();
    grading.growth_ratio = get_quantity(prm, "Growth ratio");
    grading.coarsest_cell_size =
        get_optional_quantity(prm, "Coarsest cell size").value_or(unbounded);
    if (grading.core_radius && *grading.core_radius > 0.9 * radius)
      throw InputError(request.path + "/Core radius",
                       "leaves no room for rings; at most 0.9 of the radius");
    const Carving *const carving = request.carving;
    if (carving == nullptr ||
        !carving->shape.is_coaxial(axis, get_vector(prm, "Center")) ||
        !(0.5 * carving->shape.size[(axis + 1) % 3] < 0.999 * radius))
      return grading;
    if (grading.core_radius)
      throw InputError(request.path + "/Core radius",
                       "has no effect: the zone \"" + carving->zone +
                           "\" that is carved from this body is the middle "
                           "part with cells of the cell size; remove it");
    grading.zone_radius = 0.5 * carving->shape.size[(axis + 1) % 3];
    return grading;
  }
};

const Registry<BodyShape>::Add
    cylinder({"cylinder", "along an axis, whole or a sector of it.",
              Cylinder::declare, [] { return std::make_unique<Cylinder>(); }});
} // namespace
} // namespace sabot
