#ifndef sabot_base_registry_h
#define sabot_base_registry_h

#include "sabot/base/error.h"
#include "sabot/base/nearest_name.h"
#include "sabot/base/parameters.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/** What a registry holds, without its types: for the reference, for lists of
    names, and for the test that looks every entry up in the manual. Names and
    descriptions are as the parameter files and the manual have them. */
struct RegistryContents
{
  struct Item
  {
    std::string name, description;
  };
  std::string kind; // "material law", "friction law", ...
  std::vector<Item> items;
};

/** All registries that have an entry, sorted by kind; complete once main() has
    begun. */
std::vector<RegistryContents> all_registries();

/** Makes a registry known to all_registries(); its first Add does so. */
void add_registry(RegistryContents (*contents)());

/**
 * The choices of one kind that a parameter file makes by name. A choice lives
 * in one file: its parameters with declaration, reading and checks, its work,
 * and at the end of the file one static object
 *
 *     const Registry<FrictionLaw>::Add coulomb({"Coulomb", "...", declare,
 *                                               make});
 *
 * Menus, messages, the manual and doc/reference/registries.md follow from the
 * registry: nothing else names its entries. @p Product is the
 * interface of the kind; it names the kind and the signature that makes it:
 *
 *     static constexpr const char *kind = "friction law";
 *     using Make = std::unique_ptr<FrictionLaw>(const Parameters &,
 *                                               const std::string &path);
 *
 * A whole file of a new choice is thus, with the class and its work in between,
 *
 *     // Friction that does not depend on the pressure.
 *     #include "sabot/base/registry.h"
 *     #include "sabot/couplings/friction/friction_law.h"
 *
 *     namespace sabot
 *     {
 *     namespace
 *     {
 *     class Constant : public FrictionLaw { ... };
 *     void declare(Parameters &prm) { prm.declare_entry(...); }
 *     ... make(const Parameters &prm, const std::string &path) { ... }
 *     const Registry<FrictionLaw>::Add added({"constant", "...", declare,
 *                                             make});
 *     } // namespace
 *     } // namespace sabot
 *
 * The files must be linked as objects: a static library would drop what nobody
 * names.
 */
template <typename Product>
class Registry
{
public:
  struct Entry
  {
    std::string name;        // as the parameter file has it
    std::string description; // one line for the manual
    /** Declares the entries that only this choice has, in the subsection that
        makes the choice; empty where it has none. */
    std::function<void(Parameters &)> declare;
    /** Makes the object from the values of these entries; checks what the
        patterns cannot. */
    std::function<typename Product::Make> make;
  };

  /** Registers an entry; one static object at the end of its file, made before
      main(). Two entries must not have one name. */
  struct Add
  {
    explicit Add(Entry entry)
    {
      std::vector<Entry> &all = list();
      if (all.empty())
        add_registry(&contents);
      // Sorted: the order of linking must not show in the manual.
      auto place = all.begin();
      while (place != all.end() && place->name < entry.name)
        ++place;
      all.insert(place, std::move(entry));
    }
  };

  /** All choices, sorted by name: the same order in every build, on which the
      manual and equal runs rely. */
  static const std::vector<Entry> &entries() { return list(); }

  /** The choice called @p name, upper and lower case told apart; null where
      there is none. */
  static const Entry *find(const std::string &name)
  {
    for (const Entry &entry : list())
      if (entry.name == name)
        return &entry;
    return nullptr;
  }

  /** The choice called @p name; throws InputError for the entry @p path with
      the nearest name where there is none. */
  static const Entry &get(const std::string &path, const std::string &name)
  {
    if (const Entry *const entry = find(name))
      return *entry;
    std::vector<std::string> names;
    for (const Entry &entry : list())
      names.push_back(entry.name);
    throw InputError(path, std::string("no ") + Product::kind +
                               " is called \"" + name + "\"" +
                               suggestion_or_list(name, names));
  }

  /** Declares the entry @p name that makes the choice, with the default
      @p standard. The meaning is @p lead, followed by every choice with its
      description: "Constitutive law. Elastic: hypoelastic, ...". Values other
      than the choices are refused as the file is read. */
  static void declare_choice(Parameters &prm, const std::string &name,
                             const std::string &standard,
                             const std::string &lead)
  {
    std::string words, meaning = lead;
    for (const Entry &entry : list())
    {
      words += (words.empty() ? "" : "|") + entry.name;
      meaning +=
          (meaning.empty() ? "" : " ") + entry.name + ": " + entry.description;
    }
    prm.declare_entry(name, standard, one_of(words), meaning);
  }

  /** The same for a choice that trades speed for accuracy (declare_knob()). */
  static void declare_knob(Parameters &prm, const std::string &name,
                           const std::string &standard, const std::string &lead)
  {
    declare_choice(prm, name, standard, lead);
    prm.mark_as_knob(name);
  }

  /** Declares what the choice @p name brings with it; of a name that is not
      registered all choices' entries, as the manual shows them. */
  static void declare_entries(Parameters &prm, const std::string &name)
  {
    const Entry *const chosen = find(name);
    for (const Entry &entry : list())
      if (entry.declare && (chosen == nullptr || chosen == &entry))
        entry.declare(prm);
  }

private:
  // Within a function: registration happens before main, in any order.
  static std::vector<Entry> &list()
  {
    static std::vector<Entry> all;
    return all;
  }
  static RegistryContents contents()
  {
    RegistryContents c{Product::kind, {}};
    for (const Entry &entry : list())
      c.items.push_back({entry.name, entry.description});
    return c;
  }
};
} // namespace sabot

#endif
