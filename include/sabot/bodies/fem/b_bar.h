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
 *
 * J of the law is v/V_0 of the cell; laws that need F get (J/det F_q)^(1/3)
 * F_q. Inversion is judged at every point. The stiffest point shortens the step
 * of its cell. Limit: eight points share one pressure, so only strength resists
 * the collapse of a single one (doc/theory/fem.md).
 */
class BBar : public Hexahedra
{
public:
  /** Eight points a cell; cells come by set_up(). */
  BBar(const std::string &body_name, const FemOptions &options,
       std::shared_ptr<const Material> material)
      : Hexahedra(body_name, options, material, 8)
  {
  }

  void set_up(LocalCells cells, const AlignedVector<Vec> &X) override;
  /** As Hexahedra; 4 cells, 32 points a batch. Forces are recomputed by
      cell_forces() from the points' new stress. */
  void add_forces(NodalState &nodes, const double dt) override;
  /** From F and stress as kept; needs no positions. The pressure is the mean
      over the points, weighted by their present volumes, of tr sigma_q/3 -
      q. */
  void cell_forces(const NodalState &nodes, const std::size_t cell,
                   Vec force[8]) const override;
  /** Of the points' present volumes, which share their mean ratio. */
  double volume_ratio(const std::size_t cell) const override;
  /** Compacts geometry and motion with the points. */
  void keep(const std::vector<std::size_t> &kept) override;
  void visit_state(StateVisitor &visitor, const StateItems &of_cells) override;
  void list_memory(MemoryTable &table) const override
  {
    Hexahedra::list_memory(table);
    table.add("geometry of cells", geometry);
    table.add("motion of cells", motion);
  }

protected:
  Mat gradient(const std::size_t point) const override;

private:
  static constexpr int n_packs = 2; // per cell
  static constexpr std::size_t cells_per_batch = batch_size / 8;
  /** Reference data of a cell. Gauss points at +-1/sqrt(3) in the order of
      the corners (VTK); B_aq and V_q are exact for the trilinear map. */
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
    // v times the mean present gradients, a part in each lane [m^2]
    Pack mean[8][3];
    double volume, middle_volume; // present and mid [m^3]
    double expansion;             // sum of mid volume tr l [m^3]
    double shear_bound;           // sum of v_q lambda_max G_q [m]
  };
  /** Gradients at Gauss point @p q of a cell with the corners @p X [m].
      @return its volume [m^3]. B_a = J^-T dN_a/dxi, V_q = det J with weights
      of 1. */
  static double set_up_point(const std::array<Vec, 8> &X, const int q,
                             Geometry &g);
  /** From the positions of the corners to what the material needs, into the
      batch; advances motion. Strain: l_q with its trace replaced by the
      cell's mean, spread over the diagonal; J, q: those of the cell, at all
      its points. The step of the cell stands at its first point. */
  void kinematics(const CellConstants &constants, const NodalState &nodes,
                  const std::size_t cell, const double dt);
  // Parts of kinematics(); see there in the source.
  /** F = sum x_a (x) B_aq and l of four points; what inverts rests; adds
      volumes and expansion. */
  void add_points(const NodalState &nodes, const std::size_t e, const int p,
                  const Vec x[8], Moving &cell);
  /** b_aq = F^-T B_aq [1/m] by the adjugate; adds v_q b_aq to the mean and
      v_q lambda_max of sum b (x) b to the bound of the shear. */
  static void add_present_gradients(const Geometry &g, const int p,
                                    const Pack J, Moving &cell);
  /** [s], shortened by the bulk viscosity q = rho h (c1 c |d| + c2 h d^2)
      [Pa], which it also returns; h by the mean gradients, d the mean rate,
      compression only. */
  static double stable_step(const CellConstants &constants,
                            const double reference_volume, const double dt,
                            const Moving &cell, double &q);
  /** 0.25 over the fastest rate of closing of a point by the present
      velocities [s], for the option shrink. */
  double step_of_quarter_volume(const NodalState &nodes, const std::size_t e,
                                const Moving &cell) const;

  // One entry a cell; the batch holds the points of four cells.
  AlignedVector<Geometry> geometry;
  AlignedVector<Motion> motion;
  PointBatch batch;
};
} // namespace sabot

#endif
