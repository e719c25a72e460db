// Symmetries of planes: a group, and who stands for whom.
#include "sabot/bodies/spg/mirror_planes.h"

#include <gtest/gtest.h>

#include <set>

namespace sabot
{
namespace
{
constexpr double tolerance = 1e-6, reach = 2.5;

/** x between planes at 0 and 3, y above a plane at -1, z without. */
MirrorPlanes planes()
{
  return {{{0, 0.}, {0, 3.}, {1, -1.}},
          {{{0., -1., -5.}}, {{3., 4., 5.}}},
          tolerance};
}

/** On no plane, on one, on two. */
const Vec places[] = {vec(1., 0.5, 0.), vec(0., 0.5, 0.), vec(3., 0.5, 0.),
                      vec(1.5, -1., 0.), vec(3., -1., 0.)};

TEST(MirrorPlanes, images_are_at_places_of_their_own)
{
  const MirrorPlanes mirror = planes();
  const std::size_t n_places[] = {6, 2, 2, 3, 1}; // within reach
  for (int k = 0; k < 5; ++k)
  {
    const Vec x = places[k];
    using Place = std::array<double, 3>;
    std::set<Place> seen;
    seen.insert(Place{{x[0], x[1], x[2]}});
    mirror.for_images(x, mirror.planes_at(x), reach,
                      [&](const unsigned int symmetry, const Vec there)
                      {
                        EXPECT_NE(symmetry, 0u);
                        const Place place{{there[0], there[1], there[2]}};
                        EXPECT_TRUE(seen.insert(place).second);
                      });
    EXPECT_EQ(seen.size(), n_places[k]);
  }
}

TEST(MirrorPlanes, inverses_lead_back)
{
  const MirrorPlanes mirror = planes();
  for (const Vec x : places)
    mirror.for_images(x, mirror.planes_at(x), reach,
                      [&](const unsigned int symmetry, const Vec there)
                      {
                        const Vec back =
                            mirror.place(mirror.inverse(symmetry), there);
                        EXPECT_LT(norm(back - x), 1e-14);
                      });
}

TEST(MirrorPlanes, one_symmetry_stands_for_those_that_lead_to_the_same_place)
{
  const MirrorPlanes mirror = planes();
  for (const Vec x : places)
    for (unsigned int symmetry = 0; symmetry < 18; ++symmetry)
    {
      const unsigned int on = mirror.planes_at(x),
                         canonical = mirror.canonical(symmetry, on);
      EXPECT_EQ(mirror.canonical(canonical, on), canonical);
      const double apart =
          norm(mirror.place(canonical, x) - mirror.place(symmetry, x));
      EXPECT_LT(apart, 1e-14);
    }
}

TEST(MirrorPlanes, shares_go_by_the_planes_that_a_particle_lies_on)
{
  const MirrorPlanes mirror = planes();
  const double copies[] = {1., 2., 2., 2., 4.};
  const unsigned int held[] = {0, 1, 1, 2, 3};
  for (int k = 0; k < 5; ++k)
  {
    const unsigned int on = mirror.planes_at(places[k]);
    EXPECT_EQ(MirrorPlanes::copies(on), copies[k]);
    EXPECT_EQ(MirrorPlanes::held_axes(on), held[k]);
  }
}

TEST(MirrorPlanes, what_is_on_both_sides_of_a_plane_has_no_images)
{
  const MirrorPlanes mirror({{0, 0.}}, {{{-1., 0., 0.}}, {{1., 0., 0.}}},
                            tolerance);
  EXPECT_FALSE(mirror.any());
  EXPECT_EQ(mirror.planes_at(vec(0., 0., 0.)), 0u);
}
} // namespace
} // namespace sabot
