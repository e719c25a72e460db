// Chooses plane, window and range of a section.
#include "section_view.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace sabot_charts
{
namespace
{
constexpr double lowest = std::numeric_limits<double>::lowest();
const char *const strain_name = "effective plastic strain";

/** Values below and above which a part of 0.5 % lies. */
std::array<double, 2> bulk(std::vector<double> values)
{
  constexpr double part = 0.005;
  const std::size_t k = part * values.size();
  std::nth_element(values.begin(), values.begin() + k, values.end());
  const double low = values[k];
  std::nth_element(values.begin(), values.end() - 1 - k, values.end());
  return {{low, *(values.end() - 1 - k)}};
}

/** Array "shown" of a grid: the field, or the length of a vector.
    @return whether the grid has the field. */
bool add_shown(vtkUnstructuredGrid *const grid, const std::string &field)
{
  for (vtkDataSetAttributes *const data :
       {static_cast<vtkDataSetAttributes *>(grid->GetPointData()),
        static_cast<vtkDataSetAttributes *>(grid->GetCellData())})
  {
    vtkDataArray *const from = data->GetArray(field.c_str());
    if (from == nullptr)
      continue;
    vtkNew<vtkDoubleArray> shown;
    shown->SetName("shown");
    shown->SetNumberOfTuples(from->GetNumberOfTuples());
    const int n = from->GetNumberOfComponents();
    for (vtkIdType i = 0; i < from->GetNumberOfTuples(); ++i)
    {
      double square = 0.;
      for (int c = 0; c < n && n == 3; ++c)
        square += std::pow(from->GetComponent(i, c), 2);
      shown->SetValue(i, n == 3 ? std::sqrt(square) : from->GetComponent(i, 0));
    }
    data->AddArray(shown);
    return true;
  }
  return false;
}

std::set<std::string> field_names(const std::vector<SectionBody> &bodies)
{
  std::set<std::string> names;
  for (const SectionBody &body : bodies)
    for (vtkDataSetAttributes *const data :
         {static_cast<vtkDataSetAttributes *>(body.grid->GetPointData()),
          static_cast<vtkDataSetAttributes *>(body.grid->GetCellData())})
      for (int a = 0; a < data->GetNumberOfArrays(); ++a)
        if (data->GetArray(a)->GetNumberOfComponents() != 6)
          names.insert(data->GetArrayName(a));
  names.erase("shown");
  return names;
}

std::vector<SectionBody> read_bodies(const Frame &frame,
                                     const std::string &field)
{
  std::vector<SectionBody> bodies;
  for (const FrameBody &body : frame.bodies)
  {
    SectionBody b;
    b.name = body.name;
    b.grid = read_body(body);
    b.is_of_particles = is_of_particles(b.grid);
    b.has_field = add_shown(b.grid, field);
    b.diameter = 0.;
    bodies.push_back(b);
  }
  return bodies;
}

std::string default_field(const Frame &frame)
{
  for (const FrameBody &body : frame.bodies)
  {
    const vtkSmartPointer<vtkUnstructuredGrid> grid = read_body(body);
    if (grid->GetPointData()->HasArray(strain_name) ||
        grid->GetCellData()->HasArray(strain_name))
      return strain_name;
  }
  return "velocity";
}

/** Mean velocity of the nodes. [m/s] */
std::array<double, 3> mean_velocity(vtkUnstructuredGrid *const grid)
{
  std::array<double, 3> mean{};
  vtkDataArray *const v = grid->GetPointData()->GetArray("velocity");
  for (vtkIdType i = 0; v != nullptr && i < v->GetNumberOfTuples(); ++i)
    for (int d = 0; d < 3; ++d)
      mean[d] += v->GetComponent(i, d) / v->GetNumberOfTuples();
  return mean;
}

void choose_plane(const SectionRequest &request,
                  const std::vector<SectionBody> &first, SectionView &view)
{
  double fastest = -1.;
  std::array<double, 3> flight{};
  vtkUnstructuredGrid *flyer = first[0].grid;
  for (const SectionBody &body : first)
  {
    const std::array<double, 3> v = mean_velocity(body.grid);
    const double speed = std::hypot(v[0], v[1], v[2]);
    if (speed > fastest)
    {
      fastest = speed;
      flight = v;
      flyer = body.grid;
    }
  }
  int along = 2;
  for (int d = 0; d < 3; ++d)
    if (std::abs(flight[d]) > std::abs(flight[along]))
      along = d;
  view.normal = request.normal.value_or(along == 1 ? 0 : 1);
  view.up = along != view.normal ? along : (view.normal + 2) % 3;
  view.right = 3 - view.normal - view.up;
  double bounds[6];
  flyer->GetBounds(bounds);
  const double low = bounds[2 * view.normal],
               high = bounds[2 * view.normal + 1], slack = 1e-6 * (high - low);
  view.position = request.has_position             ? request.position
                  : low <= slack && high >= -slack ? 0.
                                                   : 0.5 * (low + high);
}

/** Enlarge the window by the bulk of some points. */
void take_in(vtkUnstructuredGrid *const grid, const bool only_bulk,
             const double least_strain, SectionView &view)
{
  vtkDataArray *strain = grid->GetPointData()->GetArray(strain_name);
  const bool is_of_cells = strain == nullptr;
  if (is_of_cells)
    strain = grid->GetCellData()->GetArray(strain_name);
  if (least_strain >= 0. && strain == nullptr)
    return;
  std::vector<double> along[2];
  const auto add = [&](const double *const x)
  {
    along[0].push_back(x[view.right]);
    along[1].push_back(x[view.up]);
  };
  if (least_strain < 0. || !is_of_cells)
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
    {
      if (least_strain < 0. || strain->GetComponent(i, 0) > least_strain)
        add(grid->GetPoint(i));
    }
  else
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
      if (strain->GetComponent(c, 0) > least_strain)
      {
        double bounds[6];
        grid->GetCellBounds(c, bounds);
        const double x[3] = {0.5 * (bounds[0] + bounds[1]),
                             0.5 * (bounds[2] + bounds[3]),
                             0.5 * (bounds[4] + bounds[5])};
        add(x);
      }
  for (int k = 0; k < 2 && !along[0].empty(); ++k)
  {
    std::array<double, 2> range{
        {*std::min_element(along[k].begin(), along[k].end()),
         *std::max_element(along[k].begin(), along[k].end())}};
    if (only_bulk)
      range = bulk(along[k]);
    view.window[2 * k] = std::min(view.window[2 * k], range[0]);
    view.window[2 * k + 1] = std::max(view.window[2 * k + 1], range[1]);
  }
}

void choose_window(const SectionRequest &request,
                   const std::vector<SectionBody> &first, SectionView &view)
{
  if (request.has_window)
  {
    view.window = request.window;
    return;
  }
  view.window = {{-lowest, lowest, -lowest, lowest}};
  double largest = 0.;
  std::set<std::string> small;
  for (const SectionBody &body : first)
    largest = std::max(largest, body.grid->GetLength());
  for (const SectionBody &body : first)
    if (body.grid->GetLength() < 0.5 * largest)
      small.insert(body.name);
  for (const SectionPanel &panel : view.panels)
    for (const SectionBody &body : panel.bodies)
      if (small.empty() || small.count(body.name) > 0)
        take_in(body.grid, body.is_of_particles, -1., view);
      else
        take_in(body.grid, true, 0.01, view);
  const double margin = 0.04 * std::max(view.width(), view.height());
  for (const int side : {0, 2})
  {
    view.window[side] -= margin;
    view.window[side + 1] += margin;
  }
}

/** The next round number. */
double round_up(const double value)
{
  if (!(value > 0.) || !std::isfinite(value))
    return 0.;
  const double power = std::pow(10., std::floor(std::log10(value)));
  for (const double factor : {1., 1.5, 2., 3., 4., 5., 6., 8.})
    if (value <= factor * power * (1. + 1e-9))
      return factor * power;
  return 10. * power;
}

void choose_range(const SectionRequest &request, SectionView &view)
{
  if (request.has_range)
  {
    view.range = request.range;
    return;
  }
  std::vector<double> values;
  for (const SectionPanel &panel : view.panels)
    for (const SectionBody &body : panel.bodies)
      if (body.has_field)
      {
        vtkDataArray *shown = body.grid->GetPointData()->GetArray("shown");
        if (shown == nullptr)
          shown = body.grid->GetCellData()->GetArray("shown");
        for (vtkIdType i = 0; i < shown->GetNumberOfTuples(); ++i)
          values.push_back(shown->GetComponent(i, 0));
      }
  const std::array<double, 2> range = bulk(values);
  view.range = {{range[0] >= 0. && range[0] < 0.5 * range[1]
                     ? 0.
                     : std::copysign(round_up(std::abs(range[0])), range[0]),
                 std::copysign(round_up(std::abs(range[1])), range[1])}};
  // Temperatures and the like start well above 0.
  if (range[0] > 0. && view.range[0] > range[0])
    view.range[0] = range[0];
  if (!(view.range[1] > view.range[0]))
    view.range[1] = view.range[0] + 1.;
}
} // namespace

SectionRequest SectionRequest::parse(const nlohmann::json &d)
{
  SectionRequest request;
  request.folder = d.at("folder").get<std::string>();
  request.file = d.at("file").get<std::string>();
  request.field = d.value("field", "");
  request.title = d.value("title", "");
  request.times = d.value("times", std::vector<double>());
  const std::string normal = d.value("normal", "");
  if (!normal.empty())
    request.normal = normal[0] - 'x';
  const auto read = [&](const char *const name, auto &value)
  {
    if (!d.contains(name))
      return false;
    value = d[name].get<std::decay_t<decltype(value)>>();
    return true;
  };
  request.has_position = read("position", request.position);
  request.has_range = read("range", request.range);
  request.has_window = read("window", request.window);
  return request;
}

SectionView make_view(SectionRequest &request)
{
  SectionView view;
  const std::vector<Frame> frames = read_frames(request.folder);
  if (request.field.empty())
    request.field = default_field(frames.front());
  const std::vector<SectionBody> first =
      read_bodies(frames.front(), request.field);
  std::vector<double> times = request.times;
  if (times.empty())
    times.push_back(frames.back().time);
  for (const double time : times)
  {
    const Frame &frame = nearest_frame(frames, time);
    SectionPanel panel{frame.time, read_bodies(frame, request.field)};
    for (SectionBody &body : panel.bodies)
      for (const SectionBody &begin : first)
        if (body.is_of_particles && body.name == begin.name)
          body.diameter = particle_diameter(begin.grid);
    view.panels.push_back(panel);
  }
  bool has_field = false;
  for (const SectionPanel &panel : view.panels)
    for (const SectionBody &body : panel.bodies)
      has_field = has_field || body.has_field;
  if (!has_field)
  {
    std::string names;
    for (const std::string &name : field_names(view.panels[0].bodies))
      names += (names.empty() ? "" : ", ") + name;
    throw std::runtime_error("no body has a field \"" + request.field +
                             "\"; there are " + names);
  }
  choose_plane(request, first, view);
  choose_window(request, first, view);
  choose_range(request, view);
  return view;
}
} // namespace sabot_charts
