#ifndef sabot_bodies_fem_hexahedra_h
#define sabot_bodies_fem_hexahedra_h

#include "sabot/base/memory_table.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/fem/cell_kernels.h"
#include "sabot/bodies/fem/fem_options.h"
#include "sabot/bodies/material_points.h"

#include <algorithm>
#include <memory>

namespace sabot
{
/** The cells of a rank as they are set up from; parallel arrays. */
struct LocalCells
{
  std::vector<GlobalIndex> id; // in the mesh, ascending
  /** Local nodes of the corners, VTK order. */
  std::vector<std::array<std::uint32_t, 8>> connectivity;
  std::vector<double> volume; // V_0 [m^3]
};

/**
 * The hexahedra of a FEM body on this rank, with their material points: what
 * all integration rules share. A new rule is a class derived from this one,
 * with its registration, in a file of its own. Points of cell e are e *
 * n_points up to (e + 1) * n_points; arrays of points are padded to whole
 * packs, so that every point goes through the same vector instructions.
 *
 * A rank holds every cell of its nodes (those at its border are computed by
 * several ranks alike) and adds up corner forces in global cell order: forces
 * need no exchange and do not depend on the number of ranks.
 *
 * Tensors are in the present frame, symmetric ones as xx, yy, zz, xy, yz, xz;
 * stress is positive in tension. No function is collective: what has to be
 * agreed on between ranks is up to FemBody and FemErosion.
 */
class Hexahedra
{
public:
  // For the registry of rules.
  static constexpr const char *kind = "integration rule";
  using Make = std::unique_ptr<Hexahedra>(const std::string &body_name,
                                          const FemOptions &options,
                                          std::shared_ptr<const Material>);

  /** No cells yet. The name of the body is for messages; n_points is that of
      one cell, the same in all. */
  Hexahedra(const std::string &body_name, const FemOptions &options,
            std::shared_ptr<const Material> material,
            const unsigned int n_points);
  virtual ~Hexahedra() = default;

  /** Take these cells, whose nodes are at @p X [m]. Computes the reference
      gradients [1/m] and puts all points at rest. Needs no mesh, which may be
      gone by now. */
  virtual void set_up(LocalCells cells, const AlignedVector<Vec> &X) = 0;
  /** Subtract the internal forces of all cells; advance their state by the
      step @p dt that led here (no_step: forces only). f_a -= sum over
      points V J (sigma - q 1) F^-T B_a + hourglass forces [N], into owned
      and ghost nodes; a rank has all cells of its owned nodes, so theirs are
      complete and ghosts' are not. Also sets smallest_step and, where asked
      for, cell_step. Throws PhysicsError, with cell and place, where a cell
      is about to invert and the option says stop. */
  virtual void add_forces(NodalState &nodes, const double dt) = 0;
  /** What add_forces() added for one cell, recomputed. [N] with the sign of
      add_forces(), of stress and modes as they are now, corners in VTK
      order. Erosion subtracts it, so that a dead cell does not act in the
      half step that follows. */
  virtual void cell_forces(const NodalState &nodes, const std::size_t cell,
                           Vec force[8]) const = 0;
  /** Keep these cells only, ascending. All arrays over cells and points are
      compacted in place; the padding behind the last cell is filled up anew. */
  virtual void keep(const std::vector<std::size_t> &kept) = 0;
  /** Name of the form that holds motions without strain; empty for rules that
      have none. */
  virtual std::string hourglass_control() const { return ""; }
  /** Whether that form gives back what motions without strain cost, as a
      stiffness does; else hourglass_energy is heat. */
  virtual bool holds_hourglass_energy() const { return false; }
  /** Everything of the cells that a restart needs; the rules add their own.
      Connectivity and reference data are not part of it: they are set up
      from the mesh before, and eroded cells are taken out before arrays are
      filled. */
  virtual void visit_state(StateVisitor &visitor, const StateItems &of_cells);
  /** Arrays of cells and points; rules add their own. Local. */
  virtual void list_memory(MemoryTable &table) const;

  std::size_t size() const { return connectivity.size(); }
  /** Local nodes of the corners, VTK order; numbers of the cells in the mesh.
   */
  std::vector<std::array<std::uint32_t, 8>> connectivity;
  std::vector<GlobalIndex> cell_id;
  AlignedVector<double> volume; // V_0 [m^3], with zeros to whole packs
  AlignedVector<double> hourglass_energy; // [J]
  /** Internal energy and plastic work of cell @p e [J]. Work of law and bulk
      viscosity since the start, over the volume of the cell, without that of
      hourglass forces. */
  double internal_energy(const std::size_t e) const
  {
    return sum_points(points.internal_energy, e);
  }
  double plastic_work(const std::size_t e) const
  {
    return sum_points(points.plastic_work, e);
  }
  /** Means over the points of each cell, [row][size()]. Stress [Pa] without
      bulk viscosity; plain means, not weighted by volume; states in the
      order of the law's variables. */
  std::vector<double> cell_stress() const { return cell_means(points.stress); }
  std::vector<double> cell_states() const
  {
    return cell_means(points.state_data);
  }
  /** Mean of component xx, yy, zz, xy, yz or xz over the points [Pa]. */
  double stress(const std::size_t component, const std::size_t e) const;
  const std::vector<StateVariable> &states() const
  {
    return points.variables();
  }
  /** Mean of a scalar state variable over the points of each cell; empty when
      the material does not have it. */
  std::vector<double> cell_state(const std::string &name) const;
  /** For what a cell hands over when it goes: its volume over V_0 as the law
      sees it, and means over its points of F, of the viscous pressure [Pa] and
      of all rows of the state. */
  virtual double volume_ratio(const std::size_t e) const
  {
    return determinant(gradient(e * n_points));
  }
  Mat mean_gradient(const std::size_t e) const;
  double viscous_pressure(const std::size_t e) const
  {
    return sum_points(points.viscous_pressure, e) / n_points;
  }
  void mean_states(const std::size_t e, double *values) const;
  /** The largest mean of row @p row over the cells that count, at least 0. */
  double largest_mean(const std::size_t row,
                      const std::vector<char> &counts) const;
  /** Present flow stress of some cells [Pa], the mean of their points. By
      FlowStressProbe at the points' own pressure, volume ratio and state;
      1e300 where the law never yields. */
  std::vector<double> flow_stress(const std::vector<std::size_t> &some) const;
  /** Add the change of each cell to a scalar state variable at its points.
      For heat that is conducted between cells: every point of a cell gets
      the same change, in the unit of the variable. The material must have
      it. */
  void shift_state(const std::string &name, const std::vector<double> &change);

