#ifndef sabot_couplings_self_contact_h
#define sabot_couplings_self_contact_h

#include "sabot/couplings/coupling.h"
#include "sabot/couplings/node_halo.h"

namespace sabot
{
struct SelfContactOptions
{
  double friction = 0.;
  double stiffness_scale = 0.2;    // of E h
  double damping_fraction = 0.1;   // of critical, while approaching
  double contact_distance = 0.9;   // of the spacing
  double stability_fraction = 0.1; // of reduced mass over dt^2
};

/**
 * Contact between particles that both lost a bond and are not bonded to each
 * other: debris, also of different bodies. Repulsive below the distance
 * d0 = min(0.9 h, distance when first met), so that no energy enters when a
 * pair is found close together; Coulomb friction. Pair forces are equal and
 * opposite; each rank computes all pairs of its own particles.
 */
class SelfContact : public Coupling
{
public:
  SelfContact(const std::string &name, const std::vector<Body *> &bodies,
              const SelfContactOptions &options, MPI_Comm communicator);

  std::string kind() const override { return "self-contact"; }
  void initialize() override;
  void update_search(const unsigned int step, const double dt) override;
  void add_forces(const double dt) override;
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  Measures measure() const override;
  void visit_state(StateVisitor &visitor) override;

private:
  struct Pair
  {
    NodeKey first, second; // first < second
    double distance;       // below which they repel [m]
    double stiffness;      // [N/m]
    std::size_t slot[2];
  };
  void search();
  /** Slots of the nodes of all pairs. Collective. */
  void build_halo();

  const std::vector<Body *> bodies;
  const SelfContactOptions options;
  MPI_Comm communicator;
  std::vector<Pair> pairs;                     // sorted by keys
  std::vector<std::pair<int, int>> body_pairs; // that have debris
  NodeHalo halo;
  AlignedVector<Vec> normal_force, friction_force, total_force;
  double skin = 0., travelled = 0.;
  std::size_t n_loose = 0;
  ExactSum contact_work, friction_work;
};
} // namespace sabot

#endif
