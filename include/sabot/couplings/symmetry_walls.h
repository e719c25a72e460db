#ifndef sabot_couplings_symmetry_walls_h
#define sabot_couplings_symmetry_walls_h

#include "sabot/couplings/coupling.h"

#include <array>

namespace sabot
{
/** A plane of symmetry as one body sees it, and on which side the model is. */
struct SymmetryWall
{
  SymmetryPlane plane;
  double side; // +1: where the coordinate is larger, -1: where it is smaller
  /** Nodes of the body that were closer at the start are held on the plane by
      the body itself [m]; negative: none is. */
  double held_within = -1.;

  /** Of @p x, positive on the model's side [m]. */
  double distance(const Vec x) const
  {
    return side * (x[plane.axis] - plane.coordinate);
  }
};

/**
 * The planes of symmetry of all @p bodies, each once, with those that hold the
 * body of each index: a model is cut for all bodies alike, so a plane of one
 * holds every body that lies on its side of the plane as a whole. Before
 * distribute(); the same on every rank.
 */
std::vector<std::vector<SymmetryWall>>
find_symmetry_walls(const std::vector<Body *> &bodies);

/**
 * Planes of symmetry as walls: what comes to one meets its mirror image there,
 * at the plane, with the opposite velocity across it. So a node can never be
 * beyond, whichever body it belongs to, and slides along without friction. With
 * the distance g to the plane, the velocity v away from it, and the force f on
 * the node in this direction from all else, the force is
 *
 *   a node that flies, -v > 2 dt |f|/m: -2 (m v/dt + f), which turns its
 *     velocity around, as its image comes out if it goes through;
 *   one that is pressed: m/dt^2 max(0, -(g + dt v + dt^2 f/m)), which brings it
 *     just to the plane within the next step: the constraint of central
 *     differences, whatever the material, without the penetration that a spring
 *     needs;
 *   nodes of a rigid body: m/dt^2 max(0, -g), a spring as stiff as central
 *     differences bear, for only the body as a whole resists; dt the longest
 *     step since the node came in, so that the spring never stiffens and gives
 *     no energy.
 *
 * Nodes on faces of symmetry stay there by constraints of their bodies and are
 * left out, and so are followers of ties. What a pressed node loses of its
 * motion stands as contact energy in the ledger.
 */
class SymmetryWalls : public Coupling
{
public:
  /** Before the bodies are distributed. @p bodies by number. */
  SymmetryWalls(const std::vector<Body *> &bodies, MPI_Comm communicator);
  /** Whether any plane holds any body. */
  bool any() const;

  std::string kind() const override { return "symmetry planes"; }
  void initialize() override {}
  /** Local: each rank holds its own nodes. After all other couplings that
      push, for it asks for their forces. */
  void add_forces(const double dt) override;
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  /** "beyond a plane max" [m]: farthest that a node has been beyond. */
  Measures measure() const override;
  /** Of each body that a plane holds, as from outside. */
  std::vector<Resultant> resultants() const override;
  void visit_state(StateVisitor &visitor) override;

private:
  /** A node that met a wall in this step, and the force on it. */
  struct Held
  {
    std::uint32_t body, node; // local
    std::int64_t axis;        // of the wall
    double step;              // of rigid bodies, longest since it came in [s]
    Vec force;                // [N]
  };
  /** The same in a checkpoint, by the node's global number. */
  struct SavedHeld
  {
    std::int64_t body, axis;
    GlobalIndex node;
    double step;
    Vec force;
  };
  /** Of what all ranks held, the nodes that are owned here. */
  void restore_held(std::vector<SavedHeld> saved);
  /** The walls of a body that one look at a node tells of all: at most one
      across each axis. */
  struct WallsOfAxes
  {
    Vec coordinate = {}, side = {}; // side 0: none across this axis
    std::array<const SymmetryWall *, 3> wall{};
  };
  /** Points to those of @p of_body. */
  static std::vector<WallsOfAxes>
  by_axes(const std::vector<SymmetryWall> &of_body);
  /** Holds what comes to one of the walls @p of of body @p b. */
  void hold_at(const WallsOfAxes &of, const std::size_t b, const double dt,
               const std::vector<Held> &before);
  /** Pushes @p h, so far without a force, off the wall; @p next: its mass times
      its distance one step on [kg m], @p before: who was held in the last
      step. */
  void hold(Held h, const SymmetryWall &wall, const double next,
            const std::vector<Held> &before);

  const std::vector<Body *> bodies;
  MPI_Comm communicator;
  const std::vector<std::vector<SymmetryWall>> walls; // of each body
  std::vector<std::vector<WallsOfAxes>> of_axes;      // the same
  std::vector<Held> held;
  std::vector<ExactVectorSum> impulse; // on the nodes of each body [N s]
  ExactSum work;                       // on owned nodes [J]
  double farthest = 0.;                // beyond a plane, of this rank [m]
};
} // namespace sabot

#endif
