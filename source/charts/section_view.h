#ifndef sabot_charts_section_view_h
#define sabot_charts_section_view_h

#include "run_frames.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sabot_charts
{
/** What a picture of a section is asked to show. */
struct SectionRequest
{
  std::string folder, field, file, title;
  std::vector<double> times; // [s]; empty: the last
  std::optional<int> normal; // axis of the plane's normal; nothing: chosen
  bool has_position = false, has_range = false, has_window = false;
  double position = 0.;           // of the plane along its normal [m]
  std::array<double, 2> range{};  // of the colors, SI
  std::array<double, 4> window{}; // right low, high, up low, high [m]

  /** From an entry of kind "section". @throw std::runtime_error */
  static SectionRequest parse(const nlohmann::json &description);
};

/** A body at one time, with the field to show as array "shown": of points for
    particles, of cells or points for hexahedra. */
struct SectionBody
{
  std::string name;
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  bool is_of_particles, has_field;
  double diameter; // of particles, at the start [m]
};

struct SectionPanel
{
  double time;
  std::vector<SectionBody> bodies;
};

/** Plane, window and colors of a picture and what is in its panels. */
struct SectionView
{
  int normal, right, up; // axes; the half space along +normal is shown
  double position;       // [m]
  std::array<double, 4> window;
  std::array<double, 2> range;
  std::vector<SectionPanel> panels;

  double width() const { return window[1] - window[0]; }
  double height() const { return window[3] - window[2]; }
};

/**
 * Read the frames and choose what the request leaves open, its field, too. The
 * plane goes
 * through the fastest body: through 0 where that touches the body, else through
 * its center; "up" is the axis of its flight. The window holds the bodies that
 * are small against the largest, and what has strained by more than 1 %, but
 * for the outermost 0.5 % of the particles. @throw std::runtime_error
 */
SectionView make_view(SectionRequest &request);
} // namespace sabot_charts

#endif
