#ifndef sabot_study_pictures_h
#define sabot_study_pictures_h

#include "sabot/base/error.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace sabot
{
/** What `sabot picture` is asked for; empty: chosen from the run. */
struct PictureArguments
{
  std::string folder; // of a run
  std::string file;   // FOLDER/section.png
  std::string field;  // plastic strain, or velocity where nothing can yield
  std::string title;
  std::string times;    // with units, separated by commas; the last
  std::string normal;   // x, y or z
  std::string position; // of the plane along its normal
  std::string range;    // of the colours: low, high (SI)
  std::string window;   // lengths: right low, high, up low, high
};

/** For the program that draws: a section through a run (source/charts).
    InputError where a value has no meaning. */
nlohmann::ordered_json section_of(const PictureArguments &arguments);

/**
 * Draw charts and sections as PNG by sabot-charts, a process of its own under
 * a display or xvfb-run, as VTK's rendering ends a process without a display.
 * Leaves FOLDER/drawings.json. @return what went wrong, empty when all are
 * drawn.
 */
std::string draw_pictures(const nlohmann::ordered_json &drawings,
                          const std::string &folder);

/** `sabot picture`: a section through a run. InputError, IOError. */
ExitCode draw_picture(const PictureArguments &arguments);
} // namespace sabot

#endif
