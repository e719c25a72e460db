// Draws a section through the bodies of a run.
#include "section.h"

#include "palette_png.h"
#include "section_view.h"

#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkClipDataSet.h>
#include <vtkCutter.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkLineSource.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkRenderWindow.h>
#include <vtkScalarBarActor.h>
#include <vtkSphereSource.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace sabot_charts
{
namespace
{
/** Sizes in pixels. */
constexpr double widest = 1180., highest = 720., title_height = 44.,
                 bar_height = 66., gap = 8., caption_height = 22.;

/** Bands are told apart more easily than a gradient, and compress well. The
    colors are viridis (S. van der Walt and N. Smith), lightened at the low
    end so that quiet metal does not look black. */
vtkSmartPointer<vtkLookupTable> make_colors(const std::array<double, 2> &range)
{
  constexpr int n_bands = 16;
  constexpr unsigned char viridis[9][3] = {
      {0x5a, 0x4f, 0x7c}, {0x47, 0x2f, 0x7d}, {0x3b, 0x52, 0x8b},
      {0x2c, 0x72, 0x8e}, {0x21, 0x91, 0x8c}, {0x28, 0xae, 0x80},
      {0x5e, 0xc9, 0x62}, {0xad, 0xdc, 0x30}, {0xfd, 0xe7, 0x25}};
  vtkSmartPointer<vtkLookupTable> table =
      vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(n_bands);
  table->SetTableRange(range[0], range[1]);
  for (int b = 0; b < n_bands; ++b)
  {
    const double at = 8. * b / (n_bands - 1.);
    const int k = std::min(7, static_cast<int>(at));
    double color[3];
    for (int c = 0; c < 3; ++c)
      color[c] =
          (viridis[k][c] + (at - k) * (viridis[k + 1][c] - viridis[k][c])) /
          255.;
    table->SetTableValue(b, color[0], color[1], color[2]);
  }
  return table;
}

/** What a color bar counts in. */
struct Unit
{
  std::string text;
  double size; // SI
};

Unit unit_of(const std::string &field)
{
  return field == "von Mises" || field == "pressure" ? Unit{" [MPa]", 1e6}
         : field == "displacement"                   ? Unit{" [mm]", 1e-3}
         : field == "velocity"                       ? Unit{" [m/s]", 1.}
         : field == "temperature"                    ? Unit{" [K]", 1.}
                                                     : Unit{"", 1.};
}

class Painter
{
public:
  Painter(const SectionView &view) : view(view), colors(make_colors(view.range))
  {
    double origin[3] = {0., 0., 0.}, normal[3] = {0., 0., 0.};
    // A little inside: a symmetry plane lies on the faces of the cells, and
    // meshes have many nodes there, some a hair on this side, some on the
    // other.
    origin[view.normal] = view.position + 2e-3 * view.width();
    normal[view.normal] = 1.;
    plane->SetOrigin(origin);
    plane->SetNormal(normal);
  }

  void paint(const SectionPanel &panel, vtkRenderer *const renderer) const
  {
    for (const SectionBody &body : panel.bodies)
      if (body.is_of_particles)
        paint_particles(body, renderer);
      else if (body.grid->GetNumberOfCells() > 0)
        paint_cells(body, renderer);
    set_camera(renderer);
  }

private:
  const SectionView &view;
  vtkSmartPointer<vtkLookupTable> colors;
  vtkNew<vtkPlane> plane;

  void set_colors(vtkMapper *const mapper, vtkActor *const actor,
                  const SectionBody &body) const
  {
    if (!body.has_field)
    {
      mapper->SetScalarVisibility(false);
      actor->GetProperty()->SetColor(0.75, 0.75, 0.75);
      return;
    }
    if (body.grid->GetPointData()->HasArray("shown"))
      mapper->SetScalarModeToUsePointFieldData();
    else
      mapper->SetScalarModeToUseCellFieldData();
    mapper->SelectColorArray("shown");
    mapper->SetLookupTable(colors);
    mapper->UseLookupTableScalarRangeOn();
    mapper->SetColorModeToMapScalars();
  }

  /** Spheres that touch their neighbors at the start. */
  void paint_particles(const SectionBody &body,
                       vtkRenderer *const renderer) const
  {
    vtkNew<vtkPoints> points;
    vtkNew<vtkDoubleArray> shown;
    shown->SetName("shown");
    vtkDataArray *const values = body.grid->GetPointData()->GetArray("shown");
    for (vtkIdType i = 0; i < body.grid->GetNumberOfPoints(); ++i)
    {
      const double *const x = body.grid->GetPoint(i);
      if (x[view.normal] < view.position - 0.51 * body.diameter)
        continue;
      points->InsertNextPoint(x);
      if (values != nullptr)
        shown->InsertNextValue(values->GetComponent(i, 0));
    }
    vtkNew<vtkPolyData> cloud;
    cloud->SetPoints(points);
    if (values != nullptr)
      cloud->GetPointData()->AddArray(shown);
    vtkNew<vtkSphereSource> sphere;
    sphere->SetRadius(0.5 * body.diameter);
    sphere->SetThetaResolution(12);
    sphere->SetPhiResolution(9);
    vtkNew<vtkGlyph3DMapper> mapper;
    mapper->SetInputData(cloud);
    mapper->SetSourceConnection(sphere->GetOutputPort());
    mapper->ScalingOff();
    vtkNew<vtkActor> actor;
    set_colors(mapper, actor, body);
    actor->SetMapper(mapper);
    actor->GetProperty()->SetAmbient(0.55);
    actor->GetProperty()->SetDiffuse(0.5);
    renderer->AddActor(actor);
  }

  void paint_cells(const SectionBody &body, vtkRenderer *const renderer) const
  {
    vtkNew<vtkClipDataSet> half;
    half->SetInputData(body.grid);
    half->SetClipFunction(plane);
    vtkNew<vtkDataSetSurfaceFilter> surface;
    surface->SetInputConnection(half->GetOutputPort());
    vtkNew<vtkPolyDataMapper> outside;
    outside->SetInputConnection(surface->GetOutputPort());
    vtkNew<vtkActor> back;
    set_colors(outside, back, body);
    back->SetMapper(outside);
    back->GetProperty()->SetAmbient(0.45);
    back->GetProperty()->SetDiffuse(0.5);
    renderer->AddActor(back);

    vtkNew<vtkCutter> cutter;
    cutter->SetInputData(body.grid);
    cutter->SetCutFunction(plane);
    cutter->GenerateTrianglesOff();
    vtkNew<vtkPolyDataMapper> cut;
    cut->SetInputConnection(cutter->GetOutputPort());
    cut->SetRelativeCoincidentTopologyPolygonOffsetParameters(-2., -2.);
    cut->SetResolveCoincidentTopologyToPolygonOffset();
    vtkNew<vtkActor> front;
    set_colors(cut, front, body);
    front->SetMapper(cut);
    front->GetProperty()->LightingOff();
    front->GetProperty()->EdgeVisibilityOn();
    front->GetProperty()->SetEdgeColor(0.15, 0.15, 0.2);
    front->GetProperty()->SetLineWidth(0.6f);
    renderer->AddActor(front);
  }

  void set_camera(vtkRenderer *const renderer) const
  {
    vtkCamera *const camera = renderer->GetActiveCamera();
    double focus[3], eye[3], up[3] = {0., 0., 0.};
    focus[view.normal] = eye[view.normal] = view.position;
    focus[view.right] = eye[view.right] =
        0.5 * (view.window[0] + view.window[1]);
    focus[view.up] = eye[view.up] = 0.5 * (view.window[2] + view.window[3]);
    eye[view.normal] -= 10. * std::max(view.width(), view.height());
    up[view.up] = 1.;
    camera->SetFocalPoint(focus);
    camera->SetPosition(eye);
    camera->SetViewUp(up);
    camera->ParallelProjectionOn();
    camera->SetParallelScale(0.5 * view.height());
    renderer->ResetCameraClippingRange();
  }
};

void add_text(vtkRenderer *const renderer, const std::string &text,
              const double x, const double y, const int size,
              const bool is_centered)
{
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  actor->SetPosition(x, y);
  actor->GetTextProperty()->SetFontSize(size);
  actor->GetTextProperty()->SetColor(0.1, 0.1, 0.1);
  if (is_centered)
    actor->GetTextProperty()->SetJustificationToCentered();
  renderer->AddActor2D(actor);
}

/** A line of round length in a corner of a panel. */
void add_scale(vtkRenderer *const renderer, const SectionView &view,
               const double pixels_per_meter)
{
  const double power = std::pow(10., std::floor(std::log10(view.width() / 4.)));
  const double mantissa = view.width() / 4. / power;
  const double length = power * (mantissa >= 5.   ? 5.
                                 : mantissa >= 2. ? 2.
                                                  : 1.);
  vtkNew<vtkLineSource> line;
  line->SetPoint1(10., 12., 0.);
  line->SetPoint2(10. + length * pixels_per_meter, 12., 0.);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputConnection(line->GetOutputPort());
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.1, 0.1, 0.1);
  actor->GetProperty()->SetLineWidth(3.f);
  renderer->AddActor2D(actor);
  char text[40];
  std::snprintf(text, sizeof(text), "%g mm", 1e3 * length);
  add_text(renderer, text, 10., 16., 13, false);
}

/** Where the panels stand. Sizes in pixels. */
struct Layout
{
  std::size_t n_columns = 1, n_rows = 1;
  double scale = 0.; // [pixels/m]
  double panel_width, panel_height;
  double width, height; // of the picture

  double row_height() const { return panel_height + caption_height + gap; }
  /** Lower left corner of panel @p p, rows from the top. */
  std::array<double, 2> corner(const std::size_t p) const
  {
    const double left = 0.5 * (width - n_columns * (panel_width + gap) + gap);
    return {{left + (p % n_columns) * (panel_width + gap),
             bar_height + (n_rows - 1 - p / n_columns) * row_height()}};
  }
};

/** As many columns as make the panels largest. */
Layout make_layout(const SectionView &view)
{
  const std::size_t n = view.panels.size();
  Layout layout;
  for (std::size_t c = 1; c <= n; ++c)
  {
    const std::size_t n_rows = (n + c - 1) / c;
    const double s =
        std::min((widest - gap * (c + 1)) / (c * view.width()),
                 (highest - gap * n_rows) / (n_rows * view.height()));
    if (s > layout.scale)
    {
      layout.scale = s;
      layout.n_columns = c;
      layout.n_rows = n_rows;
    }
  }
  layout.panel_width = std::floor(layout.scale * view.width());
  layout.panel_height = std::floor(layout.scale * view.height());
  layout.width =
      std::max(560., gap + layout.n_columns * (layout.panel_width + gap));
  layout.height =
      title_height + bar_height + layout.n_rows * layout.row_height();
  return layout;
}

void add_color_bar(vtkRenderer *const page, const SectionView &view,
                   const std::string &field, const double height)
{
  vtkNew<vtkScalarBarActor> bar;
  const Unit unit = unit_of(field);
  const vtkSmartPointer<vtkLookupTable> colors =
      make_colors({{view.range[0] / unit.size, view.range[1] / unit.size}});
  bar->SetLookupTable(colors);
  bar->SetOrientationToHorizontal();
  bar->SetTitle("");
  bar->SetNumberOfLabels(5);
  bar->SetLabelFormat("%.4g");
  bar->UnconstrainedFontSizeOn();
  vtkTextProperty *const label = bar->GetLabelTextProperty();
  label->SetFontSize(14);
  label->SetColor(0.1, 0.1, 0.1);
  label->ShadowOff();
  label->ItalicOff();
  label->BoldOff();
  bar->SetPosition(0.3, 4. / height);
  bar->SetWidth(0.65);
  bar->SetHeight((bar_height - 14.) / height);
  page->AddActor2D(bar);
  add_text(page, field + unit.text, 12., 24., 15, false);
}
} // namespace

