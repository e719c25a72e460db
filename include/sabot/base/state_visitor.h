#ifndef sabot_base_state_visitor_h
#define sabot_base_state_visitor_h

#include <cstddef>
#include <string>

namespace sabot
{
/**
 * Enumerates everything that a restart needs, in one place: each body and
 * coupling hands over its arrays by name. A visitor may read or overwrite
 * them.
 */
class StateVisitor
{
public:
  virtual ~StateVisitor() = default;
  /** @p n entries of @p size bytes each. */
  virtual void visit(const std::string &name, void *data, std::size_t n,
                     std::size_t size) = 0;
};
} // namespace sabot

#endif
