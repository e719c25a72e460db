#ifndef sabot_couplings_particle_contact_h
#define sabot_couplings_particle_contact_h

#include "sabot/couplings/contact_law.h"
#include "sabot/couplings/coupling.h"
#include "sabot/couplings/halo_forces.h"

namespace sabot
{
/**
 * Penalty contact with Coulomb friction between bodies without faces. A node
 * that lies open (on the surface of its body, or loose) meets the surface that
 * the sound surface particles j of another body span: with d = x - x_j, the
 * normals n_j of the two sides' mean, and weights w_j = phi(|d_t|/R)/W of the
 * tangential distance d_t, R = 1.5 spacings,
 *
 *   gap = sum w_j d . n_j,  W = sum phi,
 *
 * exact for planes wherever the node stands, so that a lattice that slides on
 * another feels no bumps. The force on the node is that of the contact with
 * faces; the particles j take its opposite in parts w_j. It fades where the
 * surface ends: W falls to half of its mean over a plane half a spacing beyond
 * the rim. Two loose particles are not met here but by a SelfContact.
 */
class ParticleContact : public Coupling
{
public:
  /** @p pairs: of bodies, as indices. */
  ParticleContact(const std::string &name, const std::vector<Body *> &bodies,
                  const std::vector<std::pair<int, int>> &pairs,
                  const ContactOptions &options, MPI_Comm communicator);

  std::string kind() const override { return "contact"; }
  void initialize() override;
  void update_search(const unsigned int step, const double dt) override;
  void add_forces(const double dt) override;
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  Measures measure() const override;
  void visit_state(StateVisitor &visitor) override;

private:
  /** A node and the particles of one other body that it may touch. */
  struct Group
  {
    NodeKey node;
    std::int32_t other, is_sound;
    std::int64_t n_members;
    double stiffness, spacing;
    double area; // over which friction may act [m^2]
    ContactMemory memory;

    bool operator<(const Group &o) const
    {
      return node == o.node ? other < o.other : node < o.node;
    }
  };
  /** What the groups' numbers stand for on this rank. */
  struct Slots
  {
    std::size_t node, first_member, last_member; // of member_slots
  };
  /** Where a node stands against the surface of its group. */
  struct Standing
  {
    double gap = 1e300, fade = 0.;
    Vec normal = {};
  };
  void search();
  /** Halo and slots of the groups. Collective. */
  void build_halo();
  /** Friction that the node and what it touches bear [N]. */
  double largest_friction(const Group &group, const Slots &at) const;
  void update_halo();
  /** Weights go to weight[]; fade 0: beyond the surface. */
  Standing locate(const Group &group, const Slots &slots);
  /** Make weight[] sum to 1 and, as far as it can, to the node's place in the
      plane with normal @p n, so that forces have the right moment. */
  void balance_weights(const Slots &slots, const Vec n);

  const std::vector<Body *> bodies;
  const std::vector<std::pair<int, int>> pairs;
  const ContactOptions options;
  MPI_Comm communicator;
  std::vector<Group> groups;    // sorted
  std::vector<NodeKey> members; // of the groups, one after the other
  std::vector<Slots> slots;     // parallel to groups
  std::vector<std::size_t> member_slots;
  std::vector<double> weight, along_normal; // of the members of one group
  AlignedVector<SurfacePoint> surface;      // per slot
  std::vector<double> flow_stress; // per slot, at the last search; may be empty
  NodeHalo halo;
  HaloForces forces;
  double skin = 0.;      // [m], by which candidates may approach
  double allowance = 0.; // [m], of travel until the next search
  double travelled = 0.; // [m]
  double initial_over_spacing = 0., penetration_over_spacing = 0.;
};
} // namespace sabot

#endif
