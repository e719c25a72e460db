#ifndef sabot_bodies_spg_image_rows_h
#define sabot_bodies_spg_image_rows_h

#include "sabot/bodies/spg/bond_list.h"
#include "sabot/bodies/spg/mirror_planes.h"

namespace sabot
{
/** BondList::rows_in_kernels() with the images of the particles beyond planes
   of symmetry among the neighbors, numbered by @p mirror. @p points, @p kernel:
   of all particles of the body, undeformed, which tells who lies on a plane.
   Local.
 */
BondList::Rows
rows_with_images(const std::vector<std::array<double, 3>> &points,
                 const AlignedVector<Mat> &kernel, const bool cubic,
                 const MirrorPlanes &mirror,
                 const std::vector<GlobalIndex> &owned_ids);
} // namespace sabot

#endif
