// Reads the fields that a run left.
#include "run_frames.h"

#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkStaticPointLocator.h>
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

double particle_spacing(vtkUnstructuredGrid *const grid)
{
  const vtkIdType n = grid->GetNumberOfPoints();
  if (n < 2)
    return grid->GetLength() > 0. ? grid->GetLength() : 1.;
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(grid);
  locator->BuildLocator();
  std::vector<double> distances;
  vtkNew<vtkIdList> nearest;
  const vtkIdType stride = std::max<vtkIdType>(1, n / 1000);
  for (vtkIdType i = 0; i < n; i += stride)
  {
    double x[3], y[3];
    grid->GetPoint(i, x);
    locator->FindClosestNPoints(2, x, nearest);
    double square = 0.;
    for (vtkIdType k = 0; k < nearest->GetNumberOfIds(); ++k)
    {
      grid->GetPoint(nearest->GetId(k), y);
      double sum = 0.;
      for (int d = 0; d < 3; ++d)
        sum += (x[d] - y[d]) * (x[d] - y[d]);
      square = std::max(square, sum);
    }
    distances.push_back(std::sqrt(square));
  }
  std::nth_element(distances.begin(), distances.begin() + distances.size() / 2,
                   distances.end());
  return distances[distances.size() / 2];
}
} // namespace sabot_charts
