#ifndef sabot_simulation_scene_checks_h
#define sabot_simulation_scene_checks_h

#include "sabot/geometry/outline.h"
#include "sabot/simulation/scene.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
// What a scene says that cannot be, which is refused, or can hardly be meant,
// which becomes a warning of check, plan and run alike. All of this looks at
// the scene before it is distributed; nothing is collective.

/**
 * InputError where a list of the scene names something twice, where two bodies
 * would write the same files, or a body has the name of a table of the history.
 */
void check_names(const Parameters &prm);

/** The outlines of all bodies, by number, which lose them. */
std::vector<Outline> take_outlines(const Scene &scene);

/**
 * Refuse bodies that overlap, but for zones and their hosts.
 * By their true shapes: a node or the center of a cell of one lies inside of
 * the other, deeper than 1 nm, 1e-6 of the smallest extent and what flat faces
 * may be off a round surface (Outline::chord_error() of both). Throws
 * InputError for the entry "Center" of the later body.
 */
void check_overlaps(const Scene &scene, const std::vector<Outline> &outlines);

/** InputError where a contact knows the cells of a body but not the particles
    that they turn into. After the couplings have been built. */
void refuse_lone_hosts(const Scene &scene);

/** Pairs of bodies that the scene joins otherwise than by contact. */
using BodyPairs = std::set<std::pair<int, int>>;

/**
 * What the couplings of a scene and the motions of its bodies at the start say
 * of each other. Bodies fly as they are, with their velocities at the start or,
 * where a part is driven, with that of the drive; what is loaded, spins, or is
 * struck, may come anywhere.
 */
class MotionDoubts
{
public:
  /** @p tied: follower and leader of ties. All is kept by reference. */
  MotionDoubts(const Scene &scene, const std::vector<Outline> &outlines,
               const BodyPairs &tied);

  /** InputError for two rigid bodies of prescribed motion that meet by the end
      time: no force keeps them apart. */
  void refuse_irresistible() const;
  /** Bodies that meet by the end time, or touch, and that no coupling keeps
      apart or together. @p unlisted: contacts that the file describes and the
      list leaves out. */
  std::vector<std::string>
  missing_contacts(const std::vector<std::string> &unlisted) const;
  /** Of the contacts @p names those whose bodies never meet. */
  std::vector<std::string>
  idle_contacts(const std::vector<std::string> &names) const;
  /** Of the self-contacts @p names those of particles that never come loose. */
  std::vector<std::string>
  idle_self_contacts(const std::vector<std::string> &names) const;
  /** Planes of symmetry that one body has and another one, which can meet it,
      only ends on or reaches across. */
  std::vector<std::string> forgotten_planes() const;
  /** Zones that do not start with the velocity of their host. */
  std::vector<std::string> zones_left_behind() const;

private:
  /** a relative to b: direction and length of the way until the end time. */
  struct Flight
  {
    Vec direction;
    double speed, way; // [m/s, m]
  };
  /** By all velocities that parts of the two have; one without motion where
      they rest with each other. */
  std::vector<Flight> flights(const int a, const int b) const;
  /** Time until they meet [s], if they do by the end. */
  std::optional<double> time_to_meeting(const int a, const int b) const;
  bool may_meet(const int a, const int b) const;
  bool is_joined(const int a, const int b) const;
  /** Pairs that the contact @p name, and what else stands for it, keeps
      apart. */
  BodyPairs pairs_of_contact(const std::string &name) const;
  /** Which bodies may leave their straight course before the end. */
  std::vector<char> find_disturbed() const;
  /** How the pair misses each other, for a message. */
  std::string why_not(const int a, const int b) const;
  /** Which bodies couplings and meetings join, directly or not: the number of
      the group of each. */
  std::vector<int> groups() const;
  const std::string &name(const int b) const { return scene.bodies[b]->name; }

  const Scene &scene;
  const std::vector<Outline> &outlines;
  std::vector<BodyFacts> facts;
  BodyPairs joined, held_apart; // lower number first
};

/** An end time that takes 1e7 steps and more, by the finest spacing over the
    speed of sound: a unit is missing. */
std::vector<std::string> doubtful_end_time(const Scene &scene);

/** Values of single entries that can hardly be meant, each with its line: an
    angle without unit of more than a turn, a coarsest cell finer than the
    others, a sector whose cut faces are free, cells larger than their body,
    a drive without velocity or faces, a speed across the own plane of symmetry,
    an output after the end. */
std::vector<std::string> slips_of_entries(const ParameterFile &file,
                                          const std::vector<Outline> &outlines,
                                          const Scene &scene);

/** Loads of size zero, tables that are empty or that a run does not reach,
    pressures beyond the modulus of what they act on. */
std::vector<std::string> slips_of_loads(const ParameterFile &file,
                                        const Scene &scene);

/** Clamps, drives and loads of a host's face that its zone of particles reaches
    without one, gravity on a host alone. */
std::vector<std::string> slips_of_zones(const ParameterFile &file,
                                        const Scene &scene);

/** Adds to the warnings of the scene what all of these say. @p file: which
    contacts it describes, listed or not. */
void warn_of_doubts(const ParameterFile &file,
                    const std::vector<Outline> &outlines, const BodyPairs &tied,
                    Scene &scene);
} // namespace sabot

#endif
