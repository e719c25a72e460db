// The report of a study: one HTML page with everything in it.
#include "sabot/base/hash.h"
#include "sabot/base/text.h"
#include "sabot/output/file_tools.h"
#include "sabot/study/results.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace sabot
{
namespace
{
const char *const style = R"(
body{font:15px/1.5 system-ui,sans-serif;max-width:1100px;margin:2em auto;
padding:0 1em;color:#1a1a1a;background:#fff}
h1{font-size:1.5em}h2{font-size:1.2em;margin-top:2em;border-bottom:1px solid #ccc}
table{border-collapse:collapse;font-size:.9em;margin:1em 0}
td,th{border:1px solid #ccc;padding:.25em .6em;text-align:right}
td.t,th.t{text-align:left}tr.front{background:#e8f3fb}tr.bad{color:#a33}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(460px,1fr));
gap:1em}figure{margin:0}img{max-width:100%}
figcaption{font-size:.9em;color:#444}svg{width:100%;height:auto}
svg text{font:12px system-ui,sans-serif;fill:#333}svg .title{font-size:14px}
svg .grid{stroke:#e4e4e4}svg .frame{fill:none;stroke:#888}
.scroll{overflow-x:auto})";

std::string number(const double value, const char *const pattern = "%.5g")
{
  if (!std::isfinite(value))
    return "–";
  return formatted(pattern, value);
}

std::string cell(const std::string &text, const bool is_text = false)
{
  return std::string(is_text ? "<td class='t'>" : "<td>") + escape_html(text) +
         "</td>";
}

std::string head(const std::string &text, const bool is_text = false)
{
  return std::string(is_text ? "<th class='t'>" : "<th>") + escape_html(text) +
         "</th>";
}

void write_runs(const StudyResults &results, std::ostream &html)
{
  const StudyFile &study = results.study;
  html << "<h2>Runs</h2><div class='scroll'><table><tr>" << head("run", true)
       << head("status", true);
  for (std::size_t q = 0; q < study.quantities.size(); ++q)
    html << head(study.quantities[q].name + " [" + results.unit(q) + "]")
         << head(results.has_relative_error(q)
                     ? "error [%]"
                     : "difference [" + results.unit(q) + "]");
  html << head("CPU time [s]") << head("steps") << head("cells and particles")
       << head("energy residual [%]") << head("zone", true) << "</tr>\n";
  for (std::size_t run = 0; run < study.runs.size(); ++run)
  {
    const StudyOutcome &outcome = results.outcomes[run];
    bool is_front = false;
    for (const auto &front : results.fronts)
      is_front =
          is_front || std::find(front.begin(), front.end(), run) != front.end();
    html << (!outcome.is_complete() ? "<tr class='bad'>"
             : is_front             ? "<tr class='front'>"
                                    : "<tr>")
         << cell(results.label(run), true)
         << cell(outcome.status +
                     (outcome.reason.empty() ? "" : ": " + outcome.reason),
                 true);
    for (std::size_t q = 0; q < study.quantities.size(); ++q)
      html << cell(number(outcome.quantities[q]))
           << cell(outcome.is_complete()
                       ? results.has_relative_error(q)
                             ? number(100. * results.error(run, q), "%.2f")
                             : number(results.error(run, q))
                       : "–");
    html << cell(number(outcome.cpu_seconds, "%.1f"))
         << cell(number(outcome.steps, "%.0f"))
         << cell(number(outcome.items, "%.0f"))
         << cell(number(100. * outcome.energy_residual, "%.3f"))
         << cell(outcome.zone, true) << "</tr>\n";
  }
  html << "</table></div><p>Shaded runs lie on a Pareto front: no other run is "
          "both cheaper and nearer to the reference.</p>\n<ul>";
  for (std::size_t q = 0; q < study.quantities.size(); ++q)
    html << "<li>Errors of " << escape_html(study.quantities[q].name)
         << " count against " << number(results.references[q].value) << " "
         << escape_html(results.unit(q)) << ", "
         << escape_html(results.references[q].origin) << ".</li>";
  html << "</ul>\n";
}

/** Where the energy is at the end of each run. */
void write_energies(const StudyResults &results, std::ostream &html)
{
  const StudyFile &study = results.study;
  const std::vector<std::string> parts = energy_parts(results);
  if (parts.empty())
    return;
  html << "<h2>Energy at the end [J]</h2><div class='scroll'><table><tr>"
       << head("run", true);
  for (const std::string &part : parts)
    html << head(part);
  html << "</tr>\n";
  for (std::size_t run = 0; run < study.runs.size(); ++run)
  {
    html << "<tr>" << cell(results.label(run), true);
    for (const std::string &part : parts)
      html << cell(number(results.outcomes[run].energy_of(part), "%.4g"));
    html << "</tr>\n";
  }
  html << "</table></div><p>Plastic work tells how much was dissipated; it is "
          "no part of the balance by itself.</p>\n";
}

std::string file_contents(const std::string &file)
{
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return stream ? bytes.str() : "";
}

void write_pictures(const StudyResults &results, std::ostream &html)
{
  std::ostringstream figures;
  for (std::size_t run = 0; run < results.study.runs.size(); ++run)
  {
    const std::string &file = results.outcomes[run].picture;
    const std::string bytes = file.empty() ? "" : file_contents(file);
    if (!bytes.empty())
      figures << "<figure><img alt='section' src='data:image/png;base64,"
              << base64(bytes) << "'><figcaption>"
              << escape_html(results.label(run)) << "</figcaption></figure>\n";
  }
  if (!figures.str().empty())
    html << "<h2>Sections</h2><div class='charts'>\n"
         << figures.str() << "</div>\n";
}

void write_convergence(const StudyResults &results, std::ostream &html)
{
  if (results.convergence.empty())
    return;
  html << "<h2>Convergence with the spacing</h2><div class='scroll'><table><tr>"
       << head("quantity", true) << head("over", true)
       << head("other parameters", true) << head("values")
       << head("observed order") << head("at spacing 0")
       << head("uncertainty ±") << head("how", true) << "</tr>\n";
  for (const ConvergenceSeries &s : results.convergence)
    html << "<tr>" << cell(results.study.quantities[s.quantity].name, true)
         << cell(results.study.parameters[s.parameter].name, true)
         << cell(s.others.empty() ? "base" : s.others, true)
         << cell(std::to_string(s.value.size()))
         << cell(s.fit.has_order ? number(s.fit.order, "%.2f") : "none")
         << cell(s.fit.has_order ? number(s.fit.limit)
                                 : "finest: " + number(s.fit.limit))
         << cell(number(s.fit.uncertainty, "%.3g")) << cell(s.fit.method, true)
         << "</tr>\n";
  html << "</table></div><p>Least-squares fit of f<sub>0</sub> + a "
          "h<sup>p</sup>; uncertainty after E&ccedil;a and Hoekstra, J. "
          "Comput. Phys. 262 (2014) 104.</p>\n";
}

/** Means and spreads of runs that are repeats of each other. */
void write_scatter(const StudyResults &results, std::ostream &html)
{
  if (results.scatter.empty())
    return;
  html << "<h2>Scatter of repeated runs</h2><div class='scroll'><table><tr>"
       << head("quantity", true) << head("parameters", true) << head("runs")
       << head("mean") << head("standard deviation") << head("range")
       << "</tr>\n";
  for (const RepeatScatter &s : results.scatter)
    html << "<tr>" << cell(results.study.quantities[s.quantity].name, true)
         << cell(s.others, true) << cell(std::to_string(s.n))
         << cell(number(s.mean)) << cell(number(s.deviation, "%.3g"))
         << cell(number(s.range, "%.3g")) << "</tr>\n";
  html << "</table></div>\n";
}

void write_ballistic(const StudyResults &results, std::ostream &html)
{
  if (results.ballistic.empty())
    return;
  html << "<h2>Ballistic curve</h2><div class='scroll'><table><tr>"
       << head("quantity", true) << head("other parameters", true)
       << head("runs that perforate") << head("limit [m/s]") << head("a")
       << head("p") << head("root mean square off [m/s]") << "</tr>\n";
  for (const BallisticSeries &s : results.ballistic)
  {
    const BallisticFit &fit = s.fit;
    const double none = std::nan("");
    html << "<tr>" << cell(results.study.quantities[s.quantity].name, true)
         << cell(s.others.empty() ? "base" : s.others, true)
         << cell(std::to_string(fit.n_perforating))
         << cell(number(fit.exists ? fit.limit : none))
         << cell(number(fit.exists ? fit.a : none, "%.3f"))
         << cell(number(fit.exists ? fit.p : none, "%.2f"))
         << cell(number(fit.exists ? fit.deviation : none, "%.3g"))
         << "</tr>\n";
  }
  html << "</table></div><p>v<sub>r</sub> = a (v<sub>i</sub><sup>p</sup> - "
          "v<sub>bl</sub><sup>p</sup>)<sup>1/p</sup>; with fewer than four "
          "runs that perforate p is 2.</p>\n";
}

void write_prices(const StudyResults &results, std::ostream &html)
{
  const StudyFile &study = results.study;
  html << "<h2>Price list</h2>\n";
  for (std::size_t q = 0; q < study.quantities.size(); ++q)
  {
    if (results.prices[q].empty())
      continue;
    html << "<h3>" << escape_html(study.quantities[q].name)
         << "</h3><div class='scroll'><table><tr>" << head("parameter", true)
         << head("from", true) << head("to", true) << head("CPU seconds saved")
         << head("change [" + results.unit(q) + "]") << head("change [%]")
         << head("pairs of runs") << "</tr>\n";
    const double scale = results.references[q].value;
    for (const Price &price : results.prices[q])
    {
      const StudyParameter &parameter = study.parameters[price.parameter];
      html << "<tr>" << cell(parameter.name, true)
           << cell(parameter.values[0].label, true)
           << cell(parameter.values[price.value].label, true)
           << cell(number(price.seconds_saved, "%+.1f"))
           << cell(number(price.quantity_change, "%+.4g"))
           << cell(number(100. * price.quantity_change / scale, "%+.2f"))
           << cell(std::to_string(price.n_pairs)) << "</tr>\n";
    }
    html << "</table></div>\n";
  }
}
} // namespace

void write_report(const StudyResults &results, const std::vector<Chart> &charts,
                  const std::string &file)
{
  const StudyFile &study = results.study;
  std::ostringstream html;
  const std::string title = escape_html(
      study.title.empty() ? "Study of " + study.scene : study.title);
  std::size_t n_complete = 0;
  for (const StudyOutcome &outcome : results.outcomes)
    n_complete += outcome.is_complete();
  html << "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
       << "<meta name='viewport' content='width=device-width'><title>" << title
       << "</title><style>" << style << "</style></head><body>\n<h1>" << title
       << "</h1>\n<p>" << n_complete << " of " << study.runs.size()
       << " runs complete; "
       << (study.is_grid ? "all combinations." : "one parameter at a time.")
       << "</p>\n<ul>";
  for (const StudyParameter &parameter : study.parameters)
  {
    html << "<li>" << escape_html(parameter.name) << ": ";
    for (std::size_t v = 0; v < parameter.values.size(); ++v)
      html << (v > 0 ? "; " : "") << escape_html(parameter.values[v].label);
    html << " <small>(";
    for (std::size_t e = 0; e < parameter.entries.size(); ++e)
      html << (e > 0 ? ", " : "") << escape_html(parameter.entries[e]);
    html << ")</small></li>";
  }
  html << "</ul>\n";
  write_runs(results, html);
  html << "<h2>Charts</h2><div class='charts'>\n";
  for (const Chart &chart : charts)
    html << "<figure>" << draw_svg(chart) << "</figure>\n";
  html << "</div>\n";
  write_scatter(results, html);
  write_ballistic(results, html);
  write_convergence(results, html);
  write_prices(results, html);
  write_energies(results, html);
  write_pictures(results, html);
  html << "</body></html>\n";
  write_text(file, html.str());
}
} // namespace sabot
