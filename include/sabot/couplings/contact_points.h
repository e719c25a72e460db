#ifndef sabot_couplings_contact_points_h
#define sabot_couplings_contact_points_h

#include "sabot/couplings/contact_options.h"

namespace sabot
{
class SharedWork;

/**
 * A node that presses on something in this step, in the current frame: what a
 * coupling found, and the forces that spring and friction make of it. One point
 * stands for a node against a face, a patch or other particles, or for one
 * particle of a pair against the other.
 */
struct ContactPoint
{
  // Set by the coupling.
  std::size_t item;                // its own number: of the group or pair
  Vec normal;                      // unit, outward of what is touched
  Vec velocity;                    // of the node against what it touches [m/s]
  Vec first_velocity;              // the same at the start of the step, see
                                   // NodeHalo::start_velocity()
  double depth;                    // that repels [m], > 0
  double stiffness;                // k [N/m], stable
  double reduced_mass;             // [kg]
  double area;                     // that the point stands for [m^2]
  double largest_friction;         // that the metals bear [N]
  ContactMemory *memory = nullptr; // null: a spring of a pair, which has a
                                   // potential and needs no books
  double fade = 1.;                // part of the force that acts, (0, 1]
  /** Of a point with a memory: SharedWork::number_of() its bodies, and whether
      its node is owned here. */
  int pair = -1;
  bool is_owned = false;
  /** The coupling's list of what is touched. */
  std::size_t first_touched = 0, last_touched = 0;
  /** From where on that is the other body's. */
  std::size_t first_of_other = 0;

  // Set by find_forces(). On the node act part * pressing * normal and
  // part * friction; the opposite, in parts, on what it touches.
  double pressing; // k depth + c max(0, -v . n) [N]
  Vec friction;    // along the surface [N]
  double part;     // that the work of the spring bears, times fade

  /** Whether it presses with a place between nodes (PressingPlace::shares). */
  bool is_place() const { return first_of_other > first_touched; }
  /** Of the two velocities [m/s]. */
  double largest_speed() const
  {
    return std::max(norm(velocity), norm(first_velocity));
  }
  /** On the node [N]. */
  Vec normal_force() const { return part * (pressing * normal); }
  Vec friction_force() const { return part * friction; }
};

/**
 * All contact points of a coupling in one step, in the order of adding, which
 * is the order in which forces are summed. A coupling fills it, asks for the
 * forces, and pushes; spring and law work on arrays, so that the choice of a
 * law costs nothing per point, and a law that couples points (a constraint
 * solved for all at once) has them together.
 */
class ContactPoints
{
public:
  /** Before a new step; memory is kept. */
  void clear() { points.clear(); }
  void add(const ContactPoint &point) { points.push_back(point); }
  /** Penalty and damping while approaching (SpringOptions), friction by
      spring_friction() below that of the law and what the metals bear, and of
      both the part that SharedWork::back() finds. Springs of pairs, which
      remember nothing, need no @p work and have friction below what stops the
      sliding within two steps. @p dt: the step just made [s], > 0. Collective
      with @p work, else local to a rank. */
  void find_forces(const ContactOptions &options, const double dt,
                   SharedWork *const work = nullptr);
  /** That bounds the stiffnesses of the points; the coupling lets it follow its
      steps and keeps it in checkpoints. */
  SteadyStep steady_step;

  std::vector<ContactPoint>::const_iterator begin() const
  {
    return points.begin();
  }
  std::vector<ContactPoint>::const_iterator end() const { return points.end(); }

private:
  std::vector<ContactPoint> points;
  SlidingContacts contacts;    // parallel to points, for the law
  std::vector<double> largest; // friction that the law allows [N]
};
} // namespace sabot

#endif
