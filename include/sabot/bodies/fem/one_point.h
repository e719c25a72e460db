#ifndef sabot_bodies_fem_one_point_h
#define sabot_bodies_fem_one_point_h

#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/kernels/pack.h"

#include <memory>
#include <string>

namespace sabot
{
/** Name of the form that @p options come to: of "automatic", stiffness for laws
    that never yield, whose modes it gives back, and viscous for all others,
    whose large flow a stiffness would resist. */
std::string chosen_hourglass_control(const FemOptions &options,
                                     const Material &material);

/**
 * One-point hexahedra with hourglass control, in total Lagrangian form
 * (doc/theory-fem.md): with the mean gradients B_a of the reference
 * configuration,
 *
 *   F = sum x_a (x) B_a,  f_a = -V_0 J sigma F^-T B_a - hourglass.
 *
 * The forms of hourglass control are Flanagan & Belytschko's (1981) and differ
 * in the modal forces that they put on the base vectors
 *
 *   gamma_a = h_a - sum_b (h_b X_b) . B_a.
 *
 * A form is a class in a file of its own (hourglass/), which instantiates the
 * loop of one_point_loop.h with itself. Cells are computed four at a time, in
 * the lanes of packs.
 */
class OnePoint : public Hexahedra
{
public:
  // For the registry of forms.
  static constexpr const char *kind = "hourglass control";
  using Make = std::unique_ptr<OnePoint>(const std::string &body_name,
                                         const FemOptions &options,
                                         std::shared_ptr<const Material>);

  /** One point a cell; cells come by set_up(). */
  OnePoint(const std::string &body_name, const FemOptions &options,
           std::shared_ptr<const Material> material)
      : Hexahedra(body_name, options, material, 1)
  {
  }

  void set_up(LocalCells cells, const AlignedVector<Vec> &X) override;
  /** -[P B_a + modal forces], recomputed cell by cell with plain arithmetic;
      P = V_0 J (sigma - q 1) F^-T and what the modes add. */
  void cell_forces(const NodalState &nodes, const std::size_t cell,
                   Vec force[8]) const override;
  void keep(const std::vector<std::size_t> &kept) override;
  std::string hourglass_control() const override
  {
    return chosen_hourglass_control(options, *material);
  }
  bool holds_hourglass_energy() const override
  {
    return keeps_reference_modes();
  }
  void visit_state(StateVisitor &visitor, const StateItems &of_cells) override;
  void list_memory(MemoryTable &table) const override
  {
    Hexahedra::list_memory(table);
    table.add("geometry of cells", geometry);
    table.add("crookedness of cells", warp);
    table.add("motion of cells", motion);
    table.add("modes at rest", reference_modes);
    table.add("modal forces", last_forces);
  }

protected:
  Mat gradient(const std::size_t point) const override;

  /** Whether the modes that a cell keeps are sum h_b X_b, set once. True for
      a form with stiffness, which measures from the undeformed cell; a viscous
     one keeps its forces of the last step, zero at first. */
  virtual bool keeps_reference_modes() const = 0;
  /** Modal forces of one cell in its present state [N], recomputed for a cell
      that is about to go.
      @param kept  what the cell keeps of its modes, see ReferenceModes and
                   LastForces
      @param mode  in: sum h_a x_a [m]; out: forces
      @param P     V_0 J sigma F^-T; the modes' part is added */
  virtual void modal_forces(const Mat &F, const Mat &F_inverse,
                            const double present_volume, const Vec kept[4],
                            Vec mode[4], Mat &P) const = 0;

  /** Mean gradients of four cells by the base vectors of corner_sums(),
   *
   *   B_a = sum_k l_ka linear_k + sum_m h_ma mode_m   [1/m],
   *
   * read twice per step; with three vectors where eight would stand, and the
   * modes only in bodies that have a cell which is no parallelepiped. */
  struct Geometry
  {
    Pack linear[3][3];
  };
  struct Warp
  {
    Pack mode[4][3];
  };
  /** F of four cells at the end of the last step. */
  using Motion = PackMat;
  /** sum h_b X_b of four cells [mode][component], the modes of the undeformed
      cell [m]. */
  struct ReferenceModes
  {
    Pack mode[4][3];
  };
  /** The modal forces of the last step [N], for the work of the mean of both
      ends: they are books, and no force that stays is made of them, so that
      single precision will do. With bfloat16 energies knew the units that a
      scene is written in by 2e-6. */
  struct LastForces
  {
    HalfPack mode[4][3];
  };
  /** Of one pack of cells, from kinematics to forces. Written by the
      kinematics of the loop, read by scatter() once the law has the stress:
      V_0 J F^-T in m^3, P in N m, modal forces in N. */
  struct Pending
  {
    PackMat stress_to_force; // V_0 J F^-T
    PackMat hourglass;       // part of P that hourglass modes add
    Pack mode[4][3];         // modal forces
  };
  static constexpr std::size_t packs_per_batch = batch_size / n_lanes;

  /** Subtract the forces of the stress of a pack, and those that pend. -(P
      B_a + sum over modes), P = (sigma - q 1) V_0 J F^-T + the modes' part;
      corners are added cell by cell in ascending order, so that nodal sums
      do not depend on ranks. @p is_crooked: whether any cell here has modes. */
  template <bool is_crooked>
  void scatter(NodalState &nodes, const std::size_t pack);

  AlignedVector<Geometry> geometry;
  AlignedVector<Warp> warp; // empty where all cells are parallelepipeds
  AlignedVector<Motion> motion;
  /** One of these, by keeps_reference_modes(); parallelepipeds have no modes
      at rest. */
  AlignedVector<ReferenceModes> reference_modes;
  AlignedVector<LastForces> last_forces;
  PointBatch batch;
  alignas(64) Pending pending[packs_per_batch];

  /** Local nodes of the four cells of a pack, those of the last cell again in
      lanes without one. */
  struct Corners
  {
    const std::uint32_t *of[n_lanes];
  };
  Corners corners(const std::size_t pack) const
  {
    Corners c;
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
      c.of[lane] =
          connectivity[std::min(pack * n_lanes + lane, size() - 1)].data();
    return c;
  }

private:
  /** Gradients of cell @p e with the corners @p X. */
  void set_gradients(const std::size_t e, const std::array<Vec, 8> &X);
  /** All that is kept of a cell, from one lane to another. */
  void copy_cell(const std::size_t from, const std::size_t to);
  /** The modes that a cell keeps. */
  void kept_modes(const std::size_t cell, Vec kept[4]) const;
  /** Lanes behind the last cell repeat it with a volume of 0: the arithmetic
      stays finite and nothing is added. */
  void fill_up();
};
} // namespace sabot

#endif
