// Zones that find themselves: what they take from their hosts, what they cannot
// have, and what turns the cells.
#include "sabot/base/choice.h"
#include "sabot/base/error_report.h"
#include "sabot/base/text.h"
#include "sabot/bodies/conversion.h"
#include "sabot/couplings/coupling_builder.h"
#include "sabot/couplings/self_finding_zone.h"
#include "sabot/simulation/body_assembly.h"
#include "sabot/simulation/scene_checks.h"

#include <algorithm>

namespace sabot
{
void BodyAssembly::take_from_host(const Carving &carving)
{
  for (const std::string entry :
       {"Symmetry faces", "Clamped faces", "Initial velocity", "Material"})
  {
    const std::string path = "Bodies/" + carving.zone + "/" + entry;
    const auto value_at = [&](const std::string &body)
    {
      const EnteredSubsection entered(prm, "Bodies", body);
      return prm.get(entry);
    };
    const std::string its = value_at(carving.body);
    if (file.is_set(path) && !same_value(value_at(carving.zone), its))
      throw InputError(path, "is " + value_at(carving.zone) +
                                 ", but the particles are of body \"" +
                                 carving.body + "\", where it is \"" + its +
                                 "\"; remove the entry");
    const EnteredSubsection entered(prm, "Bodies", carving.zone);
    prm.set(entry, its);
  }
}

void BodyAssembly::refuse_with_growth(const Carving &carving) const
{
  {
    const EnteredSubsection entered(prm, "Bodies", carving.body);
    if (prm.get_bool("Heat conduction"))
      throw InputError("Bodies/" + carving.body + "/Heat conduction",
                       "heat is conducted in all cells of a body or in none, "
                       "but cells of this one turn into particles of \"" +
                           carving.zone +
                           "\"; remove the entry, or let that zone be fixed");
  }
  for (const std::string &body : {carving.body, carving.zone})
    if (trim(file.value("Bodies/" + body + "/Smallest step", "none")) != "none")
      throw InputError("Bodies/" + body + "/Smallest step",
                       "mass is not added to a body whose cells turn into "
                       "particles; remove the entry, for cells that are "
                       "squeezed turn by \"Converts by = stable step\"");
  for (const std::string &load : file.subsections("Loads"))
  {
    const std::string path = "Loads/" + load,
                      body = trim(file.value(path + "/Body", ""));
    if (body == carving.zone)
      throw InputError(path + "/Body",
                       "\"" + body +
                           "\" has no particles yet that could bear it; load "
                           "faces of \"" +
                           carving.body + "\", cells at which stay cells");
    if (body == carving.body && trim(file.value(path + "/Faces", "")).empty())
      throw InputError(path + "/Body",
                       "\"" + body +
                           "\" has cells that turn into particles, which are "
                           "not moved with it; name the \"Faces\" that are, or "
                           "let the zone \"" +
                           carving.zone + "\" be fixed");
  }
}

GrowingZone BodyAssembly::record_growing(const Carving &carving)
{
  GrowingZone zone;
  zone.zone = number_of(carving.zone);
  zone.host = number_of(carving.body);
  if (carving.has_start)
    zone.start = carving.shape;
  zone.turn = postures.at(carving.body).turn;
  refuse_with_growth(carving);
  const std::string path = "Bodies/" + carving.zone;
  const EnteredSubsection entered(prm, "Bodies", carving.zone);
  zone.request = *discretization_of(carving.zone)->conversion(prm, path);
  const Material &law = *bodies[zone.host]->facts().material;
  for (const auto &criterion : zone.request.criteria)
    criterion->check(law, path);
  bodies[zone.host]->own_particles = bodies[zone.zone].get();
  bodies[zone.host]->cell_source()->convert_by(zone.request.criteria);
  if (const auto &lattices = bodies[zone.zone]->particle_sink()->lattices())
    notes.push_back(
        carving.zone + ": cells of " + carving.body + " are split into " +
        formatted("%.0f to ", lattices->parts().first) +
        formatted("%.0f parts along their edges", lattices->parts().second));
  return zone;
}

std::unique_ptr<Coupling> make_self_finding_zone(GrowingZone &zone,
                                                 const CouplingContext &context)
{
  SelfFindingOptions options{zone.zone, zone.host, zone.request.interval, {}};
  if (zone.start)
    options.is_start = [start = *zone.start,
                        turn = zone.turn](const std::array<double, 3> &place)
    { return start.contains(turn.origin(place)); };
  auto coupling = std::make_unique<SelfFindingZone>(
      context.bodies[zone.zone]->name + " in " +
          context.bodies[zone.host]->name,
      context.bodies, options, context.communicator, context.tied_nodes);
  zone.coupling = coupling.get();
  return coupling;
}

void refuse_lone_hosts(const Scene &scene)
{
  const auto &bodies = scene.bodies;
  std::set<std::pair<int, int>> apart;
  for (const auto &coupling : scene.couplings)
    for (const auto &[a, b] : coupling->holds_apart())
      apart.insert(std::minmax(a, b));
  for (const GrowingZone &zone : scene.growing)
    for (const auto &body : bodies)
      if (body->id != zone.host && body->id != zone.zone &&
          apart.count(std::minmax(zone.host, body->id)) > 0 &&
          apart.count(std::minmax(zone.zone, body->id)) == 0)
        throw InputError("Bodies/" + bodies[zone.zone]->name + "/Zone",
                         "is self-finding, but what cells of body \"" +
                             bodies[zone.host]->name +
                             "\" turn into would pass through body \"" +
                             body->name + "\"; add \"" +
                             bodies[zone.zone]->name +
                             "\" to the \"Bodies\" of their contact");
}
} // namespace sabot
