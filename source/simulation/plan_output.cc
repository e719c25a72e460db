// What the output of a run will take, on disk and in time.

#include "sabot/simulation/plan_output.h"

#include "sabot/base/parameter_file.h"
#include "sabot/output/history.h"
#include "sabot/output/vtu_writer.h"

#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkZLibDataCompressor.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace sabot
{
namespace
{
using Clock = std::chrono::steady_clock;

double since(const Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double median(std::vector<double> values)
{
  std::nth_element(values.begin(), values.begin() + values.size() / 2,
                   values.end());
  return values[values.size() / 2];
}

/** Part that zlib leaves of arbitrary doubles. */
constexpr double part_of_noise = 0.95;
/** VTK compresses blocks of this size. [bytes] */
constexpr std::size_t block = 32768;

template <typename T>
double compressed_size(const std::vector<T> &values)
{
  vtkNew<vtkZLibDataCompressor> compressor;
  compressor->SetCompressionLevel(1);
  const std::size_t n = values.size() * sizeof(T);
  const auto *const bytes =
      reinterpret_cast<const unsigned char *>(values.data());
  std::vector<unsigned char> room(
      compressor->GetMaximumCompressionSpace(block));
  double total = 0.;
  for (std::size_t i = 0; i < n; i += block)
    total += compressor->Compress(bytes + i, std::min(block, n - i),
                                  room.data(), room.size());
  return total;
}

/** Range of the nodes of a body, over all ranks. */
struct Extent
{
  double low[3], high[3];
  explicit Extent(const Body &body, MPI_Comm communicator)
  {
    double values[6];
    std::fill(values, values + 6, 1e300);
    for (std::size_t i = 0; i < body.nodes().n_owned; ++i)
      for (int d = 0; d < 3; ++d)
      {
        values[d] = std::min(values[d], body.nodes().position[i][d]);
        values[3 + d] = std::min(values[3 + d], -body.nodes().position[i][d]);
      }
    MPI_Allreduce(MPI_IN_PLACE, values, 6, MPI_DOUBLE, MPI_MIN, communicator);
    for (int d = 0; d < 3; ++d)
    {
      low[d] = values[d];
      high[d] = -values[3 + d];
    }
  }
  double distance(const Vec x) const
  {
    double square = 0.;
    for (int d = 0; d < 3; ++d)
      square += std::pow(std::max({0., low[d] - x[d], x[d] - high[d]}), 2);
    return std::sqrt(square);
  }
};

/** Distances of the nodes from where waves start: the other bodies that move
    otherwise. Empty when there is no such body. [m] */
std::vector<double> wave_distances(const Scene &scene, const std::size_t body,
                                   MPI_Comm communicator)
{
  std::vector<Extent> sources;
  std::vector<std::array<double, 3>> velocities;
  for (const auto &b : scene.bodies)
    velocities.push_back(b->measure().velocity);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (velocities[b] != velocities[body])
      sources.emplace_back(*scene.bodies[b], communicator);
  std::vector<double> distances;
  if (sources.empty())
    return distances;
  const NodalState &nodes = scene.bodies[body]->nodes();
  for (std::size_t i = 0; i < nodes.n_owned; ++i)
  {
    double nearest = 1e300;
    for (const Extent &source : sources)
      nearest = std::min(nearest, source.distance(nodes.position[i]));
    distances.push_back(nearest);
  }
  return distances;
}

double n_outputs(const SceneOutput &output, const double end)
{
  return std::floor(end / output.period() * (1. + 1e-9)) + 1.;
}

/** A folder of its own among the temporary ones, removed at the end; empty
    where there can be none. The same on all ranks. */
class TemporaryFolder
{
public:
  explicit TemporaryFolder(MPI_Comm communicator)
  {
    MPI_Comm_rank(communicator, &rank);
    char name[4096] = "";
    if (rank == 0)
    {
      std::error_code error;
      const std::string pattern =
          (std::filesystem::temp_directory_path(error) / "sabot-plan-XXXXXX")
              .string();
      if (!error && pattern.size() < sizeof(name))
      {
        std::copy(pattern.c_str(), pattern.c_str() + pattern.size() + 1, name);
        if (mkdtemp(name) == nullptr)
          name[0] = '\0';
      }
    }
    MPI_Bcast(name, sizeof(name), MPI_CHAR, 0, communicator);
    path = name;
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    if (rank == 0 && !path.empty())
      std::filesystem::remove_all(path, ignored);
  }
  std::string path;

private:
  int rank;
};

/** Wall time of one frame of fields, written as a run writes it [s]. */
double seconds_per_frame(const Scene &scene, const std::string &folder,
                         MPI_Comm communicator)
{
  VtuWriter writer(folder, communicator);
  std::vector<double> seconds;
  for (unsigned int frame = 0; frame < 3; ++frame)
  {
    const auto start = Clock::now();
    std::vector<std::string> names;
    for (const auto &body : scene.bodies)
    {
      writer.write_body(body->name, body->output_mesh(), frame);
      names.push_back(body->name);
    }
    writer.add_time(frame, frame, names);
    seconds.push_back(since(start));
  }
  return median(seconds);
}

/** A row of the histories, as Run::record() makes it. */
void append_row(const Scene &scene, History &history)
{
  EnergyLedger ledger;
  for (const auto &body : scene.bodies)
    body->add_energies(ledger);
  for (const auto &coupling : scene.couplings)
    coupling->add_energies(ledger);
  Measures energies;
  ledger.for_each(
      [&](const EnergyTerm &term, const double value) {
        energies.push_back({term.name, "J", value});
      });
  history.append("ledger", energies);
  for (const auto &body : scene.bodies)
  {
    // Once for the momentum of a free scene, once for the table.
    if (scene.is_free)
      body->measure();
    history.append(body->name, body->measure().columns());
  }
  scene.resultants();
  Measures row;
  for (const auto &quantity : scene.quantities)
    row.push_back({quantity->name, quantity->unit(), quantity->value()});
  if (!row.empty())
    history.append("quantities", row);
}
} // namespace

FieldSize field_size(const OutputMesh &mesh, const bool all_yield)
{
  FieldSize size{0., 0.};
  const double points = compressed_size(mesh.points);
  size.quiet += points;
  size.disturbed += part_of_noise * 8. * mesh.points.size();
  const double cells = compressed_size(mesh.connectivity);
  size.quiet += cells;
  size.disturbed += cells;
  for (const auto *const fields : {&mesh.point_fields, &mesh.cell_fields})
    for (const OutputField &field : *fields)
    {
      // Fields of vertices are written twice (VtuWriter).
      const int n_copies =
          mesh.nodes_per_cell == 1 && fields == &mesh.cell_fields ? 2 : 1;
      const double now = n_copies * compressed_size(field.values);
      size.quiet += now;
      const bool is_constant = field.name == "body" || field.name == "rank" ||
                               field.name == "failed-bond fraction";
      const bool is_flow = field.unit == "1" || field.unit == "K";
      size.disturbed +=
          is_constant || (is_flow && !all_yield)
              ? now
              : n_copies * part_of_noise * 8. * field.values.size();
    }
  return size;
}

/** At every step of the first hundred, then every hundredth (Run). */
double n_checks(const double n_steps)
{
  return n_steps < 100. ? n_steps : 100. * (1. + std::log(n_steps / 100.));
}

double n_rows(const Scene &scene, const double n_steps)
{
  double n = n_checks(n_steps);
  for (const auto &output : scene.outputs)
    if (output->needs_rows())
      n += n_outputs(*output, scene.settings.end_time);
  return n;
}

OutputEstimate::OutputEstimate(const Scene &scene, const PhysicsPlan &physics,
                               MPI_Comm communicator)
    : scene(scene), communicator(communicator)
{
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
  {
    const Body &body = *scene.bodies[b];
    bool is_host = false;
    for (const auto &other : scene.bodies)
      if (other->particles() != nullptr && body.faces() != nullptr)
        is_host = true;
    double speed = 0.;
    for (const double component : body.measure().velocity)
      speed += component * component;
    // The far field of a zone yields only beside it.
    BodyOutput output;
    output.size = field_size(body.output_mesh(), !(is_host && speed == 0.));
    output.distances = wave_distances(scene, b, communicator);
    std::sort(output.distances.begin(), output.distances.end());
    output.wave_speed = physics.bodies[b].facts.material->sound_speed();
    bodies.push_back(output);
  }
}

double OutputEstimate::bytes(const double time, const double n_steps) const
{
  const double end = scene.settings.end_time;
  double n_frames = 0.;
  std::vector<double> times;
  for (const auto &output : scene.outputs)
    if (output->writes_fields())
    {
      n_frames = n_outputs(*output, end);
      // Many frames are sampled by a hundred.
      const double n_samples = std::min(n_frames, 100.);
      for (double k = 0.; k < n_samples; k += 1.)
        times.push_back(end * k / std::max(1., n_samples - 1.));
    }
  double bytes = 0.;
  for (std::size_t b = 0; b < bodies.size() && !times.empty(); ++b)
  {
    const BodyOutput &body = bodies[b];
    const double now = field_size(scene.bodies[b]->output_mesh(), true).quiet;
    const double n = body.distances.size();
    // Round-off runs ahead of the waves, a node a step: the front moves as it
    // has done so far, if that is faster.
    double front_speed = body.wave_speed;
    const double part_now =
        (now - body.size.quiet) / (body.size.disturbed - body.size.quiet);
    if (n > 0. && time > 0. && part_now > 0.)
      front_speed = std::max(
          front_speed,
          body.distances[std::min(n - 1., std::floor(part_now * n))] / time);
    for (const double t : times)
    {
      const double n_reached =
          std::upper_bound(body.distances.begin(), body.distances.end(),
                           front_speed * t) -
          body.distances.begin();
      const double part = n > 0. && t > 0. ? n_reached / n : 0.;
      bytes +=
          (body.size.quiet + part * (body.size.disturbed - body.size.quiet)) *
          n_frames / times.size();
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_DOUBLE, MPI_SUM, communicator);
  // History: rows of all tables, also those of the regular energy checks.
  double columns = 4. + energy_terms.size(); // time, step, total, residual
  for (const auto &body : scene.bodies)
    columns += 1. + body->measure().columns().size();
  columns += scene.quantities.empty() ? 0. : 1. + scene.quantities.size();
  constexpr double result_and_log = 10e3;
  return bytes + 8. * columns * n_rows(scene, n_steps) +
         scene.expanded_parameters().size() + result_and_log;
}

double output_seconds(const Scene &scene, const double n_steps,
                      MPI_Comm communicator)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const double rows = std::min(n_steps, n_rows(scene, n_steps));
  double n_frames = 0.;
  for (const auto &output : scene.outputs)
    if (output->writes_fields())
      n_frames += n_outputs(*output, scene.settings.end_time);
  History history;
  std::vector<double> seconds;
  for (int k = 0; k < 7; ++k)
  {
    const auto start = Clock::now();
    append_row(scene, history);
    seconds.push_back(since(start));
  }
  double total = rows * median(seconds);
  const TemporaryFolder folder(communicator);
  if (folder.path.empty())
    return total;
  try
  {
    if (n_frames > 0.)
      total += n_frames * seconds_per_frame(scene, folder.path, communicator);
    // The histories are written with each frame, half full in the mean.
    for (auto &table : history.tables)
    {
      std::vector<double> &values = table.second.values;
      const std::size_t n_columns = table.second.columns.size();
      values.resize(n_columns * static_cast<std::size_t>(0.5 * rows + 1.), 1.);
    }
    const auto start = Clock::now();
    if (rank == 0)
      history.write(folder.path + "/history.h5");
    total += std::max(1., n_frames) * since(start);
  }
  catch (const IOError &)
  {
    // No room there: the time of the output stays unknown.
  }
  MPI_Bcast(&total, 1, MPI_DOUBLE, 0, communicator);
  return total;
}
} // namespace sabot
