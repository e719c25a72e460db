// The coupling "self-contact" of a scene: debris, and surfaces that fold.
#include "sabot/couplings/contact.h"
#include "sabot/couplings/contact_members.h"

namespace sabot
{
namespace
{
void declare(Parameters &prm)
{
  declare_contact(prm);
  prm.declare_knob("Contact distance", "0.9",
                   quantity(Dimension::none, 0.1, 1.),
                   "Distance over spacing below which debris repels, unless "
                   "it was met closer.");
}

class SelfContactBuilder : public CouplingBuilder
{
public:
  int order() const override { return 2; }

  std::vector<std::unique_ptr<Coupling>>
  build(const Parameters &prm, const std::string &path, const std::string &name,
        CouplingContext &context) const override
  {
    SelfContactOptions options;
    std::vector<ContactPair> folding;
    std::vector<int> breaking;
    for (const int a : contact_members(prm, path, context, 1))
      if (context.bodies[a]->particles() != nullptr)
        breaking.push_back(a);
      else if (context.bodies[a]->faces()->deform())
        folding.push_back({a, a, false});
      else
        throw InputError(path + "/Bodies", "\"" + context.bodies[a]->name +
                                               "\" is rigid and cannot touch "
                                               "itself");
    options.parse_parameters(prm, path);
    options.contact_distance = get_quantity(prm, "Contact distance");
    for (const int a : breaking)
      context.bodies[a]->set_internal_friction(
          options.friction->internal_friction());
    // Debris of bodies that meet in a contact meets there.
    std::vector<std::pair<int, int>> pairs;
    for (const auto &pair : pairs_of_members(breaking, true))
      if (context.touching.count(pair) == 0)
        pairs.push_back(pair);
    keep_apart(pairs, path, name, context);
    for (const ContactPair &pair : folding)
      keep_apart({{pair.nodes_of, pair.faces_of}}, path, name, context);
    std::vector<std::unique_ptr<Coupling>> contacts;
    if (!pairs.empty())
      contacts.push_back(std::make_unique<SelfContact>(
          name, context.bodies, pairs, options, context.communicator));
    if (!folding.empty())
      contacts.push_back(std::make_unique<Contact>(
          pairs.empty() ? name : name + " of surfaces", context.bodies, folding,
          of_surfaces(options), context.communicator));
    return contacts;
  }
};

const Registry<CouplingBuilder>::Add registered(
    {"self-contact", "debris of SPG bodies, surfaces of FEM bodies.", declare,
     [] { return std::make_unique<SelfContactBuilder>(); }});
} // namespace
} // namespace sabot
