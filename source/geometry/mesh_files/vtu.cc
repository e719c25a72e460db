// Meshes of ParaView (.vtu), by VTK's reader. It trusts counts, so these are
// compared with the file before.
#include "sabot/geometry/vtk_cells.h"
#include "sabot/geometry/vtu_scan.h"

#include "sabot/base/text.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace sabot
{
namespace
{
/** Keeps what VTK says, in place of its printing it. */
class Listener : public vtkOutputWindow
{
public:
  static Listener *New() { VTK_STANDARD_NEW_BODY(Listener); }
  void DisplayText(const char *text) override
  {
    if (said.empty())
      said = reason(text);
  }
  // VTK warns of data that are too short: warnings count as well.
  void DisplayErrorText(const char *text) override { DisplayText(text); }
  void DisplayWarningText(const char *text) override { DisplayText(text); }
  void DisplayGenericWarningText(const char *text) override
  {
    DisplayText(text);
  }

  std::string said; // the first

private:
  /** Without VTK's "ERROR: In FILE, line 5 / vtkClass (0x55): ". */
  static std::string reason(const char *const text)
  {
    std::string last = text;
    const std::size_t colon = last.find("): ");
    last = trim(colon == std::string::npos ? last : last.substr(colon + 3));
    last = last.substr(0, last.find('\n'));
    for (char &c : last)
      c = c >= ' ' && c <= '~' ? c : '?';
    return last.empty() ? "it is not as the format wants it"
                        : last.substr(0, 200);
  }
};

/** VTK speaks to @p listener while this lives. */
class Listening
{
public:
  explicit Listening(Listener *listener)
      : before(vtkOutputWindow::GetInstance())
  {
    vtkOutputWindow::SetInstance(listener);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~Listening()
  {
    vtkOutputWindow::SetInstance(before);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_INFO);
  }
  Listening(const Listening &) = delete;
  Listening &operator=(const Listening &) = delete;

private:
  const vtkSmartPointer<vtkOutputWindow> before;
};

/** The values of an array, of one component but for points; none where there is
    no array. */
template <typename T>
std::vector<T> values_of(vtkDataArray *const array)
{
  std::vector<T> values;
  if (array == nullptr)
    return values;
  const int width = array->GetNumberOfComponents();
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    for (int c = 0; c < width; ++c)
      values.push_back(array->GetComponent(i, c));
  return values;
}

FileMesh take_grid(vtkUnstructuredGrid *grid, const MeshFile &file)
{
  VtkCells cells;
  vtkPoints *const points = grid->GetPoints();
  if (points == nullptr || grid->GetCells() == nullptr ||
      grid->GetCellTypesArray() == nullptr ||
      points->GetData()->GetNumberOfComponents() != 3)
    file.refuse("it has no points or no cells");
  cells.points = values_of<double>(points->GetData());
  cells.offsets = values_of<std::int64_t>(grid->GetCells()->GetOffsetsArray());
  cells.connectivity =
      values_of<std::int64_t>(grid->GetCells()->GetConnectivityArray());
  cells.types = values_of<std::int64_t>(grid->GetCellTypesArray());
  for (const std::string &name : vtk_id_names)
  {
    vtkDataArray *const array = grid->GetCellData()->GetArray(name.c_str());
    if (array == nullptr || array->GetNumberOfComponents() != 1)
      continue;
    cells.ids = values_of<double>(array);
    cells.ids_name = name;
    break;
  }
  return make_file_mesh(cells, file);
}

class VtuReader : public MeshReader
{
public:
  bool takes(const std::string &ending) const override
  {
    return ending == "vtu";
  }
  FileMesh read(const MeshFile &file) const override
  {
    scan_vtu(file);
    vtkNew<Listener> listener;
    const Listening listening(listener);
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(file.name.c_str());
    try
    {
      reader->Update();
    }
    catch (const std::exception &)
    {
      file.refuse("it is not as the format wants it");
    }
    if (!listener->said.empty())
      file.refuse("VTK's reader says: " + listener->said);
    return take_grid(reader->GetOutput(), file);
  }
};

const Registry<MeshReader>::Add
    added({"VTK XML", ".vtu, as ParaView saves it.", nullptr,
           [] { return std::make_unique<VtuReader>(); }});
} // namespace
} // namespace sabot
