#ifndef sabot_bodies_fem_hexahedra_h
#define sabot_bodies_fem_hexahedra_h

#include "sabot/base/nodal_state.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/fem/cell_kernels.h"
#include "sabot/bodies/fem/fem_options.h"
#include "sabot/bodies/material_points.h"
#include "sabot/geometry/hex_mesh.h"

#include <algorithm>
#include <memory>

namespace sabot
{
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
 */
class Hexahedra
{
public:
  // For the registry of rules.
  static constexpr const char *kind = "integration rule";
  using Make = std::unique_ptr<Hexahedra>(const std::string &body_name,
                                          const FemOptions &options,
                                          std::shared_ptr<const Material>);

  Hexahedra(const std::string &body_name, const FemOptions &options,
            std::shared_ptr<const Material> material,
            const unsigned int n_points);
  virtual ~Hexahedra() = default;

  /** Take the cells of @p mesh with these numbers and local nodes. */
  virtual void
  set_up(const HexMesh &mesh, const std::vector<GlobalIndex> &cell_id,
         const std::vector<std::array<std::uint32_t, 8>> &connectivity) = 0;
  /** Subtract the internal forces of all cells; advance their state by the step
      @p dt that led here (0 at the start: forces only). */
  virtual void add_forces(NodalState &nodes, const double dt) = 0;
  /** What add_forces() added for one cell, recomputed. */
  virtual void cell_forces(const NodalState &nodes, const std::size_t cell,
                           Vec force[8]) const = 0;
  /** Keep these cells only, ascending. */
  virtual void keep(const std::vector<std::size_t> &kept) = 0;
  /** Everything of the cells that a restart needs; the rules add their own. */
  virtual void visit_state(StateVisitor &visitor);

  std::size_t size() const { return connectivity.size(); }
  /** Local nodes of the corners, VTK order; numbers of the cells in the mesh.
   */
  std::vector<std::array<std::uint32_t, 8>> connectivity;
  std::vector<GlobalIndex> cell_id;
  std::vector<double> volume;             // V_0 [m^3]
  AlignedVector<double> hourglass_energy; // [J]
  /** Internal energy and plastic work of cell @p e [J]. */
  double internal_energy(const std::size_t e) const
  {
    return sum_points(points.internal_energy, e);
  }
  double plastic_work(const std::size_t e) const
  {
    return sum_points(points.plastic_work, e);
  }
  /** Means over the points of each cell, [row][size()]. */
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
  /** Present flow stress of some cells [Pa], the mean of their points. */
  std::vector<double> flow_stress(const std::vector<std::size_t> &some) const;
  /** Add the change of each cell to a scalar state variable at its points. */
  void shift_state(const std::string &name, const std::vector<double> &change);

  /** The least over the cells, as of the last add_forces(). */
  StableStep smallest_step;
  std::vector<double> cell_step;      // [s], kept where erosion asks for it
  std::vector<std::size_t> inverting; // cells seen by avoid_inversion()

protected:
  /** Points per batch; what one needs stays in the first-level cache. */
  static constexpr std::size_t batch_size = 32;
  static_assert(batch_size <= max_batch_points, "materials take no more");
  /** What a batch carries from kinematics to the material and back. */
  struct PointBatch : PointStepArrays<batch_size>
  {
    double step[batch_size]; // of cells; n_points of them apart
    double stiffening[batch_size];
  };

  /** Arrays of points for the cells of connectivity. */
  void allocate_points();
  /** What the rules have in common of keep(). */
  void keep_points(const std::vector<std::size_t> &kept);
  /** F at a point. */
  virtual Mat gradient(const std::size_t point) const = 0;
  /** Stress, work and state of @p m points from @p begin on; steps of cells
      that are stiffer than at rest. Forces only at @p dt = 0. */
  void update_points(const std::size_t begin, const std::size_t m,
                     const double dt, PointBatch &batch);
  /** Judges a step that took @p cell from volume ratio @p J_old to @p J, a
      third or more lost. Throws PhysicsError, or notes the cell.
      @return whether the cell shall rest as it was. */
  bool avoid_inversion(const NodalState &nodes, const std::size_t cell,
                       const double J_old, const double J);
  /** What the kernels of cells need of material and options. */
  CellConstants cell_constants() const;
  /** The body's smallest step, and the cell's where asked for. */
  void note_step(const std::size_t cell, const double step)
  {
    if (step < smallest_step.dt)
      smallest_step = {step, cell_id[cell]};
    if (!cell_step.empty())
      cell_step[cell] = std::min(cell_step[cell], step);
  }
  /** Before the first note_step() of a step. */
  void reset_steps();

  const std::string body_name;
  const FemOptions options;
  const std::shared_ptr<const Material> material;
  const unsigned int n_points; // of a cell
  MaterialPoints points;
  AlignedVector<Mat> polar_rotation; // R, for the Green-Naghdi rate only

private:
  /** Replace the spin increments by those of R, F = R U. */
  void polar_spin(const std::size_t begin, const std::size_t m,
                  PointBatch &batch);
  /** F with the volume ratio that the material sees. */
  void set_deformation_gradient(const std::size_t begin, const std::size_t m,
                                PointBatch &batch) const;
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
