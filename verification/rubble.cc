// Clouds of particles for problems of failed metal.
#include "verification/rubble.h"

#include "sabot/kernels/vec.h"

namespace sabot
{
ParticleCloud lattice_where(const double h, const Vec &axis, const double angle,
                            const double reach,
                            const std::function<bool(const Vec &)> &inside)
{
  ParticleCloud cloud;
  cloud.spacing = {{h, h, h}};
  cloud.face_axis.clear();
  const int n = int(reach / h) + 1;
  const double c = std::cos(angle), s = std::sin(angle);
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -n; k <= n; ++k)
      {
        const Vec X = vec(i * h, j * h, k * h);
        // Rodrigues' formula
        const Vec x =
            c * X + s * cross(axis, X) + (1. - c) * dot(axis, X) * axis;
        if (!inside(x))
          continue;
        cloud.position.push_back({{x[0], x[1], x[2]}});
        cloud.volume.push_back(h * h * h);
        cloud.on_face.push_back(0);
      }
  return cloud;
}
} // namespace sabot
