#ifndef sabot_simulation_body_assembly_h
#define sabot_simulation_body_assembly_h

#include "sabot/bodies/discretization.h"
#include "sabot/simulation/scene.h"

#include <map>

namespace sabot
{
/**
 * Builds the bodies of a scene: shapes become meshes, zones are carved from
 * their hosts, discretizations make bodies of them. Throws InputError, by the
 * entry. Not collective.
 */
class BodyAssembly
{
public:
  using Materials = std::map<std::string, std::shared_ptr<const Material>>;

  /** @p prm at its top level, with everything declared and read. */
  BodyAssembly(Parameters &prm, const ParameterFile &file,
               const Materials &materials);
  /** Build the bodies called @p names into bodies and zones. */
  void build(const std::vector<std::string> &names);

  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<CarvedZone> zones;
  std::vector<std::string> notes; // what the meshes are like

private:
  /** Zones by their hosts. */
  void find_carvings(const std::vector<std::string> &names);
  Carving read_carving(const std::string &name, const std::string &from) const;
  /** Cut the meshes of hosts whose zones follow them. */
  void carve_meshes();
  NamedMesh make_mesh(const std::string &path, const double cell_size,
                      const Carving *carving);
  std::unique_ptr<Body> make_body(const std::string &name, const int id);
  CarvedZone record(const Carving &carving) const;
  std::unique_ptr<Discretization>
  discretization_of(const std::string &body) const;
  std::unique_ptr<Shape> shape_of(const std::string &body) const;

  Parameters &prm;
  const ParameterFile &file;
  const Materials &materials;
  std::vector<Carving> carvings;
  std::map<std::string, NamedMesh> cells;  // made already, by body
  std::map<std::string, double> cell_size; // by zone that follows a mesh [m]
};

/** Refuse bodies that overlap, but for zones and their hosts, and for curved
    surfaces that are tied. */
void check_overlaps(const Scene &scene, const ParameterFile &file);
} // namespace sabot

#endif
