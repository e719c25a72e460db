// A scene from its file: loops over what its lists name.
#include "sabot/simulation/scene.h"

#include "sabot/base/error_report.h"
#include "sabot/couplings/closing_limit.h"
#include "sabot/couplings/coupling_builder.h"
#include "sabot/couplings/symmetry_walls.h"
#include "sabot/geometry/partition.h"
#include "sabot/simulation/accuracy.h"
#include "sabot/simulation/body_assembly.h"
#include "sabot/simulation/scene_checks.h"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace sabot
{
Scene::Scene(const ParameterFile &file, MPI_Comm communicator)
    : communicator(communicator)
{
  if (file.is_set("Scene") && !file.is_set("List of bodies"))
    throw InputError("Scene", "this is a study, which varies a scene; run it "
                              "by \"sabot study\", or run the scene itself");
  declare(prm, &file);
  file.parse_into(prm, [](Parameters &all) { declare(all, nullptr); });
  check_names(prm);
  Accuracy::scale_spacings(prm, names_of("bodies"));
  read_settings();
  build_materials(file);
  BodyAssembly assembly(prm, file, materials);
  assembly.build(names_of("bodies"));
  bodies = std::move(assembly.bodies);
  zones = std::move(assembly.zones);
  growing = std::move(assembly.growing);
  notes = file.notes();
  notes.insert(notes.end(), assembly.notes.begin(), assembly.notes.end());
  warnings.insert(warnings.end(), assembly.warnings.begin(),
                  assembly.warnings.end());
  for (const auto &body : bodies)
    is_free = is_free && !body->is_held();
  const std::vector<Outline> outlines = take_outlines(*this);
  check_overlaps(*this, outlines);
  build_loads();
  check_step_is_bounded();
  const auto tied = build_couplings();
  warn_of_doubts(file, outlines, tied, *this);
  build_outputs();
  build_quantities();
}

void Scene::check_step_is_bounded() const
{
  const bool deforms =
      std::any_of(bodies.begin(), bodies.end(),
                  [](const auto &body) { return body->moves_node_by_node(); });
  if (!deforms && !loads.empty() && settings.largest_step > settings.end_time)
    throw InputError("Largest step",
                     "is needed where all bodies are rigid and loads act, for "
                     "nothing else bounds the step; give what resolves the "
                     "course of the loads and the way between contacts, for "
                     "example a thousandth of the end time");
}

std::vector<std::string> Scene::names_of(const std::string &list) const
{
  return split_names(prm.get("List of " + list));
}

void Scene::read_settings()
{
  settings.title = prm.get("Title");
  settings.accuracy = prm.get(Accuracy::entry);
  settings.end_time = get_quantity(prm, "End time");
  settings.step_factor = get_quantity(prm, "Step factor");
  if (settings.step_factor > 1.)
    warnings.push_back("the step factor " + prm.get("Step factor") +
                       " is above 1: steps are longer than what is known to "
                       "be stable; where a mesh does not bear them, its energy "
                       "grows until the balance stops the run, which may take "
                       "longer than the run does; compare with 0.9");
  settings.largest_step = get_quantity(prm, "Largest step");
  settings.most_substeps = prm.get_integer("Largest number of substeps");
  settings.energy_limit = get_quantity(prm, "Energy residual limit");
  settings.checkpoint_interval = get_quantity(prm, "Checkpoint interval");
  settings.checkpoint_steps = prm.get_integer("Checkpoint interval in steps");
  settings.checkpoint_wall_time =
      get_quantity(prm, "Checkpoint interval of wall time");
  settings.ranks_per_checkpoint_file =
      prm.get_integer("Ranks per checkpoint file");
  settings.checkpoint_at_end = prm.get_bool("Checkpoint at the end");
  if (names_of("bodies").empty())
    throw InputError("List of bodies",
                     "the scene has no bodies; list their names");
}

void Scene::build_materials(const ParameterFile &file)
{
  for (const std::string &name : file.subsections("Materials"))
  {
    const EnteredSubsection entered(prm, "Materials", name);
    auto material = Material::make(prm, "Materials/" + name);
    material->name = name;
    for (const std::string &warning : material->warnings)
    {
      const std::string path = warning.substr(0, warning.find(": "));
      warnings.push_back(file.origin(path) + ": " + warning);
    }
    materials[name] = std::move(material);
  }
}

void Scene::build_loads()
{
  for (const std::string &name : names_of("loads"))
  {
    const EnteredSubsection entered(prm, "Loads", name);
    const std::string path = "Loads/" + name;
    const auto body = [&](const std::string &entry, const std::string &value)
    { return bodies[body_index(path + "/" + entry, value)].get(); };
    loads.push_back(Registry<Load>::get(path + "/Type", prm.get("Type"))
                        .make({prm, path, name, body_pointers(), body,
                               communicator, settings.end_time}));
    is_free = false;
  }
}

std::set<std::pair<int, int>> Scene::build_couplings()
{
  struct Listed
  {
    std::string name;
    std::unique_ptr<CouplingBuilder> builder;
  };
  std::vector<Listed> listed; // in the order of building
  for (const std::string &name : names_of("couplings"))
  {
    const EnteredSubsection entered(prm, "Couplings", name);
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
      {},
      {},
      {}};
  std::vector<std::unique_ptr<Coupling>> last;
  for (const GrowingZone &zone : growing)
    context.tied.insert({zone.zone, zone.host});
  for (const Listed &item : listed)
  {
    const EnteredSubsection entered(prm, "Couplings", item.name);
    auto &list = item.builder->acts_last() ? last : couplings;
    for (auto &coupling :
         item.builder->build(prm, "Couplings/" + item.name, item.name, context))
      list.push_back(std::move(coupling));
  }
  for (GrowingZone &zone : growing)
    last.insert(last.begin(), make_self_finding_zone(zone, context));
  auto planes = std::make_unique<SymmetryWalls>(body_pointers(), communicator);
  if (planes->any())
    couplings.push_back(std::move(planes));
  auto closing =
      std::make_unique<ClosingLimit>(body_pointers(), couplings, communicator);
  if (closing->any())
    couplings.push_back(std::move(closing));
  std::move(last.begin(), last.end(), std::back_inserter(couplings));

  std::set<std::string> names;
  for (const auto &coupling : couplings)
    if (!names.insert(coupling->name).second)
      throw InputError("List of couplings",
                       "\"" + coupling->name +
                           "\" is also what a part of "
                           "another coupling is called in the results; rename "
                           "it");
  refuse_lone_hosts(*this);
  warn_of_lone_debris();
  for (const CarvedZone &zone : zones)
    if (context.tied.count({zone.zone, zone.host}) == 0)
      warnings.push_back("body \"" + bodies[zone.zone]->name +
                         "\" is carved from \"" + bodies[zone.host]->name +
                         "\" but not tied to it");
  return context.tied;
}

void Scene::warn_of_lone_debris()
{
  for (const auto &body : bodies)
  {
    if (body->fragments() == nullptr || !body->facts().may_fail)
      continue;
    bool meets_itself = false;
    for (const auto &coupling : couplings)
      for (const auto &[a, b] : coupling->holds_apart())
        meets_itself = meets_itself || (a == body->id && b == body->id);
    if (!meets_itself)
      warnings.push_back("body \"" + body->name +
                         "\" can fail but is in no self-contact: its pieces "
                         "pass through each other, and bear no friction");
  }
}

void Scene::build_outputs()
{
  for (const std::string &name : names_of("outputs"))
  {
    const EnteredSubsection entered(prm, "Outputs", name);
    outputs.push_back(SceneOutput::make(prm, "Outputs/" + name));
    std::vector<const Body *> all;
    for (const auto &body : bodies)
      all.push_back(body.get());
    outputs.back()->choose(name, all);
  }
}

void Scene::build_quantities()
{
  std::vector<std::string> tables = {"ledger", "forces", "impulses"};
  for (const auto &body : bodies)
    tables.push_back(body->name);
  for (const auto &output : outputs)
    if (!output->table().empty())
      tables.push_back(output->table());
  for (const std::string &name : names_of("quantities"))
  {
    const EnteredSubsection entered(prm, "Quantities", name);
    const std::string path = "Quantities/" + name;
    const auto body = [&](const std::string &entry) -> const Body &
    { return *bodies[body_index(path + "/" + entry, prm.get(entry))]; };
    quantities.push_back(
        Registry<QuantityOfInterest>::get(path + "/Type", prm.get("Type"))
            .make({prm, path, name, body, communicator, tables}));
    quantities.back()->name = name;
  }
}

int Scene::body_index(const std::string &path,
                      const std::string &body_name) const
{
  std::vector<std::string> names;
  for (const auto &body : bodies)
  {
    if (body->name == body_name)
      return body->id;
    names.push_back(body->name);
  }
  throw_unknown_name(path, "body", body_name, names);
}

std::vector<Body *> Scene::body_pointers() const
{
  std::vector<Body *> pointers;
  for (const auto &body : bodies)
    pointers.push_back(body.get());
  return pointers;
}

std::string Scene::expanded_parameters() const
{
  std::ostringstream text;
  print_expanded(prm, text);
  return text.str();
}

std::vector<std::pair<std::string, std::string>> Scene::knobs() const
{
  // Subsections that no list names are read, but not in force.
  std::vector<std::pair<std::string, std::string>> in_force;
  for (const auto &knob : prm.knobs())
  {
    const std::size_t slash = knob.first.find('/');
    bool is_listed = slash == std::string::npos;
    for (const std::string list : {"bodies", "couplings"})
      for (const std::string &name : names_of(list))
        is_listed = is_listed || knob.first.compare(slash + 1, name.size() + 1,
                                                    name + "/") == 0;
    if (is_listed)
      in_force.push_back(knob);
  }
  return in_force;
}

void Scene::find_owners()
{
  std::size_t n = 0;
  for (const auto &body : bodies)
    n += body->partition_points().size();
  PointShare share(n, communicator);
  std::size_t first = 0;
  for (const auto &body : bodies)
  {
    share.add(first, body->partition_points(), body->partition_weight());
    first += body->partition_points().size();
  }
  const std::vector<int> owner = partition(std::move(share), n, communicator);
  auto next = owner.begin();
  for (const auto &body : bodies)
  {
    const auto begin = next;
    next += body->partition_points().size();
    body->node_owner.assign(begin, next);
  }
}

void Scene::distribute()
{
  find_owners();
  for (const auto &body : bodies)
    within_memory("\"Bodies/" + body->name + "\" (" +
                      std::to_string(body->n_items()) + " " +
                      body->item_name() + ")",
                  [&]() { body->distribute(body->node_owner, communicator); });
  // Ties first: contact and loads want to know who follows whom.
  for (auto coupling = couplings.rbegin(); coupling != couplings.rend();
       ++coupling)
  {
    (*coupling)->initialize();
    const std::vector<std::string> odd = (*coupling)->warnings();
    warnings.insert(warnings.end(), odd.begin(), odd.end());
  }
  for (const auto &load : loads)
    load->initialize();
  for (std::size_t i = 0; i < loads.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      loads[i]->check_beside(*loads[j]);
  for (const auto &quantity : quantities)
    quantity->check([this](const std::string &table)
                    { return columns_of(table); });
}

std::vector<std::string> Scene::columns_of(const std::string &table) const
{
  for (const auto &output : outputs)
    if (output->table() == table)
      return output->columns();
  Measures row = {{"time", "s", 0.}};
  for (const auto &body : bodies)
    if (body->name == table)
    {
      const Measures own = body->measure().columns();
      row.insert(row.end(), own.begin(), own.end());
    }
  if (table == "ledger")
  {
    row.push_back({"step size", "s", 0.});
    for (const EnergyTerm &term : energy_terms)
      row.push_back({term.name, "J", 0.});
    row.push_back({"total", "J", 0.});
    row.push_back({"residual", "1", 0.});
  }
  if (table == "forces" || table == "impulses")
    for (const Resultant &r : resultants())
      for (const char axis : {'x', 'y', 'z'})
        row.push_back(
            {column_of(r, axis), table == "forces" ? "N" : "N s", 0.});
  std::vector<std::string> columns;
  for (const Measure &m : row)
    columns.push_back(m.name + " [" + m.unit + "]");
  return columns;
}

std::vector<Resultant> Scene::reactions(const Body &body) const
{
  std::vector<Resultant> all = body.reactions();
  if (const VelocityConstraints *const held = body.prescribed())
    for (const Resultant &r :
         held->reactions(body.nodes(), body.id, communicator))
    {
      // What planes hold, and what images beyond them do, is one thing.
      const auto same = std::find_if(all.begin(), all.end(),
                                     [&](const Resultant &other)
                                     { return other.source == r.source; });
      if (same == all.end())
        all.push_back(r);
      else
        for (int d = 0; d < 3; ++d)
        {
          same->force[d] += r.force[d];
          same->impulse[d] += r.impulse[d];
        }
    }
  return all;
}

std::vector<Resultant> Scene::resultants() const
{
  std::vector<Resultant> all;
  const auto take = [&](const std::vector<Resultant> &some)
  { all.insert(all.end(), some.begin(), some.end()); };
  for (const auto &body : bodies)
    take(reactions(*body));
  for (const auto &load : loads)
    take(load->resultants());
  for (const auto &coupling : couplings)
    take(coupling->resultants());
  return all;
}

std::string Scene::column_of(const Resultant &r, const char axis) const
{
  return r.source + " on " + bodies[r.body]->name + " " + axis;
}
} // namespace sabot
