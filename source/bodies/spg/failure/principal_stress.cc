// Bonds fail by the largest principal stress of their ends.
#include "sabot/base/registry.h"
#include "sabot/bodies/material_points.h"
#include "sabot/bodies/spg/failure/failure_criterion.h"

#include <Eigen/Eigenvalues>

namespace sabot
{
namespace
{
constexpr const char *entry = "Critical principal stress";

class PrincipalStress : public FailureCriterion
{
public:
  using FailureCriterion::FailureCriterion;
  void measure(const MaterialPoints &points, const ParticleFields &,
               double *const value) const override
  {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      double s[6];
      for (int c = 0; c < 6; ++c)
        s[c] = points.stress_row(c)[i];
      Eigen::Matrix3d m;
      m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
      value[i] = solver.compute(m, Eigen::EigenvaluesOnly).eigenvalues()[2];
    }
  }
};

const Registry<FailureCriterion>::Add registered(
    {"maximum principal stress", "tensile.",
     [](Parameters &prm)
     {
       declare_critical_stress(prm, entry,
                               "Mean over the ends of a bond above which it "
                               "may fail.");
     },
     [](const Parameters &prm, const std::string &)
     {
       return std::make_unique<const PrincipalStress>(
           critical_value(prm, entry, 1e15));
     }});
} // namespace
} // namespace sabot
