#ifndef sabot_couplings_contact_members_h
#define sabot_couplings_contact_members_h

#include "sabot/couplings/coupling_builder.h"
#include "sabot/couplings/self_contact.h"

namespace sabot
{
// What the builders of contact and of self-contact share.

/** Declares `Bodies` and the entries of ContactOptions in the present
    subsection. */
void declare_contact(Parameters &prm);

/** The bodies that the entry `Bodies` lists, by number, in its order;
   InputError where there are fewer than @p least, or one twice. */
std::vector<int> contact_members(const Parameters &prm, const std::string &path,
                                 const CouplingContext &context,
                                 const std::size_t least);

/** Pairs (a, b) of @p members, a < b or a = b where they may meet themselves;
    ascending, each once. */
std::vector<std::pair<int, int>>
pairs_of_members(const std::vector<int> &members, const bool with_themselves);

/** Note that the contact @p name keeps these pairs apart; InputError where
   another one does already: both would push. */
void keep_apart(const std::vector<std::pair<int, int>> &pairs,
                const std::string &path, const std::string &name,
                CouplingContext &context);

/** The same spring and friction, but the bound of the stiffness that contact of
    surfaces has: SelfContact has one of its own, for it counts partners. */
ContactOptions of_surfaces(const SelfContactOptions &options);
} // namespace sabot

#endif
