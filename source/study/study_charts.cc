// Which charts a study is worth.
#include "sabot/study/results.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

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
                    const double to, const double factor)
{
  Chart::Series series;
  series.label = reference.origin;
  series.x = {from, to};
  series.y = {factor * reference.value, factor * reference.value};
  series.is_dashed = true;
  return series;
}

/** Number of the column of a quantity in the histories; 0: none. */
std::size_t column_of(const History::Table &table, const std::string &name)
{
  for (std::size_t c = 1; c < table.columns.size(); ++c)
    if (table.columns[c].compare(0, name.size() + 2, name + " [") == 0)
      return c;
  return 0;
}

/** Factor from SI to what is drawn, and its unit: lengths are in mm. */
std::pair<double, std::string> drawn_unit(const std::string &unit)
{
  return unit == "m" ? std::make_pair(1e3, std::string("mm"))
                     : std::make_pair(1., unit);
}

/** Histories of some runs over time, or over another quantity. */
Chart history_chart(const StudyResults &results, const std::size_t q,
                    const std::vector<std::size_t> &runs,
                    const std::string &varied, const std::string &over)
{
  const std::string &name = results.study.quantities[q].name;
  const auto [factor, unit] = drawn_unit(results.unit(q));
  Chart chart;
  chart.name = file_name(name) + (over.empty() ? "-history" : "-over-") +
               file_name(over) + (varied.empty() ? "" : "-by-") +
               file_name(varied);
  chart.title = name + " over " + (over.empty() ? "time" : over) +
                (varied.empty() ? "" : ", by " + varied);
  chart.x_label = over.empty() ? "time [ms]" : over;
  chart.y_label = with_unit(name, unit);
  double low = 0., high = 0.;
  for (const std::size_t run : runs)
  {
    const History::Table &table = results.outcomes[run].history;
    const std::size_t n_columns = table.columns.size(),
                      column = column_of(table, name),
                      x_column = over.empty() ? 0 : column_of(table, over);
    if (column == 0 || (!over.empty() && x_column == 0))
      continue;
    double x_factor = 1e3;
    if (!over.empty())
    {
      const std::string &head = table.columns[x_column];
      const std::size_t from = over.size() + 2;
      const auto x_unit = drawn_unit(head.substr(from, head.size() - from - 1));
      x_factor = x_unit.first;
      chart.x_label = with_unit(over, x_unit.second);
    }
    Chart::Series series;
    series.label = results.label(run);
    if (!varied.empty() && series.label == "base")
      for (const StudyParameter &parameter : results.study.parameters)
        if (parameter.name == varied)
          series.label = "base: " + varied + " " + parameter.values[0].label;
    for (std::size_t row = 0; row < table.n_rows(); ++row)
    {
      series.x.push_back(x_factor * table.values[n_columns * row + x_column]);
      series.y.push_back(factor * table.values[n_columns * row + column]);
      low = std::min(low, series.x.back());
      high = std::max(high, series.x.back());
    }
    chart.series.push_back(series);
  }
  if (std::isfinite(results.study.quantities[q].measured))
    chart.series.push_back(level(results.references[q], low, high, factor));
  return chart;
}

/** Places of a parameter's values on an axis. */
struct Places
{
  std::string label; // of the axis
  std::vector<double> x;
};

Places places_of(const StudyParameter &parameter)
{
  Places places;
  std::string unit;
  bool same_unit = true, numbers = true;
  for (const StudyParameter::Value &value : parameter.values)
  {
    char *end = nullptr;
    places.x.push_back(std::strtod(value.label.c_str(), &end));
    std::string rest = end;
    rest.erase(0, rest.find_first_not_of(' '));
    same_unit = same_unit && (places.x.size() == 1 || rest == unit);
    unit = rest;
    numbers = numbers && std::isfinite(value.number);
  }
  if (numbers && same_unit)
    places.label = with_unit(parameter.name, unit);
  else
  {
    places.label = parameter.name + (numbers ? " (SI)" : ":");
    for (std::size_t v = 0; v < parameter.values.size(); ++v)
    {
      places.x[v] = numbers ? parameter.values[v].number : v + 1.;
      if (!numbers)
        places.label +=
            " " + std::to_string(v + 1) + " " + parameter.values[v].label;
    }
  }
  return places;
}

