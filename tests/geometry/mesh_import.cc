// Import of meshes by gmsh, VTK and meshio: each format, and what damages it.
#include "gmsh_text.h"
#include "vtk_files.h"

#include <cstdlib>
#include <filesystem>
#include <map>

namespace
{
using namespace sabot;

TEST(MeshImport, gmsh_in_all_its_formats)
{
  for (const double version : {2.2, 4., 4.1})
    for (const bool is_binary : {false, true})
    {
      MeshWish wish;
      wish.unit = 1e-3;
      wish.origin = {{1., 0., 0.}};
      const NamedMesh made =
          read_text("block.msh", GmshText(version, is_binary).str(), wish);
      EXPECT_EQ(made.mesh.cells.size(), 8u);
      EXPECT_NEAR(volume_of(made), 8e-9, 1e-20);
      EXPECT_NEAR(range_of(made, 0).second, 1.002, 1e-15);
      for (const std::string name : {"struck face", "11"})
        EXPECT_NEAR(area_of(made, name)[2], -4e-6, 1e-18)
            << version << is_binary;
      EXPECT_NEAR(area_of(made, "0")[2], 4e-6, 1e-18);
      EXPECT_TRUE(has(made.notes.back(), "from (1000, 0, 0) mm to (1002, 2, 2) "
                                         "mm; parts: plate (1); faces: struck "
                                         "face (11), 0"))
          << made.notes.back();
      // Cut off anywhere: a message, with the name of the file.
      const std::string text = GmshText(version, is_binary).str();
      for (std::size_t n = 1; n < text.size() - 14; n += 37)
        EXPECT_TRUE(has(refusal("cut.msh", text.substr(0, n)), "cut.msh"));
    }
}

TEST(MeshImport, gmsh_cut_for_parallel_programs_keeps_its_names)
{
  // Elements name the pieces, which belong to the groups.
  std::string text = GmshText(4.1, false).str();
  const auto replace = [&](const std::string &part, const std::string &other)
  {
    const std::size_t at = text.find(part, text.find("$Elements"));
    ASSERT_NE(at, std::string::npos) << part;
    text.replace(at, part.size(), other);
  };
  replace("2 5 3 4", "2 15 3 4");
  replace("3 1 5 8", "3 9 5 8");
  text.insert(text.find("$Nodes"),
              "$PartitionedEntities\n2\n1\n77 2\n0 0 1 1\n"
              "15 2 5 2 1 2 0 0 0 0 0 0 1 -11 1 4\n"
              "9 3 1 1 1 0 0 0 0 0 0 1 1 0\n$EndPartitionedEntities\n");
  const NamedMesh made = read_text("cut.msh", text);
  EXPECT_NEAR(area_of(made, "struck face")[2], -4., 1e-12);
  EXPECT_TRUE(has(made.notes.back(), "parts: plate (1)")) << made.notes.back();
}

TEST(MeshImport, a_name_of_gmsh_in_latin_1_is_told_by_line)
{
  std::string text = GmshText(2.2, false).str();
  text.replace(text.find("struck"), 6,
               "Fl\xe4"
               "che");
  const std::string message = refusal("latin.msh", text);
  EXPECT_TRUE(has(message, "latin.msh\", line 7: the byte 0xe4 after \"\"Fl\" "
                           "is not UTF-8"))
      << message;
}

TEST(MeshImport, unknown_faces_and_parts_are_refused_with_the_known)
{
  const std::string text = GmshText(2.2, false).str();
  const NamedMesh made = read_text("block.msh", text);
  try
  {
    find_face_ids("Bodies/a/Clamped faces", "5", made);
    FAIL();
  }
  catch (const InputError &error)
  {
    EXPECT_STREQ(error.what(), "\"5\" is not a face; allowed: struck face "
                               "(11), 0, or a plane, as \"x = 0 mm\"");
  }
  MeshWish wish;
  wish.part = "2";
  EXPECT_TRUE(has(refusal("block.msh", text, wish), "the file has plate (1)"));
  wish.part = "plate";
  EXPECT_EQ(read_text("block.msh", text, wish).mesh.cells.size(), 8u);
}

std::string replaced(std::string text, const std::string &old,
                     const std::string &with)
{
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), with);
}

TEST(MeshImport, wrong_counts_and_labels_of_gmsh)
{
  const std::string text = GmshText(2.2, false).str();
  const auto bad = [&](const std::string &old, const std::string &with)
  { return refusal("bad.msh", replaced(text, old, with)); };
  EXPECT_TRUE(has(bad("$Nodes\n27", "$Nodes\n2000000000"), "line 11: it ann"))
      << bad("$Nodes\n27", "$Nodes\n2000000000");
  EXPECT_TRUE(has(bad("$Nodes\n27", "$Nodes\n-1"), "is negative"));
  EXPECT_TRUE(has(bad("$Nodes\n27", "$Nodes\nmany"), "\"many\" stands where"));
  EXPECT_TRUE(has(bad("101 1 0 0", "100 1 0 0"), "node 100 is there twice"));
  EXPECT_TRUE(has(bad("101 1 0 0", "901 1 0 0"), "has the node 101, which"));
  EXPECT_TRUE(has(bad("101 1 0 0", "101 nan 0 0"), "where a number should"));
  EXPECT_TRUE(has(bad("5 2 1 7 ", "4 2 1 7 "), "elements have the type"))
      << bad("5 2 1 7 ", "4 2 1 7 ");
  EXPECT_TRUE(has(bad("2.2 0 8", "5 0 8"), "none of 2.2, 4.0 and 4.1"));
  EXPECT_TRUE(has(bad("$EndNodes", "$Nothing"), "$EndNodes is missing"));
  EXPECT_TRUE(has(bad("$MeshFormat", "$NOD"), "format 1"));
  // Any number will do for a name.
  std::string odd = text;
  for (std::size_t at = 0; (at = odd.find(" 11 7 ", at)) != std::string::npos;)
    odd.replace(at, 6, " 2000000000 7 ");
  EXPECT_NEAR(area_of(read_text("odd.msh", odd), "2000000000")[2], -4., 1e-12);
}

