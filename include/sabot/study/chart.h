#ifndef sabot_study_chart_h
#define sabot_study_chart_h

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace sabot
{
/** A chart of points and lines, drawn as SVG for the report and by VTK as PNG
    (source/charts). */
struct Chart
{
  struct Series
  {
    std::string label;
    std::vector<double> x, y;       // points that are not finite are left out
    std::vector<std::string> names; // of the points, in the report; or empty
    bool has_line = true, has_points = false, is_dashed = false;
  };
  std::string name; // of its file
  std::string title, x_label, y_label;
  bool is_x_logarithmic = false;
  std::vector<Series> series;
};

/** An svg element, to stand in an HTML page. */
std::string draw_svg(const Chart &chart);

/** For the program that draws PNG files. */
nlohmann::ordered_json to_json(const Chart &chart);

/** Round numbers between @p low and @p high, about @p n of them. */
std::vector<double> axis_ticks(const double low, const double high,
                               const unsigned int n);
/** Text with &, < and > written out for HTML. */
std::string escape_html(const std::string &text);
} // namespace sabot

#endif
