// The list of what bodies may write as fields.
#include "sabot/base/output_fields.h"

#include <stdexcept>

namespace sabot
{
namespace
{
// Within a function: fields are described before main, in any order.
std::vector<FieldDescription> &all_fields()
{
  static std::vector<FieldDescription> fields;
  return fields;
}
} // namespace

const std::vector<FieldDescription> &described_fields()
{
  return all_fields();
}

const FieldDescription &described_field(const std::string &name)
{
  for (const FieldDescription &field : all_fields())
    if (field.name == name)
      return field;
  throw std::logic_error("field \"" + name + "\" was not described");
}

DescribeField::DescribeField(const FieldDescription &field)
{
  auto place = all_fields().begin();
  while (place != all_fields().end() && place->name < field.name)
    ++place;
  all_fields().insert(place, field);
}
} // namespace sabot
