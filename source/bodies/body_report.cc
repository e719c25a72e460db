// Output fields and measures that all bodies with material points have.
#include "sabot/bodies/body_report.h"

#include "sabot/base/exact_sum.h"
#include "sabot/kernels/stress_update.h"

#include <algorithm>
#include <limits>

namespace sabot
{
namespace
{
const DescribeField described[] = {
    DescribeField({"displacement", "m", 3, "all bodies",
                   "Current less initial position."}),
    DescribeField({"velocity", "m/s", 3, "all bodies", "Of the node."}),
    DescribeField({"stress", "Pa", 6, "cells, particles",
                   "Cauchy stress, in the current frame; positive in "
                   "tension."}),
    DescribeField({"von Mises", "Pa", 1, "cells, particles",
                   "sqrt(3/2 s:s) of the deviator s of the stress."}),
    DescribeField({"pressure", "Pa", 1, "cells, particles",
                   "Minus a third of the trace of the stress; positive in "
                   "compression."}),
    DescribeField({"body", "1", 1, "all bodies",
                   "Number of the body in the list of bodies, from 0."}),
    DescribeField({"rank", "1", 1, "all bodies", "MPI rank that owns it."})};
} // namespace

void add_material_fields(FieldList &fields,
                         const std::vector<std::size_t> &items,
                         const std::size_t n, const double *const stress,
                         const double *const state,
                         const std::vector<StateVariable> &variables)
{
  const auto stress_at = [&](const std::size_t i, const unsigned int c)
  { return stress[c * n + items[i]]; };
  add_field(fields, "stress", items.size(), stress_at);
  add_field(fields, "von Mises", items.size(),
            [&](const std::size_t i, const unsigned int)
            {
              double s[6];
              for (unsigned int c = 0; c < 6; ++c)
                s[c] = stress_at(i, c);
              return von_mises(s);
            });
  add_field(
      fields, "pressure", items.size(),
      [&](const std::size_t i, const unsigned int)
      { return -(stress_at(i, 0) + stress_at(i, 1) + stress_at(i, 2)) / 3.; });
  for (const StateVariable &variable : variables)
    if (!variable.is_tensor)
    {
      const double *const values =
          find_state(variables, state, n, variable.name);
      add_field(fields, variable.name, items.size(),
                [&](const std::size_t i, const unsigned int)
                { return values[items[i]]; });
    }
}

BodyMeasures measure_nodes(const NodalState &nodes, MPI_Comm communicator,
                           const std::vector<char> *const left_out)
{
  ExactSum mass, momentum[3], kinetic;
  double top[6];
  std::fill(std::begin(top), std::end(top),
            std::numeric_limits<double>::lowest());
  {
    ExactTerms masses(mass), energies(kinetic), x_momenta(momentum[0]),
        y_momenta(momentum[1]), z_momenta(momentum[2]);
    for (std::size_t i = 0; i < nodes.n_owned; ++i)
    {
      if (left_out != nullptr && (*left_out)[i])
        continue;
      const double m = nodes.lumped_mass[i];
      const Vec v = nodes.velocity[i], x = nodes.position[i];
      masses.add(m);
      energies.add(0.5 * m * norm_square(v));
      x_momenta.add(m * v[0]);
      y_momenta.add(m * v[1]);
      z_momenta.add(m * v[2]);
      for (int d = 0; d < 3; ++d)
      {
        top[d] = std::max(top[d], x[d]);
        top[3 + d] = std::max(top[3 + d], -x[d]);
      }
    }
  }
  ExactSum::reduce({&mass, &momentum[0], &momentum[1], &momentum[2], &kinetic},
                   communicator);
  MPI_Allreduce(MPI_IN_PLACE, top, 6, MPI_DOUBLE, MPI_MAX, communicator);
  BodyMeasures measures;
  measures.mass = mass.value();
  measures.kinetic_energy = kinetic.value();
  for (int d = 0; d < 3; ++d)
  {
    measures.velocity[d] =
        mass.value() > 0. ? momentum[d].value() / mass.value() : 0.;
    // No -0, which the largest may be or not, by the order of ranks and nodes.
    measures.low[d] = 0. - top[3 + d];
    measures.high[d] = top[d] + 0.;
  }
  return measures;
}

const double *find_state(const std::vector<StateVariable> &variables,
                         const double *const state, const std::size_t n,
                         const std::string &name)
{
  std::size_t first = 0;
  for (const StateVariable &variable : variables)
  {
    if (variable.name == name)
      return state + first * n;
    first += variable.is_tensor ? n_symmetric : 1;
  }
  return nullptr;
}

std::size_t count_states(const std::vector<StateVariable> &variables)
{
  std::size_t count = 0;
  for (const StateVariable &variable : variables)
    count += variable.is_tensor ? n_symmetric : 1;
  return count;
}
} // namespace sabot
