#include "sabot/base/error.h"
#include "sabot/base/quantity.h"
#include "sabot/bodies/fem/fem_body.h"
#include "sabot/bodies/rigid/rigid_body.h"
#include "sabot/couplings/contact.h"
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
    for a zone and the body that it was carved from. */
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
} // namespace

void Scene::check_overlaps() const
{
  std::set<std::pair<std::string, std::string>> carved;
  for (const auto &body : bodies)
  {
    const std::string from =
        file.value("Bodies/" + body->name + "/Carve from", "");
    carved.insert({body->name, from});
    carved.insert({from, body->name});
  }
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
    {
      if (carved.count({bodies[i]->name, bodies[j]->name}) > 0)
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
  std::set<std::pair<int, int>> tied;
  std::vector<std::unique_ptr<Coupling>> ties;
  const std::vector<std::string> names =
      split_names(prm.get("List of couplings"));
  for (const bool ties_now : {true, false})
    for (const std::string &name : names)
    {
      const std::string path = "Couplings/" + name;
      prm.enter_subsection("Couplings");
      prm.enter_subsection(name);
      const std::string type = prm.get("Type");
      if (type == "tie" && ties_now)
      {
        const int follower =
            body_index(path + "/Follower", prm.get("Follower"));
        const int leader = body_index(path + "/Leader", prm.get("Leader"));
        if (follower == leader)
          throw InputError(path + "/Leader", "a body cannot be tied to itself");
        if (dynamic_cast<FemBody *>(bodies[leader].get()) == nullptr)
          throw InputError(path + "/Leader", "the leader must be a FEM body");
        if (dynamic_cast<RigidBody *>(bodies[follower].get()) != nullptr)
          throw InputError(path + "/Follower",
                           "a rigid body cannot follow another");
        tied.insert({follower, leader});
        ties.push_back(std::make_unique<Tie>(name, pointers, follower, leader,
                                             get_quantity(prm, "Tolerance"),
                                             communicator));
      }
      else if (type != "tie" && !ties_now)
      {
        std::vector<int> members;
        for (const std::string &member : split_names(prm.get("Bodies")))
          members.push_back(body_index(path + "/Bodies", member));
        const std::size_t least = type == "contact" ? 2 : 1;
        if (members.size() < least)
          throw InputError(path + "/Bodies",
                           "a " + type + " needs " +
                               (least == 2 ? "two bodies" : "one body") +
                               " at least");
        if (type == "contact")
        {
          ContactOptions options;
          options.friction = get_quantity(prm, "Friction coefficient");
          options.damping_fraction = get_quantity(prm, "Damping fraction");
          options.stiffness_scale = get_quantity(prm, "Stiffness scale");
          options.dynamic_friction =
              get_quantity(prm, "Dynamic friction coefficient");
          options.friction_decay = get_quantity(prm, "Friction decay");
          if (options.dynamic_friction > options.friction)
            throw InputError(path + "/Dynamic friction coefficient",
                             "is above the friction coefficient, that of rest");
          if (options.dynamic_friction < 0. && options.friction_decay > 0.)
            throw InputError(path + "/Friction decay",
                             "needs a dynamic friction coefficient");
          if (get_quantity(prm, "Shear strength") > 0.)
            options.shear_limit = get_quantity(prm, "Shear strength");
          std::vector<ContactPair> pairs;
          for (const int a : members)
            for (const int b : members)
              if (a != b && bodies[a]->item_name() == "cells")
                pairs.push_back(
                    {a, b, tied.count({a, b}) + tied.count({b, a}) > 0});
          if (pairs.empty())
            throw InputError(path + "/Bodies",
                             "contact needs the faces of a FEM body; between "
                             "particles use a self-contact");
          couplings.push_back(std::make_unique<Contact>(name, pointers, pairs,
                                                        options, communicator));
        }
        else
        {
          SelfContactOptions options;
          options.friction = get_quantity(prm, "Friction coefficient");
          options.damping_fraction = get_quantity(prm, "Damping fraction");
          options.stiffness_scale = get_quantity(prm, "Stiffness scale");
          options.contact_distance = get_quantity(prm, "Contact distance");
          for (const int a : members)
            if (bodies[a]->item_name() != "particles")
              throw InputError(path + "/Bodies",
                               "self-contact is between particles; \"" +
                                   bodies[a]->name + "\" is a FEM body");
          couplings.push_back(std::make_unique<SelfContact>(
              name, pointers, options, communicator));
        }
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
