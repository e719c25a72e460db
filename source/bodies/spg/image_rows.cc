// Rows of neighbors of the start, images beyond planes of symmetry among them.
#include "sabot/bodies/spg/image_rows.h"

#include "sabot/kernels/mirrored.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** No kernel reaches farther [m]. */
double largest_reach(const AlignedVector<Mat> &kernel)
{
  double reach = 0.;
  for (const Mat &H : kernel)
    for (const Vec row : H.row)
      reach = std::max(reach,
                       std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
  return reach;
}

/** An image and its particle's kernel. */
struct Image
{
  GlobalIndex number;
  std::array<double, 3> place; // [m]
  Mat kernel;
};

std::vector<Image> images_of(const std::vector<std::array<double, 3>> &points,
                             const AlignedVector<Mat> &kernel,
                             const MirrorPlanes &mirror)
{
  const double reach = largest_reach(kernel);
  std::vector<Image> images;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Vec X = vec(points[i][0], points[i][1], points[i][2]);
    mirror.for_images(X, mirror.planes_at(X), reach,
                      [&](const unsigned int symmetry, const Vec there)
                      {
                        Mat H = kernel[kernel.size() == 1 ? 0 : i];
                        sabot::mirror(H, mirror.turned_axes(symmetry));
                        images.push_back({MirrorPlanes::image(i, symmetry),
                                          {{there[0], there[1], there[2]}},
                                          H});
                      });
  }
  std::sort(images.begin(), images.end(),
            [](const Image &a, const Image &b) { return a.number < b.number; });
  return images;
}
} // namespace

BondList::Rows
rows_with_images(const std::vector<std::array<double, 3>> &points,
                 const AlignedVector<Mat> &kernel, const bool cubic,
                 const MirrorPlanes &mirror,
                 const std::vector<GlobalIndex> &owned_ids)
{
  if (!mirror.any())
    return BondList::rows_in_kernels(points, kernel, cubic, owned_ids);
  const std::vector<Image> images = images_of(points, kernel, mirror);
  std::vector<std::array<double, 3>> all_points = points;
  AlignedVector<Mat> all_kernels = kernel;
  for (const Image &image : images)
  {
    all_points.push_back(image.place);
    // The one kernel of a lattice is its own image.
    if (kernel.size() == points.size())
      all_kernels.push_back(image.kernel);
  }
  const GlobalIndex n = points.size();
  const BondList::Rows by_place =
      BondList::rows_in_kernels(all_points, all_kernels, cubic, owned_ids);
  BondList::Rows rows;
  rows.reserve(by_place.size(), by_place.n_neighbors());
  for (std::size_t i = 0; i < by_place.size(); ++i)
  {
    for (const GlobalIndex j : by_place[i])
      rows.add(j < n ? j : images[j - n].number);
    rows.end_row();
  }
  return rows;
}
} // namespace sabot
