#ifndef sabot_bodies_material_points_h
#define sabot_bodies_material_points_h

#include "sabot/base/measures.h"
#include "sabot/base/state_visitor.h"
#include "sabot/base/types.h"
#include "sabot/bodies/flow_stress.h"
#include "sabot/kernels/vec.h"
#include "sabot/materials/material.h"

#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/**
 * What a step does to the @p n consecutive points from @p begin on: views of
 * what their body has found from the motion, [n] each. Tensors in the order of
 * n_symmetric.
 *
 * Filled by the kinematics of a body for one batch, read by MaterialPoints and,
 * through the MaterialBatch that rotate() makes of it, by the law. A batch has
 * at most max_batch_points. Strain and spin are the symmetric and the skew part
 * of l = (F - F_old) [(F + F_old)/2]^-1 (Hughes & Winget 1980), increments
 * without unit.
 */
struct PointStep
{
  std::size_t begin = 0, n = 0;
  double dt = 0.; // [s] > 0
  /** Strain increment of the middle configuration, tensor components; turned
      to the end of the step by rotate(). */
  double *strain[n_symmetric] = {};
  /** Skew part of l: w_ij = (l_ij - l_ji)/2, of which the rotation R of the
      step is made. */
  const double *spin[3] = {}; // increments w_xy, w_yz, w_xz
  /** Volume ratio to the undeformed state, not to the last kernel update;
      what an equation of state asks for. */
  const double *jacobian = nullptr; // det F, total, new
  /** (v_old + v_new)/4: with it the trapezoidal rule of the work is one
      multiplication per stress. */
  const double *half_volume = nullptr; // half of the mean volume [m^3]
  /** Bulk viscosity q >= 0 at the end of the step, which acts beside the
      law's stress as sigma - q 1 and never enters its yield condition. */
  const double *viscous_pressure = nullptr; // artificial, new [Pa]
  /** Stress beside the stress, and what the return does to both; see
      MaterialBatch. [Pa^2], added to the square of the von Mises stress;
      null: none. The return factor theta scales deviator and extra stress
      alike. The plastic work is that of the whole step per mean volume. */
  const double *extra_square = nullptr;
  double *return_factor = nullptr;
  double *plastic_work = nullptr; // [J/m^3]

  // What only some laws need, as in MaterialBatch.
  /** Mean of old and new q, for laws whose internal energy counts the
      heating of a shock: room for [n], filled by rotate(). */
  double *mean_viscous_pressure = nullptr; // room for it
  /** Total F at the end of the step, row by row. */
  const double *deformation_gradient[9] = {};
  /** Dilatational modulus over the one at rest, written by laws that
      stiffen; the stable step goes down by its square root. */
  double *stiffening = nullptr;
};

/** Room for a PointStep of at most @p capacity points. On the body, not on
    the stack of the loop: a batch's arrays stay in the first-level cache
    from kinematics to forces. */
template <std::size_t capacity>
struct PointStepArrays
{
  alignas(64) double strain[n_symmetric][capacity];
  double spin[3][capacity];
  double jacobian[capacity], half_volume[capacity];
  double viscous_pressure[capacity];
  double return_factor[capacity], plastic_work[capacity];
  double mean_viscous_pressure[capacity];
  double deformation_gradient[9][capacity];

  /** Views for @p n points from @p begin on; extra_square and stiffening are
      left to the body. */
  PointStep views(const std::size_t begin, const std::size_t n, const double dt)
  {
    PointStep step;
    step.begin = begin;
    step.n = n;
    step.dt = dt;
    for (int c = 0; c < n_symmetric; ++c)
      step.strain[c] = strain[c];
    for (int c = 0; c < 3; ++c)
      step.spin[c] = spin[c];
    for (int c = 0; c < 9; ++c)
      step.deformation_gradient[c] = deformation_gradient[c];
    step.jacobian = jacobian;
    step.half_volume = half_volume;
    step.viscous_pressure = viscous_pressure;
    step.return_factor = return_factor;
    step.plastic_work = plastic_work;
    step.mean_viscous_pressure = mean_viscous_pressure;
    return step;
  }
};

/**
 * The points at which a body knows its material, quadrature points and
 * particles alike: Cauchy stress, state of the law, viscous pressure and
 * energies, as structure of arrays [row][stride()] of which the first size()
 * points count; rows may be padded to whole vectors.
 *
 * A step of a batch is rotate(), the law's update() and finish():
 *
 *   sigma <- R sigma R^T,  W += V/2 sigma : d eps     (rotate)
 *   sigma <- law(sigma, d eps)                        (by the body)
 *   W += V/2 sigma : d eps - V/2 (q_old + q_new) tr d eps  (finish)
 *
 * with R of the increment of spin (Hughes & Winget 1980) and V the mean volume
 * of the step, so that W is the trapezoidal rule. No function is collective.
 */
