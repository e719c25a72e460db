// Load: a velocity that is forced upon faces, or upon a whole body.
#include "sabot/geometry/face_names.h"
#include "sabot/loads/time_course.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace sabot
{
namespace
{
/** Of nodes that are at fault the one with the least number, on all ranks. */
struct FirstNode
{
  static constexpr double none = std::numeric_limits<double>::max();
  double number = none, is_tied = 0.;
  Vec at = {}; // [m]

  void take(const NodalState &state, const std::size_t i)
  {
    if (double(state.global_id[i]) >= number)
      return;
    number = state.global_id[i];
    is_tied = state.is_follower(i);
    at = state.position[i];
  }
  /** Whether there is one on any rank. Collective. */
  bool reduce(MPI_Comm communicator)
  {
    double least = number;
    MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, communicator);
    if (least == none)
      return false;
    double all[4] = {at[0], at[1], at[2], is_tied};
    for (double &value : all)
      value = number == least ? value : 0.;
    MPI_Allreduce(MPI_IN_PLACE, all, 4, MPI_DOUBLE, MPI_SUM, communicator);
    at = vec(all[0], all[1], all[2]);
    is_tied = all[3];
    return true;
  }
  std::string place() const
  {
    char text[100];
    std::snprintf(text, sizeof(text), "(%.6g, %.6g, %.6g) mm", 1e3 * at[0],
                  1e3 * at[1], 1e3 * at[2]);
    return text;
  }
};

/**
 * v = factor(t) V for the held components; of a rigid body V + W x r. Along a
 * step nodes move with the mean of the factor, so that they are where its
 * integral says; at its end they have the velocity of that time.
 *
 * What drives the nodes does the work -f . v dt against their forces, and the
 * change of their kinetic energy, (factor^2)/2 m |V|^2.
 */
class PrescribedMotion : public Load
{
public:
  explicit PrescribedMotion(const LoadRequest &request);
  std::string type() const override { return "prescribed motion"; }
  std::vector<int> drives() const override { return {body.id}; }
  void initialize() override;
  void check_beside(const Load &other) const override;
  void impose_velocities(const double begin, const double end) override;
  void accumulate_work(const double half_dt) override
  {
    constraints.accumulate_work(body.nodes(), half_dt, factor);
  }
  void add_energies(EnergyLedger &ledger) const override
  {
    ledger.external.add(constraints.work());
    ledger.external.add(kinetic_work);
  }
  void take_kick_energy(const double dt, ExactSum &sum) const override
  {
    const NodalState &state = body.nodes();
    for (std::size_t i = 0; i < state.n_owned && !is_rigid; ++i)
    {
      const Vec undone =
          (vec(1., 1., 1.) - constraints.held_at(i).first) * state.force[i];
      if (norm_square(undone) > 0.)
        sum.add(-dt * dt / (8. * state.inertia[i]) * norm_square(undone));
    }
  }
  /** Of a rigid body without the work against forces, which it counts
      itself. */
  double total_work() const override
  {
    ExactSum work = constraints.work();
    work.add(kinetic_work);
    ExactSum::reduce({&work}, communicator);
    return work.value();
  }
  std::vector<Resultant> resultants() const override
  {
    if (is_rigid)
      return {};
    std::vector<Resultant> all = constraints.reactions(
        body.nodes(), body.id, {Holder::drive}, communicator);
    all[0].source = name;
    return all;
  }
  void visit_state(StateVisitor &visitor) override
  {
    visitor.visit_value("factor", factor);
    visitor.visit_value("factor at the end of the step", last_factor);
    visitor.visit_sum("work", constraints.work());
    visitor.visit_sum("kinetic work", kinetic_work);
    constraints.visit_state(visitor, body.name, body.nodes());
  }

  static void declare(Parameters &prm);

private:
  using Holder = VelocityConstraints::Holder;
  std::vector<std::size_t> driven_nodes() const;
  /** InputError, on all ranks, where a node is already led otherwise. */
  void refuse_contradictions(const std::vector<std::size_t> &nodes) const;

  Body &body;
  const std::string path;
  const std::unique_ptr<TimeCourse> course;
  MPI_Comm communicator;
  bool is_rigid = false, is_whole = false;
  std::vector<unsigned int> ids; // of faces
  std::array<bool, 3> is_held{};
  Vec velocity, angular_velocity; // [m/s], [1/s]
  VelocityConstraints constraints;
  std::vector<double> energy; // 1/2 m |V|^2 of the nodes [J]
  double factor = 0., last_factor = 0.;
  ExactSum kinetic_work;
};

PrescribedMotion::PrescribedMotion(const LoadRequest &request)
    : Load(request.name), body(*request.body("Body", request.prm.get("Body"))),
      path(request.path), course(TimeCourse::make(request)),
      communicator(request.communicator)
{
  const Parameters &prm = request.prm;
  const auto v = get_vector(prm, "Velocity"),
             w = get_vector(prm, "Angular velocity");
  velocity = vec(v[0], v[1], v[2]);
  angular_velocity = vec(w[0], w[1], w[2]);
  for (const unsigned int axis :
       word_ids(path + "/Components", prm.get("Components"), {"x", "y", "z"},
                "component"))
    is_held[axis] = true;
  is_rigid = body.loadable()->prescribe_rigid_motion();
  is_whole = split_names(prm.get("Faces")).empty();
  const bool all = is_held[0] && is_held[1] && is_held[2];
  if (is_rigid && !is_whole)
    throw InputError(path + "/Faces", "of a rigid body move with all of it; "
                                      "remove the entry");
  if (is_rigid && !all)
    throw InputError(path + "/Components",
                     "of a rigid body are all prescribed; remove the entry");
  if (!is_rigid && norm(angular_velocity) > 0.)
    throw InputError(path + "/Angular velocity",
                     "is for rigid bodies; body \"" + body.name +
                         "\" deforms; remove it");
  if (!is_whole)
    ids = body.find_faces(path + "/Faces", prm.get("Faces"));
  body.loadable()->keep_faces(ids);
  for (int d = 0; d < 3; ++d)
    if (!is_held[d])
      velocity[d] = 0.;
}

std::vector<std::size_t> PrescribedMotion::driven_nodes() const
{
  const std::size_t n_owned = body.nodes().n_owned;
  std::vector<std::size_t> nodes;
  if (is_whole)
  {
    nodes.resize(n_owned);
    std::iota(nodes.begin(), nodes.end(), 0);
    return nodes;
  }
  const LoadedSurface surface = body.loadable()->loaded_surface(ids);
  for (const auto &face : surface.faces)
    for (const std::size_t a : face)
      if (a < n_owned)
        nodes.push_back(a);
  for (const LoadedSurface::Share &share : surface.shares)
    nodes.push_back(share.node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void PrescribedMotion::initialize()
{
  const std::vector<std::size_t> nodes = driven_nodes();
  int any = !nodes.empty();
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
  if (any == 0)
    throw InputError(path + "/Faces", "names no face of body \"" + body.name +
                                          "\" that can be moved; planes of "
                                          "symmetry and faces that a zone has "
                                          "taken cannot");
  if (is_rigid)
    body.loadable()->move_rigidly(velocity, angular_velocity, true);
  else
  {
    refuse_contradictions(nodes);
    for (const std::size_t i : nodes)
      for (int d = 0; d < 3; ++d)
        if (is_held[d])
          constraints.prescribe(i, d, velocity[d], Holder::drive);
  }
  constraints.finish();
  const NodalState &state = body.nodes();
  for (const std::size_t i : nodes)
    energy.push_back(0.5 * state.inertia[i] *
                     norm_square(is_rigid ? state.velocity[i] : velocity));
}

void PrescribedMotion::refuse_contradictions(
    const std::vector<std::size_t> &nodes) const
{
  const NodalState &state = body.nodes();
  FirstNode first;
  for (const std::size_t i : nodes)
  {
    bool contradicts = state.is_follower(i);
    if (const VelocityConstraints *const own = body.prescribed())
    {
      const auto [free, value] = own->held_at(i);
      for (int d = 0; d < 3; ++d)
        contradicts =
            contradicts || (is_held[d] && free[d] == 0. &&
                            (velocity[d] != value[d] || value[d] != 0.));
    }
    if (contradicts)
      first.take(state, i);
  }
  if (!first.reduce(communicator))
    return;
  throw InputError(
      path + "/Faces",
      "the node at " + first.place() + " of body \"" + body.name + "\" is " +
          (first.is_tied > 0. ? "moved by the tie that it follows"
                              : "held by a clamped, driven or symmetry face") +
          "; leave the component out of \"Components\" or that "
          "face out of \"Faces\"");
}

void PrescribedMotion::check_beside(const Load &other) const
{
  const auto *const motion = dynamic_cast<const PrescribedMotion *>(&other);
  if (motion == nullptr || &motion->body != &body)
    return;
  if (is_rigid)
    throw InputError(path + "/Body",
                     "\"" + other.name + "\" prescribes the motion of \"" +
                         body.name + "\" already; keep one of the two");
  const NodalState &state = body.nodes();
  FirstNode first;
  for (std::size_t i = 0; i < state.n_owned; ++i)
  {
    const Vec free = constraints.held_at(i).first,
              free_of_other = motion->constraints.held_at(i).first;
    for (int d = 0; d < 3; ++d)
      if (free[d] == 0. && free_of_other[d] == 0.)
        first.take(state, i);
  }
  if (first.reduce(communicator))
    throw InputError(path + "/Faces",
                     "the node at " + first.place() + " of body \"" +
                         body.name + "\" is moved by \"" + other.name +
                         "\", too; leave the component out of the "
                         "\"Components\" of one, or name all faces that move "
                         "alike in one load");
}

void PrescribedMotion::impose_velocities(const double begin, const double end)
{
  const bool is_moment = !(end > begin);
  factor = is_moment ? course->value(end) : course->mean(begin, end);
  if (is_rigid)
    body.loadable()->move_rigidly(factor * velocity, factor * angular_velocity,
                                  !(end > 0.));
  else
    constraints.impose(body.nodes(), factor);
  if (!is_moment)
    return;
  // At the start the scene begins with this velocity.
  if (end > 0. && factor != last_factor)
    for (const double e : energy)
      kinetic_work.add(e * (factor * factor - last_factor * last_factor));
  last_factor = factor;
}

void PrescribedMotion::declare(Parameters &prm)
{
  prm.declare_entry("Body", "", any_text(), "Name of the body.");
  prm.declare_entry("Faces", "", name_list(),
                    "Faces whose nodes are moved, by the names that the body's "
                    "entries for faces take; none: the whole body, as always "
                    "of a rigid one.");
  prm.declare_entry("Velocity", "0 m/s, 0 m/s, 0 m/s",
                    quantities(Dimension::velocity, 3, 3, -1e5, 1e5),
                    "Velocity where the factor of the course is 1; of a rigid "
                    "body that of its center of mass.");
  prm.declare_entry("Components", "x, y, z", name_list(),
                    "Components of the velocity that are prescribed; the "
                    "others are free.");
  prm.declare_entry("Angular velocity", "0 1/s, 0 1/s, 0 1/s",
                    quantities(Dimension::strain_rate, 3, 3, -1e8, 1e8),
                    "Rotation vector per time of a rigid body about its center "
                    "of mass, where the factor is 1.");
  TimeCourse::declare(prm);
}

const Registry<Load>::Add registered(
    {"prescribed motion",
     "a velocity of faces, or of a whole body; the work that it takes is "
     "external.",
     PrescribedMotion::declare, [](const LoadRequest &request) {
       return std::make_unique<PrescribedMotion>(request);
     }});
} // namespace
} // namespace sabot
