// The shape "projectile": a cylinder with a nose.
#include "sabot/geometry/round_bodies.h"
#include "sabot/geometry/sector.h"
#include "sabot/geometry/shape.h"

namespace sabot
{
namespace
{
class Projectile : public BodyShape
{
public:
  static void declare(Parameters &prm)
  {
    const Pattern length = quantity(Dimension::length, 1e-9, 1e3);
    prm.declare_entry("Radius", "1 mm", length, "Radius of the projectile.");
    prm.declare_entry("Length", "1 mm", length,
                      "Length of the shaft, without the nose.");
    prm.declare_entry("Axis", "z", one_of("x|y|z|-x|-y|-z"),
                      "Where the nose points.");
    prm.declare_entry(
        "Nose", "ogive", one_of("ogive|conical|spherical"),
        "Shape of the nose; the ogive is tangent to the shaft, the "
        "spherical one a cap of a ball.");
    prm.declare_entry("Nose length", "1 mm", length,
                      "Length of the nose: of an ogive at least the radius, of "
                      "a spherical one at most, then half a ball.");
    Sector::declare(prm, "projectile",
                    "half keeps the positive side of the axis that follows the "
                    "projectile's (x after z), quarter that of the other one, "
                    "too. The cut planes are called as a box's faces, e.g. -x, "
                    "-y.");
  }

  std::string face_names() const override
  {
    return "end, side and the cut planes of a sector";
  }

  Vec axis(const Parameters &prm) const override
  {
    const std::string axis = prm.get("Axis");
    Vec direction = {};
    direction[axis.back() - 'x'] = axis[0] == '-' ? -1. : 1.;
    return direction;
  }

  NamedMesh mesh(const ShapeRequest &request) const override
  {
    const Parameters &prm = request.prm;
    ProjectileSpecification projectile;
    projectile.radius = get_quantity(prm, "Radius");
    projectile.shaft_length = get_quantity(prm, "Length");
    projectile.nose_length = get_quantity(prm, "Nose length");
    const std::string nose = prm.get("Nose"), axis = prm.get("Axis");
    projectile.nose = nose == "ogive"     ? Nose::ogive
                      : nose == "conical" ? Nose::conical
                                          : Nose::spherical;
    if (projectile.nose == Nose::ogive &&
        projectile.nose_length < projectile.radius)
      throw InputError(request.path + "/Nose length",
                       "a tangent ogive is at least as long as its radius; "
                       "use a spherical nose or a longer one");
    if (projectile.nose == Nose::spherical &&
        projectile.nose_length > (1. + 1e-9) * projectile.radius)
      throw InputError(request.path + "/Nose length",
                       "a spherical nose is at most as long as the radius, "
                       "then half a ball; use an ogive for a longer one");
    projectile.axis = axis.back() - 'x';
    projectile.towards_positive = axis[0] != '-';
    projectile.center = get_vector(prm, "Center");
    projectile.cell_size = request.cell_size;
    const Sector sector = Sector::parse(prm);
    projectile.n_cuts = sector.n_cuts;
    std::vector<std::string> faces = {"end", "side"};
    sector.name_cuts(projectile.axis + 1, faces);
    return {make_projectile(projectile), std::move(faces)};
  }
};

const Registry<BodyShape>::Add projectile(
    {"projectile", "a cylinder with a conical, ogival or spherical nose.",
     Projectile::declare, [] { return std::make_unique<Projectile>(); }});
} // namespace
} // namespace sabot