void check_grid(const std::string &file)
{
  SCOPED_TRACE(file);
  const MeshFile source{file, "Bodies/a/Mesh file"};
  MeshWish wish;
  const NamedMesh made = read_mesh(source, wish);
  EXPECT_NEAR(volume_of(made), 8., 1e-12);
  EXPECT_NEAR(area_of(made, "7")[2], -1., 1e-12);
  wish.part = "1";
  EXPECT_NEAR(range_of(read_mesh(source, wish), 2).first, 1., 1e-15);

  // Damaged anywhere: read or refused by name, never a crash.
  const std::string text = source.text();
  for (std::size_t i = 0; i < text.size(); i += 1 + text.size() / 30)
  {
    std::string other = text;
    other[i] = i % 3 ? char(255 - other[i]) : '9';
    const std::string name =
        "bad" + std::filesystem::path(file).extension().string();
    const std::string said = refusal(name, other);
    EXPECT_TRUE(said.empty() || has(said, name)) << said;
    EXPECT_FALSE(has(said, "\n"));
    const std::string cut = refusal(name, text.substr(0, i));
    EXPECT_TRUE(cut.empty() || has(cut, name)) << cut;
  }
}

TEST(MeshImport, vtk_of_old_and_new_versions)
{
  for (const int version : {42, 51})
    for (const bool is_binary : {false, true})
      check_grid(write_vtk(version, is_binary));
  EXPECT_TRUE(has(refusal("bad.vtk", "nothing\n"), "bad.vtk\", line 1"));
}

/** As editors of other systems save it. */
std::string with_line_ends(const std::string &text, const std::string &end)
{
  std::string changed;
  for (const char c : text)
    changed += c == '\n' ? end : std::string(1, c);
  return changed;
}

TEST(MeshImport, texts_have_the_line_ends_of_any_system)
{
  std::stringstream vtk, vtu;
  vtk << std::ifstream(write_vtk(51, false)).rdbuf();
  vtu << std::ifstream(write_vtu(vtkXMLWriter::Ascii, false, false)).rdbuf();
  const std::map<std::string, std::string> texts = {
      {"ends.inp", Block().abaqus() + "*Nset, nset=low\n1, 2, 3\n"},
      {"ends.msh", GmshText(4.1, false).str()},
      {"ends-2.msh", GmshText(2.2, false).str()},
      {"ends.vtk", vtk.str()},
      {"ends.vtu", vtu.str()}};
  for (const auto &[name, text] : texts)
  {
    const NamedMesh here = read_text(name, text);
    for (const std::string end : {"\r\n", "\r"})
    {
      const NamedMesh made = read_text(name, with_line_ends(text, end));
      EXPECT_EQ(made.mesh.nodes, here.mesh.nodes) << name;
      EXPECT_EQ(made.mesh.cells, here.mesh.cells) << name;
      EXPECT_EQ(made.notes, here.notes) << name;
    }
  }
  for (const std::string end : {"\n", "\r\n", "\r"})
    EXPECT_TRUE(
        has(refusal("bad.inp", with_line_ends("*Node\n1, 0, 0, 0\n2, x, "
                                              "0, 0\n",
                                              end)),
            "line 3"));
}

TEST(MeshImport, vtu_in_all_its_encodings)
{
  for (const int mode : vtu_modes)
    for (const bool is_packed : {false, true})
      for (const bool is_encoded : {false, true})
        check_grid(write_vtu(mode, is_packed, is_encoded));
  EXPECT_TRUE(has(refusal("bad.vtu", "<VTKFile type=\"PolyData\">"),
                  "no UnstructuredGrid"));
}

TEST(MeshImport, other_endings_go_through_meshio)
{
  // Stands in for meshio: copies, or complains.
  namespace fs = std::filesystem;
  const std::string folder = testing::TempDir() + "fake-meshio",
                    script = folder + "/meshio", path = std::getenv("PATH");
  fs::create_directories(folder);
  std::ofstream(script) << "#!/bin/sh\n[ \"$1\" = convert ] || exit 3\n"
                           "grep -q VTKFile \"$2\" && exec /bin/cp \"$2\" "
                           "\"$3\"\necho 'Error: unknown cards'\nexit 1\n";
  fs::permissions(script, fs::perms::owner_all);
  const std::string file = testing::TempDir() + "block.bdf";
  fs::rename(write_vtu(vtu_modes[0], false, false), file);
  setenv("PATH", (folder + ":" + path).c_str(), 1);
  const NamedMesh made = read_mesh({file, "Bodies/a/Mesh file"}, MeshWish());
  EXPECT_NEAR(volume_of(made), 8., 1e-12);
  EXPECT_TRUE(has(refusal("bad.bdf", "GRID\n"), "unknown cards"));
  setenv("PATH", testing::TempDir().c_str(), 1);
  EXPECT_TRUE(has(refusal("bad.exo", "GRID\n"), "pip install meshio"));
  setenv("PATH", path.c_str(), 1);
  EXPECT_TRUE(has(refusal("none/there.msh", ""), "cannot open the mesh file"));
}
} // namespace
