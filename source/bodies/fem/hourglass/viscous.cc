// Viscous hourglass control: for large plastic flow, where a stiffness would
// remember shapes that the metal has long forgotten.
#include "sabot/base/registry.h"
#include "sabot/bodies/fem/one_point_loop.h"

namespace sabot
{
namespace
{
/**
 * Modal forces f = kappa q', q' = sum gamma_a v_a, with gamma of the present
 * configuration, where sum gamma_a x_a = 0 (no torque), and
 *
 *   kappa = coefficient/4 rho c V^(2/3)   (Flanagan & Belytschko 1981)
 *
 * for base vectors of unit entries. Cells keep the forces of the last step, so
 * that the work of a step is the mean of both ends.
 */
class Viscous final : public OnePointLoop<Viscous>
{
public:
  using OnePointLoop<Viscous>::OnePointLoop;
  static constexpr bool needs_velocities = true;

  template <bool>
  SABOT_IN_LOOP void hourglass(const CellConstants &constants,
                               const FourCells &cells, const double dt,
                               const std::size_t pack, Pending &out)
  {
    const Pack zero = {};
    LastForces &kept = last_forces[pack];
    const Pack coefficient = options.hourglass_coefficient * 0.25 *
                             constants.density * constants.sound_speed *
                             cells.edge * cells.edge;
    Pack pulled[4][3]; // F^-1 sum h_a x_a
    const Pack overlap = pull_back(cells, pulled);
    // gamma_a = h_a - p.B_a: in a flattened, crooked cell the part along B is
    // large. There the viscosity stops at what ends the motion of the h in a
    // step, and that along B, which strains the cell as well, in four.
    const Pack strongest =
        (is_step(dt) ? 0.125 * constants.density / dt : any) * cells.volume /
        (8. + 4. * overlap);
    const Pack bounded = pack_min(coefficient, strongest);
    out.hourglass = {};
    Pack work = zero;
    for (int m = 0; m < 4; ++m)
      for (int i = 0; i < 3; ++i)
      {
        const Pack r = cells.rate[i][m] - dot(cells.L.m[i], pulled[m]);
        const Pack f = bounded * r;
        work += (f + to_double(kept.mode[m][i])) * r;
        kept.mode[m][i] = to_float(f);
        out.mode[m][i] = f;
        for (int j = 0; j < 3; ++j)
          out.hourglass.m[i][j] -= f * pulled[m][j];
      }
    double *const energy = &hourglass_energy[pack * n_lanes];
    store_pack(energy, load_pack(energy) + 0.5 * dt * work);
  }

protected:
  bool keeps_reference_modes() const override { return false; }

  void modal_forces(const Mat &, const Mat &F_inverse, const double,
                    const Vec kept[4], Vec mode[4], Mat &P) const override
  {
    for (int k = 0; k < 4; ++k)
    {
      const Vec pulled = F_inverse * mode[k];
      mode[k] = kept[k];
      add_outer(P, -mode[k], pulled);
    }
  }

private:
  /** Over volume, before there is a step: no bound [kg/s/m^3]. */
  static constexpr double any = 1e100;

  /** p_m = F^-1 sum h_a x_a of each mode. @return sum_m p_m . S p_m. */
  static SABOT_IN_LOOP Pack pull_back(const FourCells &cells, Pack pulled[4][3])
  {
    const PackMat &S = cells.S;
    Pack overlap = {};
    for (int m = 0; m < 4; ++m)
    {
      const Pack mode[3] = {cells.modal[0][m], cells.modal[1][m],
                            cells.modal[2][m]};
      for (int i = 0; i < 3; ++i)
        pulled[m][i] = dot(cells.inverse.m[i], mode);
      const Pack S_pulled[3] = {dot(S.m[0], pulled[m]), dot(S.m[1], pulled[m]),
                                dot(S.m[2], pulled[m])};
      overlap += dot(pulled[m], S_pulled);
    }
    return overlap;
  }
};

const Registry<OnePoint>::Add
    viscous({"viscous",
             "Flanagan-Belytschko viscosity, for large plastic flow.",
             {},
             [](const std::string &body_name, const FemOptions &options,
                std::shared_ptr<const Material> material)
             {
               return std::make_unique<Viscous>(body_name, options,
                                                std::move(material));
             }});
} // namespace
} // namespace sabot
