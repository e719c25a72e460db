// Adds the failure criterion "maximum principal strain": bonds fail where the
// metal is stretched too far along some direction,
//
//   ln(lambda_1) > critical value,
//
// lambda_1 the largest principal stretch of F, so that lambda_1^2 is the
// largest eigenvalue of F^T F (Saint-Venant's criterion, with Hencky's strain:
// H. Hencky, Z. Techn. Phys. 9 (1928) 215). To keep it, copy this file into
// source/bodies/spg/failure. Scene: failure_criterion.prm.
#include "sabot/bodies/spg/failure/failure_criterion.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/particle_fields.h"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace sabot
{
namespace
{
constexpr const char *entry = "Critical principal strain";

class PrincipalStrain : public FailureCriterion
{
public:
  using FailureCriterion::FailureCriterion;
  void measure(const MaterialPoints &points, const ParticleFields &fields,
               double *const value) const override
  {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const Mat F = fields.deformation_gradient(i), C = transpose(F) * F;
      Eigen::Matrix3d m;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          m(a, b) = C(a, b);
      const double square =
          solver.compute(m, Eigen::EigenvaluesOnly).eigenvalues()[2];
      value[i] = 0.5 * std::log(square);
    }
  }
};

const Registry<FailureCriterion>::Add registered(
    {"maximum principal strain", "tensile, logarithmic.",
     [](Parameters &prm)
     {
       declare_critical_strain(prm, entry,
                               "Mean over the ends of a bond above which it "
                               "may fail.");
     },
     [](const Parameters &prm, const std::string &)
     {
       return std::make_unique<const PrincipalStrain>(
           critical_value(prm, entry, 1e10));
     }});
} // namespace
} // namespace sabot
