#ifndef sabot_bodies_body_report_h
#define sabot_bodies_body_report_h

#include "sabot/base/measures.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/output_fields.h"
#include "sabot/materials/material.h"

#include <mpi.h>

#include <vector>

namespace sabot
{
/**
 * Stress, von Mises, pressure and scalar state variables as output fields.
 * @param items   which of the n cells or particles, usually the owned ones
 * @param stress  [6][n], Cauchy [Pa], xx, yy, zz, xy, yz, xz; the pressure
 *                -tr/3 is positive in compression
 * @param state   [count_states()][n], in the order of the variables; tensors
 *                take six arrays and are left out
 */
void add_material_fields(FieldList &fields,
                         const std::vector<std::size_t> &items,
                         const std::size_t n, const double *stress,
                         const double *state,
                         const std::vector<StateVariable> &variables);

/** A field with value(item, component) for @p n items; unit and number of
    components are those of its description (base/output_fields.h). Item by
    item, components adjacent. The name must have been described, as
    DescribeField does at the bottom of the file that owns the field. Nothing
    where the list does not want it. Local. */
template <typename Value>
void add_field(FieldList &fields, const std::string &name, const std::size_t n,
               const Value &value)
{
  if (!fields.wants(name))
    return;
  const FieldDescription &described = described_field(name);
  OutputField field{name, described.unit, described.n_components, {}};
  field.values.reserve(n * field.n_components);
  for (std::size_t i = 0; i < n; ++i)
    for (unsigned int c = 0; c < field.n_components; ++c)
      field.values.push_back(value(i, c));
  fields.push_back(std::move(field));
}

/**
 * Mass [kg], velocity of the center of mass [m/s], kinetic energy [J] and
 * bounding box [m] of all owned nodes that are not left out ([n_owned], may be
 * null). Exact sums: collective, and the same for every number of ranks.
 */
BodyMeasures measure_nodes(const NodalState &nodes, MPI_Comm communicator,
                           const std::vector<char> *left_out = nullptr);

/** By name. Start of the array of a scalar state variable in [state][n], or
 * null. */
const double *find_state(const std::vector<StateVariable> &variables,
                         const double *state, const std::size_t n,
                         const std::string &name);

/** Number of arrays that the state variables take: one a scalar, six a
    tensor. */
std::size_t count_states(const std::vector<StateVariable> &variables);
} // namespace sabot

#endif
