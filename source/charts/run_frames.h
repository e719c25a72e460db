#ifndef sabot_charts_run_frames_h
#define sabot_charts_run_frames_h

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <string>
#include <vector>

namespace sabot_charts
{
/** A body as sabot.pvd lists it. */
struct FrameBody
{
  std::string name, file;
};

/** The bodies of a run at one time. [s] */
struct Frame
{
  double time;
  std::vector<FrameBody> bodies;
};

/** Frames of FOLDER/sabot.pvd, by time. @throw std::runtime_error when there
    are none. */
std::vector<Frame> read_frames(const std::string &folder);

/** The frame whose time is nearest. */
const Frame &nearest_frame(const std::vector<Frame> &frames, const double time);

/** Mesh of a body, from its .vtu or .pvtu file. @throw std::runtime_error */
vtkSmartPointer<vtkUnstructuredGrid> read_body(const FrameBody &body);

/** Whether the cells are single points: a body of particles. */
bool is_of_particles(vtkUnstructuredGrid *grid);

/** Mean diameter of the particles. [m] @throw std::runtime_error */
double particle_diameter(vtkUnstructuredGrid *grid);
} // namespace sabot_charts

#endif
