// Arrays of an SPG body's particles: start, room for ghosts, checkpoint.
#include "sabot/bodies/spg/particle_fields.h"

#include "sabot/bodies/spg/mirror_planes.h"

namespace sabot
{
void ParticleFields::allocate(const std::vector<double> &volume,
                              const bool stiffens)
{
  const std::size_t n = volume.size();
  reference_volume = kernel_reference_volume = volume;
  incremental_deformation_gradient.assign(n, Mat::identity());
  kernel_reference_deformation_gradient.assign(n, Mat::identity());
  this->stiffens = stiffens;
  if (stiffens)
    stiffening.assign(n, 1.);
  own_force.assign(n, Vec{});
}

void ParticleFields::extend(const std::size_t n_owned)
{
  const std::size_t before = reference_volume.size();
  for (const std::size_t n : {before, n_owned})
    resize(n);
  reference_volume.resize(n_owned, 0.);
  kernel_reference_volume.resize(n_owned, 0.);
  incremental_deformation_gradient.resize(n_owned, Mat::identity());
  kernel_reference_deformation_gradient.resize(n_owned, Mat::identity());
  if (stiffens)
    stiffening.resize(n_owned, 1.);
  own_force.resize(n_owned, Vec{});
}

void ParticleFields::note_planes(const MirrorPlanes &mirror,
                                 const NodalState &nodes)
{
  if (!mirror.any())
    return;
  copies.clear();
  for (const std::uint8_t on : mirror.planes_of(nodes))
    copies.push_back(MirrorPlanes::copies(on));
}

void ParticleFields::resize(const std::size_t n_local)
{
  generalized_stress.resize(n_local, Mat::zero());
  kernel.resize(n_local);
  kernel_reference_position.resize(n_local);
}

void ParticleFields::visit_state(StateVisitor &visitor, const StateItems &items)
{
  visitor.visit_items("kernel position", kernel_reference_position, items);
  visitor.visit_items("kernel", kernel, items);
  visitor.visit_items("kernel volume", kernel_reference_volume, items);
  visitor.visit_items("gradient", incremental_deformation_gradient, items);
  visitor.visit_items("total gradient", kernel_reference_deformation_gradient,
                      items);
  visitor.visit_items("stiffening", stiffening, items);
}
} // namespace sabot
