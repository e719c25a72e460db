#ifndef sabot_bodies_spg_failure_failure_criterion_h
#define sabot_bodies_spg_failure_failure_criterion_h

#include <memory>
#include <optional>
#include <string>

namespace sabot
{
class Material;
class MaterialPoints;
class Parameters;
struct ParticleFields;

/**
 * By what bonds fail: a bond fails for ever when the mean of the measure over
 * its two particles exceeds the critical value and its stretch the critical
 * stretch (Wu & Wu 2018, Eqs. 19-21, for the effective plastic strain). One
 * file a criterion.
 *
 * Criteria have no state: what a bond has borne before is in the state of the
 * law. Damage is never mended, even where the measure falls again, since failed
 * bonds are removed.
 */
class FailureCriterion
{
public:
  static constexpr const char *kind = "failure criterion";
  using Make = std::unique_ptr<const FailureCriterion>(const Parameters &,
                                                       const std::string &path);

  /** @p critical: in the unit of the measure; nothing: bonds never fail. Pa
      for a stress, without unit for a strain. */
  explicit FailureCriterion(const std::optional<double> critical)
      : critical(critical)
  {
  }
  virtual ~FailureCriterion() = default;

  bool can_be_met() const { return critical.has_value(); }
  /** Only where can_be_met(). */
  double critical_value() const { return *critical; }

  /** The effective plastic strain at which a bond between points of @p law may
      fail: of damage that in slow shear, where the triaxiality is 0. For
      estimates before the run; nothing for measures that say nothing of it, or
      where bonds never fail. */
  virtual std::optional<double>
  critical_plastic_strain(const Material & /*law*/) const
  {
    return std::nullopt;
  }

  /** Throws InputError where the body's material does not know what the
      measure needs. @p path: of the body. Called once, when the body is
      made. */
  virtual void check(const MaterialPoints &, const std::string & /*path*/) const
  {
  }
  /** The measure of every owned particle, into @p value [n_owned]. Not
      averaged over neighbors: BondFailure takes the mean of the two ends and
      exchanges ghosts. Local. */
  virtual void measure(const MaterialPoints &points,
                       const ParticleFields &fields, double *value) const = 0;

private:
  const std::optional<double> critical;
};

/** Declares an entry of a critical value whose default is the word "never",
    of a stress [Pa], or of a strain. Negative values are refused. */
void declare_critical_stress(Parameters &prm, const std::string &name,
                             const std::string &meaning);
void declare_critical_strain(Parameters &prm, const std::string &name,
                             const std::string &meaning);
/** What it says; nothing for "never" and for the numbers from @p never on that
    older files have in its place. */
std::optional<double> critical_value(const Parameters &prm,
                                     const std::string &name,
                                     const double never);
} // namespace sabot

#endif
