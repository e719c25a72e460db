// Heat between particles and nonlocal failure, as a body asks for them.
#include "sabot/bodies/spg/particle_heat.h"

#include "sabot/bodies/spg/approximation/approximation.h"
#include "sabot/bodies/spg/failure/bond_failure.h"
#include "sabot/bodies/spg/particle_fields.h"
#include "sabot/bodies/spg/spg_parts.h"

namespace sabot
{
void ParticleHeat::set_up(const SpgParts &body, BondFailure &failure,
                          MPI_Comm communicator)
{
  const ParticleConduction::Cloud cloud{body.bonds,
                                        body.exchange,
                                        body.fields.kernel_reference_position,
                                        body.approximation.moment_inverse,
                                        body.fields.kernel_reference_volume,
                                        body.approximation.lost_direction};
  const SpgOptions &options = body.options;
  const Material &law = body.points.law();
  std::vector<double> capacity = body.fields.reference_volume;
  if (options.nonlocal_length && options.can_fail())
    failure.average_by(std::make_unique<ParticleConduction>(
        *options.nonlocal_length * *options.nonlocal_length, cloud, capacity,
        communicator));
  for (double &c : capacity)
    c *= law.density() * law.specific_heat();
  if (options.conducts_heat)
    conduction = std::make_unique<ParticleConduction>(
        law.conductivity(), cloud, std::move(capacity), communicator);
}

void ParticleHeat::advance(const double time, const double interval,
                           MaterialPoints &points)
{
  if (!conduction || time < last + interval)
    return;
  conduction->advance(time - last, points.state("temperature"));
  last = time;
}

void ParticleHeat::visit_state(StateVisitor &visitor)
{
  if (conduction)
    visitor.visit_value("last conduction", last);
}
} // namespace sabot
