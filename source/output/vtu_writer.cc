// Fields of bodies as VTU files, by VTK.
#include "sabot/output/vtu_writer.h"

#include "sabot/base/error.h"
#include "sabot/output/file_names.h"
#include "sabot/output/file_tools.h"
#include "sabot/output/vtu_compressor.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>

namespace sabot
{
namespace
{
const char *const tensor_names[6] = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"};

/** The arrays of @p fields; each carries its unit. */
void add_fields(const std::vector<OutputField> &fields,
                vtkDataSetAttributes *attributes)
{
  for (const OutputField &field : fields)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(field.name.c_str());
    array->SetNumberOfComponents(field.n_components);
    array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(),
                                 field.unit.c_str());
    if (field.n_components == 6)
      for (int c = 0; c < 6; ++c)
        array->SetComponentName(c, tensor_names[c]);
    array->SetNumberOfTuples(field.values.size() / field.n_components);
    std::copy(field.values.begin(), field.values.end(), array->GetPointer(0));
    attributes->AddArray(array);
  }
}

std::string body_file(const std::string &body, const unsigned int frame)
{
  std::ostringstream stream;
  stream << file_name_of(body) << "_" << std::setw(6) << std::setfill('0')
         << frame;
  return stream.str();
}

std::string escaped(const std::string &text)
{
  std::string out;
  for (const char c : text)
    out += c == '&'   ? "&amp;"
           : c == '<' ? "&lt;"
           : c == '>' ? "&gt;"
           : c == '"' ? "&quot;"
                      : std::string(1, c);
  return out;
}
} // namespace

VtuWriter::VtuWriter(const std::string &folder, MPI_Comm communicator)
    : folder(folder), communicator(communicator)
{
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  std::string problem;
  try
  {
    if (rank == 0)
      kept = std::make_unique<KeptFolder>(folder + "/fields");
  }
  catch (const IOError &e)
  {
    problem = e.what();
  }
  agree(problem);
}

void VtuWriter::agree(const std::string &problem) const
{
  int bad = problem.empty() ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPI_INT, MPI_MAX, communicator);
  if (bad)
    throw IOError(problem.empty() ? "another rank could not write its part"
                                  : problem);
}

std::string VtuWriter::piece_name(const std::string &body,
                                  const unsigned int frame,
                                  const int piece) const
{
  return body_file(body, frame) +
         (n_ranks > 1 ? "_" + std::to_string(piece) : std::string()) + ".vtu";
}

void VtuWriter::write_body(const std::string &body, const OutputMesh &mesh,
                           const unsigned int frame)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.points.size() / 3);
  for (std::size_t i = 0; i < mesh.points.size() / 3; ++i)
    points->SetPoint(i, &mesh.points[3 * i]);
  vtkNew<vtkCellArray> cells;
  const unsigned int n = mesh.nodes_per_cell;
  // Half of the bytes to compress, where they hold the numbers of a rank.
  if (mesh.connectivity.size() <
      std::size_t(std::numeric_limits<std::int32_t>::max()))
    cells->Use32BitStorage();
  for (std::size_t c = 0; c < mesh.connectivity.size() / n; ++c)
  {
    vtkIdType nodes[8];
    for (unsigned int a = 0; a < n; ++a)
      nodes[a] = mesh.connectivity[n * c + a];
    cells->InsertNextCell(n, nodes);
  }
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  grid->SetCells(n == 1 ? VTK_VERTEX : VTK_HEXAHEDRON, cells);
  add_fields(mesh.point_fields, grid->GetPointData());
  add_fields(mesh.cell_fields, grid->GetCellData());
  // Glyphs take their color from points: there, too, where each is a cell.
  if (n == 1)
    add_fields(mesh.cell_fields, grid->GetPointData());

  std::string problem;
  const std::string file = folder + "/fields/" + piece_name(body, frame, rank);
  try
  {
    if (kept)
      kept->check();
    write_atomically(
        file,
        [&](const std::string &temporary)
        {
          // What keeps a file from being made is told by us, not by VTK, which
          // fills the screen.
          errno = 0;
          if (!std::ofstream(temporary))
            throw IOError("cannot write \"" + file +
                          "\": " + std::strerror(errno));
          vtkObject::GlobalWarningDisplayOff();
          vtkNew<vtkXMLUnstructuredGridWriter> writer;
          writer->SetFileName(temporary.c_str());
          writer->SetInputData(grid);
          vtkNew<VtuCompressor> compressor;
          writer->SetCompressor(compressor);
          writer->SetDataModeToAppended();
          writer->EncodeAppendedDataOff();
          // The name's ending is not .vtu yet; VTK would print a warning.
          if (writer->Write() != 1 || writer->GetErrorCode() != 0)
          {
            const std::string reason =
                errno != 0 ? std::strerror(errno) : "the write failed";
            throw IOError("cannot write \"" + file + "\": " + reason);
          }
        });
    if (rank == 0)
    {
      if (n_ranks > 1)
        write_collection(body, mesh, frame);
      remove_other_pieces(body, frame);
    }
  }
  catch (const IOError &e)
  {
    problem = e.what();
  }
  agree(problem);
}

