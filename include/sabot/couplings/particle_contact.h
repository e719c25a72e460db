#ifndef sabot_couplings_particle_contact_h
#define sabot_couplings_particle_contact_h

#include "sabot/couplings/contact_options.h"
#include "sabot/couplings/contact_points.h"
#include "sabot/couplings/coupling.h"
#include "sabot/couplings/halo_forces.h"
#include "sabot/couplings/mirror_images.h"
#include "sabot/couplings/particle_search.h"
#include "sabot/couplings/particle_standing.h"
#include "sabot/couplings/search_age.h"
#include "sabot/couplings/shared_work.h"

namespace sabot
{
/**
 * Penalty contact with friction between bodies without faces. A node
 * that lies open (on the surface of its body, or loose) meets what
 * stand_on_surface() makes of the sound surface of another body; where there is
 * none, and for a loose node, what stand_in_volume() makes of all of its
 * particles. The force on the node is that of the contact with faces; the
 * particles that it presses on take its opposite in parts. Two particles that
 * are both loose and alone are not met here but by a SelfContact.
 */
class ParticleContact : public Coupling
{
public:
  /** @p bodies: all of the scene, by number; @p pairs: of bodies of particles,
      each once; both sides' nodes are held. */
  ParticleContact(const std::string &name, const std::vector<Body *> &bodies,
                  const std::vector<std::pair<int, int>> &pairs,
                  const ContactOptions &options, MPI_Comm communicator);

  std::string kind() const override { return "contact"; }
  std::vector<std::pair<int, int>> holds_apart() const override
  {
    return pairs;
  }
  double stability_fraction() const override
  {
    return options.stability_fraction;
  }
  void initialize() override;
  void update_search(const unsigned int step, const double dt) override;
  void add_forces(const double dt) override;
  void keep_stiffness(const double) override { points.steady_step.keep(); }
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  std::size_t n_items() const override { return groups.size(); }
  Measures measure() const override;
  std::vector<Resultant> resultants() const override
  {
    return forces.resultants(name, pairs, halo, communicator);
  }
  void visit_state(StateVisitor &visitor) override;

private:
  /** A node and the particles of one other body that it may touch. Part of
      checkpoints, and sent between ranks, so plain numbers; n_members of the
      list of members belong to it. */
  struct Group
  {
    NodeKey node;
    std::int32_t other, is_sound;
    std::int64_t n_members;
    double stiffness, spacing, its_spacing;
    double area; // over which friction may act [m^2]
    ContactMemory memory;

    bool operator<(const Group &o) const
    {
      return node == o.node ? other < o.other : node < o.node;
    }
  };
  /** What the groups' numbers stand for on this rank: slots of the halo. */
  struct Slots
  {
    std::size_t node, first_member, last_member; // of member_slots
  };
  /** New groups, which inherit their memories. Bodies whose boxes are apart are
      not searched until they may have met. Collective. */
  void search();
  /** @p mine, @p its: surfaces of the two bodies. */
  Group make_group(const SearchedParticle &node, const int other,
                   const std::int64_t n_members, const ContactSurface &mine,
                   const ContactSurface &its) const;
  /** Each group to the owners of all that it touches. Collective. */
  void tell_owners(const std::vector<Group> &my_groups,
                   const std::vector<Member> &my_members);
  /** Of all ranks' groups those that touch nodes owned here, in one order. */
  void keep_relevant(const std::vector<Group> &all,
                     const std::vector<Member> &all_members);
  /** Halo and slots of the groups. Collective. */
  void build_halo();
  /** Of the slots of the present halo. Collective. */
  void find_shares();
  /** Friction that the node and what it touches bear [N]. */
  double largest_friction(const Group &group, const Slots &at) const;
  /** Motion of all slots, and what surface and volume they are part of now.
      Collective. */
  void update_halo();
  /** The group's particles, and their images in planes of symmetry, each as
      often as the whole has it; @p x: where the node is [m]. */
  void gather_near(const Group &group, const Slots &at, const Vec x);
  /** Where the node stands: against the sound surface, if it is on the surface
      of its own body and there is one, else against the volume. Weights go to
      near[]. */
  Standing locate(const Group &group, const Slots &slots);
  /** Adds a contact point where the other body holds the node of group
      @p number. At the start (@p dt = 0) bodies may touch already. */
  void press(const std::size_t number, const double dt);
  /** Against what is near, as one: sets its velocity [m/s] and reduced mass
      [kg]. */
  void find_motion(const Slots &at, ContactPoint &point) const;
  /** Forces on the node; opposite, in parts, on what it presses on. */
  void push(const ContactPoint &point);

  const std::vector<Body *> bodies;
  const std::vector<std::pair<int, int>> pairs;
  const ContactOptions options;
  MPI_Comm communicator;
  std::vector<Group> groups;   // sorted
  std::vector<Member> members; // of the groups, one after the other
  std::vector<Slots> slots;    // parallel to groups
  std::vector<std::size_t> member_slots;
  std::vector<NearParticle> near; // of the group at hand
  ContactPoints points;           // of the step
  SharedWork shared_work;
  std::vector<NearParticle> touched;   // by the points, one after the other
  std::vector<char> is_on_surface;     // per slot
  AlignedVector<SurfacePoint> surface; // per slot
  AlignedVector<VolumePoint> volume;   // per slot, contents of the whole
  std::vector<double> share;           // per slot, ContactSurface::node_share
  std::vector<std::vector<SymmetryPlane>> symmetry_planes; // of bodies
  MirrorImages images;
  std::vector<double> flow_stress; // per slot, at the last search; may be empty
  NodeHalo halo;
  HaloForces forces;
  struct Ways
  {
    double skin = 0.;      // [m], by which candidates may approach
    double allowance = 0.; // [m], of travel until the next search
  } way;
  SearchAge age;
  struct Depth
  {
    double initial = 0., largest = 0.;
  } over_spacing;
  std::size_t n_deep = 0; // nodes so far inside that nothing holds them
};
} // namespace sabot

#endif
