// Hourglass control by stiffness: for elastic bodies, whose modes it holds
// without drift.
#include "sabot/base/registry.h"
#include "sabot/bodies/fem/one_point_loop.h"

namespace sabot
{
namespace
{
/**
 * Modal forces f = k q, q = sum gamma_a x_a = sum h_a x_a - F sum h_a X_a,
 *
 *   k = coefficient/8 rho c^2 V^(1/3)   (Flanagan & Belytschko 1981)
 *
 * for base vectors of unit entries, in total form: what the modes hold comes
 * back. Crooked cells keep sum h_a X_a, which others do not have.
 */
class Stiffness final : public OnePointLoop<Stiffness>
{
public:
  using OnePointLoop<Stiffness>::OnePointLoop;
  static constexpr bool needs_velocities = false;

  template <bool is_crooked>
  SABOT_IN_LOOP void hourglass(const CellConstants &constants,
                               const FourCells &cells, const double,
                               const std::size_t pack, Pending &out)
  {
    const double c = constants.sound_speed;
    const Pack coefficient = options.hourglass_coefficient * 0.125 *
                             constants.density * c * c * cells.edge;
    out.hourglass = {};
    Pack work = {};
    for (int m = 0; m < 4; ++m)
      for (int i = 0; i < 3; ++i)
      {
        Pack q = cells.modal[i][m];
        if constexpr (is_crooked)
          q -= dot(cells.F.m[i], reference_modes[pack].mode[m]);
        const Pack f = coefficient * q;
        work += f * q;
        out.mode[m][i] = f;
        if constexpr (is_crooked)
          for (int j = 0; j < 3; ++j)
            out.hourglass.m[i][j] -= f * reference_modes[pack].mode[m][j];
      }
    store_pack(&hourglass_energy[pack * n_lanes], 0.5 * work);
  }

protected:
  bool keeps_reference_modes() const override { return true; }

  void modal_forces(const Mat &F, const Mat &, const double present_volume,
                    const Vec kept[4], Vec mode[4], Mat &P) const override
  {
    const double c = material->sound_speed(),
                 stiffness = options.hourglass_coefficient * 0.125 *
                             material->density() * c * c *
                             std::cbrt(present_volume);
    for (int k = 0; k < 4; ++k)
    {
      mode[k] = stiffness * (mode[k] - F * kept[k]);
      add_outer(P, -mode[k], kept[k]);
    }
  }
};

const Registry<OnePoint>::Add
    stiffness({"stiffness",
               "Flanagan-Belytschko stiffness, for elastic bodies.",
               {},
               [](const std::string &body_name, const FemOptions &options,
                  std::shared_ptr<const Material> material)
               {
                 return std::make_unique<Stiffness>(body_name, options,
                                                    std::move(material));
               }});
} // namespace
} // namespace sabot
