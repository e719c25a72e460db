// The coupling "contact" of a scene: surfaces by faces, surfaces of particles,
// and debris, as the bodies need them.
#include "sabot/couplings/contact.h"
#include "sabot/couplings/contact_members.h"
#include "sabot/couplings/particle_contact.h"

namespace sabot
{
namespace
{
class ContactBuilder : public CouplingBuilder
{
public:
  int order() const override { return 1; }

  std::vector<std::unique_ptr<Coupling>>
  build(const Parameters &prm, const std::string &path, const std::string &name,
        CouplingContext &context) const override
  {
    const std::vector<int> members = contact_members(prm, path, context, 2);
    keep_apart(pairs_of_members(members, false), path, name, context);
    SelfContactOptions options;
    options.parse_parameters(prm, path);
    const auto has_particles = [&](const int b)
    { return context.bodies[b]->particles() != nullptr; };
    std::vector<ContactPair> with_faces;
    for (const int a : members)
      for (const int b : members)
        if (a != b && !has_particles(a))
          with_faces.push_back(
              {a, b,
               context.tied.count({a, b}) + context.tied.count({b, a}) > 0});
    std::vector<std::pair<int, int>> without;
    for (const auto &[a, b] : pairs_of_members(members, false))
      if (has_particles(a) && has_particles(b) &&
          context.touching.insert({a, b}).second)
        without.emplace_back(a, b);
    std::vector<std::unique_ptr<Coupling>> contacts;
    if (!with_faces.empty())
      contacts.push_back(std::make_unique<Contact>(
          name, context.bodies, with_faces, of_surfaces(options),
          context.communicator));
    if (without.empty())
      return contacts;
    contacts.push_back(std::make_unique<ParticleContact>(
        with_faces.empty() ? name : name + " of particles", context.bodies,
        without, of_surfaces(options), context.communicator));
    // What is loose on both sides has no surface.
    contacts.push_back(
        std::make_unique<SelfContact>(name + " of debris", context.bodies,
                                      without, options, context.communicator));
    return contacts;
  }
};

const Registry<CouplingBuilder>::Add registered(
    {"contact",
     "nodes against the faces of FEM bodies and the surfaces of particles, "
     "with friction.",
     declare_contact, [] { return std::make_unique<ContactBuilder>(); }});
} // namespace
} // namespace sabot
