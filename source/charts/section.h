#ifndef sabot_charts_section_h
#define sabot_charts_section_h

#include <nlohmann/json_fwd.hpp>

namespace sabot_charts
{
/**
 * Draw a section through all bodies of a run as PNG: the cut cells, and the
 * particles and the outside of what lies behind the plane, colored by a field;
 * one panel per time. Entries of the description: "folder" (of the run), "file"
 * (of the picture), and as far as it is not to be chosen "field", "title",
 * "times" [s], "normal" ("x", "y" or "z"), "position" [m], "range", "window"
 * [m] (right low, high, up low, high). @throw std::exception with a message.
 */
void draw_section(const nlohmann::json &description);
} // namespace sabot_charts

#endif
