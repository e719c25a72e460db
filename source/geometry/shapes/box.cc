// The shape "box": uniform, graded away from a zone that is left out of it, or
// from a part with finer cells; particles stand on a lattice of its own.
#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/shape.h"

#include <algorithm>

namespace sabot
{
const std::array<const char *, 6> box_faces = {
    {"-x", "+x", "-y", "+y", "-z", "+z"}};

namespace
{
class Box : public BodyShape
{
public:
  static void declare(Parameters &prm)
  {
    prm.declare_knob("Size", "1 mm, 1 mm, 1 mm",
                     quantities(Dimension::length, 3, 3, 1e-9, 1e3),
                     "Edge lengths of the box.");
  }

  void declare_grading(Parameters &prm) const override
  {
    prm.declare_knob("Coarsest cell size", "none",
                     word_or("none", quantity(Dimension::length, 1e-9, 1e3)),
                     "Where a zone is carved from the body or refined, "
                     "cells grow away from it up to this size.");
    prm.declare_knob("Growth ratio", "1.15", quantity(Dimension::none, 1., 3.),
                     "Size of one cell over the last, away from the zone.");
    prm.declare_knob(
        "Refined zone size", "none",
        word_or("none", quantities(Dimension::length, 3, 3, 0., 1e3)),
        "Edge lengths of the part of the box that has cells of "
        "the cell size; none: all of it has.");
    prm.declare_entry("Refined zone center", "0 mm, 0 mm, 0 mm",
                      quantities(Dimension::length, 3, 3, -1e3, 1e3),
                      "Position of its center.");
  }

  std::string face_names() const override { return "-x, +x, -y, +y, -z, +z"; }

  NamedMesh mesh(const ShapeRequest &request) const override
  {
    BoxSpecification box;
    box.center = get_vector(request.prm, "Center");
    box.size = get_vector(request.prm, "Size");
    box.cell_size = request.cell_size;
    const Carving *const carving = request.carving;
    if (carving != nullptr && !carving->follows_mesh)
    {
      box.has_zone = true;
      box.zone_center = carving->shape.center;
      box.zone_size = carving->shape.size;
      box.zone_path = "Bodies/" + carving->zone;
    }
    if (request.is_graded)
      grade(request, box);
    return {make_graded_box(box), {box_faces.begin(), box_faces.end()}};
  }

  bool has_lattice() const override { return true; }

  ParticleCloud lattice(const Parameters &prm,
                        const std::array<double, 3> &spacing) const override
  {
    return make_box_cloud(get_vector(prm, "Center"), get_vector(prm, "Size"),
                          spacing);
  }

  std::optional<ZoneShape> zone(const Parameters &prm,
                                const std::string &) const override
  {
    ZoneShape zone;
    zone.center = get_vector(prm, "Center");
    zone.size = get_vector(prm, "Size");
    return zone;
  }

private:
  static void grade(const ShapeRequest &request, BoxSpecification &box)
  {
    const Parameters &prm = request.prm;
    box.coarsest_cell_size =
        get_optional_quantity(prm, "Coarsest cell size").value_or(unbounded);
    box.growth_ratio = get_quantity(prm, "Growth ratio");
    if (prm.get("Refined zone size") == "none")
      return;
    const auto refined = get_vector(prm, "Refined zone size");
    // A length of 0 was a word for none.
    const auto n_none = std::count(refined.begin(), refined.end(), 0.);
    if (n_none == 3)
      return;
    if (n_none > 0)
      throw InputError(request.path + "/Refined zone size",
                       "is 0 along an axis; give all three edge lengths");
    if (box.has_zone)
      throw InputError(request.path + "/Refined zone size",
                       "a body has one zone, and \"" + request.carving->zone +
                           "\" is carved from this one already");
    box.has_zone = true;
    box.zone_is_cut = false;
    box.zone_center = get_vector(prm, "Refined zone center");
    box.zone_size = refined;
    box.zone_path = request.path;
  }
};

const Registry<BodyShape>::Add box({"box", "of any edge lengths.", Box::declare,
                                    [] { return std::make_unique<Box>(); }});
} // namespace
} // namespace sabot