class MaterialPoints
{
public:
  /** No points yet; the material is shared with other bodies and is not
      changed by updates, all state is here. */
  explicit MaterialPoints(std::shared_ptr<const Material> material);

  /** @p n points at rest, rows padded to @p stride >= n. Stress, viscous
      pressure and energies are zero, state variables have the initial values
      of the law, padding included. */
  void allocate(const std::size_t n, const std::size_t stride);
  /** Room for @p n points, more than there are, rows without padding; new ones
      as allocate() leaves them. */
  void extend(const std::size_t n);
  /** Keep the groups of @p per_group consecutive points with the ascending
      numbers @p kept; the new rows, of length @p stride, are filled up with
      copies of the last point. Rows move to the front, which must not be
      longer than before; padded points go through the law like the others
      and must be in a state that it can update. */
  void keep(const std::vector<std::size_t> &kept, const std::size_t per_group,
            const std::size_t stride);

  /** Rotate stress and tensors of state to the end of the step, add the work
      of the old stress. @return views for the law's update(). Stress and
      tensors are turned exactly by R = (1 - w/2)^-1 (1 + w/2), strains to
      the frame of the end of the step, in which the law works. The views are
      valid until the next call: the rows of the state are those of the last
      one. */
  MaterialBatch rotate(const PointStep &step);
  /** After the law's update(): work of the new stress and of the viscous
      pressure [J], plastic work [J]. Adds to internal_energy V/2 sigma : d
      eps - V/2 (q_old + q_new) tr d eps and to plastic_work V times the
      law's density, and keeps the new viscous pressure for the next step. */
  void finish(const PointStep &step);

  const Material &law() const { return *material; }
  const std::vector<StateVariable> &variables() const
  {
    return state_variables;
  }
  std::size_t size() const { return n_points; }
  /** Distance of two rows; size() and what pads it to whole packs. */
  std::size_t stride() const { return row_length; }
  /** Rows of the state: one per scalar, six per tensor variable. */
  std::size_t n_rows() const { return n_state_rows; }

  /** Component @p c of the stress of all points [Pa]. c = xx, yy, zz, xy,
      yz, xz; in the present frame, positive in tension. */
  double *stress_row(const int c) { return &stress[c * row_length]; }
  const double *stress_row(const int c) const
  {
    return &stress[c * row_length];
  }
  /** sigma - q 1 of a point, q its viscous pressure unless given [Pa]. This
      is the stress that makes nodal forces, in the present frame. */
  Mat total_stress(const std::size_t point, const double q) const
  {
    const double *const s = &stress[point];
    const std::size_t n = row_length;
    return {{vec(s[0] - q, s[3 * n], s[5 * n]),
             vec(s[3 * n], s[n] - q, s[4 * n]),
             vec(s[5 * n], s[4 * n], s[2 * n] - q)}};
  }
  Mat total_stress(const std::size_t point) const
  {
    return total_stress(point, viscous_pressure[point]);
  }
  /** One row of the state of all points, [stride()], in the order of
      variables(). */
  const double *state_row(const std::size_t row) const
  {
    return &state_data[row * row_length];
  }
  double *state_row(const std::size_t row)
  {
    return &state_data[row * row_length];
  }
  /** Values of a state variable, the first component of a tensor; null where
      the law has none of this name. */
  const double *state(const std::string &name) const;
  double *state(const std::string &name);
  /** Whether the law has it; the same on ranks without points. */
  bool has_state(const std::string &name) const;

  /** Append a point of volume ratio @p jacobian to those that a probe asks
      for their flow stress. The probe copies pressure and state and finds
      the flow stress by trial returns; the point is not changed. */
  void add_to(FlowStressProbe &probe, const std::size_t point,
              const double jacobian) const;
  /** Stress, von Mises stress, pressure and scalar states as output fields.
      Values in the order of points; units as registered in body_report.cc. */
  void add_fields(FieldList &fields,
                  const std::vector<std::size_t> &points) const;
  /** Everything that a restart needs, bit by bit; @p per_item points of each of
      the @p items. What pads rows gets copies of the last point. */
  void visit_state(StateVisitor &visitor, const StateItems &items,
                   const std::size_t per_item);

  AlignedVector<double> stress;           // [6][stride()] Cauchy [Pa]
  AlignedVector<double> state_data;       // [n_rows()][stride()]
  AlignedVector<double> viscous_pressure; // of the last step [Pa]
  AlignedVector<double> internal_energy;  // work of the stresses [J]
  AlignedVector<double> plastic_work;     // part of it [J]

private:
  const std::shared_ptr<const Material> material;
  const std::vector<StateVariable> state_variables;
  const std::size_t n_state_rows;
  std::size_t n_points = 0, row_length = 0;
  std::vector<double *> rows; // of a batch, while it is updated
};
} // namespace sabot

#endif
