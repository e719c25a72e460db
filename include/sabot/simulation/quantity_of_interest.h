#ifndef sabot_simulation_quantity_of_interest_h
#define sabot_simulation_quantity_of_interest_h

#include "sabot/base/registry.h"
#include "sabot/bodies/body.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sabot
{
class History;

/** What a quantity of interest is built from; its subsection is entered. */
struct QuantityRequest
{
  const Parameters &prm;
  std::string path, name; // "Quantities/depth", "depth"
  /** The body that the entry @p entry names; InputError where there is none. */
  std::function<const Body &(const std::string &entry)> body;
  MPI_Comm communicator;
  /** Names of the tables that the histories of the scene will have. */
  std::vector<std::string> tables = {};
};

/** Names of the columns of a table, "name [unit]"; see Scene::columns_of(). */
using ColumnsOf =
    std::function<std::vector<std::string>(const std::string &table)>;

/**
 * A number that a scene reports over time and in result.json. A new one is one
 * file: a class with the work, its entries, and on its last line its
 * registration,
 *
 *     const Registry<QuantityOfInterest>::Add registered(
 *         {"velocity", "of the body's center of mass ...", declare, make});
 */
class QuantityOfInterest
{
public:
  static constexpr const char *kind = "quantity of interest";
  /** Reads its entries; throws InputError, by the entry. */
  using Make = std::unique_ptr<QuantityOfInterest>(const QuantityRequest &);
  virtual ~QuantityOfInterest() = default;

  /** Once, when the bodies have been distributed: whether they have what it
      asks for. InputError, on all ranks. Collective. */
  virtual void check(const ColumnsOf & /*columns_of*/) {}
  /** The histories of the run, once before it starts: for what is found in
      their rows. They outlive the quantity's use. */
  virtual void attach(const History & /*history*/) {}
  /** Look at the scene at @p time [s], before value() is asked for: at every
      row of the histories. Collective. */
  virtual void look(const double /*time*/) {}
  /** The value now, in SI, the same on every rank. Collective. */
  virtual double value() const = 0;
  virtual std::string unit() const = 0;
  /** When and where it was found, for those that search [s, m]. */
  virtual Measures details() const { return {}; }
  /** What look() keeps. */
  virtual void visit_state(StateVisitor &, const std::string & /*name*/) {}

  std::string name; // in the history and in result.json
};

/** Tells the unit of a type of quantity before a scene is built, so that a
    measured value can be held against it; one static object beside the
    registration of a type that has one unit. */
struct UnitOfQuantity
{
  UnitOfQuantity(const std::string &type, const std::string &unit);
};

/** The unit of the type of quantity; empty where it has told none. */
std::string unit_of_quantity(const std::string &type);
} // namespace sabot

#endif
