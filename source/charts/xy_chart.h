#ifndef sabot_charts_xy_chart_h
#define sabot_charts_xy_chart_h

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace sabot_charts
{
/**
 * Draw a chart of points and lines as FOLDER/<name>.png. The description is
 * what to_json() of sabot/study/chart.h gives. @return whether it was written.
 */
bool draw_chart(const nlohmann::json &description, const std::string &folder);
} // namespace sabot_charts

#endif
