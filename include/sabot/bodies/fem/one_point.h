#ifndef sabot_bodies_fem_one_point_h
#define sabot_bodies_fem_one_point_h

#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/kernels/pack.h"

namespace sabot
{
/**
 * One-point hexahedra with Flanagan-Belytschko hourglass control, in total
 * Lagrangian form (doc/theory-fem.md): with the mean gradients B_a of the
 * reference configuration,
 *
 *   F = sum x_a (x) B_a,  f_a = -V_0 J sigma F^-T B_a - hourglass,
 *   gamma_a = h_a - sum_b (h_b X_b) . B_a,  q = sum gamma_a x_a
 *
 * for stiffness control; viscous control takes gamma and q' = sum gamma_a v_a
 * in the present configuration, where sum gamma_a x_a = 0 (no torque).
 * Cells are computed four at a time, in the lanes of packs.
 */
class OnePoint : public Hexahedra
{
public:
  OnePoint(const std::string &body_name, const FemOptions &options,
           std::shared_ptr<const Material> material)
      : Hexahedra(body_name, options, material, 1)
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
  /** Reference data of four cells, read twice per step. */
  struct Geometry
  {
    Pack B[8][3];     // mean gradients [1/m]
    Pack square[6];   // sum B_a (x) B_a: xx, yy, zz, xy, yz, xz
    Pack volume;      // V_0; 0 in lanes without a cell
    Pack size_square; // V_0^(2/3)
    std::uint32_t node[8][n_lanes];
  };
  /** Per cell what the next step needs. The modes are, for stiffness control,
      sum h_b X_b, for viscous control the modal forces of the last step. */
  struct Motion
  {
    PackMat F;
    Pack mode[4][3];
  };
  /** Of one pack of cells, from kinematics to forces. */
  struct Pending
  {
    PackMat stress_to_force; // V_0 J F^-T
    PackMat hourglass;       // part of P that hourglass modes add
    Pack mode[4][3];         // modal forces
  };
  static constexpr std::size_t packs_per_batch = batch_size / n_lanes;

  template <bool viscous>
  void compute(NodalState &nodes, const double dt);
  template <bool viscous>
  void kinematics(const NodalState &nodes, const std::size_t pack,
                  const double dt);
  void scatter(NodalState &nodes, const std::size_t pack);
  void fill_up();

  AlignedVector<Geometry> geometry;
  AlignedVector<Motion> motion;
  PointBatch batch;
  alignas(64) Pending pending[packs_per_batch];
};
} // namespace sabot

#endif
