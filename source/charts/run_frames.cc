// Reads the fields that a run left.
#include "run_frames.h"

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace sabot_charts
{
namespace
{
/** Value of an attribute of a line of XML, empty where there is none. */
std::string attribute(const std::string &line, const std::string &name)
{
  const std::string start = " " + name + "=\"";
  const std::size_t begin = line.find(start);
  if (begin == std::string::npos)
    return "";
  const std::size_t from = begin + start.size(), to = line.find('"', from);
  return to == std::string::npos ? "" : line.substr(from, to - from);
}

bool ends_with(const std::string &text, const std::string &end)
{
  return text.size() >= end.size() &&
         text.compare(text.size() - end.size(), end.size(), end) == 0;
}
} // namespace

std::vector<Frame> read_frames(const std::string &folder)
{
  const std::string name = folder + "/sabot.pvd";
  std::ifstream file(name);
  if (!file)
    throw std::runtime_error("cannot read \"" + name +
                             "\"; the scene needs an output of type VTU");
  std::vector<Frame> frames;
  for (std::string line; std::getline(file, line);)
  {
    if (line.find("<DataSet") == std::string::npos)
      continue;
    const double time = std::stod("0" + attribute(line, "timestep"));
    if (frames.empty() || frames.back().time != time)
      frames.push_back({time, {}});
    frames.back().bodies.push_back(
        {attribute(line, "name"), folder + "/" + attribute(line, "file")});
  }
  if (frames.empty())
    throw std::runtime_error("\"" + name + "\" lists no fields");
  return frames;
}

const Frame &nearest_frame(const std::vector<Frame> &frames, const double time)
{
  return *std::min_element(
      frames.begin(), frames.end(),
      [&](const Frame &a, const Frame &b)
      { return std::abs(a.time - time) < std::abs(b.time - time); });
}

vtkSmartPointer<vtkUnstructuredGrid> read_body(const FrameBody &body)
{
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  const auto read = [&](auto &reader)
  {
    reader->SetFileName(body.file.c_str());
    reader->Update();
    grid = reader->GetOutput();
    if (reader->GetErrorCode() != 0)
      grid = nullptr;
  };
  // VTK would only print a complaint.
  if (!std::ifstream(body.file))
    throw std::runtime_error("cannot read \"" + body.file + "\"");
  if (ends_with(body.file, ".pvtu"))
  {
    vtkNew<vtkXMLPUnstructuredGridReader> reader;
    read(reader);
  }
  else
  {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    read(reader);
  }
  if (!grid)
    throw std::runtime_error("cannot read \"" + body.file + "\"");
  return grid;
}

bool is_of_particles(vtkUnstructuredGrid *const grid)
{
  return grid->GetNumberOfCells() > 0 && grid->GetCellType(0) == VTK_VERTEX;
}

double particle_diameter(vtkUnstructuredGrid *const grid)
{
  vtkDataArray *const diameters = grid->GetPointData()->GetArray("diameter");
  if (diameters == nullptr)
    throw std::runtime_error("the particles have no field \"diameter\": these "
                             "are results of an older program");
  double sum = 0.;
  const vtkIdType n = diameters->GetNumberOfTuples();
  for (vtkIdType i = 0; i < n; ++i)
    sum += diameters->GetComponent(i, 0);
  return sum / n;
}
} // namespace sabot_charts
