#include "sabot/base/error.h"
#include "sabot/base/parameters.h"
#include "sabot/couplings/contact.h"
#include "sabot/couplings/particle_contact.h"
#include "sabot/couplings/self_contact.h"
#include "sabot/couplings/tie.h"
#include "sabot/geometry/partition.h"
#include "sabot/simulation/scene.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace sabot
{
namespace
{
constexpr double seen_from_outside = 1e-9;

/** Bodies overlap when a node of one lies deep inside the other's shape; for
    the boxes and cylinders of a scene their bounding boxes tell enough, but
    for a zone and the body that it was carved from, and for what is tied. */
struct Bounds
{
  double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
};

Bounds bounds_of(const Body &body)
{
  Bounds b;
  for (const auto &p : body.partition_points())
    for (int d = 0; d < 3; ++d)
    {
      b.low[d] = std::min(b.low[d], p[d]);
      b.high[d] = std::max(b.high[d], p[d]);
    }
  return b;
}

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

void Scene::check_overlaps() const
{
  std::set<std::pair<std::string, std::string>> excused;
  for (const auto &body : bodies)
  {
    const std::string from =
        file.value("Bodies/" + body->name + "/Carve from", "");
    excused.insert({body->name, from});
    excused.insert({from, body->name});
  }
  // Boxes around two sides of a curved tie overlap.
  for (const std::string &name : split_names(prm.get("List of couplings")))
  {
    const std::string path = "Couplings/" + name;
    const std::string follower = file.value(path + "/Follower", ""),
                      leader = file.value(path + "/Leader", "");
    const auto is_filled = [&](const std::string &body)
    {
      const std::string entry = "Bodies/" + body + "/Geometry";
      return make_shape(entry, file.value(entry, "box"))->fills_bounds();
    };
    if (file.value(path + "/Type", "") == "tie" &&
        !(is_filled(follower) && is_filled(leader)))
    {
      excused.insert({follower, leader});
      excused.insert({leader, follower});
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
    {
      if (excused.count({bodies[i]->name, bodies[j]->name}) > 0)
        continue;
      const Bounds a = bounds_of(*bodies[i]), b = bounds_of(*bodies[j]);
      double overlap = 1e300, size = 1e300;
      for (int d = 0; d < 3; ++d)
      {
        overlap = std::min(overlap, std::min(a.high[d], b.high[d]) -
                                        std::max(a.low[d], b.low[d]));
        size = std::min({size, a.high[d] - a.low[d], b.high[d] - b.low[d]});
      }
      if (overlap > 1e-6 * size + seen_from_outside)
        throw InputError("Bodies/" + bodies[i]->name + "/Centre",
                         "bodies \"" + bodies[i]->name + "\" and \"" +
                             bodies[j]->name + "\" overlap by " +
                             std::to_string(overlap * 1e3) +
                             " mm; move one of them apart");
    }
}

void Scene::build_couplings()
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

  for (const auto &body : bodies)
  {
    const std::string from =
        file.value("Bodies/" + body->name + "/Carve from", "");
    if (!from.empty() &&
        tied.count({body->id, body_index("Bodies", from)}) == 0)
      warnings.push_back("body \"" + body->name + "\" is carved from \"" +
                         from + "\" but not tied to it");
  }
}

void Scene::build_outputs()
{
  for (const std::string &name : split_names(prm.get("List of outputs")))
  {
    prm.enter_subsection("Outputs");
    prm.enter_subsection(name);
    outputs.push_back({name,
                       prm.get("Type") == "VTU" ? OutputSettings::Type::vtu
                                                : OutputSettings::Type::history,
                       get_quantity(prm, "Interval")});
    prm.leave_subsection();
    prm.leave_subsection();
  }
}

void Scene::build_quantities()
{
  for (const std::string &name : split_names(prm.get("List of quantities")))
  {
    const std::string path = "Quantities/" + name;
    prm.enter_subsection("Quantities");
    prm.enter_subsection(name);
    QuantityOfInterest quantity;
    quantity.name = name;
    const std::string type = prm.get("Type");
    using Type = QuantityOfInterest::Type;
    quantity.type = type == "velocity"            ? Type::velocity
                    : type == "penetration depth" ? Type::penetration_depth
                    : type == "length"            ? Type::length
                                                  : Type::radius;
    quantity.body = body_index(path + "/Body", prm.get("Body"));
    const std::vector<double> d = get_quantities(prm, "Direction");
    const Vec direction = vec(d[0], d[1], d[2]);
    int n_axes = 0;
    for (const double component : d)
      n_axes += component != 0.;
    if (norm(direction) == 0. ||
        (quantity.type != Type::velocity && n_axes != 1))
      throw InputError(path + "/Direction",
                       "give a vector that is not zero and, but for a "
                       "velocity, points along x, y or z");
    quantity.direction = (1. / norm(direction)) * direction;
    quantity.origin = get_quantity(prm, "Origin");
    const std::string planes = file.value(
        "Bodies/" + bodies[quantity.body]->name + "/Symmetry faces", "");
    for (const std::string &plane : split_names(planes))
      for (int d = 0; d < 3; ++d)
        if (plane.size() == 2 && plane[1] == "xyz"[d])
          quantity.whole[d] = 2.;
    quantities.push_back(quantity);
    prm.leave_subsection();
    prm.leave_subsection();
  }
}

void Scene::distribute()
{
  std::vector<std::array<double, 3>> points;
  std::vector<float> weights;
  for (const auto &body : bodies)
  {
    const auto &p = body->partition_points();
    points.insert(points.end(), p.begin(), p.end());
    weights.insert(weights.end(), p.size(), body->partition_weight());
  }
  const std::vector<int> owner = partition(points, weights, communicator);
  std::size_t first = 0;
  for (const auto &body : bodies)
  {
    const std::size_t n = body->partition_points().size();
    body->node_owner.assign(owner.begin() + first, owner.begin() + first + n);
    first += n;
    body->distribute(body->node_owner, communicator);
  }
  // Ties first: contact wants to know who follows whom.
  for (auto coupling = couplings.rbegin(); coupling != couplings.rend();
       ++coupling)
    (*coupling)->initialize();
}
} // namespace sabot
