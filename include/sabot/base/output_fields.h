#ifndef sabot_base_output_fields_h
#define sabot_base_output_fields_h

#include <string>
#include <vector>

namespace sabot
{
/** What a field of the output means: a row of the reference. */
struct FieldDescription
{
  std::string name, unit;    // SI
  unsigned int n_components; // 1, 3 (x, y, z), 6 (xx, yy, zz, xy, yz, xz)
  std::string bodies;        // whose: "all bodies", "particles", ...
  std::string meaning;       // with frame and sign, one or two sentences
};

/** All fields that some body or material may write, sorted by name. A body
    writes those it has; doc/reference/fields.md is this list. */
const std::vector<FieldDescription> &described_fields();

/** The description of a field; std::logic_error for one without, so that
    nothing is written that the reference does not know. */
const FieldDescription &described_field(const std::string &name);

/**
 * Makes a field known: one static object in the file that makes its values.
 * This is the one place where its unit stands. A state variable of a material
 * is a field, too, unless it is a tensor.
 */
struct DescribeField
{
  explicit DescribeField(const FieldDescription &field);
};
} // namespace sabot

#endif
