// Who meets whom by the velocities at the start, and whether the couplings
// know.
#include "sabot/simulation/scene_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sabot
{
namespace
{
constexpr double anywhere = 1e6; // [m], as far as any scene

std::pair<int, int> ordered(const int a, const int b)
{
  return {std::min(a, b), std::max(a, b)};
}

std::vector<Vec> velocities(const BodyFacts &facts)
{
  const auto as_vec = [](const std::array<double, 3> &v)
  { return vec(v[0], v[1], v[2]); };
  std::vector<Vec> all = {as_vec(facts.velocity)};
  if (facts.driven_velocity)
    all.push_back(as_vec(*facts.driven_velocity));
  return all;
}

std::string in_us(const double time)
{
  char text[40];
  std::snprintf(text, sizeof(text), "%.4g us", 1e6 * time);
  return text;
}

std::string quoted(const std::string &name)
{
  return "\"" + name + "\"";
}
} // namespace

MotionDoubts::MotionDoubts(const Scene &scene,
                           const std::vector<Outline> &outlines,
                           const BodyPairs &tied)
    : scene(scene), outlines(outlines)
{
  for (const auto &body : scene.bodies)
  {
    facts.push_back(body->facts());
    // What is loaded may come anywhere.
    facts.back().moves_by_itself =
        facts.back().moves_by_itself || !scene.loads.empty();
  }
  for (const auto &[a, b] : tied)
    joined.insert(ordered(a, b));
  for (const CarvedZone &zone : scene.zones)
    joined.insert(ordered(zone.zone, zone.host));
  for (const auto &coupling : scene.couplings)
    for (const auto &[a, b] : coupling->holds_apart())
      held_apart.insert(ordered(a, b));
}

std::vector<MotionDoubts::Flight> MotionDoubts::flights(const int a,
                                                        const int b) const
{
  std::vector<Flight> flights;
  for (const Vec of_a : velocities(facts[a]))
    for (const Vec of_b : velocities(facts[b]))
    {
      const double speed = norm(of_a - of_b);
      flights.push_back(
          {speed > 0. ? (1. / speed) * (of_a - of_b) : vec(1., 0., 0.), speed,
           speed * scene.settings.end_time});
    }
  return flights;
}

std::optional<double> MotionDoubts::time_to_meeting(const int a,
                                                    const int b) const
{
  std::optional<double> first;
  for (const Flight &flight : flights(a, b))
  {
    if (!(flight.speed > 0.))
      continue;
    const auto way =
        way_to_meeting(outlines[a], outlines[b], flight.direction, flight.way);
    if (way)
      first =
          std::min(first.value_or(*way / flight.speed), *way / flight.speed);
  }
  return first;
}

bool MotionDoubts::may_meet(const int a, const int b) const
{
  const Outline &one = outlines[a], &other = outlines[b];
  const double margin = std::max(one.spacing(), other.spacing());
  for (const Flight &flight : flights(a, b))
  {
    if (!(flight.speed > 0.))
      continue;
    if (way_to_meeting(one, other, flight.direction, flight.way))
      return true;
    // What passes by within a spacing may touch, unless it comes from there.
    if (may_come_near(one, other, flight.direction, flight.way, margin) &&
        !way_to_meeting(one, other, -flight.direction, anywhere))
      return true;
  }
  return false;
}

bool MotionDoubts::is_joined(const int a, const int b) const
{
  return joined.count(ordered(a, b)) > 0;
}

BodyPairs MotionDoubts::pairs_of_contact(const std::string &contact) const
{
  BodyPairs pairs;
  for (const auto &coupling : scene.couplings)
    if (coupling->name == contact ||
        coupling->name.compare(0, contact.size() + 4, contact + " of ") == 0)
      for (const auto &[a, b] : coupling->holds_apart())
        pairs.insert(ordered(a, b));
  return pairs;
}

std::vector<char> MotionDoubts::find_disturbed() const
{
  std::vector<char> disturbed;
  for (const BodyFacts &body : facts)
    disturbed.push_back(body.moves_by_itself);
  BodyPairs striking;
  for (const auto &[a, b] : held_apart)
    if (a != b && !is_joined(a, b) && may_meet(a, b))
      striking.insert({a, b});
  for (const auto &[a, b] : joined)
    if (facts[a].velocity != facts[b].velocity)
      striking.insert({a, b});
  for (const auto &[a, b] : striking)
    disturbed[a] = disturbed[b] = 1;
  // It spreads along contacts and ties.
  for (std::size_t round = 0; round < facts.size(); ++round)
    for (const BodyPairs *const pairs : {&held_apart, &joined})
      for (const auto &[a, b] : *pairs)
        disturbed[a] = disturbed[b] = disturbed[a] || disturbed[b];
  return disturbed;
}

void MotionDoubts::refuse_irresistible() const
{
  const auto is_prescribed = [this](const int i)
  { return !facts[i].deforms && scene.bodies[i]->is_held(); };
  for (int a = 0; a < int(facts.size()); ++a)
    for (int b = a + 1; b < int(facts.size()); ++b)
    {
      if (is_joined(a, b) || !is_prescribed(a) || !is_prescribed(b))
        continue;
      if (const auto time = time_to_meeting(a, b))
        throw InputError(
            "Bodies/" + name(b) + "/Motion",
            "is prescribed, as that of body " + quoted(name(a)) +
                ", and the two meet after " + in_us(*time) +
                ": no contact can keep them apart; let one of them "
                "be free, or end the run before");
    }
}

std::vector<std::string>
MotionDoubts::missing_contacts(const std::vector<std::string> &unlisted) const
{
  std::vector<std::string> warnings;
  for (int a = 0; a < int(facts.size()); ++a)
    for (int b = a + 1; b < int(facts.size()); ++b)
    {
      if (is_joined(a, b) || held_apart.count({a, b}) > 0)
        continue;
      const double size =
          std::min(outlines[a].spacing(), outlines[b].spacing());
      const auto time = time_to_meeting(a, b);
      const bool touches = touch(outlines[a], outlines[b], 1e-3 * size);
      if (!time && !touches)
        continue;
      std::string text = "bodies " + quoted(name(a)) + " and " +
                         quoted(name(b)) +
                         (time ? " meet after " + in_us(*time) +
                                     " by their velocities at the start"
                               : " touch each other") +
                         ", but no contact keeps them apart" +
                         (time ? "" : " and no tie holds them together") +
                         ": they will pass through each other; list both "
                         "in the bodies of a contact";
      for (const std::string &contact : unlisted)
        text += "; \"Couplings/" + contact +
                "\" is described but not in the list of couplings";
      warnings.push_back(text);
    }
  return warnings;
}

std::string MotionDoubts::why_not(const int a, const int b) const
{
  const std::string pair = quoted(name(a)) + " and " + quoted(name(b));
  const Flight flight = flights(a, b).front();
  if (!(flight.speed > 0.))
    return pair + " rest with each other";
  if (const auto way =
          way_to_meeting(outlines[a], outlines[b], flight.direction, anywhere))
    return pair + " would meet after " + in_us(*way / flight.speed);
  if (way_to_meeting(outlines[a], outlines[b], -flight.direction, anywhere))
    return pair + " fly apart: check the sign of the velocity";
  return pair + " miss each other";
}

std::vector<std::string>
MotionDoubts::idle_contacts(const std::vector<std::string> &names) const
{
  const std::vector<char> disturbed = find_disturbed();
  std::vector<std::string> warnings;
  for (const std::string &contact : names)
  {
    std::string reasons;
    bool may_act = false;
    for (const auto &[a, b] : pairs_of_contact(contact))
    {
      if (a != b && is_joined(a, b))
        continue;
      // Alone with itself a body folds, or breaks.
      may_act =
          may_act || a == b || disturbed[a] || disturbed[b] || may_meet(a, b);
      if (may_act)
        break;
      if (reasons.size() < 300)
        reasons += (reasons.empty() ? "" : ", ") + why_not(a, b);
    }
    if (!may_act && !reasons.empty())
      warnings.push_back("contact " + quoted(contact) +
                         " never acts by the end time of " +
                         in_us(scene.settings.end_time) + ": " + reasons);
  }
  return warnings;
}

std::vector<std::string>
MotionDoubts::idle_self_contacts(const std::vector<std::string> &names) const
{
  std::vector<std::string> warnings;
  for (const std::string &contact : names)
  {
    const BodyPairs pairs = pairs_of_contact(contact);
    const auto may_act = [&](const std::pair<int, int> &pair)
    {
      const BodyFacts &one = facts[pair.first], &other = facts[pair.second];
      return !one.is_particles || !other.is_particles || one.may_fail ||
             other.may_fail;
    };
    if (!pairs.empty() && std::none_of(pairs.begin(), pairs.end(), may_act))
      warnings.push_back("self-contact " + quoted(contact) +
                         " never acts: it is between pieces of particles, and "
                         "no bond of its bodies can fail");
  }
  return warnings;
}

std::vector<std::string> doubtful_end_time(const Scene &scene)
{
  double step = std::numeric_limits<double>::max();
  for (const auto &body : scene.bodies)
  {
    const BodyFacts facts = body->facts();
    if (facts.deforms)
      step = std::min(
          step, *std::min_element(facts.spacing.begin(), facts.spacing.end()) /
                    facts.material->sound_speed());
  }
  const double n = scene.settings.end_time / step;
  constexpr double most = 1e7;
  if (n < most)
    return {};
  char text[200];
  std::snprintf(text, sizeof(text),
                "the end time of %.4g s takes about %.1g steps of %.2g s: is a "
                "unit missing (a number alone is in s)?",
                scene.settings.end_time, n, step);
  return {text};
}
} // namespace sabot
