#ifndef sabot_couplings_self_contact_h
#define sabot_couplings_self_contact_h

#include "sabot/couplings/contact_options.h"
#include "sabot/couplings/contact_points.h"
#include "sabot/couplings/coupling.h"
#include "sabot/couplings/debris.h"
#include "sabot/couplings/halo_forces.h"
#include "sabot/couplings/search_age.h"

namespace sabot
{
/** Contact of single particles. The stability fraction bounds the stiffness of
    all partners together, so it may be larger than that of one spring. */
struct SelfContactOptions : ContactOptions
{
  SelfContactOptions() { stability_fraction = 0.4; }
  /** d0 over the spacing: below it debris repels. */
  double contact_distance = 0.9;
};

/**
 * Contact between particles that both lost a bond and are not bonded to each
 * other: debris, also of different bodies. Repulsive below the distance
 * d0 = min(0.9 h, distance when first met), so that no energy enters when a
 * pair is found close together; Coulomb friction. Pair forces are equal and
 * opposite; each rank computes all pairs of its own particles.
 *
 * k = K h: a column of particles of cross-section h^2 that touch answers a
 * strain e, a change of distance by h e, with K h^2 e, as the material does
 * without room to the sides. The stiffness S_a = sum k of all pairs that touch
 * particle a moves it with a frequency below (2 S_a/m_a)^(1/2) (Gershgorin),
 * so k is scaled down to keep 2 S_a dt^2/m_a below the stability fraction.
 *
 * Crumbled particles of one continuum that lie on two planes of symmetry do not
 * repel each other: in the whole such a file of pieces buckles.
 * Where planes of symmetry cut the model, debris also meets the mirror images
 * of all debris in them, its own included. Of a pair (a, image of b) the force
 * on b is the image of that on the image, which (b, image of a) gives as well:
 * such pairs are counted once. What lies on a plane is its own image, and so is
 * its pair with anything else.
 */
class SelfContact : public Coupling
{
public:
  /** @p bodies: all of the scene, by number; @p pairs: of bodies of particles
      that may meet; (a, a): parts of one body. */
  SelfContact(const std::string &name, const std::vector<Body *> &bodies,
              const std::vector<std::pair<int, int>> &pairs,
              const SelfContactOptions &options, MPI_Comm communicator);

  /** "self-contact", or "contact" where no body meets itself. */
  std::string kind() const override;
  std::vector<std::pair<int, int>> holds_apart() const override
  {
    return body_pairs;
  }
  void initialize() override;
  void update_search(const unsigned int step, const double dt) override;
  void add_forces(const double dt) override;
  void keep_stiffness(const double last_step) override
  {
    kept_step = last_step;
  }
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  std::size_t n_items() const override { return halo.n_owned(); }
  Measures measure() const override;
  std::vector<Resultant> resultants() const override
  {
    return forces.resultants(name, body_pairs, halo, communicator,
                             images.any());
  }
  void visit_state(StateVisitor &visitor) override;

private:
  /** Part of checkpoints, so plain numbers; slots follow from the keys. */
  struct Pair
  {
    NodeKey first, second;   // first < second; equal: with its own image
    std::uint64_t image;     // of the second, see DebrisImages
    double distance;         // below which they repel [m]
    double largest_distance; // that it may be [m]
    double stiffness;        // [N/m]
    double area;             // that a pair stands for, h^2 [m^2]
    double largest_friction; // that the metals bear [N]
    std::size_t slot[2];
  };
  /** By keys. */
  static bool comes_before(const Pair &p, const Pair &q);
  /** Pairs, halo and, where friction is held below yield, what the metals
      bear. Collective. */
  void search();
  /** New pairs, which remember the distance at which they were first met.
      Collective. */
  void find_pairs();
  /** @p reach: largest distance of repulsion over the spacing. */
  Pair make_pair(const NodeKey &a, const NodeKey &b, const std::uint64_t image,
                 const double distance, const double reach,
                 const DebrisView &of_a, const DebrisView &of_b) const;
  /** Slots of the nodes of all pairs. Collective. */
  void build_halo();
  /** Find the pairs that touch, and scale the stiffness of all that touches a
      particle below its bound. Collective. */
  void soften(const double dt);
  /** Forces on the second particle, the opposite on the first. */
  void push(const ContactPoint &on_second);

  const std::vector<Body *> bodies;
  const std::vector<std::pair<int, int>> body_pairs;
  const SelfContactOptions options;
  MPI_Comm communicator;
  const DebrisImages images;
  std::vector<Pair> pairs; // sorted by keys
  NodeHalo halo;
  /** SearchAge::traveled up to which a pair stays apart [m]; no state, for what
      is apart does nothing. */
  std::vector<double> wake;
  std::vector<std::size_t> touching; // pairs, ascending
  std::vector<double> softening;     // per slot, of the stiffness
  HaloForces forces;
  ContactPoints points; // of the step
  double skin = 0.;
  SearchAge age;
  std::size_t n_loose = 0;
  double kept_step = 0.; // that bounds stiffnesses, too, in the next step [s]
};
} // namespace sabot

#endif
