// Reads what the runs of a study left, and draws its conclusions.
#include "sabot/study/results.h"

#include "sabot/base/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

namespace sabot
{
namespace
{
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double number(const nlohmann::json &node, const std::string &key)
{
  return node.is_object() && node.contains(key) && node[key].is_number()
             ? node[key].get<double>()
             : nothing;
}

/** What stands under @p key; null for what is not there, or in something that
    has no keys: a result may be damaged, or of a program to come. */
const nlohmann::json &part(const nlohmann::json &node, const std::string &key)
{
  static const nlohmann::json none;
  return node.is_object() && node.contains(key) ? node[key] : none;
}

std::string text_of(const nlohmann::json &node, const std::string &key)
{
  const nlohmann::json &text = part(node, key);
  return text.is_string() ? text.get<std::string>() : "";
}

std::string zone_in_words(const nlohmann::json &zones)
{
  std::string text;
  for (const auto &zone : zones.items())
  {
    const double distance =
        number(part(zone.value(), "plastic_strain_over_0.01"),
               "distance_from_tie_in_spacings");
    char room[60] = "";
    if (std::isfinite(distance))
      std::snprintf(room, sizeof(room), " (%.1f spacings)", distance);
    text += (text.empty() ? "" : "; ") + zone.key() + ": " +
            text_of(zone.value(), "verdict") + room;
  }
  return text;
}
} // namespace

StudyOutcome read_outcome(const std::string &folder,
                          const std::vector<StudyQuantity> &quantities)
{
  StudyOutcome outcome;
  outcome.quantities.assign(quantities.size(), nothing);
  outcome.units.assign(quantities.size(), "");
  std::ifstream file(folder + "/result.json");
  const nlohmann::json r = nlohmann::json::parse(file, nullptr, false);
  if (!file || !r.is_object())
    return outcome;
  const std::string status = text_of(r, "status");
  if (status != "completed" && status != "failed" && status != "interrupted")
    return outcome;
  outcome.status = status;
  outcome.reason = text_of(r, "reason");
  outcome.cpu_seconds = number(r, "cpu_seconds");
  outcome.wall_seconds = number(r, "wall_seconds");
  outcome.energy_residual = number(r, "energy_residual_max");
  outcome.steps = number(r, "steps");
  for (const auto &body : part(r, "bodies").items())
    for (const char *const kind : {"particles", "cells"})
      if (!part(body.value(), kind).is_null())
        outcome.items += number(body.value(), kind);
  for (const auto &term : part(r, "energy").items())
    outcome.energy.emplace_back(term.key(),
                                number(part(r, "energy"), term.key()));
  outcome.zone = zone_in_words(part(r, "zone"));
  for (std::size_t q = 0; q < quantities.size(); ++q)
  {
    const nlohmann::json &quantity =
        part(part(r, "quantities"), quantities[q].name);
    outcome.quantities[q] = number(quantity, "value");
    outcome.units[q] = text_of(quantity, "unit");
  }
  try
  {
    History history;
    history.read(folder + "/history.h5");
    outcome.history = history.tables["quantities"];
  }
  catch (const IOError &)
  {
    // A run without a history still has its result.
  }
  return outcome;
}

double StudyOutcome::energy_of(const std::string &part) const
{
  for (const auto &[name, value] : energy)
    if (name == part)
      return value;
  return nothing;
}

std::vector<std::string> energy_parts(const StudyResults &results)
{
  std::vector<std::string> parts;
  for (const StudyOutcome &outcome : results.outcomes)
    for (const auto &[name, value] : outcome.energy)
      if (value != 0. && std::isfinite(value) && name != "total" &&
          std::find(parts.begin(), parts.end(), name) == parts.end())
        parts.push_back(name);
  return parts;
}

StudyResults::StudyResults(const StudyFile &study,
                           std::vector<StudyOutcome> outcomes_)
    : study(study), outcomes(std::move(outcomes_))
{
  for (std::size_t p = 0; p < study.parameters.size(); ++p)
    if (study.parameters[p].role == StudyParameter::Role::spacing)
      for (std::size_t q = 0; q < study.quantities.size(); ++q)
        find_convergence(p, q);
  for (std::size_t q = 0; q < study.quantities.size(); ++q)
  {
    find_scatter(q);
    find_ballistic(q);
    references.push_back(find_reference(q));
    find_prices(q);
  }
}

bool StudyResults::is_usable(const std::size_t run, const std::size_t q) const
{
  return outcomes[run].is_complete() &&
         std::isfinite(outcomes[run].quantities[q]);
}

void StudyResults::find_convergence(const std::size_t p, const std::size_t q)
{
  // One series for each choice of the other parameters; repeats are averaged.
  std::map<std::vector<std::size_t>, ConvergenceSeries> series;
  std::map<std::vector<std::size_t>, std::pair<double, double>> sums;
  for (std::size_t run = 0; run < study.runs.size(); ++run)
    if (is_usable(run, q))
    {
      auto &[sum, n] = sums[without_repeats(run)];
      sum += outcomes[run].quantities[q];
      n += 1.;
    }
  for (const auto &[choice, sum] : sums)
  {
    std::vector<std::size_t> rest = choice;
    rest[p] = 0;
    ConvergenceSeries &s = series[rest];
    s.parameter = p;
    s.quantity = q;
    s.others = study.label({rest, "", {}, ""}, p);
    s.spacing.push_back(study.parameters[p].values[choice[p]].number);
    s.value.push_back(sum.first / sum.second);
  }
  for (auto &[rest, s] : series)
    if (s.spacing.size() >= 2)
    {
      s.fit = fit_convergence(s.spacing, s.value);
      convergence.push_back(s);
    }
}

std::vector<std::size_t>
StudyResults::without_repeats(const std::size_t run) const
{
  std::vector<std::size_t> choice = study.runs[run].choice;
  for (std::size_t p = 0; p < choice.size(); ++p)
    if (study.parameters[p].role == StudyParameter::Role::repeat)
      choice[p] = 0;
  return choice;
}

void StudyResults::find_scatter(const std::size_t q)
{
  std::map<std::vector<std::size_t>, std::vector<double>> groups;
  for (std::size_t run = 0; run < study.runs.size(); ++run)
    if (is_usable(run, q))
      groups[without_repeats(run)].push_back(outcomes[run].quantities[q]);
  for (const auto &[choice, values] : groups)
  {
    if (values.size() < 2)
      continue;
    RepeatScatter s;
    s.quantity = q;
    const std::string words = study.label({choice, "", {}, ""});
    s.others = words.empty() ? "base" : words;
    s.n = values.size();
    for (const double value : values)
      s.mean += value / s.n;
    for (const double value : values)
      s.deviation += (value - s.mean) * (value - s.mean) / (s.n - 1.);
    s.deviation = std::sqrt(s.deviation);
    const auto ends = std::minmax_element(values.begin(), values.end());
    s.range = *ends.second - *ends.first;
    scatter.push_back(s);
  }
}

void StudyResults::find_ballistic(const std::size_t q)
{
  const std::string &name = study.quantities[q].ballistic;
  for (std::size_t p = 0; p < study.parameters.size(); ++p)
  {
    if (study.parameters[p].name != name)
      continue;
    std::map<std::vector<std::size_t>,
             std::pair<std::vector<double>, std::vector<double>>>
        curves;
    for (std::size_t run = 0; run < study.runs.size(); ++run)
    {
      std::vector<std::size_t> choice = without_repeats(run);
      const double impact = study.parameters[p].values[choice[p]].number;
      choice[p] = 0;
      if (!is_usable(run, q))
        continue;
      curves[choice].first.push_back(impact);
      curves[choice].second.push_back(outcomes[run].quantities[q]);
    }
    for (const auto &[choice, curve] : curves)
      ballistic.push_back({p, q, choice, study.label({choice, "", {}, ""}, p),
                           fit_ballistic(curve.first, curve.second)});
  }
}

ErrorReference StudyResults::find_reference(const std::size_t q) const
{
  const StudyQuantity &quantity = study.quantities[q];
  if (std::isfinite(quantity.measured))
    return {quantity.measured,
            "measured" + (quantity.source.empty()
                              ? std::string()
                              : " (" + quantity.source + ")")};
  ErrorReference reference;
  for (const ConvergenceSeries &s : convergence)
    if (s.quantity == q && s.others.empty() && s.fit.has_order)
      reference = {s.fit.limit, "extrapolated to spacing 0"};
  if (!reference.origin.empty())
    return reference;
  std::size_t dearest = 0;
  bool found = false;
  for (std::size_t run = 0; run < outcomes.size(); ++run)
    if (is_usable(run, q) &&
        (!found || outcomes[run].cpu_seconds > outcomes[dearest].cpu_seconds))
    {
      dearest = run;
      found = true;
    }
  if (found)
    reference = {outcomes[dearest].quantities[q],
                 "the dearest run (" + label(dearest) + ")"};
  return reference;
}

void StudyResults::find_prices(const std::size_t q)
{
  std::vector<PricedRun> priced;
  std::vector<double> cost, errors;
  for (std::size_t run = 0; run < outcomes.size(); ++run)
  {
    const bool good = is_usable(run, q);
    priced.push_back({study.runs[run].choice, outcomes[run].cpu_seconds,
                      good ? outcomes[run].quantities[q] : nothing});
    cost.push_back(outcomes[run].cpu_seconds);
    errors.push_back(good ? error(run, q) : nothing);
  }
  std::vector<std::size_t> n_values;
  for (const StudyParameter &parameter : study.parameters)
    n_values.push_back(parameter.values.size());
  prices.push_back(price_list(priced, n_values));
  fronts.push_back(pareto_front(cost, errors));
}

double StudyResults::error(const std::size_t run,
                           const std::size_t quantity) const
{
  const double exact = references[quantity].value;
  return std::abs(outcomes[run].quantities[quantity] - exact) /
         (has_relative_error(quantity) ? std::abs(exact) : 1.);
}

std::string StudyResults::error_name(const std::size_t quantity) const
{
  return (has_relative_error(quantity) ? "relative error of "
                                       : "difference of ") +
         study.quantities[quantity].name;
}

std::string StudyResults::error_unit(const std::size_t quantity) const
{
  return has_relative_error(quantity) ? "1" : unit(quantity);
}

std::string StudyResults::label(const std::size_t run) const
{
  // All values where there is no base that the runs have in common.
  if (study.is_grid || study.parameters.size() == 1)
  {
    std::string text;
    for (std::size_t p = 0; p < study.parameters.size(); ++p)
      text += (p == 0 ? "" : ", ") + study.parameters[p].name + " " +
              study.parameters[p].values[study.runs[run].choice[p]].label;
    return text;
  }
  const std::string text = study.label(study.runs[run]);
  return text.empty() ? "base" : text;
}

std::string StudyResults::unit(const std::size_t quantity) const
{
  for (const StudyOutcome &outcome : outcomes)
    if (!outcome.units[quantity].empty())
      return outcome.units[quantity];
  return "";
}
} // namespace sabot
