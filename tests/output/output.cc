// Files of a run: history, fields, log.
#include "temporary_folder.h"

#include "sabot/base/error.h"
#include "sabot/output/file_lock.h"
#include "sabot/output/file_tools.h"
#include "sabot/output/history.h"
#include "sabot/output/kept_folder.h"
#include "sabot/output/vtu_writer.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace
{
using namespace sabot;

class WrittenOutput : public TemporaryFolder
{
protected:
  std::string read(const std::string &file)
  {
    std::ifstream stream(folder + "/" + file, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }
};

OutputMesh two_cells()
{
  OutputMesh mesh;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i)
        for (const double x : {i / 3., j / 7., k + 1e-13})
          mesh.points.push_back(x);
  const auto at = [](int i, int j, int k) { return i + 3 * (j + 2 * k); };
  for (int i = 0; i < 2; ++i)
    for (const int k : {0, 1})
      for (const int a :
           {at(i, 0, k), at(i + 1, 0, k), at(i + 1, 1, k), at(i, 1, k)})
        mesh.connectivity.push_back(a);
  OutputField velocity{"velocity", "m/s", 3, {}};
  for (int i = 0; i < 36; ++i)
    velocity.values.push_back(i / 3.);
  mesh.point_fields.push_back(velocity);
  mesh.cell_fields.push_back(
      {"stress", "Pa", 6, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12. / 7.}});
  return mesh;
}

TEST_F(WrittenOutput, hexahedra_are_read_back_by_vtk_to_the_last_bit)
{
  VtuWriter writer(folder, MPI_COMM_WORLD);
  const OutputMesh mesh = two_cells();
  writer.write_body("plate", mesh, 3);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((folder + "/fields/plate_000003.vtu").c_str());
  reader->Update();
  vtkUnstructuredGrid *const grid = reader->GetOutput();
  ASSERT_EQ(grid->GetNumberOfPoints(), 12);
  ASSERT_EQ(grid->GetNumberOfCells(), 2);
  EXPECT_EQ(grid->GetCellType(0), VTK_HEXAHEDRON);
  for (int i = 0; i < 12; ++i)
    for (int d = 0; d < 3; ++d)
      EXPECT_EQ(grid->GetPoint(i)[d], mesh.points[3 * i + d]);
  vtkDataArray *const v = grid->GetPointData()->GetArray("velocity");
  ASSERT_NE(v, nullptr);
  EXPECT_EQ(v->GetComponent(11, 2), 35. / 3.);
  vtkDataArray *const s = grid->GetCellData()->GetArray("stress");
  ASSERT_NE(s, nullptr);
  EXPECT_EQ(s->GetNumberOfComponents(), 6);
  EXPECT_EQ(s->GetComponent(1, 5), 12. / 7.);
  EXPECT_STREQ(s->GetComponentName(3), "XY");
  EXPECT_NE(read("fields/plate_000003.vtu").find("vtkZLibDataCompressor"),
            std::string::npos);
}

TEST_F(WrittenOutput, noise_is_stored_and_what_repeats_is_compressed)
{
  constexpr std::size_t n = 20000;
  OutputMesh cloud;
  cloud.nodes_per_cell = 1;
  cloud.points.assign(3 * n, 0.);
  std::vector<double> noise(n);
  std::mt19937_64 random(5);
  for (std::size_t i = 0; i < n; ++i)
  {
    cloud.connectivity.push_back(i);
    noise[i] = std::uniform_real_distribution<double>(-1., 1.)(random);
  }
  cloud.point_fields.push_back({"velocity", "m/s", 1, noise});
  VtuWriter(folder, MPI_COMM_WORLD).write_body("core", cloud, 0);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((folder + "/fields/core_000000.vtu").c_str());
  reader->Update();
  vtkDataArray *const v =
      reader->GetOutput()->GetPointData()->GetArray("velocity");
  ASSERT_NE(v, nullptr);
  for (std::size_t i = 0; i < n; ++i)
    ASSERT_EQ(v->GetComponent(i, 0), noise[i]);
  // Points are zeros, connectivity counts up.
  const double size = read("fields/core_000000.vtu").size(),
               bytes_of_noise = n * sizeof(double);
  EXPECT_GT(size, bytes_of_noise);
  EXPECT_LT(size, bytes_of_noise + n * 4.);
}

