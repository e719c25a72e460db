#ifndef sabot_tests_geometry_vtk_files_h
#define sabot_tests_geometry_vtk_files_h

#include "mesh_files.h"

#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace sabot
{
/** The block with MaterialID 0 below and 1 above, and a face of its own. */
inline vtkNew<vtkUnstructuredGrid> make_grid()
{
  const Block block;
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto &x : block.nodes)
    points->InsertNextPoint(x.data());
  grid->SetPoints(points);
  vtkNew<vtkIntArray> ids;
  ids->SetName("MaterialID");
  for (int c = 0; c < 8; ++c)
  {
    vtkIdType nodes[8];
    for (int a = 0; a < 8; ++a)
      nodes[a] = block.cells[c][a] - 1;
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, nodes);
    ids->InsertNextValue(c / 4);
  }
  const vtkIdType face[4] = {0, 1, 4, 3};
  grid->InsertNextCell(VTK_QUAD, 4, face);
  ids->InsertNextValue(7);
  grid->GetCellData()->AddArray(ids);
  return grid;
}

constexpr int vtu_modes[] = {vtkXMLWriter::Ascii, vtkXMLWriter::Binary,
                             vtkXMLWriter::Appended};

/** Names of the files. */
inline std::string write_vtk(const int version, const bool is_binary)
{
  vtkNew<vtkUnstructuredGridWriter> writer;
  const std::string file = testing::TempDir() + "block-" +
                           std::to_string(version) + std::to_string(is_binary) +
                           ".vtk";
  writer->SetFileName(file.c_str());
  writer->SetInputData(make_grid());
  writer->SetFileVersion(version);
  is_binary ? writer->SetFileTypeToBinary() : writer->SetFileTypeToASCII();
  writer->Write();
  return file;
}

inline std::string write_vtu(const int mode, const bool is_packed,
                             const bool is_encoded)
{
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  const std::string file = testing::TempDir() + "block-" +
                           std::to_string(mode) + std::to_string(is_packed) +
                           std::to_string(is_encoded) + ".vtu";
  writer->SetFileName(file.c_str());
  writer->SetInputData(make_grid());
  writer->SetDataMode(mode);
  writer->SetEncodeAppendedData(is_encoded);
  if (!is_packed)
    writer->SetCompressorTypeToNone();
  writer->Write();
  return file;
}
} // namespace sabot

#endif
