#ifndef sabot_simulation_scene_h
#define sabot_simulation_scene_h

#include "sabot/base/parameter_file.h"
#include "sabot/bodies/body.h"
#include "sabot/couplings/coupling.h"
#include "sabot/geometry/shape.h"
#include "sabot/materials/material.h"

#include "sabot/base/parameters.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sabot
{
/** A number that a scene reports in result.json. */
struct QuantityOfInterest
{
  enum class Type
  {
    velocity,
    penetration_depth,
    length,
    radius
  };
  std::string name;
  Type type;
  int body;
  Vec direction;      // unit
  double origin = 0.; // of the penetration depth, along the direction [m]
  /** Extent of the whole over that of the part that is modelled, per axis: 2
      across a plane of symmetry. */
  std::array<double, 3> whole{{1., 1., 1.}};
};

/** When fields or histories are written. */
struct OutputSettings
{
  enum class Type
  {
    vtu,
    history
  };
  std::string name;
  Type type;
  double interval; // [s]
};

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
 * A scene file, read and checked: declared entries, then the objects built
 * from them. Construction throws InputError with file and line; it changes
 * nothing on disk.
 */
class Scene
{
public:
  Scene(const ParameterFile &file, MPI_Comm communicator);

  /** Partition all bodies together, distribute them and start the couplings.
      Collective; after this the scene can run. */
  void distribute();

  RunSettings settings;
  std::vector<std::shared_ptr<const Material>> materials;
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<std::unique_ptr<Coupling>> couplings; // ties last
  std::vector<OutputSettings> outputs;
  std::vector<QuantityOfInterest> quantities;
  std::vector<CarvedZone> zones;
  std::vector<std::string> warnings;
  std::vector<std::string> notes; // for `sabot check`, e.g. mesh quality
  /** True where nothing holds a body from outside, so that linear momentum
      must be constant. */
  bool is_free = true;

  Parameters prm;
  int body_index(const std::string &path, const std::string &body_name) const;
  std::vector<Body *> body_pointers() const;

  /** Declare the entries that the file's lists call for. */
  static void declare(Parameters &prm, const ParameterFile *file);

private:
  void read_settings();
  void build_materials();
  void build_bodies();
  std::vector<Carving> find_carvings(const std::vector<std::string> &names);
  /** Mesh of the body whose subsection is entered, around or with the cells of
      the zone that is @p carving. */
  NamedMesh make_mesh(const std::string &path, const double cell_size,
                      const Carving *carving);
  /** Enter the spacing of particles that are the nodes of a mesh; refuse
     another one in the file. */
  void follow_spacing(const std::string &path, const double spacing);
  void record_zone(const Carving &carving);
  /** The SPG body whose subsection is entered; @p zone: cells of another body
      that it replaces. */
  std::unique_ptr<Body> make_particles(const std::string &name,
                                       std::shared_ptr<const Material> material,
                                       NamedMesh *zone);
  void build_couplings();
  void build_outputs();
  void build_quantities();
  void check_overlaps() const;

  const ParameterFile &file;
  MPI_Comm communicator;
  std::map<std::string, std::shared_ptr<const Material>> material_by_name;
};
} // namespace sabot

#endif
