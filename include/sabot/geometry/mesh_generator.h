#ifndef sabot_geometry_mesh_generator_h
#define sabot_geometry_mesh_generator_h

#include "sabot/geometry/hex_mesh.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace sabot
{
/** Cells that grow away from their fine part without an upper bound. */
constexpr double unbounded = std::numeric_limits<double>::infinity();

/** A box of hexahedra, uniform, or graded away from a zone: the part that has
    cells of the cell size, which may be left out for particles. */
struct BoxSpecification
{
  std::array<double, 3> center{{0., 0., 0.}}, size{{0., 0., 0.}}; // [m]
  double cell_size = 0.;                                          // [m]
  double coarsest_cell_size = unbounded;                          // [m]
  double growth_ratio = 1.;
  bool has_zone = false;
  bool zone_is_cut = true; // else it is only where the cells are fine
  std::array<double, 3> zone_center{{0., 0., 0.}}, zone_size{{0., 0., 0.}};
  std::string zone_path; // of the zone's body, for messages
};

/**
 * The box, in cells whose planes are common to all rows: uniform where there is
 * no zone, else uniform over the zone and growing away from it along each axis.
 * Boundary ids: 0 to 5 for -x, +x, -y, +y, -z, +z, and 6 for the faces of the
 * zone. Throws InputError when the zone is not inside the box.
 */
HexMesh make_graded_box(const BoxSpecification &box);

/** How the o-grid of a cylinder is graded. */
struct CylinderGrading
{
  /** Of the square core's corners [m]; nothing: 0.55 of the radius. */
  std::optional<double> core_radius;
  double growth_ratio = 1.;
  double coarsest_cell_size = unbounded; // [m], of the rings
  /** Rings meet at this radius [m]: the part inside has the mesh of a cylinder
      of its own, outside of it the rings grow. */
  std::optional<double> zone_radius;
};

/**
 * A cylinder of hexahedra on an o-grid (square core, rings around it), with
 * cells of about @p cell_size. Its polygonal cross-section is scaled to the
 * area pi r^2, so that volume and mass are exact; the rim nodes then lie
 * outside the circle by a fraction pi^2/(3 n^2) of r for n rim cells.
 * Boundary ids: 0 lower end, 1 upper end, 2 side. @p axis: 0, 1, 2.
 * @p n_cuts: 1 keeps the half where the coordinate after the axis is not less
 * than the center's, 2 the quarter where the one after that is not, either; the
 * cut planes have the boundary ids 3 and 4. @p grading: a smaller core, or an
 * inner cylinder, with rings that grow outwards.
 */
HexMesh make_cylinder(const double radius, const double length,
                      const unsigned int axis,
                      const std::array<double, 3> &center,
                      const double cell_size, const unsigned int n_cuts = 0,
                      const CylinderGrading &grading = CylinderGrading());

/** Sizes [m] from @p fine on, each @p growth times the last up to @p coarsest,
    then scaled to fill @p length. */
std::vector<double> growing_sizes(const double length, const double fine,
                                  const double coarsest, const double growth);

/** Grid planes between @p low and @p high: about @p fine between @p inner_low
    and @p inner_high, which are planes themselves, then growing outwards. */
std::vector<double> graded_planes(const double low, const double high,
                                  const double inner_low,
                                  const double inner_high, const double fine,
                                  const double coarsest, const double growth);
} // namespace sabot

#endif
