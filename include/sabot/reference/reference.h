#ifndef sabot_reference_reference_h
#define sabot_reference_reference_h

#include <string>
#include <vector>

namespace sabot
{
/** A page of the reference, in Markdown. */
struct ReferencePage
{
  std::string file, text;
};

/**
 * The pages of doc/reference that this program can write of itself: entries of
 * scenes (scene.md) and of studies (study.md), fields of the output
 * (fields.md), terms of the energy ledger (ledger.md), what the process
 * returns (exit-codes.md), and all choices by name (registries.md). Each is
 * made from what the program itself uses, so that it cannot drift from the
 * code. Not collective.
 */
std::vector<ReferencePage> reference_pages();
} // namespace sabot

#endif
