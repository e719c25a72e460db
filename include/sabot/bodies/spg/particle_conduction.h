#ifndef sabot_bodies_spg_particle_conduction_h
#define sabot_bodies_spg_particle_conduction_h

#include "sabot/base/nodal_state.h"
#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/particle_exchange.h"

#include <vector>

namespace sabot
{
/**
 * Heat conduction between particles, rho_0 c dT/dt = div(k grad T) in the
 * configuration of the last kernel update, insulated at free surfaces and
 * across failed bonds; backward Euler between steps of the motion. From the
 * energy (as the mechanical one, with the bond residual for what the direct
 * gradient does not see)
 *
 *   E = 1/2 sum_N k V_N ( |g_N|^2 + 3/S_N sum_J phi r_NJ^2 ),
 *   g_N = M_N^-1 sum_J phi (T_J - T_N) dX,  r_NJ = T_J - T_N - g_N . dX,
 *   S_N = sum_J phi |dX|^2,
 *
 * exact for linear fields on any cloud; where M_N = S_N/3 1 it is the sum over
 * bonds 3 k V_N / (2 S_N) phi (T_J - T_N)^2. The 3 is thus no free constant.
 * Heat flows in pairs, equal and opposite:
 *
 *   q_NJ = phi [ (a_N + a_J) . dX + (b_N + b_J) (T_J - T_N) ],
 *   b_N = 3 k V_N / S_N,  a_N = k V_N M_N^-1 g_N - b_N g_N.
 *
 * Particles that lost a direction count with the sum over bonds, a_N = 0.
 */
class ParticleConduction
{
public:
  /** What the body holds; valid while this lives. Entries of ghosts are
      needed for positions only; coefficients of ghosts are exchanged. */
  struct Cloud
  {
    const BondList &bonds;
    const ParticleExchange &exchange;
    const AlignedVector<Vec> &position; // X, with ghosts
    const AlignedVector<Mat> &moment_inverse;
    const std::vector<double> &volume; // V
    const std::vector<char> &weak;
  };
  /** @p capacity: rho_0 c V_0 of the owned particles [J/K]. */
  ParticleConduction(const double conductivity, const Cloud &cloud,
                     std::vector<double> capacity, MPI_Comm communicator);

  /** Conduct for @p dt [s]; @p temperature of owned particles [K] is
      updated. Collective. (C + dt K) dT = dt q(T), solved by conjugate
      gradients to 1e-9 of the change with the bonds' part of K on the
      diagonal; no matrix is stored. Throws PhysicsError where it does not
      converge. */
  void advance(const double dt, double *temperature);

  /** Heat that flows into each owned particle [W] by the temperatures of
      all; collective. temperature is resized to all local particles and its
      ghosts are filled; flow [n_owned] sums to zero over the body. After
      assemble() only. */
  void heat_flow(std::vector<double> &temperature, std::vector<double> &flow);
  /** Take over the configuration of the last kernel update. b of each
      particle, 0 where it has no bonds. Local. */
  void assemble();

private:
  const double conductivity;
  const Cloud cloud;
  const std::vector<double> capacity;
  MPI_Comm communicator;
  /** By which the system is scaled to entries of order 1 [J/K]. */
  double largest_capacity = 0.; // over ranks
  /** a and, in the fourth lane, b; owned and ghosts. */
  AlignedVector<Vec> coefficient;
  std::vector<double> stiffness; // b of owned particles
};
} // namespace sabot

#endif
