// Charts of points and lines as SVG, and as JSON for the program that draws
// PNG.
#include "sabot/study/chart.h"

#include "sabot/base/text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace sabot
{
namespace
{
// Colors that stay apart for color-blind readers (M. Okabe and K. Ito, 2008).
const std::vector<std::string> colors = {"#0072B2", "#D55E00", "#009E73",
                                         "#CC79A7", "#E69F00", "#56B4E9",
                                         "#000000", "#8C6D31"};

constexpr double width = 640., height = 380., left = 80., right = 20.,
                 top = 34., bottom = 52.;

std::string short_number(const double value)
{
  return formatted("%.4g", std::abs(value) < 1e-300 ? 0. : value);
}

struct Axis
{
  double low, high;
  bool logarithmic;
  double from, to; // on the page

  double place(const double value) const
  {
    const double v = logarithmic ? std::log10(value) : value;
    return from + (to - from) * (v - low) / (high - low);
  }
  bool takes(const double value) const
  {
    return std::isfinite(value) && (!logarithmic || value > 0.);
  }
};

Axis make_axis(const Chart &chart, const bool is_x)
{
  Axis axis{std::numeric_limits<double>::max(),
            std::numeric_limits<double>::lowest(),
            is_x && chart.is_x_logarithmic, is_x ? left : height - bottom,
            is_x ? width - right : top};
  for (const Chart::Series &series : chart.series)
    for (const double value : is_x ? series.x : series.y)
      if (axis.takes(value))
      {
        const double v = axis.logarithmic ? std::log10(value) : value;
        axis.low = std::min(axis.low, v);
        axis.high = std::max(axis.high, v);
      }
  if (axis.low > axis.high)
    axis.low = axis.high = 0.;
  double margin = 0.05 * (axis.high - axis.low);
  if (margin <= 1e-9 * std::max(std::abs(axis.low), std::abs(axis.high)))
    margin = std::max(0.05 * std::abs(axis.high), 1e-300);
  if (axis.low == 0. && axis.high == 0.)
    margin = 1.;
  axis.low -= margin;
  axis.high += margin;
  return axis;
}

void draw_axis(std::ostream &svg, const Axis &axis, const bool is_x)
{
  for (double tick : axis_ticks(axis.low, axis.high, is_x ? 6 : 5))
  {
    const double value = axis.logarithmic ? std::pow(10., tick) : tick;
    const double p = axis.place(value);
    if (is_x)
      svg << "<line x1='" << p << "' x2='" << p << "' y1='" << top << "' y2='"
          << height - bottom << "' class='grid'/><text x='" << p << "' y='"
          << height - bottom + 18 << "' text-anchor='middle'>"
          << short_number(value) << "</text>\n";
    else
      svg << "<line y1='" << p << "' y2='" << p << "' x1='" << left << "' x2='"
          << width - right << "' class='grid'/><text x='" << left - 6 << "' y='"
          << p + 4 << "' text-anchor='end'>" << short_number(value)
          << "</text>\n";
  }
}
} // namespace

std::string escape_html(const std::string &text)
{
  std::string out;
  for (const char c : text)
    out += c == '&'    ? "&amp;"
           : c == '<'  ? "&lt;"
           : c == '>'  ? "&gt;"
           : c == '\'' ? "&#39;"
           : c == '"'  ? "&quot;"
                       : std::string(1, c);
  return out;
}

std::vector<double> axis_ticks(const double low, const double high,
                               const unsigned int n)
{
  const double rough = (high - low) / n;
  const double power = std::pow(10., std::floor(std::log10(rough)));
  const double factor = rough / power;
  const double step = power * (factor < 1.5   ? 1.
                               : factor < 3.5 ? 2.
                               : factor < 7.5 ? 5.
                                              : 10.);
  std::vector<double> ticks;
  for (double i = std::ceil(low / step); i * step <= high; i += 1.)
    ticks.push_back(i * step);
  return ticks;
}

std::string draw_svg(const Chart &chart)
{
  const Axis x = make_axis(chart, true), y = make_axis(chart, false);
  const double legend = 18. * chart.series.size() + 8.;
  std::ostringstream svg;
  svg.precision(6);
  svg << "<svg viewBox='0 0 " << width << " " << height + legend
      << "' role='img'>\n<text x='" << 0.5 * width
      << "' y='20' class='title' text-anchor='middle'>"
      << escape_html(chart.title) << "</text>\n";
  draw_axis(svg, x, true);
  draw_axis(svg, y, false);
  svg << "<rect x='" << left << "' y='" << top << "' width='"
      << width - left - right << "' height='" << height - top - bottom
      << "' class='frame'/>\n<text x='" << 0.5 * (left + width - right)
      << "' y='" << height - 12 << "' text-anchor='middle'>"
      << escape_html(chart.x_label) << "</text>\n<text transform='translate(16,"
      << 0.5 * (top + height - bottom) << ") rotate(-90)' text-anchor='middle'>"
      << escape_html(chart.y_label) << "</text>\n";
  for (std::size_t s = 0; s < chart.series.size(); ++s)
  {
    const Chart::Series &series = chart.series[s];
    const std::string &color = colors[s % colors.size()];
    std::ostringstream points, circles;
    for (std::size_t i = 0; i < series.x.size(); ++i)
    {
      if (!x.takes(series.x[i]) || !y.takes(series.y[i]))
        continue;
      const double px = x.place(series.x[i]), py = y.place(series.y[i]);
      points << px << "," << py << " ";
      if (series.has_points)
        circles << "<circle cx='" << px << "' cy='" << py << "' r='4' fill='"
                << color << "'>"
                << (i < series.names.size()
                        ? "<title>" + escape_html(series.names[i]) + "</title>"
                        : "")
                << "</circle>";
    }
    const std::string dash = series.is_dashed ? " stroke-dasharray='7 4'" : "";
    if (series.has_line)
      svg << "<polyline fill='none' stroke='" << color << "' stroke-width='1.6'"
          << dash << " points='" << points.str() << "'/>";
    svg << circles.str();
    const double ly = height + 12. + 18. * s;
    if (series.has_line)
      svg << "<line x1='" << left << "' x2='" << left + 26 << "' y1='" << ly - 4
          << "' y2='" << ly - 4 << "' stroke='" << color << "' stroke-width='2'"
          << dash << "/>";
    if (series.has_points)
      svg << "<circle cx='" << left + 13 << "' cy='" << ly - 4
          << "' r='4' fill='" << color << "'/>";
    svg << "<text x='" << left + 34 << "' y='" << ly << "'>"
        << escape_html(series.label) << "</text>\n";
  }
  svg << "</svg>\n";
  return svg.str();
}

nlohmann::ordered_json to_json(const Chart &chart)
{
  nlohmann::ordered_json json;
  json["name"] = chart.name;
  json["title"] = chart.title;
  json["x_label"] = chart.x_label;
  json["y_label"] = chart.y_label;
  json["is_x_logarithmic"] = chart.is_x_logarithmic;
  json["series"] = nlohmann::ordered_json::array();
  for (std::size_t s = 0; s < chart.series.size(); ++s)
  {
    const Chart::Series &series = chart.series[s];
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < series.x.size(); ++i)
      if (std::isfinite(series.x[i]) && std::isfinite(series.y[i]) &&
          (!chart.is_x_logarithmic || series.x[i] > 0.))
        points.push_back({series.x[i], series.y[i]});
    json["series"].push_back({{"label", series.label},
                              {"color", colors[s % colors.size()]},
                              {"has_line", series.has_line},
                              {"has_points", series.has_points},
                              {"is_dashed", series.is_dashed},
                              {"points", points}});
  }
  return json;
}
} // namespace sabot
