// Draws a chart of points and lines by VTK.
#include "xy_chart.h"

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkPNGWriter.h>
#include <vtkRenderer.h>
#include <vtkRenderWindow.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>

namespace sabot_charts
{
using nlohmann::json;

namespace
{
void add_series(vtkChartXY *chart, const json &series)
{
  vtkNew<vtkTable> table;
  for (const char *const name : {"x", "y"})
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(name);
    table->AddColumn(column);
  }
  const json &points = series["points"];
  // A VTK line needs two points; one is drawn twice.
  const std::size_t n = points.size() == 1 ? 2 : points.size();
  if (n == 0)
    return;
  table->SetNumberOfRows(n);
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 2; ++c)
      table->SetValue(i, c,
                      points[points.size() == 1 ? 0 : i][c].get<double>());
  const std::string color = series["color"];
  unsigned int r = 0, g = 0, b = 0;
  std::sscanf(color.c_str(), "#%2x%2x%2x", &r, &g, &b);
  const bool has_line = series["has_line"], has_points = series["has_points"];
  vtkPlotPoints *const plot = vtkPlotPoints::SafeDownCast(
      chart->AddPlot(has_line ? vtkChart::LINE : vtkChart::POINTS));
  plot->SetInputData(table, 0, 1);
  plot->SetLabel(series["label"].get<std::string>());
  plot->SetColor(r, g, b, 255);
  plot->SetWidth(2.f);
  if (series["is_dashed"])
    plot->GetPen()->SetLineType(vtkPen::DASH_LINE);
  plot->SetMarkerStyle(has_points ? vtkPlotPoints::CIRCLE
                                  : vtkPlotPoints::NONE);
  plot->SetMarkerSize(9.f);
}

} // namespace

bool draw_chart(const json &description, const std::string &folder)
{
  vtkNew<vtkContextView> view;
  view->GetRenderWindow()->SetSize(1000, 680);
  view->GetRenderWindow()->SetOffScreenRendering(1);
  view->GetRenderer()->SetBackground(1., 1., 1.);
  vtkNew<vtkChartXY> chart;
  view->GetScene()->AddItem(chart);
  chart->SetTitle(description["title"].get<std::string>());
  chart->GetTitleProperties()->SetFontSize(18);
  chart->SetShowLegend(true);
  const std::pair<int, const char *> axes[] = {{vtkAxis::BOTTOM, "x_label"},
                                               {vtkAxis::LEFT, "y_label"}};
  for (const auto &[which, label] : axes)
  {
    vtkAxis *const axis = chart->GetAxis(which);
    axis->SetTitle(description[label].get<std::string>());
    axis->GetTitleProperties()->SetFontSize(15);
    axis->GetLabelProperties()->SetFontSize(13);
  }
  chart->GetAxis(vtkAxis::BOTTOM)
      ->SetLogScale(description["is_x_logarithmic"].get<bool>());
  for (const json &series : description["series"])
    add_series(chart, series);
  view->GetRenderWindow()->SetMultiSamples(0);
  view->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(view->GetRenderWindow());
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(
      (folder + "/" + description["name"].get<std::string>() + ".png").c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
  return writer->GetErrorCode() == 0;
}
} // namespace sabot_charts
