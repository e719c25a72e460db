// Output of the state at a material point as a table over time.
#include "sabot/base/error.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/output_fields.h"
#include "sabot/base/parameters.h"
#include "sabot/base/registry.h"
#include "sabot/bodies/body.h"
#include "sabot/output/history.h"
#include "sabot/output/item_fields.h"
#include "sabot/output/output.h"
#include "sabot/output/run_files.h"

#include <algorithm>
#include <limits>

namespace sabot
{
namespace
{
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/** Fields that tell of the material and not of the program. */
const std::vector<std::string> &fields_of_a_state()
{
  static const std::vector<std::string> names = []
  {
    std::vector<std::string> some;
    for (const FieldDescription &field : described_fields())
      if (field.name != "body" && field.name != "rank" &&
          field.name != "fragment" && field.name != "diameter")
        some.push_back(field.name);
    return some;
  }();
  return names;
}

/** The particle, or the center of the cell, that was nearest to a point at the
    start, followed for the whole run; what nodes have is the mean over those of
    the cell. Of several at one distance the least by x, y, z, so that the ranks
    do not matter. */
class Gauge : public SceneOutput
{
public:
  Gauge(const Parameters &prm, const std::string &path)
      : path(path), body_name(prm.get("Body")), point(get_vector(prm, "Point"))
  {
  }
  void choose(const std::string &name,
              const std::vector<const Body *> &bodies) override
  {
    its_table = name;
    if (is_table_of_runs(name))
      throw InputError(path, "a gauge cannot be called \"" + name +
                                 "\": history.h5 has a table of this name");
    std::vector<std::string> names;
    for (const Body *const some : bodies)
    {
      names.push_back(some->name);
      if (some->name == body_name)
        body = some;
      if (some->name == name)
        throw InputError(path, "a body is called \"" + name +
                                   "\", too, and both would fill one table of "
                                   "the history; rename the gauge");
    }
    if (body == nullptr)
      throw_unknown_name(path + "/Body", "body", body_name, names);
    if (!body->facts().deforms)
      throw InputError(path + "/Body", "\"" + body_name +
                                           "\" is rigid and has no state at a "
                                           "point; name a body of cells or "
                                           "particles");
    check_point();
  }
  std::string table() const override { return its_table; }
  std::vector<std::string> columns() const override
  {
    std::vector<std::string> columns = {"time [s]"};
    for (const Measure &m : row_of(body->output_mesh(fields_of_a_state()), -1))
      columns.push_back(m.name + " [" + m.unit + "]");
    return columns;
  }

protected:
  void write(const OutputMoment &moment, RunFiles &files) override
  {
    const History::Table &so_far = files.history.tables[its_table];
    const std::size_t n = so_far.columns.size();
    if (n > 0 && so_far.values[so_far.values.size() - n] == moment.time)
      return;
    const std::vector<MaterialSite> sites = body->material_sites();
    if (!is_placed)
      find_place(sites, files.communicator);
    std::ptrdiff_t item = -1;
    for (std::size_t i = 0; i < sites.size() && item < 0; ++i)
      if (sites[i].reference_position == place)
        item = i;
    // Whoever owns it tells the others; nobody does once it has eroded.
    Measures row = row_of(body->output_mesh(fields_of_a_state()), item);
    int rank, owner;
    MPI_Comm_rank(files.communicator, &rank);
    owner = item >= 0 ? rank : -1;
    MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MAX,
                  files.communicator);
    std::vector<double> values;
    for (const Measure &m : row)
      values.push_back(m.value);
    if (owner >= 0)
      MPI_Bcast(values.data(), values.size(), MPI_DOUBLE, owner,
                files.communicator);
    for (std::size_t c = 0; c < row.size(); ++c)
      row[c].value = values[c];
    row.insert(row.begin(), {"time", "s", moment.time});
    files.history.append(its_table, row);
    if (moment.is_last)
      files.write_history();
  }
  void visit_more(StateVisitor &visitor, const std::string &name) override
  {
    visitor.visit_value(name + " is placed", is_placed);
    visitor.visit_array(name + " place", place);
  }

private:
  /** InputError where the point is not among the nodes of the body. */
  void check_point() const
  {
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::max());
    high.fill(std::numeric_limits<double>::lowest());
    for (const auto &p : body->partition_points())
      for (int d = 0; d < 3; ++d)
      {
        low[d] = std::min(low[d], p[d]);
        high[d] = std::max(high[d], p[d]);
      }
    const std::array<double, 3> spacing = body->facts().spacing;
    for (int d = 0; d < 3; ++d)
      if (point[d] < low[d] - spacing[d] || point[d] > high[d] + spacing[d])
        throw InputError(path + "/Point",
                         "it lies outside of body \"" + body_name +
                             "\", which reaches from " +
                             std::to_string(1e3 * low[d]) + " to " +
                             std::to_string(1e3 * high[d]) + " mm along " +
                             "xyz"[d]);
  }
  void find_place(const std::vector<MaterialSite> &sites, MPI_Comm communicator)
  {
    std::vector<double> best;
    for (const MaterialSite &site : sites)
    {
      const std::array<double, 3> &X = site.reference_position;
      double square = 0.;
      for (int d = 0; d < 3; ++d)
        square += (X[d] - point[d]) * (X[d] - point[d]);
      const std::vector<double> its = {square, X[0], X[1], X[2]};
      if (best.empty() || its < best)
        best = its;
    }
    if (least_row(best, 4, communicator) >= 0)
      place = {{best[1], best[2], best[3]}};
    is_placed = true;
  }
  /** Place and fields of an item of this rank; not a number for none. */
  static Measures row_of(const OutputMesh &mesh, const std::ptrdiff_t item)
  {
    Measures row;
    const std::vector<std::array<double, 3>> positions = item_positions(mesh);
    for (int d = 0; d < 3; ++d)
      row.push_back({std::string("position ") + "xyz"[d], "m",
                     item < 0 ? nothing : positions[item][d]});
    for (const std::string &name : fields_of_a_state())
      if (const std::optional<OutputField> field = item_field(mesh, name))
        for (unsigned int c = 0; c < field->n_components; ++c)
        {
          const std::string component = component_name(field->n_components, c);
          row.push_back(
              {name + (component.empty() ? "" : " ") + component, field->unit,
               item < 0 ? nothing
                        : field->values[field->n_components * item + c]});
        }
    return row;
  }

  const std::string path, body_name;
  const std::array<double, 3> point; // [m]
  std::string its_table;
  const Body *body = nullptr;
  std::array<double, 3> place{}; // of the item at the start [m]
  bool is_placed = false;
};

void declare(Parameters &prm)
{
  prm.declare_entry("Body", "", any_text(), "Gauges: name of the body.");
  prm.declare_entry("Point", "0 m, 0 m, 0 m",
                    quantities(Dimension::length, 3, 3, -1e3, 1e3),
                    "Gauges: a point of the body at the start; the particle or "
                    "the center of the cell nearest to it is followed.");
}

const Registry<SceneOutput>::Add registered(
    {"gauge",
     "the state at a material point over time, as the table of history.h5 that "
     "is named as the output: position, displacement, velocity, stress, state "
     "of the material.",
     declare, [](const Parameters &prm, const std::string &path) {
       return std::make_unique<Gauge>(prm, path);
     }});
} // namespace
} // namespace sabot