/** The fitted curves up to the fastest shot, and what was measured. */
void add_ballistic(const StudyResults &results, const std::size_t q,
                   const std::size_t p, const double low, const double high,
                   Chart &chart)
{
  constexpr int n_points = 200;
  for (const BallisticSeries &series : results.ballistic)
  {
    if (series.quantity != q || series.parameter != p || !series.fit.exists)
      continue;
    Chart::Series curve;
    char text[80];
    std::snprintf(text, sizeof(text), "fit: limit %.1f m/s, a %.3f, p %.2f",
                  series.fit.limit, series.fit.a, series.fit.p);
    curve.label = (series.others.empty() ? "" : series.others + ", ") + text;
    curve.is_dashed = true;
    const double from = std::min(low, series.fit.limit);
    for (int i = 0; i <= n_points; ++i)
    {
      const double impact = from + (high - from) * i / n_points;
      curve.x.push_back(impact);
      curve.y.push_back(series.fit.residual(impact));
    }
    chart.series.push_back(curve);
  }
  Chart::Series measured;
  measured.label = "measured";
  measured.has_line = false;
  measured.has_points = true;
  for (const auto &[impact, residual] :
       results.study.quantities[q].measured_curve)
  {
    measured.x.push_back(impact);
    measured.y.push_back(residual);
  }
  if (!measured.x.empty())
    chart.series.push_back(measured);
}

Chart parameter_chart(const StudyResults &results, const std::size_t q,
                      const std::size_t p)
{
  const StudyFile &study = results.study;
  const StudyParameter &parameter = study.parameters[p];
  const std::string &name = study.quantities[q].name;
  const auto [factor, unit] = drawn_unit(results.unit(q));
  const Places places = places_of(parameter);
  Chart chart;
  chart.name = file_name(name) + "-at-" + file_name(parameter.name);
  chart.title = name + " at " + parameter.name;
  chart.x_label = places.label;
  chart.y_label = with_unit(name, unit);
  std::map<std::vector<std::size_t>, std::vector<std::pair<double, double>>>
      groups;
  std::map<std::vector<std::size_t>, std::size_t> first_run;
  double low = std::numeric_limits<double>::max(), high = -low;
  for (std::size_t run = 0; run < study.runs.size(); ++run)
  {
    std::vector<std::size_t> rest = study.runs[run].choice;
    const std::size_t v = rest[p];
    rest[p] = 0;
    if (!results.outcomes[run].is_complete() ||
        (!study.is_grid && !study.varies_only(study.runs[run], p)))
      continue;
    const double x = places.x[v];
    groups[rest].emplace_back(x, factor * results.outcomes[run].quantities[q]);
    first_run.emplace(rest, run);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  for (auto &[rest, points] : groups)
  {
    std::sort(points.begin(), points.end());
    Chart::Series series;
    const std::string others = study.label(study.runs[first_run[rest]], p);
    series.label = others.empty() ? "runs" : others;
    series.has_points = true;
    for (const auto &[x, y] : points)
    {
      series.x.push_back(x);
      series.y.push_back(y);
    }
    chart.series.push_back(series);
  }
  const bool is_ballistic = study.quantities[q].ballistic == parameter.name;
  if (is_ballistic)
    add_ballistic(results, q, p, low, high, chart);
  if (std::isfinite(results.references[q].value) && low <= high &&
      !is_ballistic)
    chart.series.push_back(level(results.references[q], low, high, factor));
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
  const bool is_relative = results.has_relative_error(q);
  const double factor = is_relative ? 100. : 1.;
  chart.y_label = is_relative ? "relative error [%]"
                              : "difference [" + results.unit(q) + "]";
  chart.is_x_logarithmic = true;
  Chart::Series all, front;
  all.label = "runs";
  all.has_line = false;
  all.has_points = true;
  for (std::size_t run = 0; run < results.outcomes.size(); ++run)
    if (results.outcomes[run].is_complete())
    {
      all.x.push_back(results.outcomes[run].cpu_seconds);
      all.y.push_back(factor * results.error(run, q));
      all.names.push_back(results.label(run));
    }
  front.label = "Pareto front:";
  front.has_points = true;
  for (const std::size_t run : results.fronts[q])
  {
    front.label += (front.x.empty() ? " " : "; ") + results.label(run);
    front.x.push_back(results.outcomes[run].cpu_seconds);
    front.y.push_back(factor * results.error(run, q));
    front.names.push_back(results.label(run));
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
    // A chart for each parameter, where one is varied at a time, stays
    // readable.
    const bool is_split = !study.is_grid && study.parameters.size() > 1;
    for (std::size_t p = 0; p < (is_split ? study.parameters.size() : 1); ++p)
    {
      std::vector<std::size_t> runs;
      for (std::size_t run = 0; run < outcomes.size(); ++run)
        if (!is_split || study.varies_only(study.runs[run], p))
          runs.push_back(run);
      const std::string varied = is_split ? study.parameters[p].name : "";
      charts.push_back(history_chart(*this, q, runs, varied, ""));
      if (!study.quantities[q].over.empty())
        charts.push_back(
            history_chart(*this, q, runs, varied, study.quantities[q].over));
    }
    for (std::size_t p = 0; p < study.parameters.size(); ++p)
      charts.push_back(parameter_chart(*this, q, p));
    charts.push_back(cost_chart(*this, q));
  }
  return charts;
}
} // namespace sabot
