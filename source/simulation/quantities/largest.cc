// Quantity of interest: the extreme of a field over a body and over time, with
// its place and its time.
#include "sabot/base/nearest_name.h"
#include "sabot/base/output_fields.h"
#include "sabot/output/item_fields.h"
#include "sabot/simulation/directed_quantity.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
/** Over cells or particles, and over the rows of the histories so far. */
class Largest : public QuantityOfInterest
{
public:
  explicit Largest(const QuantityRequest &request)
      : path(request.path), body(request.body("Body")),
        field(request.prm.get("Field")),
        component(request.prm.get("Component")),
        which(request.prm.get("Value")), communicator(request.communicator)
  {
    std::vector<std::string> names;
    for (const FieldDescription &known : described_fields())
    {
      names.push_back(known.name);
      if (known.name == field)
        described = &known;
    }
    if (described == nullptr)
      throw_unknown_name(path + "/Field", "field", field, names);
    const unsigned int n = described->n_components;
    std::vector<std::string> allowed = {"magnitude"};
    for (unsigned int c = 0; n > 1 && c < n; ++c)
      allowed.push_back(component_name(n, c));
    if (n == 6)
      allowed.erase(allowed.begin());
    if (n > 1 &&
        std::find(allowed.begin(), allowed.end(), component) == allowed.end())
      throw_unknown_name(path + "/Component",
                         "component of field \"" + field + "\"", component,
                         allowed);
  }
  void check(const ColumnsOf &) override
  {
    if (!item_field(body.output_mesh({field}), field))
      throw InputError(path + "/Field", "body \"" + body.name +
                                            "\" has no field \"" + field +
                                            "\"; the reference says which "
                                            "bodies and laws have it");
  }
  void look(const double time) override
  {
    const OutputMesh mesh = body.output_mesh({field});
    const OutputField values = *item_field(mesh, field);
    const std::vector<std::array<double, 3>> positions = item_positions(mesh);
    // The least row: what is no number comes before all.
    std::array<double, 5> least;
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
      const double v = scalar(values, i);
      const std::array<double, 3> &x = positions[i];
      const std::array<double, 5> its = {
          {std::isnan(v) ? -1e308 : -rating(v), x[0], x[1], x[2], v}};
      if (i == 0 || its < least)
        least = its;
    }
    std::vector<double> best;
    if (!positions.empty())
      best.assign(least.begin(), least.end());
    if (least_row(best, 5, communicator) < 0)
      return;
    if (has_value && !(-best[0] > rating(found.value)))
      return;
    has_value = true;
    found = {best[4], time, {{best[1], best[2], best[3]}}};
  }
  double value() const override { return found.value; }
  std::string unit() const override { return described->unit; }
  Measures details() const override
  {
    return {{"at time", "s", found.time},
            {"x", "m", found.place[0]},
            {"y", "m", found.place[1]},
            {"z", "m", found.place[2]}};
  }
  void visit_state(StateVisitor &visitor, const std::string &name) override
  {
    visitor.visit_value(name + " has a value", has_value);
    visitor.visit_value(name + " value", found.value);
    visitor.visit_value(name + " time", found.time);
    visitor.visit_array(name + " place", found.place);
  }

private:
  struct Found
  {
    double value, time;          // SI, [s]
    std::array<double, 3> place; // then [m]
  };
  double scalar(const OutputField &values, const std::size_t i) const
  {
    const unsigned int n = values.n_components;
    const double *const v = &values.values[n * i];
    if (n == 1)
      return v[0];
    if (component == "magnitude")
      return std::hypot(v[0], v[1], v[2]);
    for (unsigned int c = 0; c < n; ++c)
      if (component_name(n, c) == component)
        return v[c];
    return 0.;
  }
  double rating(const double v) const
  {
    return which == "maximum" ? v : which == "minimum" ? -v : std::abs(v);
  }

  const std::string path;
  const Body &body;
  const std::string field, component, which;
  MPI_Comm communicator;
  const FieldDescription *described = nullptr;
  bool has_value = false;
  Found found{std::numeric_limits<double>::quiet_NaN(),
              std::numeric_limits<double>::quiet_NaN(),
              {}};
};

void declare(Parameters &prm)
{
  declare_body_of_quantity(prm);
  prm.declare_entry("Field", "von Mises", any_text(),
                    "Name of an output field, as the reference lists them.");
  prm.declare_entry("Component", "magnitude", any_text(),
                    "Of a vector magnitude, x, y or z; of a tensor xx, yy, zz, "
                    "xy, yz or xz; of other fields it is not looked at.");
  prm.declare_entry("Value", "maximum",
                    one_of("maximum|minimum|largest magnitude"),
                    "Which extreme.");
}

const Registry<QuantityOfInterest>::Add registered(
    {"largest",
     "the extreme of a field over the cells or particles of a body and over "
     "the rows of the histories so far; its time and place then stand in "
     "result.json.",
     declare, [](const QuantityRequest &request) {
       return std::make_unique<Largest>(request);
     }});
} // namespace
} // namespace sabot
