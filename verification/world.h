#ifndef verification_world_h
#define verification_world_h

#include "sabot/bodies/fem/fem_body.h"
#include "sabot/bodies/spg/spg_body.h"
#include "sabot/geometry/mesh_generator.h"
#include "sabot/geometry/partition.h"
#include "sabot/integrator/stepper.h"
#include "verification/metals.h"

#include <cmath>
#include <random>

namespace sabot
{
/** Bodies, loads and couplings under the integrator, without a scene file. */
struct World
{
  /** @p most_substeps: that a body may make within one step. */
  explicit World(const unsigned int most_substeps = 1)
      : limits(limits_of(most_substeps))
  {
  }
  static StepLimits limits_of(const unsigned int most_substeps)
  {
    StepLimits limits;
    limits.most_substeps = most_substeps;
    return limits;
  }
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<std::unique_ptr<Load>> loads;
  std::vector<std::unique_ptr<Coupling>> couplings;
  Timers timers;
  const StepLimits limits;
  Stepper stepper{bodies, loads, couplings, limits, timers, MPI_COMM_WORLD};

  void distribute()
  {
    for (auto &body : bodies)
    {
      const auto &points = body->partition_points();
      body->node_owner.clear();
      if (!points.empty()) // those of a body that grows follow its host's
      {
        PointShare share(points.size(), MPI_COMM_WORLD);
        share.add(0, points, 1.f);
        body->node_owner =
            partition(std::move(share), points.size(), MPI_COMM_WORLD);
      }
      body->distribute(body->node_owner, MPI_COMM_WORLD);
    }
    for (auto c = couplings.rbegin(); c != couplings.rend(); ++c)
      (*c)->initialize();
    for (auto &load : loads)
      load->initialize();
  }
  std::vector<Body *> pointers() const
  {
    std::vector<Body *> p;
    for (auto &body : bodies)
      p.push_back(body.get());
    return p;
  }
  /** A load of the kind @p type with these values of its entries, as a scene
      has it. Before distribute(). */
  void add_load(const std::string &type,
                const std::vector<std::pair<std::string, std::string>> &values)
  {
    const auto &entry = Registry<Load>::get("Type", type);
    Parameters prm;
    entry.declare(prm);
    for (const auto &value : values)
      if (!prm.set(value.first, value.second))
        throw InputError(value.first, "cannot be \"" + value.second + "\"");
    for (auto &body : bodies)
      if (!body->find_faces) // by their numbers
        body->find_faces = [](const std::string &, const std::string &text)
        {
          std::vector<unsigned int> ids;
          for (const std::string &id : split_names(text))
            ids.push_back(std::stoul(id));
          return ids;
        };
    const auto body = [this](const std::string &, const std::string &name)
    {
      for (auto &candidate : bodies)
        if (candidate->name == name)
          return candidate.get();
      throw InputError("Body", "no body is called \"" + name + "\"");
    };
    loads.push_back(
        entry.make({prm, type, type, pointers(), body, MPI_COMM_WORLD}));
  }
  /** One step of @p factor times the stable one. @return its size [s]. */
  double advance(const double factor)
  {
    const StepProposal proposal = stepper.propose(false);
    const double dt = factor * proposal.dt;
    stepper.advance(dt, stepper.substeps(proposal, dt));
    stepper.update();
    return stepper.last_step();
  }
  /** Where the energy is, of all ranks [J]. Collective. */
  EnergyLedger ledger() const
  {
    EnergyLedger ledger;
    for (auto &body : bodies)
      body->add_energies(ledger);
    for (auto &load : loads)
      load->add_energies(ledger);
    for (auto &coupling : couplings)
      coupling->add_energies(ledger);
    ledger.reduce(MPI_COMM_WORLD);
    return ledger;
  }
  /** Of the ledger, less the work done from outside [J]. Collective. */
  double total_energy() const { return ledger().total().value(); }
  /** Work of stresses, stabilization and hourglass control [J]. Collective. */
  double internal_energy() const
  {
    const EnergyLedger e = ledger();
    return e.internal.value() + e.stabilization.value() + e.hourglass.value() +
           e.eroded.value();
  }
  /** What contact holds and friction has taken [J]. Collective. */
  double contact_energy() const
  {
    const EnergyLedger e = ledger();
    return e.contact.value() + e.friction.value();
  }
  /** Linear and angular momentum of this rank's nodes (tests on one rank). */
  std::array<double, 6> momenta() const
  {
    std::array<double, 6> sum{};
    for (auto &body : bodies)
    {
      const NodalState &n = body->nodes();
      for (std::size_t i = 0; i < n.n_owned; ++i)
      {
        const Vec p = n.inertia[i] * n.velocity[i], l = cross(n.position[i], p);
        for (int d = 0; d < 3; ++d)
        {
          sum[d] += p[d];
          sum[3 + d] += l[d];
        }
      }
    }
    return sum;
  }
};

inline double measure(const Body &body, const std::string &name)
{
  return body.measure().find(name);
}

/** Random velocities of about @p speed on all owned nodes. */
inline void shake(Body &body, const double speed)
{
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-speed, speed);
  for (Vec &v : body.nodes().velocity)
    v = vec(uniform(generator), uniform(generator), uniform(generator));
}

/** Displace every node of a cloud by a random part of the spacing. */
inline ParticleCloud perturbed_cloud(const std::array<double, 3> &size,
                                     const double h, const double part)
{
  ParticleCloud cloud = make_box_cloud({{0, 0, 0}}, size, h);
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-part * h, part * h);
  for (auto &p : cloud.position)
    for (double &x : p)
      x += uniform(generator);
  return cloud;
}
} // namespace sabot

#endif
