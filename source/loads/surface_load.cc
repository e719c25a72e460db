// Loads on faces: which nodes bear them.
#include "sabot/loads/surface_load.h"

#include <algorithm>
#include <cmath>

namespace sabot
{
namespace
{
Body &body_of(const LoadRequest &request)
{
  return *request.body("Body", request.prm.get("Body"));
}
} // namespace

SurfaceLoad::SurfaceLoad(const LoadRequest &request)
    : Load(request.name), body(body_of(request)), path(request.path + "/Faces"),
      ids(body.find_faces(path, request.prm.get("Faces"))),
      course(TimeCourse::make(request)), communicator(request.communicator)
{
  if (ids.empty())
    throw InputError(path, "is empty; name the faces that bear the load");
  body.loadable()->keep_faces(ids);
}

void SurfaceLoad::declare(Parameters &prm)
{
  prm.declare_entry("Body", "", any_text(), "Name of the body.");
  prm.declare_entry("Faces", "", name_list(),
                    "Faces of the body that bear the load, by the names that "
                    "its entries for faces take; they turn with the body.");
  TimeCourse::declare(prm);
}

void SurfaceLoad::initialize()
{
  const LoadedSurface surface = body.loadable()->loaded_surface(ids);
  std::vector<std::size_t> nodes;
  for (const auto &face : surface.faces)
    for (const std::size_t a : face)
      if (a < body.nodes().n_owned)
        nodes.push_back(a);
  for (const LoadedSurface::Share &share : surface.shares)
    nodes.push_back(share.node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  int any = !nodes.empty();
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
  if (any == 0)
    throw InputError(path, "names no face of body \"" + body.name +
                               "\" that can bear a load; planes of symmetry "
                               "and faces that a zone has taken cannot");
  forces.emplace_back(body, std::move(nodes));
  take_faces();
}

void SurfaceLoad::take_faces()
{
  version = body.contact_surface_version();
  const std::vector<std::size_t> &nodes = forces[0].nodes;
  const std::size_t n_owned = body.nodes().n_owned;
  const auto slot = [&](const std::size_t node)
  {
    return node < n_owned ? std::lower_bound(nodes.begin(), nodes.end(), node) -
                                nodes.begin()
                          : elsewhere;
  };
  const LoadedSurface surface = body.loadable()->loaded_surface(ids);
  faces.clear();
  for (const auto &face : surface.faces)
    faces.push_back(
        {face, {{slot(face[0]), slot(face[1]), slot(face[2]), slot(face[3])}}});
  shares.clear();
  for (const LoadedSurface::Share &share : surface.shares)
    shares.push_back({slot(share.node), share});
  faces_changed();
}

void SurfaceLoad::add_forces(const double time)
{
  if (version != body.contact_surface_version())
    take_faces();
  std::fill(force().begin(), force().end(), Vec{});
  compute(course->value(time));
  forces[0].add();
}

void SurfaceLoad::accumulate_work(const double half_dt)
{
  forces[0].accumulate_work(half_dt);
}

void SurfaceLoad::add_energies(EnergyLedger &ledger) const
{
  forces[0].add_energies(ledger);
}

double SurfaceLoad::total_work() const
{
  ExactSum work = forces[0].total_work();
  ExactSum::reduce({&work}, communicator);
  return work.value();
}

std::vector<Resultant> SurfaceLoad::resultants() const
{
  return {forces[0].resultant(name, communicator)};
}

void SurfaceLoad::visit_state(StateVisitor &visitor)
{
  forces[0].visit_state(visitor);
}

std::array<Vec, 4> nodal_areas(const std::array<Vec, 4> &x)
{
  constexpr double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const double g = 1. / std::sqrt(3.);
  std::array<Vec, 4> areas{};
  for (const auto &c : corner)
  {
    const double s = g * c[0], t = g * c[1];
    const Vec along_s =
                  0.25 * ((1. - t) * (x[1] - x[0]) + (1. + t) * (x[2] - x[3])),
              along_t =
                  0.25 * ((1. - s) * (x[3] - x[0]) + (1. + s) * (x[2] - x[1]));
    const Vec normal = cross(along_s, along_t);
    for (int a = 0; a < 4; ++a)
      areas[a] +=
          (0.25 * (1. + s * corner[a][0]) * (1. + t * corner[a][1])) * normal;
  }
  return areas;
}
} // namespace sabot
