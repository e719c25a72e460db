#ifndef sabot_simulation_scene_h
#define sabot_simulation_scene_h

#include "sabot/base/parameter_file.h"
#include "sabot/bodies/body.h"
#include "sabot/couplings/coupling.h"
#include "sabot/geometry/carving.h"
#include "sabot/materials/material.h"
#include "sabot/output/output.h"
#include "sabot/simulation/quantity_of_interest.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/** Scalars of a scene. */
struct RunSettings
{
  std::string title;
  double end_time, step_factor, largest_step, energy_limit;
  // Between checkpoints, 0: none for this reason.
  double checkpoint_interval, checkpoint_wall_time; // [s]
  unsigned int checkpoint_steps;
};

/** A part of a FEM body in whose place there are particles. */
struct CarvedZone
{
  int zone, host;                            // bodies
  ZoneShape shape;                           // may reach beyond the host
  std::array<double, 3> spacing;             // of the particles [m]
  std::array<double, 3> host_low, host_high; // bounds before carving [m]
};

/**
 * A scene file, read and checked: what its lists name, built by the registries
 * of bodies, couplings, outputs and quantities. Construction throws InputError
 * with file and line; it changes nothing on disk and is not collective but for
 * @p communicator, which couplings keep.
 */
class Scene
{
public:
  Scene(const ParameterFile &file, MPI_Comm communicator);

  /** Partition all bodies together, distribute them and start the couplings.
      Collective; after this the scene can run. */
  void distribute();

  /** Declare the entries that the lists of @p file call for; of a null file all
      that there are, as the manual shows them. */
  static void declare(Parameters &prm, const ParameterFile *file);

  /** The number of the body called @p body_name; InputError for the entry
      @p path, with the nearest name, where there is none. */
  int body_index(const std::string &path, const std::string &body_name) const;
  std::vector<Body *> body_pointers() const;
  /** Every entry with its value, as a parameter file. */
  std::string expanded_parameters() const;
  /** Path and value of every entry that trades speed for accuracy. */
  std::vector<std::pair<std::string, std::string>> knobs() const;

  RunSettings settings;
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<std::unique_ptr<Coupling>> couplings; // ties last
  std::vector<std::unique_ptr<Output>> outputs;
  std::vector<std::unique_ptr<QuantityOfInterest>> quantities;
  std::vector<CarvedZone> zones;
  std::vector<std::string> warnings;
  std::vector<std::string> notes; // old names in the file; what meshes are like
  /** True where nothing holds a body from outside, so that linear momentum
      must be constant. */
  bool is_free = true;

private:
  void read_settings();
  void build_materials(const ParameterFile &file);
  void build_couplings();
  void build_outputs();
  void build_quantities();
  std::vector<std::string> names_of(const std::string &list) const;

  mutable Parameters prm; // printing does not change it, but is not const
  MPI_Comm communicator;
  std::map<std::string, std::shared_ptr<const Material>> materials;
};
} // namespace sabot

#endif
