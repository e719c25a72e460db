#ifndef sabot_study_pictures_h
#define sabot_study_pictures_h

#include "sabot/base/error.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace sabot
{
/** What `sabot picture` is asked for, as the user has written it; empty: chosen
    from the run (source/charts/section_view.h says how). */
struct PictureArguments
{
  std::string folder; // of a run
  std::string file;   // FOLDER/section.png
  std::string field;  // plastic strain, or velocity where nothing can yield
  std::string title;
  std::string times;    // with units, separated by commas; the last
  std::string normal;   // x, y or z
  std::string position; // of the plane along its normal
  std::string range;    // of the colors: low, high (SI)
  std::string window;   // lengths: right low, high, up low, high
};

/** For the program that draws: a section through a run (source/charts), with
    absolute paths and SI numbers; what was not asked for is not there:

        {"kind": "section", "folder": "/...", "file": "/.../section.png",
         "title": ..., "field": "pressure", "times": [2e-5], "normal": "y",
         "position": 0.0, "range": [0, 1e9], "window": [-0.03, 0.03, ...]}

    InputError, which names the option, where a value has no meaning. */
nlohmann::ordered_json section_of(const PictureArguments &arguments);

/**
 * Draw charts and sections as PNG by sabot-charts, a process of its own under
 * a display or xvfb-run, as VTK's rendering ends a process without a display.
 * Leaves FOLDER/drawings.json, what was asked for, and FOLDER/drawings.txt,
 * what the program said. One that fails does not stop the others. @return what
 * went wrong, empty when all are drawn.
 */
std::string draw_pictures(const nlohmann::ordered_json &drawings,
                          const std::string &folder);

/** `sabot picture`: a section through a run, one panel for each time, of the
    nearest frame; says the picture's name. InputError where the run has no
    fields or a time is more than half an interval beyond them, IOError where
    nothing could be drawn. Without MPI. */
ExitCode draw_picture(const PictureArguments &arguments);
} // namespace sabot

#endif
