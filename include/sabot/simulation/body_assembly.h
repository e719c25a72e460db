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

  /**
   * @p prm at its top level, with everything declared and read.
   * All three are kept by reference. Does nothing yet.
   */
  BodyAssembly(Parameters &prm, const ParameterFile &file,
               const Materials &materials);
  /**
   * Build the bodies called @p names into bodies and zones.
   * Zones first, as hosts need to know what is cut from them; then meshes that
   * are cut cell by cell; then bodies in the order of @p names, which numbers
   * them from 0. InputError for unknown materials or hosts, for a host that is
   * not of finite elements, and for a second zone of one host.
   */
  void build(const std::vector<std::string> &names);

  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<CarvedZone> zones;
  std::vector<GrowingZone> growing;
  std::vector<std::string> notes, warnings; // what the meshes are like

private:
  /**
   * How bodies are turned, and where their axes point then.
   * InputError for a zone that is turned by itself: it turns with its host.
   */
  void find_postures(const std::vector<std::string> &names);
  /**
   * Zones by their hosts.
   * Fills `carvings` from the entries "Carve from".
   */
  void find_carvings(const std::vector<std::string> &names);
  /**
   * The zone's shape must be a box or a cylinder, else InputError. It follows
   * the mesh where host or zone has no lattice of its own.
   */
  Carving read_carving(const std::string &name, const std::string &from) const;
  /** Whether a zone that finds itself, whose section has been entered, has
      particles from the start; leaves "yes" or "no" for the expanded
     parameters, where all entries are set. */
  bool has_start_zone(const std::string &name) const;
  /**
   * Cut the meshes of hosts whose zones follow them.
   * Cells of host and zone come from one mesh, so that their faces meet; the
   * zone's spacing is that of the cells, and discretizations are told so.
   */
  void carve_meshes();
  /**
   * Notes the quality of the mesh; InputError where a cell has a scaled
   * Jacobian of zero or less. @p cell_size [m]; @p carving may be null.
   */
  NamedMesh make_mesh(const std::string &path, const double cell_size,
                      const Carving *carving);
  /** Makes the planes known that the body's entries and its loads list among
      faces. */
  void name_planes_of(const std::string &path, NamedMesh &made) const;
  /** What @p make returns; too many items become an InputError by the entry of
      the present subsection that says how large they are. */
  template <typename Make>
  auto counted(const std::string &path, const Make &make) const;
  /** Its subsection with material, shape and mesh, as BodyRequest. */
  std::unique_ptr<Body> make_body(const std::string &name, const int id);
  /** Entries of a zone that finds itself that are its host's: faces that are
      held, and speed. InputError where the file says otherwise. */
  void take_from_host(const Carving &carving);
  /** By the bodies as they were built; the host is told. InputError where host
      and zone do not fit. */
  GrowingZone record_growing(const Carving &carving);
  /** InputError for what a host whose cells go cannot have. */
  void refuse_with_growth(const Carving &carving) const;
  /** Number of a body that has been built. */
  int number_of(const std::string &name) const;
  /** By the bodies as they were built: numbers, bounds and spacing [m]. */
  CarvedZone record(const Carving &carving) const;
  /** By the entry "Discretization" of the file, FEM where there is none. */
  std::unique_ptr<Discretization>
  discretization_of(const std::string &body) const;
  /** By the entry "Geometry" of the file, a box where there is none. */
  std::unique_ptr<BodyShape> shape_of(const std::string &body) const;

  Parameters &prm;
  const ParameterFile &file;
  const Materials &materials;
  struct Posture
  {
    Turn turn;
    Vec axis; // turned, of unit length
  };
  std::map<std::string, Posture> postures; // by body
  std::vector<Carving> carvings;
  std::map<std::string, NamedMesh> cells;  // made already, by body
  std::map<std::string, double> cell_size; // by zone that follows a mesh [m]
};
} // namespace sabot

#endif
