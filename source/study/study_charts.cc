#include "sabot/study/results.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
std::string file_name(std::string text)
{
  for (char &c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)))
      c = '-';
  return text;
}

std::string with_unit(const std::string &name, const std::string &unit)
{
  return unit.empty() || unit == "1" ? name : name + " [" + unit + "]";
}

Chart::Series level(const ErrorReference &reference, const double from,
                    const double to)
{
  Chart::Series series;
  series.label = reference.origin;
  series.x = {from, to};
  series.y = {reference.value, reference.value};
  series.is_dashed = true;
  return series;
}

Chart history_chart(const StudyResults &results, const std::size_t q)
{
  const std::string &name = results.study.quantities[q].name;
  Chart chart;
  chart.name = "history-" + file_name(name);
  chart.title = name + " over time";
  chart.x_label = "time [ms]";
  chart.y_label = with_unit(name, results.unit(q));
  double end = 0.;
  for (std::size_t run = 0; run < results.outcomes.size(); ++run)
  {
    const History::Table &table = results.outcomes[run].history;
    const std::size_t n_columns = table.columns.size();
    std::size_t column = 0;
    for (std::size_t c = 1; c < n_columns; ++c)
      if (table.columns[c].compare(0, name.size() + 2, name + " [") == 0)
        column = c;
    if (column == 0)
      continue;
    Chart::Series series;
    series.label = results.label(run);
    for (std::size_t row = 0; row < table.n_rows(); ++row)
    {
      series.x.push_back(1e3 * table.values[n_columns * row]);
      series.y.push_back(table.values[n_columns * row + column]);
      end = std::max(end, series.x.back());
    }
    chart.series.push_back(series);
  }
  if (std::isfinite(results.study.quantities[q].measured))
    chart.series.push_back(level(results.references[q], 0., end));
  return chart;
}

Chart parameter_chart(const StudyResults &results, const std::size_t q,
                      const std::size_t p)
{
  const StudyFile &study = results.study;
  const StudyParameter &parameter = study.parameters[p];
  const std::string &name = study.quantities[q].name;
  Chart chart;
  chart.name = file_name(name) + "-over-" + file_name(parameter.name);
  chart.title = name + " over " + parameter.name;
  chart.y_label = with_unit(name, results.unit(q));
  const bool numbers = std::all_of(
      parameter.values.begin(), parameter.values.end(),
      [](const StudyParameter::Value &v) { return std::isfinite(v.number); });
  chart.x_label = parameter.name + (numbers ? " (SI)" : ":");
  for (std::size_t v = 0; v < parameter.values.size() && !numbers; ++v)
    chart.x_label +=
        " " + std::to_string(v + 1) + " " + parameter.values[v].label;
  std::map<std::vector<std::size_t>, std::vector<std::pair<double, double>>>
      groups;
  std::map<std::vector<std::size_t>, std::size_t> first_run;
  double low = std::numeric_limits<double>::max(), high = -low;
  for (std::size_t run = 0; run < study.runs.size(); ++run)
  {
    std::vector<std::size_t> rest = study.runs[run].choice;
    const std::size_t v = rest[p];
    rest[p] = 0;
    const bool is_base =
        std::all_of(rest.begin(), rest.end(),
                    [](const std::size_t choice) { return choice == 0; });
    if (!results.outcomes[run].is_complete() || (!study.is_grid && !is_base))
      continue;
    const double x = numbers ? parameter.values[v].number : v + 1.;
    groups[rest].emplace_back(x, results.outcomes[run].quantities[q]);
    first_run.emplace(rest, run);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  for (auto &[rest, points] : groups)
  {
    std::sort(points.begin(), points.end());
    Chart::Series series;
    std::string others;
    for (std::size_t o = 0; o < rest.size(); ++o)
      if (o != p && rest[o] != 0)
        others += (others.empty() ? "" : ", ") + study.parameters[o].name +
                  " " + study.parameters[o].values[rest[o]].label;
    series.label = others.empty() ? "runs" : others;
    series.has_points = true;
    for (const auto &[x, y] : points)
    {
      series.x.push_back(x);
      series.y.push_back(y);
    }
    chart.series.push_back(series);
  }
  if (std::isfinite(results.references[q].value) && low <= high)
    chart.series.push_back(level(results.references[q], low, high));
  return chart;
}

Chart cost_chart(const StudyResults &results, const std::size_t q)
{
  const std::string &name = results.study.quantities[q].name;
  Chart chart;
  chart.name = "cost-" + file_name(name);
  chart.title =
      "cost and error of " + name + " against " + results.references[q].origin;
  chart.x_label = "CPU time [s]";
  chart.y_label = "relative error [%]";
  chart.is_x_logarithmic = true;
  Chart::Series all, front;
  all.label = "runs";
  all.has_line = false;
  all.has_points = true;
  for (std::size_t run = 0; run < results.outcomes.size(); ++run)
    if (results.outcomes[run].is_complete())
    {
      all.x.push_back(results.outcomes[run].cpu_seconds);
      all.y.push_back(100. * results.error(run, q));
    }
  front.label = "Pareto front:";
  front.has_points = true;
  for (const std::size_t run : results.fronts[q])
  {
    front.label += (front.x.empty() ? " " : "; ") + results.label(run);
    front.x.push_back(results.outcomes[run].cpu_seconds);
    front.y.push_back(100. * results.error(run, q));
  }
  chart.series = {all, front};
  return chart;
}
} // namespace

std::vector<Chart> StudyResults::charts() const
{
  std::vector<Chart> charts;
  for (std::size_t q = 0; q < study.quantities.size(); ++q)
  {
    charts.push_back(history_chart(*this, q));
    for (std::size_t p = 0; p < study.parameters.size(); ++p)
      charts.push_back(parameter_chart(*this, q, p));
    charts.push_back(cost_chart(*this, q));
  }
  return charts;
}
} // namespace sabot
