// Quantity of interest: the force that a cross-section of a body carries.
#include "sabot/base/text.h"
#include "sabot/simulation/directed_quantity.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** F = -n . sum of the internal forces on all nodes beyond a plane across the
    undeformed body, positive in tension: what is beyond pulls the rest along n.
    By equilibrium it is (d/dt of the momentum beyond) less what acts there from
    outside, with the other sign. */
class SectionForce : public QuantityOfInterest
{
public:
  explicit SectionForce(const QuantityRequest &request)
      : across(DirectedQuantity::read(request, false)),
        communicator(request.communicator)
  {
    const std::array<double, 3> p = get_vector(request.prm, "Point");
    offset = dot(across.direction, vec(p[0], p[1], p[2]));
    if (!across.body.facts().deforms)
      throw InputError(
          request.path + "/Body",
          "\"" + across.body.name +
              "\" is rigid: it has no internal forces; name a body "
              "of cells or particles");
    refuse_outside(request);
    std::array<int, 3> n_planes{};
    for (const SymmetryPlane &plane : across.body.planes_of_symmetry())
    {
      const double along = std::abs(across.direction[plane.axis]);
      if (along > 0. && along < 1.)
        throw InputError(request.path + "/Direction",
                         "a section of a body that is cut at planes of "
                         "symmetry must lie along or across them");
      n_planes[plane.axis] += along == 0.;
    }
    // A plane that cuts the section leaves half of it; between two parallel
    // ones the whole is without bounds.
    for (const int n : n_planes)
      copies *= n == 1 ? 2. : 1.;
  }
  double value() const override
  {
    ExactVectorSum force;
    if (const FaceView *const faces = across.body.faces())
      faces->add_section_force(across.direction, offset, force);
    if (const ParticleView *const particles = across.body.particles())
    {
      // A particle's stress gives forces that add up to nothing, unless the
      // plane passes through its neighborhood.
      const NodalState &nodes = across.body.nodes();
      for (std::size_t i = 0; i < nodes.n_owned; ++i)
        if (dot(nodes.reference_position[i], across.direction) > offset)
          force.add(particles->own_force(i));
    }
    ExactVectorSum::reduce({&force}, communicator);
    const std::array<double, 3> f = force.value();
    return -copies * dot(across.direction, vec(f[0], f[1], f[2]));
  }
  std::string unit() const override { return "N"; }

private:
  void refuse_outside(const QuantityRequest &request) const
  {
    double low = 1e300, high = -1e300;
    for (const std::array<double, 3> &p : across.body.partition_points())
    {
      const double place = dot(across.direction, vec(p[0], p[1], p[2]));
      low = std::min(low, place);
      high = std::max(high, place);
    }
    if (low < high && (offset < low || offset > high))
      throw InputError(request.path + "/Point",
                       "the section lies outside of body \"" +
                           across.body.name + "\": at " +
                           formatted("%.6g mm along the direction, the body ",
                                     1e3 * offset) +
                           formatted("from %.6g", 1e3 * low) +
                           formatted(" to %.6g mm", 1e3 * high));
  }

  const DirectedQuantity across;
  MPI_Comm communicator;
  double offset = 0.; // of the plane along the direction [m]
  double copies = 1.; // of the section in the whole
};

void declare(Parameters &prm)
{
  declare_directed_quantity(prm);
  prm.declare_entry("Point", "0 m, 0 m, 0 m",
                    quantities(Dimension::length, 3, 3, -1e3, 1e3),
                    "A point of the section, in the undeformed body.");
}

const UnitOfQuantity described("section force", "N");

const Registry<QuantityOfInterest>::Add registered(
    {"section force",
     "that the part of the body beyond a plane across the direction exerts on "
     "the rest, along the direction: positive in tension. The plane follows "
     "the metal. Of the whole where planes of symmetry cut the section.",
     declare, [](const QuantityRequest &request) {
       return std::make_unique<SectionForce>(request);
     }});
} // namespace
} // namespace sabot
