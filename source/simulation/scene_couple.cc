// The couplings of a scene, in the order in which they are built and act.
#include "sabot/couplings/coupling_builder.h"
#include "sabot/simulation/scene.h"

#include <algorithm>

namespace sabot
{
void Scene::build_couplings()
{
  struct Listed
  {
    std::string name;
    std::unique_ptr<CouplingBuilder> builder;
  };
  std::vector<Listed> listed;
  for (const std::string &name : names_of("List of couplings"))
  {
    const Entered entered(prm, "Couplings", name);
    const std::string type = prm.get("Type");
    listed.push_back({name, Registry<CouplingBuilder>::get(
                                "Couplings/" + name + "/Type", type)
                                .make()});
  }
  std::stable_sort(listed.begin(), listed.end(),
                   [](const Listed &a, const Listed &b)
                   { return a.builder->order() < b.builder->order(); });

  CouplingContext context{
      body_pointers(),
      [this](const std::string &path, const std::string &name)
      { return body_index(path, name); },
      communicator,
      {},
      {}};
  std::vector<std::unique_ptr<Coupling>> last;
  for (const Listed &item : listed)
  {
    const Entered entered(prm, "Couplings", item.name);
    auto &list = item.builder->acts_last() ? last : couplings;
    for (auto &coupling :
         item.builder->build(prm, "Couplings/" + item.name, item.name, context))
      list.push_back(std::move(coupling));
  }
  std::move(last.begin(), last.end(), std::back_inserter(couplings));

  for (const CarvedZone &zone : zones)
    if (context.tied.count({zone.zone, zone.host}) == 0)
      warnings.push_back("body \"" + bodies[zone.zone]->name +
                         "\" is carved from \"" + bodies[zone.host]->name +
                         "\" but not tied to it");
}
} // namespace sabot