  /** The least over the cells, as of the last add_forces(). [s], with the
      global number of the cell; of all cells here, those of other ranks'
      nodes included. */
  StableStep smallest_step;
  /** Step of each cell by itself [size()] [s], empty unless erosion or
      conversion by the step, or mass scaling, asks for it. */
  std::vector<double> cell_step;
  /** Mass that mass scaling has added to each cell, over its own; [size()],
      empty without. */
  std::vector<double> added_share;
  /** Local numbers, perhaps repeated, of cells that the option erode
      condemns; FemErosion empties it. */
  std::vector<std::size_t> inverting; // cells seen by avoid_inversion()

protected:
  /** Points per batch; what one needs stays in the first-level cache. */
  static constexpr std::size_t batch_size = 32;
  static_assert(batch_size <= max_batch_points, "materials take no more");
  /** What a batch carries from kinematics to the material and back. The step
      of a cell stands at its first point; stiffening is the law's modulus
      over the one at rest, at each point. */
  struct PointBatch : PointStepArrays<batch_size>
  {
    double step[batch_size]; // of cells; n_points of them apart
    double stiffening[batch_size];
  };

  /** Numbers and corners of the cells, and arrays of their points. R = 1 for
      the Green-Naghdi rate. */
  void take(LocalCells cells);
  /** Corners of a cell [m]. */
  std::array<Vec, 8> corners_of(const std::size_t cell,
                                const AlignedVector<Vec> &X) const;
  /** What the rules have in common of keep(). */
  void keep_points(const std::vector<std::size_t> &kept);
  /** F at a point. From the undeformed state, as of the last kinematics; of
      point q of cell e by e n_points + q. */
  virtual Mat gradient(const std::size_t point) const = 0;
  /** Stress, work and state of @p m points from @p begin on; steps of cells
      that are stiffer than at rest. Forces only at @p dt = 0. In between:
      for the Green-Naghdi rate the spin is replaced by that of the polar
      rotation; then rotate(), law and finish() of MaterialPoints; then each
      cell's step from the batch, over the square root of the largest
      stiffening of its points. */
  void update_points(const std::size_t begin, const std::size_t m,
                     const double dt, PointBatch &batch);
  /** Judges a step that took @p cell from volume ratio @p J_old to @p J, a
      third or more lost. Throws PhysicsError, or notes the cell. @return
      whether the cell shall rest as it was. With stop: throws. With erode:
      the cell is noted, and rests where J <= 0. With shrink: goes on as long
      as J > 0, throws beyond. Not on the fast path. */
  bool avoid_inversion(const NodalState &nodes, const std::size_t cell,
                       const double J_old, const double J);
  /** What the kernels of cells need of material and options. Lame's lambda =
      K - 2 mu/3 at rest. */
  CellConstants cell_constants() const;
  /** The body's smallest step, and the cell's where asked for. */
  void note_step(const std::size_t cell, const double step)
  {
    if (step < smallest_step.dt)
      smallest_step = {step, cell_id[cell]};
    if (!cell_step.empty())
      cell_step[cell] = std::min(cell_step[cell], step);
  }
  /** Before the first note_step() of a step. Sets them to the largest
      double, in cell_step too. */
  void reset_steps();

  const std::string body_name;
  const FemOptions options;
  const std::shared_ptr<const Material> material;
  const unsigned int n_points; // of a cell
  MaterialPoints points;
  AlignedVector<Mat> polar_rotation; // R, for the Green-Naghdi rate only

private:
  /** Replace the spin increments by those of R, F = R U. R by polar
      decomposition of F at each point; the spin is the Cayley spin of R
      R_old^T, so that rotate() turns by exactly that increment. Without the
      oscillation of the Jaumann rate in large elastic simple shear. */
  void polar_spin(const std::size_t begin, const std::size_t m,
                  PointBatch &batch);
  /** F with the volume ratio that the material sees. With several points a
      cell (J/det F)^(1/3) F, J the cell's mean volume ratio (F-bar, de Souza
      Neto et al. 1996), else F itself; row by row into the batch. */
  void set_deformation_gradient(const std::size_t begin, const std::size_t m,
                                PointBatch &batch) const;
  /** rotate(), the law and finish() for points of one batch, dt > 0 [s]. */
  void update_stress(const std::size_t begin, const std::size_t m,
                     const double dt, PointBatch &batch);
  double sum_points(const AlignedVector<double> &values,
                    const std::size_t e) const
  {
    double sum = 0.;
    for (std::size_t q = e * n_points; q < (e + 1) * n_points; ++q)
      sum += values[q];
    return sum;
  }
  std::vector<double> cell_means(const AlignedVector<double> &rows) const;
};

/** The next multiple that is not less than @p n. */
inline std::size_t round_up(const std::size_t n, const std::size_t multiple)
{
  return (n + multiple - 1) / multiple * multiple;
}
} // namespace sabot

#endif
