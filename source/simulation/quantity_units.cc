// The units of the types of quantities, before there is any.
#include "sabot/simulation/quantity_of_interest.h"

#include <map>

namespace sabot
{
namespace
{
// Within a function: types tell before main, in any order.
std::map<std::string, std::string> &units()
{
  static std::map<std::string, std::string> all;
  return all;
}
} // namespace

UnitOfQuantity::UnitOfQuantity(const std::string &type, const std::string &unit)
{
  units()[type] = unit;
}

std::string unit_of_quantity(const std::string &type)
{
  const auto at = units().find(type);
  return at == units().end() ? "" : at->second;
}
} // namespace sabot
