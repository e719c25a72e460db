#ifndef tests_materials_point_h
#define tests_materials_point_h

#include "sabot/kernels/stress_update.h"
#include "sabot/materials/laws.h"

#include <cmath>
#include <vector>

/** One material point under a prescribed velocity gradient. */
struct Point
{
  explicit Point(const sabot::Material &material) : material(material)
  {
    for (const auto &variable : material.state_variables())
      for (int c = 0; c < (variable.is_tensor ? 6 : 1); ++c)
        state.push_back(variable.initial_value);
  }

  /** Apply l dt = strain (xx, yy, zz, xy, yz, xz) and spin (xy, yz, xz). */
  void step(const double (&strain)[6], const double (&spin)[3], const double dt)
  {
    using namespace sabot;
    const Mat half_l = {{vec(0.5 * strain[0], 0.5 * (strain[3] + spin[0]),
                             0.5 * (strain[5] + spin[2])),
                         vec(0.5 * (strain[3] - spin[0]), 0.5 * strain[1],
                             0.5 * (strain[4] + spin[1])),
                         vec(0.5 * (strain[5] - spin[2]),
                             0.5 * (strain[4] - spin[1]), 0.5 * strain[2])}};
    F = inverse(Mat::identity() - half_l) * (Mat::identity() + half_l) * F;
    double gradient[9];
    const double *const w[3] = {&spin[0], &spin[1], &spin[2]};
    double *s[6];
    const double *e[6];
    for (int c = 0; c < 6; ++c)
    {
      s[c] = &stress[c];
      e[c] = &strain[c];
    }
    sabot::rotate_symmetric(1, w, s);
    jacobian = determinant(F);
    const double *const now[6] = {s[0], s[1], s[2], s[3], s[4], s[5]};
    const double half = 0.5;
    sabot::half_work(1, now, e, &half, &energy);
    std::vector<double *> states;
    for (double &value : state)
      states.push_back(&value);
    const double extra = 0.;
    sabot::MaterialBatch batch;
    batch.n = 1;
    batch.dt = dt;
    for (int c = 0; c < 6; ++c)
    {
      batch.strain_increment[c] = e[c];
      batch.stress[c] = s[c];
    }
    batch.jacobian = &jacobian;
    batch.states = states.data();
    batch.extra_square = &extra;
    batch.return_factor = &theta;
    batch.plastic_work = &work;
    batch.viscous_pressure = &viscous_pressure;
    if (material.needs_deformation_gradient())
      for (int c = 0; c < 9; ++c)
      {
        gradient[c] = F(c / 3, c % 3);
        batch.deformation_gradient[c] = &gradient[c];
      }
    if (material.stiffens())
      batch.stiffening = &stiffening;
    material.update(batch);
    sabot::half_work(1, now, e, &half, &energy);
    plastic_work += work;
  }

  const sabot::Material &material;
  double stress[6] = {0, 0, 0, 0, 0, 0};
  double jacobian = 1., theta = 1., work = 0., energy = 0., plastic_work = 0.;
  double viscous_pressure = 0., stiffening = 1.;
  sabot::Mat F = sabot::Mat::identity();
  std::vector<double> state;
};

#endif
