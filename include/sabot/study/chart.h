#ifndef sabot_study_chart_h
#define sabot_study_chart_h

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace sabot
{
/**
 * A chart of points and lines, drawn as SVG for the report and by VTK as PNG
 * (source/charts). Values are in the units that the labels name, not
 * necessarily SI; the axes fit all series.
 */
struct Chart
{
  /** Points of one color, in the order in which the line joins them. */
  struct Series
  {
    std::string label;
    std::vector<double> x, y;       // points that are not finite are left out
    std::vector<std::string> names; // of the points, in the report; or empty
    bool has_line = true, has_points = false, is_dashed = false;
  };
  std::string name;                    // of its file, without ending
  std::string title, x_label, y_label; // labels with unit
  bool is_x_logarithmic = false;       // then only x > 0 is drawn
  std::vector<Series> series;
};

/** An svg element, to stand in an HTML page, whose style sheet has to know the
    classes "title", "grid" and "frame". Names of points show as tips. */
std::string draw_svg(const Chart &chart);

/**
 * For the program that draws PNG files: what draw_chart() of
 * source/charts/xy_chart.h reads,
 *
 *     {"name": ..., "title": ..., "x_label": ..., "y_label": ...,
 *      "is_x_logarithmic": false,
 *      "series": [{"label": ..., "color": "#0072B2", "has_line": true,
 *                  "has_points": false, "is_dashed": false,
 *                  "points": [[x, y], ...]}, ...]}
 *
 * with the colors of the SVG; points that cannot be drawn are left out.
 */
nlohmann::ordered_json to_json(const Chart &chart);

/** Round numbers (1, 2 or 5 times a power of ten apart) between @p low and
    @p high, about @p n of them. */
std::vector<double> axis_ticks(const double low, const double high,
                               const unsigned int n);
/** Text with &, < and > written out for HTML. */
std::string escape_html(const std::string &text);
} // namespace sabot

#endif
