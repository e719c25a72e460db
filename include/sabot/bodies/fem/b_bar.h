#ifndef sabot_bodies_fem_b_bar_h
#define sabot_bodies_fem_b_bar_h

#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/kernels/pack.h"

namespace sabot
{
/**
 * Hexahedra with 2 x 2 x 2 points, the volumetric strain replaced by its mean
 * over the cell (B-bar, Hughes 1980): no hourglass modes and no volumetric
 * locking. With the present gradients b_aq of point q, of volume v_q,
 *
 *   d_q = dev(sum v_a (x) b_aq) + 1/3 tr, tr = sum_q v_q tr d_q / v,
 *   f_a = -sum_q v_q (dev sigma_q + p 1) b_aq, p = sum_q v_q tr sigma_q / 3 v,
 *
 * which do the same work. Four points share a pack, two packs make a cell.
 * All points see the mean volume ratio; the bulk viscosity is that of the mean
 * rate. Costs several times a one-point cell.
 */
class BBar : public Hexahedra
{
public:
  BBar(const std::string &body_name, const FemOptions &options,
       std::shared_ptr<const Material> material)
      : Hexahedra(body_name, options, material, 8)
  {
  }

  void set_up(
      const HexMesh &mesh, const std::vector<GlobalIndex> &cell_id,
      const std::vector<std::array<std::uint32_t, 8>> &connectivity) override;
  void add_forces(NodalState &nodes, const double dt) override;
  void cell_forces(const NodalState &nodes, const std::size_t cell,
                   Vec force[8]) const override;
  void keep(const std::vector<std::size_t> &kept) override;
  void visit_state(StateVisitor &visitor) override;

protected:
  Mat gradient(const std::size_t point) const override;

private:
  static constexpr int n_packs = 2; // per cell
  static constexpr std::size_t cells_per_batch = batch_size / 8;
  /** Reference data of a cell. */
  struct Geometry
  {
    Pack B[n_packs][8][3]; // reference gradients at the points [1/m]
    Pack volume[n_packs];  // of the points, V_q [m^3]
  };
  /** What the next step needs of a cell: F at its points. */
  struct Motion
  {
    PackMat F[n_packs];
  };
  /** A cell between two positions, and sums over its points. */
  struct Moving // on the stack, while kinematics() runs
  {
    PackMat F[n_packs], l[n_packs]; // l: see midpoint_increment()
    Vec mean[8];                    // v times the mean present gradients [m^2]
    double volume, middle_volume;   // present and mid [m^3]
    double expansion;               // sum of mid volume tr l [m^3]
    double shear_bound;             // sum of v_q lambda_max G_q [m]
  };
  /** Gradients at Gauss point @p q of a cell with the corners @p X [m].
      @return its volume [m^3]. */
  static double set_up_point(const std::array<Vec, 8> &X, const int q,
                             Geometry &g);
  /** From the positions of the corners to what the material needs, into the
      batch; advances motion. */
  void kinematics(const CellConstants &constants, const NodalState &nodes,
                  const std::size_t cell, const double dt);
  // Parts of kinematics(); see there in the source.
  void add_points(const NodalState &nodes, const std::size_t e, const int p,
                  const Vec x[8], Moving &cell);
  static void add_present_gradients(const Geometry &g, const int p,
                                    const Pack J, Moving &cell);
  static double stable_step(const CellConstants &constants,
                            const double reference_volume, const double dt,
                            const Moving &cell, double &q);
  double step_of_quarter_volume(const NodalState &nodes, const std::size_t e,
                                const Moving &cell) const;

  // One entry a cell; the batch holds the points of four cells.
  AlignedVector<Geometry> geometry;
  AlignedVector<Motion> motion;
  PointBatch batch;
};
} // namespace sabot

#endif
