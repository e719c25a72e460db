// Bonds fail by the largest shear strain of their ends.
#include "sabot/base/registry.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/failure/failure_criterion.h"
#include "sabot/bodies/spg/particle_fields.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
constexpr const char *entry = "Critical shear strain";

/** Largest difference of two principal logarithmic strains of F. */
class ShearStrain : public FailureCriterion
{
public:
  using FailureCriterion::FailureCriterion;
  void measure(const MaterialPoints &points, const ParticleFields &fields,
               double *const value) const override
  {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const Mat F = fields.deformation_gradient(i);
      const Mat C = transpose(F) * F;
      Eigen::Matrix3d m;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          m(a, b) = C(a, b);
      const auto e = solver.compute(m, Eigen::EigenvaluesOnly).eigenvalues();
      value[i] =
          0.5 * std::log(std::max(1e-300, e[2]) / std::max(1e-300, e[0]));
    }
  }
};

const Registry<FailureCriterion>::Add registered(
    {"maximum shear strain",
     "largest difference of two principal logarithmic strains.",
     [](Parameters &prm)
     {
       declare_critical_strain(prm, entry,
                               "Mean over the ends of a bond above which it "
                               "may fail.");
     },
     [](const Parameters &prm, const std::string &)
     {
       return std::make_unique<const ShearStrain>(
           critical_value(prm, entry, 1e10));
     }});
} // namespace
} // namespace sabot
