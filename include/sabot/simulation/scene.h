#ifndef sabot_simulation_scene_h
#define sabot_simulation_scene_h

#include "sabot/base/parameter_file.h"
#include "sabot/bodies/body.h"
#include "sabot/bodies/conversion_criterion.h"
#include "sabot/couplings/coupling.h"
#include "sabot/geometry/carving.h"
#include "sabot/geometry/turn.h"
#include "sabot/loads/load.h"
#include "sabot/materials/material.h"
#include "sabot/output/output.h"
#include "sabot/simulation/quantity_of_interest.h"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/**
 * Scalars of a scene.
 * In SI. @p step_factor is that of the least stable step, below 1 for the
 * nonlinear part; @p energy_limit bounds the residual of EnergyBalance, a pure
 * number.
 */
struct RunSettings
{
  std::string title, accuracy;
  double end_time, step_factor, largest_step, energy_limit;
  // Between checkpoints, 0: none for this reason.
  double checkpoint_interval, checkpoint_wall_time; // [s]
  unsigned int checkpoint_steps;
  unsigned int most_substeps; // of a body within one step
  unsigned int ranks_per_checkpoint_file;
  bool checkpoint_at_end; // from which a later end time goes on
};

/**
 * A part of a FEM body in whose place there are particles.
 * Bodies by their numbers in Scene::bodies. Lengths are of the reference
 * configuration before the two are turned; the bounds are those of nodes and
 * particles of host and zone together, the host's as a whole.
 */
struct CarvedZone
{
  int zone, host;                            // bodies
  ZoneShape shape;                           // may reach beyond the host
  Turn turn;                                 // of both
  std::array<double, 3> spacing;             // of the particles [m]
  std::array<double, 3> host_low, host_high; // bounds before carving [m]
};

struct CouplingContext;
class SelfFindingZone;

/** A zone whose particles cells of its host turn into while the run goes on. */
struct GrowingZone
{
  int zone, host;                      // bodies
  std::optional<ZoneShape> start;      // where particles are from the start
  Turn turn;                           // of both
  ConversionRequest request;           // when cells turn
  SelfFindingZone *coupling = nullptr; // what turns them; the scene owns it
};

/** What turns the cells of a growing zone's host, whose coupling it becomes. */
std::unique_ptr<Coupling>
make_self_finding_zone(GrowingZone &zone, const CouplingContext &context);

/**
 * A scene file, read and checked: what its lists name, built by the registries
 * of bodies, loads, couplings, outputs and quantities. Construction throws
 * InputError with file and line; it changes nothing on disk and is not
 * collective but for
 * @p communicator, which couplings keep.
 */
class Scene
{
public:
  /**
   * In this order: settings, materials, bodies with zones, overlaps, loads,
   * couplings, outputs, quantities. @p file is read only while this runs.
   */
  Scene(const ParameterFile &file, MPI_Comm communicator);

  /**
   * Partition all bodies together, distribute them, start loads and couplings.
   * Collective; after this the scene can run.
   * One partition for the points of all bodies, weighted with what a point of
   * each costs; then each body keeps its share, and couplings start from the
   * last to the first, ties before contact, which has to know who follows whom.
   */
  void distribute();

  /**
   * Declare the entries that the lists of @p file call for; of a null file all
   * that there are, as the manual shows them.
   * InputError where a list and the subsections of @p file do not fit together.
   */
  static void declare(Parameters &prm, const ParameterFile *file);

  /**
   * The number of the body called @p body_name; InputError for the entry @p
   * path, with the nearest name, where there is none.
   * From 0, in the order of "List of bodies"; the same as Body::id.
   */
  int body_index(const std::string &path, const std::string &body_name) const;
  /** In the order of their numbers; they live as long as the scene. */
  std::vector<Body *> body_pointers() const;
  /**
   * Every entry with its value, as a parameter file.
   * Defaults included: read again it gives the same scene. What checkpoints
   * hold and parameters.prm in the results is.
   */
  std::string expanded_parameters() const;
  /**
   * Path and value of every entry that trades speed for accuracy.
   * Of listed bodies and couplings and of the top level only; subsections that
   * no list names are read, but not in force.
   */
  std::vector<std::pair<std::string, std::string>> knobs() const;

  /** What holds or drives a body from outside: "clamped faces", "symmetry
      faces", "driven faces", "prescribed motion". After distribute();
      collective. */
  std::vector<Resultant> reactions(const Body &body) const;
  /** Who pushes whom: reactions of bodies, then what couplings do. After
      distribute(); collective. */
  std::vector<Resultant> resultants() const;
  /** Column of the tables `forces` and `impulses`, without unit. */
  std::string column_of(const Resultant &resultant, const char axis) const;
  /** Columns that a table of the histories has, "name [unit]"; only "time [s]"
      where there is no such table. After distribute(); collective. */
  std::vector<std::string> columns_of(const std::string &table) const;

  RunSettings settings;
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<std::unique_ptr<Load>> loads;         // in the list's order
  std::vector<std::unique_ptr<Coupling>> couplings; // ties last
  std::vector<std::unique_ptr<SceneOutput>> outputs;
  std::vector<std::unique_ptr<QuantityOfInterest>> quantities;
  std::vector<CarvedZone> zones;
  std::vector<GrowingZone> growing;
  /** What can hardly be meant; distribute() adds to it. */
  std::vector<std::string> warnings;
  std::vector<std::string> notes; // old names in the file; what meshes are like
  /** True where nothing holds or loads a body from outside, so that linear
      momentum must be constant. */
  bool is_free = true;

private:
  /** Partition of the nodes of all bodies, into Body::node_owner. */
  void find_owners();
  /** InputError where the list of bodies is empty. */
  void read_settings();
  /** All subsections of "Materials", whether a body uses them or not. */
  void build_materials(const ParameterFile &file);
  /** Of all kinds, in the order of the list. */
  void build_loads();
  /** InputError where rigid bodies and loads leave the step without a bound. */
  void check_step_is_bounded() const;
  /**
   * In the order that their builders ask for, equal ones in the list's; those
   * that act last, as ties do, at the end. Warns of zones without a tie to
   * their host.
   * @return follower and leader of ties
   */
  std::set<std::pair<int, int>> build_couplings();
  /** Of bodies that can fail and are in no self-contact. */
  void warn_of_lone_debris();
  void build_outputs();
  void build_quantities();
  /** Of "List of <list>"; empty where the entry is. */
  std::vector<std::string> names_of(const std::string &list) const;

  mutable Parameters prm; // printing does not change it, but is not const
  MPI_Comm communicator;
  std::map<std::string, std::shared_ptr<const Material>> materials;
};
} // namespace sabot

#endif
