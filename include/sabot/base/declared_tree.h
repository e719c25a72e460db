#ifndef sabot_base_declared_tree_h
#define sabot_base_declared_tree_h

#include <nlohmann/json_fwd.hpp>

namespace sabot
{
class Parameters;

/**
 * What is declared in @p prm, in the order of declaration: a subsection is an
 * object of what stands in it, an entry an object with the texts "value",
 * "default_value", "documentation" and "pattern_description".
 */
nlohmann::ordered_json declared_tree(const Parameters &prm);

/** Whether a node of that tree is an entry: it has a value, which a subsection
    has not. */
bool is_entry(const nlohmann::ordered_json &node);
} // namespace sabot

#endif
