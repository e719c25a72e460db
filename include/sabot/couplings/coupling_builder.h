#ifndef sabot_couplings_coupling_builder_h
#define sabot_couplings_coupling_builder_h

#include "sabot/base/registry.h"
#include "sabot/couplings/coupling.h"

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
struct TiedNodes;

/** What couplings are built from, and what those built before have claimed.
    The bodies are not distributed yet: only what they are may be asked. */
struct CouplingContext
{
  const std::vector<Body *> bodies; // numbered by Body::id
  /** Number of the body that the entry @p path names; throws InputError. */
  const std::function<int(const std::string &path, const std::string &name)>
      body_index;
  MPI_Comm communicator;

  std::set<std::pair<int, int>> tied; // follower, leader
  /** Pairs of bodies of particles that a contact holds apart, lower number
      first. */
  std::set<std::pair<int, int>> touching;
  /** Pairs of bodies, lower number first, and the coupling that keeps their
      surfaces or debris apart. */
  std::map<std::pair<int, int>, std::string> kept_apart;
  /** What the ties of the scene tell each other; the first makes it. */
  std::shared_ptr<TiedNodes> tied_nodes;
};

/**
 * A type of coupling that a scene may ask for: declares the entries, reads and
 * checks them, and builds what they stand for. A type is one file with a class
 * derived from this one, and at the end
 *
 *     const Registry<CouplingBuilder>::Add tie({"tie", "...", declare, make});
 */
class CouplingBuilder
{
public:
  static constexpr const char *kind = "coupling";
  using Make = std::unique_ptr<CouplingBuilder>();
  virtual ~CouplingBuilder() = default;

  /** Types are built in ascending order, couplings of a type in that of the
      scene's list: contact must know what is tied, self-contact what meets in a
      contact. */
  virtual int order() const = 0;
  /** Whether its couplings act after all others, because they hand on forces:
      ties. */
  virtual bool acts_last() const { return false; }
  /**
   * The couplings that the subsection @p path of @p prm, which is entered,
   * stands for: one or several, the first called @p name. Takes note in
   * @p context of what it claims. Throws InputError for entries that cannot be
   * meant. Not collective.
   */
  virtual std::vector<std::unique_ptr<Coupling>>
  build(const Parameters &prm, const std::string &path, const std::string &name,
        CouplingContext &context) const = 0;
};
} // namespace sabot

#endif
