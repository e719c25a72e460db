#ifndef sabot_bodies_fem_fem_mass_scaling_h
#define sabot_bodies_fem_fem_mass_scaling_h

#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/bodies/mass_scaling.h"

namespace sabot
{
/** The smallest step of a body of hexahedra: dm/8 to each node of a cell that
    asks for less. As omega_max of a body is at most the largest of its cells',
    the body does not ask for less, either. */
class FemMassScaling : public MassScaling
{
public:
  /** All is kept by reference, and may still be without cells; @p density
      [kg/m^3] at rest. Collective. */
  FemMassScaling(const MassScalingOptions &options,
                 const std::string &body_name, NodalState &nodes,
                 const VelocityConstraints &held, Hexahedra &cells,
                 const double density, MPI_Comm communicator)
      : MassScaling(options, body_name, "cells", nodes, held, communicator),
        cells(cells), density(density)
  {
  }
  /** Sets cells.smallest_step to what is left. Collective. */
  bool hold(const unsigned int step, const double dt) override;

private:
  Hexahedra &cells;
  const double density; // [kg/m^3]
};
} // namespace sabot

#endif
