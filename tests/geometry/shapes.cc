// Shapes as parameter files name them: what each declares and builds.
#include "sabot/base/error.h"
#include "sabot/geometry/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>

namespace
{
using namespace sabot;

constexpr double pi = 3.14159265358979323846;

/** A body of one shape with the standard values of its entries, but for those
    given. */
class Body
{
public:
  Body(const std::string &shape, const std::vector<std::string> &entries = {})
      : shape(make_shape("Bodies/b/Geometry", shape)), file(read(entries))
  {
    prm.declare_entry("Center", "1 mm, 2 mm, 3 mm",
                      quantities(Dimension::length, 3, 3), "");
    Registry<BodyShape>::declare_entries(prm, shape);
    this->shape->declare_grading(prm);
    file.parse_into(prm);
  }

  NamedMesh mesh(const Carving *carving = nullptr)
  {
    ShapeRequest request{prm, file, "Bodies/b"};
    request.cell_size = 0.25e-3;
    request.is_graded = prm.is_declared("Refined zone size");
    request.carving = carving;
    return shape->mesh(request);
  }

  const std::unique_ptr<BodyShape> shape;
  Parameters prm;

private:
  static ParameterFile read(const std::vector<std::string> &entries)
  {
    const std::string name = ::testing::TempDir() + "shape.prm";
    std::ofstream stream(name);
    for (const std::string &entry : entries)
      stream << "set " << entry << "\n";
    stream.close();
    const ParameterFile file(name, {});
    std::remove(name.c_str());
    return file;
  }
  const ParameterFile file;
};

double volume(const HexMesh &mesh)
{
  return std::accumulate(mesh.volume.begin(), mesh.volume.end(), 0.);
}

TEST(Shapes, each_has_its_volume_and_named_faces)
{
  // Standard values: lengths of 1 mm; the ogive is tangent and as long as its
  // radius: half a ball.
  const std::vector<std::pair<std::string, double>> expected = {
      {"box", 1e-9},
      {"cylinder", pi * 1e-9},
      {"projectile", (1. + 2. / 3.) * pi * 1e-9},
      {"sphere", 4. / 3. * pi * 1e-9}};
  for (const auto &[name, exact] : expected)
  {
    const NamedMesh made = Body(name).mesh();
    EXPECT_NEAR(volume(made.mesh), exact, 1e-6 * exact) << name;
    for (const unsigned int id : made.mesh.boundary_id)
      EXPECT_LT(id, made.faces.size()) << name;
    const std::string words = make_shape("", name)->face_names();
    EXPECT_EQ(words.substr(0, made.faces[0].size()), made.faces[0]) << name;
  }
  EXPECT_EQ(Registry<BodyShape>::entries().size(), expected.size() + 1);
}

TEST(Shapes, a_sector_names_its_cut_planes)
{
  const NamedMesh made = Body("cylinder", {"Sector = quarter"}).mesh();
  EXPECT_NEAR(volume(made.mesh), pi / 4. * 1e-9, 1e-15);
  EXPECT_EQ(made.faces,
            (std::vector<std::string>{"lower", "upper", "side", "-x", "-y"}));
}

TEST(Shapes, zones_are_boxes_and_whole_cylinders)
{
  Body box("box", {"Size = 1 mm, 2 mm, 3 mm"});
  const auto zone = box.shape->zone(box.prm, "Bodies/b");
  ASSERT_TRUE(zone.has_value());
  EXPECT_FALSE(zone->axis);
  EXPECT_DOUBLE_EQ(zone->size[2], 3e-3);

  Body cylinder("cylinder", {"Axis = x", "Length = 5 mm"});
  const auto round = cylinder.shape->zone(cylinder.prm, "Bodies/b");
  ASSERT_TRUE(round.has_value());
  EXPECT_TRUE(round->is_coaxial(0, {{7e-3, 2e-3, 3e-3}}));
  EXPECT_FALSE(round->is_coaxial(1, {{1e-3, 2e-3, 3e-3}}));
  EXPECT_DOUBLE_EQ(round->size[0], 5e-3);

  Body half("cylinder", {"Sector = half"});
  EXPECT_THROW(half.shape->zone(half.prm, "Bodies/b"), InputError);
  Body sphere("sphere");
  EXPECT_FALSE(sphere.shape->zone(sphere.prm, "Bodies/b").has_value());
}

TEST(Shapes, a_box_has_one_zone_only)
{
  Body body("box", {"Refined zone size = 0.5 mm, 0.5 mm, 0.5 mm",
                    "Refined zone center = 1 mm, 2 mm, 3 mm"});
  EXPECT_NEAR(volume(body.mesh().mesh), 1e-9, 1e-20);
  Carving carving;
  carving.zone = "z";
  carving.shape.center = {{1e-3, 2e-3, 3e-3}};
  carving.shape.size = {{0.5e-3, 0.5e-3, 0.5e-3}};
  EXPECT_THROW(body.mesh(&carving), InputError);
}

TEST(Shapes, a_file_needs_a_name)
{
  EXPECT_THROW(Body("file").mesh(), InputError);
  EXPECT_FALSE(make_shape("", "file")->follows_cell_size());
  EXPECT_THROW(make_shape("Bodies/b/Geometry", "boks"), InputError);
}
} // namespace
