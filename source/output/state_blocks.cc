// Copies a state out of its owners and back.
#include "sabot/output/state_blocks.h"

#include "sabot/base/error.h"

#include <cstring>

namespace sabot
{
void StateSaver::visit(const std::string &name, void *data, std::size_t n,
                       std::size_t size)
{
  const char *const begin = static_cast<const char *>(data);
  blocks.push_back({section + "/" + name, n, size,
                    std::vector<char>(begin, begin + n * size)});
}

StateRestorer::StateRestorer(std::vector<StateBlock> blocks)
    : blocks(std::move(blocks))
{
}

const StateBlock &StateRestorer::next(const std::string &name) const
{
  const std::string wanted = section + "/" + name;
  if (position >= blocks.size() || blocks[position].name != wanted)
    throw IOError("the checkpoint does not fit this program: \"" + wanted +
                  "\" was expected, found " +
                  (position < blocks.size()
                       ? "\"" + blocks[position].name + "\""
                       : "nothing"));
  return blocks[position];
}

void StateRestorer::visit(const std::string &name, void *data, std::size_t n,
                          std::size_t size)
{
  const StateBlock &block = next(name);
  if (block.n != n || block.size != size)
    throw IOError("the checkpoint does not fit this scene: \"" + block.name +
                  "\" has " + std::to_string(block.n) + " entries of " +
                  std::to_string(block.size) + " bytes, expected " +
                  std::to_string(n) + " of " + std::to_string(size));
  if (n > 0)
    std::memcpy(data, block.bytes.data(), n * size);
  ++position;
}

std::size_t StateRestorer::n_entries(const std::string &name, std::size_t) const
{
  return next(name).n;
}
} // namespace sabot
