#ifndef sabot_bodies_conduction_solver_h
#define sabot_bodies_conduction_solver_h

#include <mpi.h>

#include <functional>
#include <vector>

namespace sabot
{
/**
 * Conjugate gradients with the diagonal as preconditioner for the symmetric
 * positive system A x = right of a step of implicit heat conduction, scaled to
 * entries of order 1. At the steps of explicit dynamics k dt/(rho c h^2) is far
 * below 1 and a few iterations do. Dot products are exact sums, so that the
 * result does not depend on the number of ranks if @p multiply sums its rows in
 * global order.
 * @param multiply  product = A x on owned entries; sets the ghosts of x first
 * @param x         [owned, then ghosts], solution on owned entries
 * @return number of iterations. Collective. Throws PhysicsError.
 *
 * Starts from x = 0 and ends when r . D^-1 r has come down to 1e-18 of its
 * first value (of 1 where that is less): temperatures to 1e-9 of the largest
 * change, or to 1e-9 K. More than 10000 iterations, or numbers that are none,
 * count as no convergence. diagonal and right are [owned].
 */
unsigned int solve_conduction(
    const std::vector<double> &diagonal, const std::vector<double> &right,
    const std::function<void(std::vector<double> &x,
                             std::vector<double> &product)> &multiply,
    std::vector<double> &x, MPI_Comm communicator);
} // namespace sabot

#endif
