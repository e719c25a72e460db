#ifndef sabot_bodies_conversion_criterion_h
#define sabot_bodies_conversion_criterion_h

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sabot
{
class Material;
class Parameters;

/** Cells of a body on this rank as the criteria of conversion see them, made
    when asked for. Arrays [size()], by active cell. */
class CellConditions
{
public:
  virtual ~CellConditions() = default;
  virtual std::size_t size() const = 0;
  /** Of the undeformed cells, the mean of the corners [m]. */
  virtual std::vector<std::array<double, 3>> centers() const = 0;
  /** Means over a cell's points of a state of the law; empty: it has none. */
  virtual std::vector<double> state(const std::string &name) const = 0;
  /** Own stable step over that at the start of the run. */
  virtual std::vector<double> step_ratio() = 0;
  /** Least scaled Jacobian of the corners: the determinant of the three edges
      over the product of their lengths; 1 for a brick, 0 flat. */
  virtual std::vector<double> scaled_jacobian() const = 0;
  /** Longest over shortest edge, over the same of the undeformed cell. */
  virtual std::vector<double> stretch_of_aspect() const = 0;
  /** Whether a cell is within @p layers cells of a particle with broken bonds.
      Collective. */
  virtual std::vector<char> near_failure(const unsigned int layers) const = 0;
};

/**
 * When a cell of the host of a self-finding zone turns into particles. Several
 * may be named; a cell turns by any of them. One file each.
 */
class ConversionCriterion
{
public:
  static constexpr const char *kind = "conversion criterion";
  using Make = std::shared_ptr<const ConversionCriterion>(
      const Parameters &, const std::string &path);

  virtual ~ConversionCriterion() = default;
  /** Throws InputError for a law that cannot answer. @p path: of the body. */
  virtual void check(const Material &, const std::string & /*path*/) const {}
  /** Whether it asks for step_ratio(). */
  virtual bool needs_steps() const { return false; }
  /** How far metal flows until it speaks, for estimates before a run. */
  struct Onset
  {
    /** Effective plastic strain of a cell; nothing: where bonds fail. */
    std::optional<double> strain;
    double layers = 0.; // of cells ahead of that
  };
  virtual Onset onset() const = 0;
  /** Sets the cells that shall turn. Collective. */
  virtual void mark(CellConditions &cells, std::vector<char> &unfit) const = 0;
};
/** What a scene says of conversion. */
struct ConversionRequest
{
  std::vector<std::shared_ptr<const ConversionCriterion>> criteria;
  unsigned int interval = 10; // steps between looks at the cells
};
} // namespace sabot

#endif
