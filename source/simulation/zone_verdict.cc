// Whether a zone of particles was large enough: how far strain and failure came
// to the tie.

#include "sabot/simulation/zone_verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace sabot
{
namespace
{
constexpr double strained = 0.01;
/** Distance to keep between the tie and what must lie inside: about a kernel
    radius. [spacings] */
constexpr double margin = 2.;
constexpr double nowhere = std::numeric_limits<double>::max();

using Point = std::array<double, 3>;

/** How far something came: least distance from the tie and extent. */
struct Reach
{
  double distance = nowhere;
  double radius = 0.; // from the axis of a cylinder
  Point low{{nowhere, nowhere, nowhere}}, high{{-nowhere, -nowhere, -nowhere}};

  void add(const ZoneBox &box, const Point &place)
  {
    const Point x = box.turn.origin(place);
    if (box.axis)
      radius = std::max(radius, box.radius_of(x));
    distance = std::min(distance, box.distance_from_tie(x));
    for (int d = 0; d < 3; ++d)
    {
      low[d] = std::min(low[d], x[d]);
      high[d] = std::max(high[d], x[d]);
    }
  }
  void reduce(MPI_Comm communicator)
  {
    double values[8] = {distance, low[0],   low[1],   low[2],
                        -high[0], -high[1], -high[2], -radius};
    MPI_Allreduce(MPI_IN_PLACE, values, 8, MPI_DOUBLE, MPI_MIN, communicator);
    distance = values[0];
    radius = -values[7];
    for (int d = 0; d < 3; ++d)
    {
      low[d] = values[1 + d];
      high[d] = -values[4 + d];
    }
  }
};

/** The box that holds @p reach, kept symmetric where both sides are tied. */
std::pair<Point, Point> smallest_box(const ZoneBox &zone, const Reach &reach)
{
  Point low = zone.low, high = zone.high;
  const bool empty = reach.distance == nowhere;
  for (int d = 0; d < 3; ++d)
  {
    const double gap = margin * zone.spacing[d];
    const double center = 0.5 * (zone.low[d] + zone.high[d]);
    // Nothing happened: a block of a few particles stays.
    double down = empty ? center - gap : reach.low[d] - gap,
           up = empty ? center + gap : reach.high[d] + gap;
    if (zone.axis && d != *zone.axis)
    {
      down = center - reach.radius - gap;
      up = center + reach.radius + gap;
    }
    if (zone.tied_low[d] && zone.tied_high[d])
    {
      const double half = std::max(center - down, up - center);
      down = center - half;
      up = center + half;
    }
    if (zone.tied_low[d])
      low[d] = down;
    if (zone.tied_high[d])
      high[d] = up;
  }
  return {low, high};
}

double seconds_of(const Timers &timers, const std::string &name)
{
  const auto found = timers.all().find(name);
  return found == timers.all().end() ? 0. : found->second.seconds;
}
} // namespace

double ZoneBox::radius_of(const Point &x) const
{
  double square = 0.;
  for (int d = 0; d < 3; ++d)
    if (d != axis)
      square += std::pow(x[d] - 0.5 * (low[d] + high[d]), 2);
  return std::sqrt(square);
}

double ZoneBox::distance_from_tie(const Point &x) const
{
  double inside = nowhere, outside = 0.;
  for (int d = 0; d < 3; ++d)
    for (const bool upper : {false, true})
    {
      if (!(upper ? tied_high[d] : tied_low[d]))
        continue;
      const bool radial = axis && d != *axis;
      const double depth = (radial  ? 0.5 * (high[d] - low[d]) - radius_of(x)
                            : upper ? high[d] - x[d]
                                    : x[d] - low[d]) /
                           spacing[d];
      inside = std::min(inside, depth);
      outside = std::max(outside, -depth);
    }
  return outside > 0. ? -outside : inside;
}

std::vector<ZoneBox> find_zones(const Scene &scene)
{
  std::vector<ZoneBox> zones;
  for (const CarvedZone &carved : scene.zones)
  {
    ZoneBox zone;
    zone.zone = carved.zone;
    zone.host = carved.host;
    zone.turn = carved.turn;
    zone.axis = carved.shape.axis;
    zone.spacing = carved.spacing;
    bool side = false; // of a cylinder, which a sector may have cut
    for (int d = 0; d < 3; ++d)
    {
      zone.low[d] = carved.shape.center[d] - 0.5 * carved.shape.size[d];
      zone.high[d] = carved.shape.center[d] + 0.5 * carved.shape.size[d];
      const double slack = 1e-3 * zone.spacing[d];
      zone.tied_low[d] = zone.low[d] > carved.host_low[d] + slack;
      zone.tied_high[d] = zone.high[d] < carved.host_high[d] - slack;
      side =
          side || (d != zone.axis && (zone.tied_low[d] || zone.tied_high[d]));
    }
    if (zone.axis)
      for (const int d : {(*zone.axis + 1) % 3, (*zone.axis + 2) % 3})
        zone.tied_low[d] = zone.tied_high[d] = side;
    zones.push_back(zone);
  }
  return zones;
}

std::vector<ZoneVerdict> judge_zones(const Scene &scene, const Timers &timers,
                                     const unsigned int n_steps,
                                     MPI_Comm communicator)
{
  std::vector<ZoneVerdict> verdicts;
  double n_spg = 0., n_fem = 0.;
  for (const auto &body : scene.bodies)
  {
    if (body->particles() != nullptr)
      n_spg += body->n_items();
    else if (body->faces() != nullptr && body->faces()->deform())
      n_fem += body->n_items();
  }
  for (const ZoneBox &zone : find_zones(scene))
  {
    const Body &body = *scene.bodies[zone.zone];
    Reach plastic, bonds;
    for (const MaterialSite &site : body.material_sites())
    {
      if (site.plastic_strain > strained)
        plastic.add(zone, site.reference_position);
      if (site.failed_share > 0.)
        bonds.add(zone, site.reference_position);
    }
    const Body &host = *scene.bodies[zone.host];
    for (const MaterialSite &site : host.material_sites())
      if (site.plastic_strain > strained)
        plastic.add(zone, site.reference_position);
    plastic.reduce(communicator);
    bonds.reduce(communicator);

    ZoneVerdict verdict;
    verdict.zone = body.name;
    verdict.host = host.name;
    verdict.spacing =
        std::cbrt(zone.spacing[0] * zone.spacing[1] * zone.spacing[2]);
    verdict.plastic_distance = plastic.distance;
    verdict.bond_distance = bonds.distance;
    verdict.n_particles = body.n_items();
    Reach both = plastic;
    if (bonds.distance < nowhere)
    {
      both.distance = std::min(plastic.distance, bonds.distance);
      both.radius = std::max(plastic.radius, bonds.radius);
      for (int d = 0; d < 3; ++d)
      {
        both.low[d] = std::min(plastic.low[d], bonds.low[d]);
        both.high[d] = std::max(plastic.high[d], bonds.high[d]);
      }
    }
    // What a cell of the host next to the zone is like.
    const double cell_seconds =
        n_fem > 0. ? seconds_of(timers, "fem step") / n_fem : 0.;
    // All that grows with the number of particles.
    double particle_seconds = 0.;
    for (const char *const name :
         {"spg step", "kernel update", "contact search", "self-contact",
          "self-contact search"})
      particle_seconds += seconds_of(timers, name) / std::max(1., n_spg);
    const auto judge = [&](const Reach &reach)
    {
      const auto [low, high] = smallest_box(zone, reach);
      ZoneVerdict::Box box;
      box.n_particles = 1.;
      double n_cells = 1., n_cells_now = 1.;
      for (int d = 0; d < 3; ++d)
      {
        box.size[d] = high[d] - low[d];
        box.n_particles *= std::round(box.size[d] / zone.spacing[d]) + 1.;
        n_cells *= box.size[d] / zone.spacing[d];
        n_cells_now *= (zone.high[d] - zone.low[d]) / zone.spacing[d];
      }
      if (zone.axis) // perhaps a sector of it: by volume
      {
        box.n_particles = verdict.n_particles * n_cells / n_cells_now;
        n_cells = box.n_particles;
        n_cells_now = verdict.n_particles;
      }
      box.seconds_saved =
          (verdict.n_particles - box.n_particles) * particle_seconds -
          (n_cells_now - n_cells) * cell_seconds;
      return box;
    };
    verdict.for_both = judge(both);
    verdict.for_bonds = judge(bonds);
    if (n_steps == 0)
      verdict.for_both.seconds_saved = verdict.for_bonds.seconds_saved = 0.;
    verdicts.push_back(verdict);
  }
  return verdicts;
}

std::string describe(const ZoneVerdict &v)
{
  const auto came = [](const std::string &what, const double distance)
  {
    char text[120];
    if (distance == nowhere)
      return what + " nowhere";
    std::snprintf(text, sizeof(text),
                  distance < 0. ? "%s %.1f spacings beyond the tie"
                                : "%s within %.1f spacings of the tie",
                  what.c_str(), std::abs(distance));
    return std::string(text);
  };
  char box[200];
  std::snprintf(box, sizeof(box),
                "; %s%.1f x %.1f x %.1f mm would hold both (%s %.3g s)",
                v.is_lower_bound() ? "at least " : "", 1e3 * v.for_both.size[0],
                1e3 * v.for_both.size[1], 1e3 * v.for_both.size[2],
                v.for_both.seconds_saved >= 0. ? "saves" : "costs",
                std::abs(v.for_both.seconds_saved));
  return "zone " + v.zone + ": " +
         came("plastic strain over 1 %", v.plastic_distance) + ", " +
         came("broken bonds", v.bond_distance) + box;
}
} // namespace sabot
