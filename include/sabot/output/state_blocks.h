#ifndef sabot_output_state_blocks_h
#define sabot_output_state_blocks_h

#include "sabot/base/state_visitor.h"

#include <string>
#include <vector>

namespace sabot
{
/**
 * One array of a saved state, bit by bit.
 * What CheckpointFolder stores, with a checksum of each.
 */
struct StateBlock
{
  std::string name;        // "body core/position"
  std::size_t n = 0;       // entries
  std::size_t size = 0;    // of an entry [bytes]
  std::vector<char> bytes; // [n * size]
};

/**
 * Copies the arrays that it visits: what a rank has to save. Takes as much
 * memory as the state, for as long as it lives.
 * Changes nothing of what it visits. Not collective.
 */
class StateSaver : public StateVisitor
{
public:
  void visit(const std::string &name, void *data, std::size_t n,
             std::size_t size) override;

  std::string section; // put before each name, with a slash: "body core"
  std::vector<StateBlock> blocks; // in the order of the visits
};

/**
 * Overwrites the arrays that it visits, in the order in which they were saved.
 * IOError, which names both, when name or size differ from what was saved: the
 * checkpoint is of another scene or of another version of the program. What
 * follows from the arrays the owners make anew (StateVisitor::is_restoring()).
 *
 * The order is that of StateSaver::blocks. After an IOError what was visited
 * before is overwritten already: the run cannot go on. Not collective.
 */
class StateRestorer : public StateVisitor
{
public:
  explicit StateRestorer(std::vector<StateBlock> blocks);
  void visit(const std::string &name, void *data, std::size_t n,
             std::size_t size) override;
  /**
   * Of the block that is next; IOError where @p name is another one. The @p n
   * of now does not count.
   */
  std::size_t n_entries(const std::string &name, std::size_t n) const override;
  bool is_restoring() const override { return true; }

  std::string section; // expected before each name

private:
  /** The block that @p name should be. IOError for another one. */
  const StateBlock &next(const std::string &name) const;

  std::vector<StateBlock> blocks;
  std::size_t position = 0; // of the next block
};
} // namespace sabot

#endif
