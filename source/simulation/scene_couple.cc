#include "sabot/base/error.h"
#include "sabot/base/parameters.h"
#include "sabot/couplings/contact.h"
#include "sabot/couplings/particle_contact.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/couplings/tie.h"
#include "sabot/simulation/scene.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace sabot
{
namespace
{
bool has_particles(const Body &body)
{
  return body.particles() != nullptr;
}

/** The entries that contact and self-contact share. */
void read_contact_options(const Parameters &prm, const std::string &path,
                          ContactOptions &options)
{
  options.friction = get_quantity(prm, "Friction coefficient");
  options.damping_fraction = get_quantity(prm, "Damping fraction");
  options.stiffness_scale = get_quantity(prm, "Stiffness scale");
  options.dynamic_friction = get_quantity(prm, "Dynamic friction coefficient");
  options.friction_decay = get_quantity(prm, "Friction decay");
  if (options.dynamic_friction > options.friction)
    throw InputError(path + "/Dynamic friction coefficient",
                     "is above the friction coefficient, that of rest");
  if (options.dynamic_friction < 0. && options.friction_decay > 0.)
    throw InputError(path + "/Friction decay",
                     "needs a dynamic friction coefficient");
  options.limit_by_yield = prm.get("Shear strength") == "yield";
  if (!options.limit_by_yield && get_quantity(prm, "Shear strength") > 0.)
    options.shear_limit = get_quantity(prm, "Shear strength");
}

/** The members of a contact or self-contact, in the subsection of @p prm. */
std::vector<std::pair<int, int>> pairs_of(const std::vector<int> &members,
                                          const bool with_themselves)
{
  std::vector<std::pair<int, int>> pairs;
  for (const int a : members)
    for (const int b : members)
      if (a < b || (a == b && with_themselves))
        pairs.emplace_back(a, b);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}
} // namespace

void Scene::build_couplings(const ParameterFile &)
{
  const std::vector<Body *> pointers = body_pointers();
  std::set<std::pair<int, int>> tied;     // follower, leader
  std::set<std::pair<int, int>> touching; // pairs of SPG bodies in a contact
  std::vector<std::unique_ptr<Coupling>> ties;
  const auto build_tie = [&](const std::string &name, const std::string &path)
  {
    const int follower = body_index(path + "/Follower", prm.get("Follower"));
    const int leader = body_index(path + "/Leader", prm.get("Leader"));
    if (follower == leader)
      throw InputError(path + "/Leader", "a body cannot be tied to itself");
    const FaceView *const faces = bodies[leader]->faces();
    if (faces == nullptr || !faces->deform())
      throw InputError(path + "/Leader", "the leader must be a FEM body");
    if (!bodies[follower]->moves_node_by_node())
      throw InputError(path + "/Follower",
                       "a rigid body cannot follow another");
    tied.insert({follower, leader});
    ties.push_back(std::make_unique<Tie>(name, pointers, follower, leader,
                                         get_quantity(prm, "Tolerance"),
                                         communicator));
  };
  const auto members_of = [&](const std::string &path, const std::size_t least)
  {
    std::vector<int> members;
    for (const std::string &member : split_names(prm.get("Bodies")))
      members.push_back(body_index(path + "/Bodies", member));
    if (members.size() < least)
      throw InputError(path + "/Bodies",
                       "a " + prm.get("Type") + " needs " +
                           (least == 2 ? "two bodies" : "one body") +
                           " at least");
    return members;
  };
  const auto build_contact =
      [&](const std::string &name, const std::string &path)
  {
    const std::vector<int> members = members_of(path, 2);
    SelfContactOptions options;
    read_contact_options(prm, path, options);
    std::vector<ContactPair> with_faces;
    for (const int a : members)
      for (const int b : members)
        if (a != b && !has_particles(*bodies[a]))
          with_faces.push_back(
              {a, b, tied.count({a, b}) + tied.count({b, a}) > 0});
    std::vector<std::pair<int, int>> without;
    for (const auto &[a, b] : pairs_of(members, false))
      if (has_particles(*bodies[a]) && has_particles(*bodies[b]) &&
          touching.insert({a, b}).second)
        without.emplace_back(a, b);
    if (with_faces.empty() && without.empty())
      throw InputError(path + "/Bodies",
                       "these bodies meet in other contacts already");
    ContactOptions of_surfaces = options;
    of_surfaces.stability_fraction = ContactOptions().stability_fraction;
    if (!with_faces.empty())
      couplings.push_back(std::make_unique<Contact>(name, pointers, with_faces,
                                                    of_surfaces, communicator));
    if (without.empty())
      return;
    couplings.push_back(std::make_unique<ParticleContact>(
        with_faces.empty() ? name : name + " of particles", pointers, without,
        of_surfaces, communicator));
    // What is loose on both sides has no surface.
    couplings.push_back(std::make_unique<SelfContact>(
        name + " of debris", pointers, without, options, communicator));
  };
  const auto build_self_contact =
      [&](const std::string &name, const std::string &path)
  {
    const std::vector<int> members = members_of(path, 1);
    SelfContactOptions options;
    read_contact_options(prm, path, options);
    options.contact_distance = get_quantity(prm, "Contact distance");
    std::vector<ContactPair> folding;
    std::vector<int> breaking;
    for (const int a : members)
      if (has_particles(*bodies[a]))
        breaking.push_back(a);
      else if (bodies[a]->faces()->deform())
        folding.push_back({a, a, false});
      else
        throw InputError(path + "/Bodies", "\"" + bodies[a]->name +
                                               "\" is rigid and cannot touch "
                                               "itself");
    std::vector<std::pair<int, int>> pairs;
    for (const auto &[a, b] : pairs_of(breaking, true))
      if (touching.count({a, b}) == 0)
        pairs.emplace_back(a, b);
    if (!pairs.empty())
      couplings.push_back(std::make_unique<SelfContact>(name, pointers, pairs,
                                                        options, communicator));
    if (folding.empty())
      return;
    ContactOptions of_surfaces = options;
    of_surfaces.stability_fraction = ContactOptions().stability_fraction;
    couplings.push_back(std::make_unique<Contact>(
        pairs.empty() ? name : name + " of surfaces", pointers, folding,
        of_surfaces, communicator));
  };
  // Contact knows what is tied, self-contact what meets in a contact.
  for (const std::string pass : {"tie", "contact", "self-contact"})
    for (const std::string &name : split_names(prm.get("List of couplings")))
    {
      const std::string path = "Couplings/" + name;
      prm.enter_subsection("Couplings");
      prm.enter_subsection(name);
      if (prm.get("Type") == pass)
      {
        if (pass == "tie")
          build_tie(name, path);
        else if (pass == "contact")
          build_contact(name, path);
        else
          build_self_contact(name, path);
      }
      prm.leave_subsection();
      prm.leave_subsection();
    }
  // Ties hand over all other forces on followers, so they come last.
  for (auto &tie : ties)
    couplings.push_back(std::move(tie));

  for (const CarvedZone &zone : zones)
    if (tied.count({zone.zone, zone.host}) == 0)
      warnings.push_back("body \"" + bodies[zone.zone]->name +
                         "\" is carved from \"" + bodies[zone.host]->name +
                         "\" but not tied to it");
}
} // namespace sabot
