// The facade of deal.II's parameter handler: the one file, beside the reader of
// files, that has to know it.
#include "sabot/base/parameters.h"

#include "sabot/base/declared_tree.h"
#include "sabot/base/quantity.h"

#include <deal.II/base/parameter_handler.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <stdexcept>

namespace sabot
{
namespace
{
namespace Patterns = dealii::Patterns;

/** See word_or(). */
class WordOrPattern : public Patterns::PatternBase
{
public:
  WordOrPattern(const std::string &word, const Pattern &other)
      : word(word), other(other)
  {
  }
  bool match(const std::string &text) const override
  {
    return text == word || other.match(text);
  }
  std::string description(const OutputStyle = Machine) const override
  {
    return word + ", or " + other.description();
  }
  std::unique_ptr<PatternBase> clone() const override
  {
    return std::make_unique<WordOrPattern>(*this);
  }

private:
  std::string word;
  Pattern other;
};

template <typename Type, typename... Arguments>
Pattern make_pattern(const Arguments &...arguments)
{
  return Pattern(std::make_shared<Type>(arguments...));
}
} // namespace

bool Pattern::match(const std::string &text) const
{
  return base->match(text);
}

std::string Pattern::description() const
{
  return base->description(dealii::Patterns::PatternBase::Machine);
}

Pattern any_text()
{
  return make_pattern<Patterns::Anything>();
}

Pattern name_list()
{
  return make_pattern<Patterns::List>(Patterns::Anything(), 0, 1000, ",");
}

Pattern one_of(const std::string &words)
{
  return make_pattern<Patterns::Selection>(words);
}

Pattern boolean()
{
  return make_pattern<Patterns::Bool>();
}

Pattern integer(const int low, const int high)
{
  return low == -2147483647 && high == 2147483647
             ? make_pattern<Patterns::Integer>()
         : high == 2147483647 ? make_pattern<Patterns::Integer>(low)
                              : make_pattern<Patterns::Integer>(low, high);
}

Pattern quantity(const Dimension dimension, const double min, const double max)
{
  return make_pattern<QuantityPattern>(dimension, min, max);
}

Pattern quantities(const Dimension dimension, const unsigned int n_min,
                   const unsigned int n_max, const double min, const double max)
{
  return make_pattern<QuantityPattern>(dimension, n_min, n_max, min, max);
}

Pattern word_or(const std::string &word, const Pattern &other)
{
  return make_pattern<WordOrPattern>(word, other);
}

Parameters::Parameters() : prm(std::make_unique<dealii::ParameterHandler>()) {}
Parameters::~Parameters() = default;

void Parameters::declare_entry(const std::string &name,
                               const std::string &standard,
                               const Pattern &pattern,
                               const std::string &meaning)
{
  prm->declare_entry(name, standard, pattern.get(), meaning);
  std::vector<std::string> path = section;
  path.push_back(name);
  declared.insert(path);
}

void Parameters::declare_knob(const std::string &name,
                              const std::string &standard,
                              const Pattern &pattern,
                              const std::string &meaning)
{
  const auto other = standards.find(name);
  declare_entry(name, other == standards.end() ? standard : other->second,
                pattern, meaning);
  mark_as_knob(name);
}

void Parameters::mark_as_knob(const std::string &name)
{
  all_knobs.push_back(section);
  all_knobs.back().push_back(name);
}

std::vector<std::pair<std::string, std::string>> Parameters::knobs()
{
  std::vector<std::pair<std::string, std::string>> values;
  for (const std::vector<std::string> &knob : all_knobs)
  {
    std::string path;
    for (std::size_t k = 0; k + 1 < knob.size(); ++k)
    {
      prm->enter_subsection(knob[k]);
      path += knob[k] + "/";
    }
    values.emplace_back(path + knob.back(), prm->get(knob.back()));
    for (std::size_t k = 0; k + 1 < knob.size(); ++k)
      prm->leave_subsection();
  }
  return values;
}

void Parameters::enter_subsection(const std::string &name)
{
  prm->enter_subsection(name);
  section.push_back(name);
}

void Parameters::leave_subsection()
{
  prm->leave_subsection();
  section.pop_back();
}

void Parameters::expect_declared(const std::string &name) const
{
  // deal.II asserts so in debug builds; else it gives an empty text.
  if (!is_declared(name))
    throw std::logic_error("entry \"" + name + "\" was not declared");
}

std::string Parameters::get(const std::string &name) const
{
  expect_declared(name);
  return prm->get(name);
}

bool Parameters::get_bool(const std::string &name) const
{
  expect_declared(name);
  return prm->get_bool(name);
}

long Parameters::get_integer(const std::string &name) const
{
  expect_declared(name);
  return prm->get_integer(name);
}

bool Parameters::is_declared(const std::string &name) const
{
  std::vector<std::string> path = section;
  path.push_back(name);
  return declared.count(path) > 0;
}

std::vector<std::string> Parameters::entry_names() const
{
  std::vector<std::string> names;
  nlohmann::ordered_json tree = declared_tree(*this);
  for (const std::string &name : section)
    tree = nlohmann::ordered_json(tree.value(name, nlohmann::ordered_json()));
  for (const auto &item : tree.items())
    if (is_entry(item.value()))
      names.push_back(item.key());
  return names;
}

bool Parameters::set(const std::string &name, const std::string &value)
{
  try
  {
    prm->set(name, value);
    return true;
  }
  catch (const dealii::ExceptionBase &)
  {
    return false;
  }
}

double get_quantity(const Parameters &prm, const std::string &name)
{
  return to_si(prm.get(name));
}

std::optional<double> get_optional_quantity(const Parameters &prm,
                                            const std::string &name)
{
  try
  {
    return to_si(prm.get(name));
  }
  catch (const std::invalid_argument &)
  {
    return std::nullopt;
  }
}

std::vector<double> get_quantities(const Parameters &prm,
                                   const std::string &name)
{
  std::vector<double> values;
  for (const std::string &item : split_at_commas(prm.get(name)))
    values.push_back(to_si(item));
  return values;
}

std::array<double, 3> get_vector(const Parameters &prm, const std::string &name)
{
  const std::vector<double> v = get_quantities(prm, name);
  return {{v[0], v[1], v[2]}};
}

std::optional<double> read_quantity(const std::string &text)
{
  for (int d = 0; d <= static_cast<int>(Dimension::conductivity); ++d)
    if (QuantityPattern(static_cast<Dimension>(d)).match(text))
      return to_si(text);
  return std::nullopt;
}

bool is_told_in(const std::string &text, const std::string &unit)
{
  return QuantityPattern(dimension_of_unit(unit).value_or(Dimension::none))
      .match(text);
}

std::vector<std::string> split_names(const std::string &text)
{
  std::vector<std::string> names;
  for (const std::string &name : split_at_commas(text))
    if (!name.empty())
      names.push_back(name);
  return names;
}
} // namespace sabot