void VtuWriter::remove_other_pieces(const std::string &body,
                                    const unsigned int frame) const
{
  const std::string start = folder + "/fields/" + body_file(body, frame);
  remove_file(start + (n_ranks > 1 ? ".vtu" : ".pvtu"));
  const auto piece = [&](const int i)
  { return start + "_" + std::to_string(i) + ".vtu"; };
  for (int i = n_ranks > 1 ? n_ranks : 0; std::filesystem::exists(piece(i));
       ++i)
    remove_file(piece(i));
}

std::string VtuWriter::frame_file(const std::string &body,
                                  const unsigned int frame) const
{
  const std::string start = "fields/" + body_file(body, frame);
  return start + (std::filesystem::exists(folder + "/" + start + ".pvtu")
                      ? ".pvtu"
                      : ".vtu");
}

void VtuWriter::write_collection(const std::string &body,
                                 const OutputMesh &mesh,
                                 const unsigned int frame) const
{
  std::ostringstream xml;
  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" "
         "version=\"0.1\" byte_order=\"LittleEndian\">\n"
         "<PUnstructuredGrid GhostLevel=\"0\">\n";
  const auto list =
      [&](const char *section, const std::vector<OutputField> &fields)
  {
    xml << "<" << section << ">\n";
    for (const OutputField &field : fields)
    {
      xml << "<PDataArray type=\"Float64\" Name=\"" << escaped(field.name)
          << "\" NumberOfComponents=\"" << field.n_components << "\"";
      if (field.n_components == 6)
        for (int c = 0; c < 6; ++c)
          xml << " ComponentName" << c << "=\"" << tensor_names[c] << "\"";
      xml << "/>\n";
    }
    xml << "</" << section << ">\n";
  };
  std::vector<OutputField> at_points = mesh.point_fields;
  if (mesh.nodes_per_cell == 1)
    at_points.insert(at_points.end(), mesh.cell_fields.begin(),
                     mesh.cell_fields.end());
  list("PPointData", at_points);
  list("PCellData", mesh.cell_fields);
  xml << "<PPoints><PDataArray type=\"Float64\" Name=\"Points\" "
         "NumberOfComponents=\"3\"/></PPoints>\n";
  for (int piece = 0; piece < n_ranks; ++piece)
    xml << "<Piece Source=\"" << escaped(piece_name(body, frame, piece))
        << "\"/>\n";
  xml << "</PUnstructuredGrid>\n</VTKFile>\n";
  write_text(folder + "/fields/" + body_file(body, frame) + ".pvtu", xml.str());
}

void VtuWriter::add_time(const double time, const unsigned int frame,
                         const std::vector<std::string> &bodies)
{
  frames.emplace_back(time, frame);
  std::string problem;
  if (rank == 0)
  {
    std::ostringstream xml;
    xml << std::setprecision(17)
        << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" "
           "version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for (const auto &[t, f] : frames)
      for (std::size_t b = 0; b < bodies.size(); ++b)
        xml << "<DataSet timestep=\"" << t << "\" group=\"\" part=\"" << b
            << "\" name=\"" << escaped(bodies[b]) << "\" file=\""
            << escaped(frame_file(bodies[b], f)) << "\"/>\n";
    xml << "</Collection>\n</VTKFile>\n";
    try
    {
      write_text(folder + "/sabot.pvd", xml.str());
    }
    catch (const IOError &e)
    {
      problem = e.what();
    }
  }
  agree(problem);
}
} // namespace sabot
