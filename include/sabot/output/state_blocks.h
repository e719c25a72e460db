#ifndef sabot_output_state_blocks_h
#define sabot_output_state_blocks_h

#include "sabot/base/state_visitor.h"

#include <string>
#include <vector>

namespace sabot
{
/** One array of a saved state. */
struct StateBlock
{
  std::string name; // "body core/position"
  std::size_t n = 0, size = 0;
  std::vector<char> bytes; // [n * size]
};

/** Copies the arrays that it visits. */
class StateSaver : public StateVisitor
{
public:
  void visit(const std::string &name, void *data, std::size_t n,
             std::size_t size) override;

  std::string section; // put before each name, with a slash
  std::vector<StateBlock> blocks;
};

/** Overwrites the arrays that it visits, in the order in which they were
    saved. IOError when name or size differ from what was saved. */
class StateRestorer : public StateVisitor
{
public:
  explicit StateRestorer(std::vector<StateBlock> blocks);
  void visit(const std::string &name, void *data, std::size_t n,
             std::size_t size) override;
  std::size_t n_entries(const std::string &name, std::size_t n) const override;
  bool is_restoring() const override { return true; }

  std::string section;

private:
  const StateBlock &next(const std::string &name) const;

  std::vector<StateBlock> blocks;
  std::size_t position = 0;
};
} // namespace sabot

#endif