TEST_F(WrittenOutput, particles_and_the_collection)
{
  VtuWriter writer(folder, MPI_COMM_WORLD);
  OutputMesh cloud;
  cloud.nodes_per_cell = 1;
  cloud.points = {0, 0, 0, 1, 2, 3};
  cloud.connectivity = {0, 1};
  writer.write_body("core", cloud, 0);
  writer.write_body("empty", OutputMesh(), 0);
  writer.add_time(0.25, 0, {"core", "empty"});
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((folder + "/fields/core_000000.vtu").c_str());
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfCells(), 2);
  EXPECT_EQ(reader->GetOutput()->GetCellType(1), VTK_VERTEX);
  const std::string pvd = read("sabot.pvd");
  EXPECT_NE(pvd.find("timestep=\"0.25\" group=\"\" part=\"0\" name=\"core\" "
                     "file=\"fields/core_000000.vtu\""),
            std::string::npos);
  EXPECT_NE(pvd.find("part=\"1\""), std::string::npos);
}

TEST_F(WrittenOutput, history_reads_back_and_equal_runs_give_equal_bytes)
{
  History history;
  for (int i = 0; i < 5; ++i)
    history.append("ledger", {{"time", "s", i / 3.}, {"kinetic", "J", 7. * i}});
  history.write(folder + "/a.h5");
  history.write(folder + "/b.h5");
  EXPECT_EQ(read("a.h5"), read("b.h5"));
  EXPECT_GT(read("a.h5").size(), 0u);
  History back;
  back.read(folder + "/a.h5");
  EXPECT_EQ(back.tables["ledger"].columns,
            (std::vector<std::string>{"time [s]", "kinetic [J]"}));
  EXPECT_EQ(back.tables["ledger"].values, history.tables["ledger"].values);
}

TEST_F(WrittenOutput, trouble_with_the_disk_is_an_io_error)
{
  EXPECT_THROW(write_text(folder + "/no/such/folder/x", "text"), IOError);
  EXPECT_THROW(History().write("/proc/history.h5"), IOError);
  std::ofstream(folder + "/file") << "x";
  EXPECT_THROW(VtuWriter(folder + "/file", MPI_COMM_WORLD), IOError);
}

using Folders = TemporaryFolder;

TEST_F(Folders, that_are_gone_or_replaced_are_told)
{
  namespace fs = std::filesystem;
  const std::string path = folder + "/a/b";
  const KeptFolder kept(path);
  EXPECT_EQ(kept.trouble(), "");
  std::ofstream(path + "/file") << "what it holds does not matter";
  EXPECT_EQ(kept.trouble(), "");
  fs::rename(path, folder + "/c");
  EXPECT_NE(kept.trouble().find("is gone"), std::string::npos);
  fs::create_directory(path);
  EXPECT_NE(kept.trouble().find("has been replaced"), std::string::npos);
  EXPECT_THROW(kept.check(), IOError);
  fs::remove(path);
  fs::rename(folder + "/c", path); // moved back
  EXPECT_EQ(kept.trouble(), "");
  fs::remove_all(path);
  fs::create_directory(path); // perhaps under the same number
  EXPECT_NE(kept.trouble().find("has been replaced"), std::string::npos);
}

TEST_F(Folders, a_lock_has_one_owner)
{
  const std::string file = folder + "/lock";
  {
    const FileLock first(file);
    EXPECT_TRUE(first.is_held());
    const FileLock second(file);
    EXPECT_FALSE(second.is_held());
    EXPECT_EQ(second.holder(), "process " + std::to_string(getpid()));
    // Without its file it is nobody's business any more.
    std::filesystem::remove(file);
    const FileLock third(file);
    EXPECT_TRUE(third.is_held());
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_TRUE(FileLock(file).is_held());
  EXPECT_THROW(FileLock(folder + "/nowhere/lock"), IOError);
}

TEST_F(Folders, a_history_that_is_none_is_refused)
{
  History history;
  history.append("a", {{"time", "s", 1.}, {"speed", "m/s", 2.}});
  const std::string file = folder + "/history.h5";
  history.write(file);
  std::ifstream stream(file, std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(stream), {}};
  unsigned int n_refused = 0;
  for (std::size_t i = 0; i < good.size(); i += 17)
  {
    std::string bad = good;
    bad[i] ^= 0x41;
    std::ofstream(file, std::ios::binary) << bad;
    try
    {
      history.read(file);
    }
    catch (const IOError &)
    {
      ++n_refused;
    }
  }
  EXPECT_GT(n_refused, 5U);
  // What HDF5 could not close it does not complain of: ctest fails where the
  // end of this program says so (tests/CMakeLists.txt).
}
} // namespace