void draw_section(const nlohmann::json &description)
{
  SectionRequest request = SectionRequest::parse(description);
  const SectionView view = make_view(request);
  const Layout layout = make_layout(view);
  const double width = layout.width, height = layout.height;
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(4);
  window->SetSize(width, height);

  vtkNew<vtkRenderer> page;
  page->SetBackground(1., 1., 1.);
  window->AddRenderer(page);
  add_text(page, request.title, 0.5 * width, height - 28., 18, true);
  const Painter painter(view);
  for (std::size_t p = 0; p < view.panels.size(); ++p)
  {
    const auto [x, y] = layout.corner(p);
    vtkNew<vtkRenderer> renderer;
    renderer->SetViewport(x / width, y / height,
                          (x + layout.panel_width) / width,
                          (y + layout.panel_height) / height);
    renderer->SetBackground(0.965, 0.965, 0.965);
    window->AddRenderer(renderer);
    painter.paint(view.panels[p], renderer);
    char text[80];
    std::snprintf(text, sizeof(text), "t = %.4g ms", 1e3 * view.panels[p].time);
    add_text(page, text, x + 2., y + layout.panel_height + 5., 15, false);
    if (p == 0)
      add_scale(renderer, view, layout.scale);
  }
  add_color_bar(page, view, request.field, height);
  window->Render();
  write_palette_png(window, request.file);
}
} // namespace sabot_charts
