#ifndef sabot_couplings_self_finding_zone_h
#define sabot_couplings_self_finding_zone_h

#include "sabot/base/exact_sum.h"
#include "sabot/bodies/conversion.h"
#include "sabot/couplings/coupling.h"
#include "sabot/couplings/lattice_followers.h"
#include "sabot/couplings/tie.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/** What a scene says about a zone that finds itself. */
struct SelfFindingOptions
{
  int zone = 0, host = 0;     // numbers of the bodies
  unsigned int interval = 10; // steps between looks at the host's cells
  /** Whether a place of the undeformed host is of particles from the start;
      empty: none is. */
  std::function<bool(const std::array<double, 3> &)> is_start;
};

/**
 * Cells of a host turn into particles of a zone while the run goes on. A node
 * that belongs to cells and particles is one node in two bodies: the particle
 * has the node's velocity, the node its force and its mass, so that nothing is
 * tied by a stiffness or by shape functions:
 *
 *   v_p = v_a,  f_a += f_p,  inertia_a = m_a + m_p.
 *
 * Once the node has no cells left the particle moves by its own forces, and the
 * node, without mass, goes along. Mass and both momenta are kept to round-off,
 * as node and particle are at one place with one velocity and share one mass.
 * Nodes and particles that belong together are on one rank: nothing is sent.
 * Particles of split cells within edges and faces are up to LatticeFollowers.
 */
class SelfFindingZone : public Coupling
{
public:
  /** @p others: what ties hold, cells around which stay; may be null. */
  SelfFindingZone(const std::string &name, const std::vector<Body *> &bodies,
                  const SelfFindingOptions &options, MPI_Comm communicator,
                  const std::shared_ptr<TiedNodes> &others);

  /** Places of the undeformed host. */
  using Region = std::function<bool(const std::array<double, 3> &)>;
  /** Cells within that turn after the next step, but those that never do:
      what a run of this scene may come to, for estimates. */
  void turn_next(Region region) { told = std::move(region); }
  std::string kind() const override { return "conversion"; }
  std::vector<int> joins() const override;
  /** Turns the cells of the start. Collective. */
  void initialize() override;
  bool change_bodies(const unsigned int step) override;
  void impose_kinematics() override;
  void add_forces(const double dt) override;
  void forward_changes() override;
  void add_energies(EnergyLedger &ledger) const override;
  Measures measure() const override;
  void visit_state(StateVisitor &visitor) override;

private:
  /** Particle and node of the host, owned and local. */
  struct Shared
  {
    std::size_t particle, node;
  };
  /** Whether the particle's site is a node. */
  bool is_at_node(const std::size_t i) const;
  /** Turn these cells. Collective; @return whether any rank had one. */
  bool convert(const std::vector<std::size_t> &cells, const unsigned int step);
  /** An owned particle and its node. */
  Shared pair_of(const std::size_t i) const;
  /** Pairs of the particles from @p first on. */
  void pair_new(const std::size_t first);
  /** Particles whose nodes lost their last cells move by themselves. */
  void settle_pairs(const NodalMatter &matter);
  /** Particles' forces from and to the nodes that they share or follow. */
  void take_back();
  void hand_on();

  const SelfFindingOptions options;
  Body &zone, &host;
  CellSource &source;
  ParticleSink &sink;
  MPI_Comm communicator;
  const std::shared_ptr<TiedNodes> others;
  std::vector<Shared> shared; // ascending by particle
  std::vector<Shared> alone;  // their nodes follow the particles
  AlignedVector<Vec> handed;  // of each of shared, the force last added [N]
  ExactSum lost, hourglass;   // [J]
  ExactSum converted_mass, converted_energy; // [kg], [J]
  std::vector<char> is_failing;              // of particles, while it looks
  Region told;                               // turns after the next step
  std::unique_ptr<LatticeFollowers> lattice; // null: cells are not split
};
} // namespace sabot

#endif
