#ifndef sabot_output_output_h
#define sabot_output_output_h

#include <memory>
#include <string>
#include <vector>

namespace sabot
{
class Body;
class Parameters;
class RunFiles;
class StateVisitor;

/** What outputs may look at, once the step is done. */
struct OutputMoment
{
  double time;                      // [s]
  unsigned int step;                // of the run, 0 at its start
  bool is_last;                     // nothing follows: also when the run failed
  std::vector<const Body *> bodies; // in the scene's order
};

/**
 * What a run leaves at intervals of physical time. A new one is one file: a
 * class that writes, its entries, and on its last line its registration,
 *
 *     const Registry<SceneOutput>::Add registered(
 *         {"VTU", "fields of all bodies for ParaView.", nullptr, make});
 *
 * Its entries stand beside "Type" and "Interval", which all outputs have. At
 * the start and at the end everything is written, in between where the
 * multiples of the interval fall due; the step is not cut to meet them.
 */
class SceneOutput
{
public:
  static constexpr const char *kind = "output";
  /** Makes one from the present subsection, whose path is @p path, for
      messages; InputError. */
  using Make = std::unique_ptr<SceneOutput>(const Parameters &prm,
                                            const std::string &path);

  virtual ~SceneOutput() = default;

  /** Declares the entries of one output in the present subsection: those of
      all, and those of @p type; of all types where there is no such type, as
      the manual shows them. */
  static void declare_parameters(Parameters &prm, const std::string &type);
  /** The output that the present subsection describes. InputError. */
  static std::unique_ptr<SceneOutput> make(const Parameters &prm,
                                           const std::string &path);

  /** Whether a write falls due at @p time [s], up to 1e-9 of the interval; the
      same on every rank. Depends on nothing that a later end time changes. */
  bool is_due(const double time) const
  {
    return time >= next - 1e-9 * interval;
  }
  /** Time between two writes [s]. */
  double period() const { return interval; }
  /** Whether it writes the fields of all bodies. */
  virtual bool writes_fields() const { return false; }
  /** Whether the run appends rows to the histories when this is due; it does so
      before the write. */
  virtual bool needs_rows() const { return false; }

  /** Once, when the bodies of the scene are known; InputError where they do not
      have what it asks for. @p name: in the list of outputs. Not collective. */
  virtual void choose(const std::string & /*name*/,
                      const std::vector<const Body *> & /*bodies*/)
  {
  }
  /** Name of the table of the histories to which it adds rows; empty: none. */
  virtual std::string table() const { return ""; }
  /** Columns of that table, "name [unit]", once the bodies have been
      distributed. Collective. */
  virtual std::vector<std::string> columns() const { return {}; }

  /** Called once before the first write. Collective; IOError on all ranks. */
  virtual void open(RunFiles & /*files*/) {}
  /** write() where it is due or @p moment the last; then the next multiple of
      the interval falls due. Collective; IOError on all ranks. */
  void write_when_due(const OutputMoment &moment, RunFiles &files);
  /** The time that falls due next, as part of the state @p name, then what the
      kind of output keeps. */
  void visit_state(StateVisitor &visitor, const std::string &name);

protected:
  virtual void visit_more(StateVisitor &, const std::string & /*name*/) {}
  /** Collective; every rank must throw IOError when one cannot write. */
  virtual void write(const OutputMoment &moment, RunFiles &files) = 0;

private:
  double interval = 0.; // [s]
  double next = 0.;     // [s]
};
} // namespace sabot

#endif
