// Which nodes a tie holds, and by what weights.
#include "sabot/couplings/tie.h"

#include "sabot/couplings/box_buckets.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sabot
{
namespace
{
struct FaceRecord
{
  GlobalIndex id;
  std::array<GlobalIndex, 4> node;
  std::array<Vec, 4> x;
  bool has_cell;                        // it is known what is behind
  std::array<GlobalIndex, 8> cell_node; // VTK order
  std::array<Vec, 8> cell_x;
};

struct NodeRecord
{
  GlobalIndex id;
  Vec x;
};

std::array<double, 4> bilinear(const double s, const double t)
{
  return {{0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t),
           0.25 * (1 + s) * (1 + t), 0.25 * (1 - s) * (1 + t)}};
}

/** Closest point of a bilinear quadrilateral by Gauss-Newton; returns the
    distance and the weights, or a huge distance when it lies outside. */
double project(const FaceRecord &face, const Vec x, std::array<double, 4> &w)
{
  double s = 0., t = 0.;
  for (int iteration = 0; iteration < 20; ++iteration)
  {
    w = bilinear(s, t);
    const Vec r = x - (w[0] * face.x[0] + w[1] * face.x[1] + w[2] * face.x[2] +
                       w[3] * face.x[3]);
    const Vec ds = 0.25 * ((1 - t) * (face.x[1] - face.x[0]) +
                           (1 + t) * (face.x[2] - face.x[3])),
              dt = 0.25 * ((1 - s) * (face.x[3] - face.x[0]) +
                           (1 + s) * (face.x[2] - face.x[1]));
    const double a = dot(ds, ds), b = dot(ds, dt), c = dot(dt, dt),
                 f = dot(ds, r), g = dot(dt, r), det = a * c - b * b;
    const double step_s = (c * f - b * g) / det, step_t = (a * g - b * f) / det;
    s += step_s;
    t += step_t;
    if (std::abs(step_s) + std::abs(step_t) < 1e-14)
      break;
  }
  constexpr double outside = 1e300, slack = 1e-6;
  if (!(std::abs(s) < 1 + slack && std::abs(t) < 1 + slack))
    return outside;
  w = bilinear(std::clamp(s, -1., 1.), std::clamp(t, -1., 1.));
  double sum = 0.;
  for (double &weight : w)
  {
    if (weight < 1e-9)
      weight = 0.;
    sum += weight;
  }
  Vec closest = {};
  for (int a = 0; a < 4; ++a)
  {
    w[a] /= sum;
    closest += w[a] * face.x[a];
  }
  return norm(x - closest);
}

/** Trilinear functions, and what they make of the corners. */
void trilinear(const std::array<double, 3> &xi, const std::array<Vec, 8> &x,
               std::array<double, 8> &w, Vec &point, Mat &slope)
{
  constexpr int sign[3][8] = {{-1, 1, 1, -1, -1, 1, 1, -1},
                              {-1, -1, 1, 1, -1, -1, 1, 1},
                              {-1, -1, -1, -1, 1, 1, 1, 1}};
  point = Vec{};
  slope = Mat::zero(); // column d in row d: dx/dxi_d
  for (int a = 0; a < 8; ++a)
  {
    double f[3];
    for (int d = 0; d < 3; ++d)
      f[d] = 0.5 * (1. + sign[d][a] * xi[d]);
    w[a] = f[0] * f[1] * f[2];
    point += w[a] * x[a];
    for (int d = 0; d < 3; ++d)
      slope.row[d] += 0.5 * sign[d][a] * f[(d + 1) % 3] * f[(d + 2) % 3] * x[a];
  }
}

/** Weights of a cell's corners with sum w_a x_a = @p x, by Newton's method;
    false where that is too far outside, or cannot be. */
bool continue_cell(const std::array<Vec, 8> &corners, const Vec x,
                   std::array<double, 8> &w)
{
  // A quarter of the cell: inner corners then have -1/4 of the mass at most.
  constexpr double farthest = 1.5, converged = 1e-14;
  std::array<double, 3> xi{};
  for (int iteration = 0; iteration < 50; ++iteration)
  {
    Vec point;
    Mat slope;
    trilinear(xi, corners, w, point, slope);
    double determinant;
    const Vec step = transpose(inverse(slope, determinant)) * (x - point);
    double change = 0.;
    for (int d = 0; d < 3; ++d)
    {
      xi[d] += step[d];
      change += std::abs(step[d]);
    }
    if (!(change < 10.))
      return false;
    if (change > converged && iteration < 49)
      continue;
    trilinear(xi, corners, w, point, slope);
    for (const double c : xi)
      if (std::abs(c) > farthest)
        return false;
    return change <= 1e-12;
  }
  return false;
}
/** Faces of the leader with the cells behind, each from the rank of its lowest
    node, in global order. Collective. */
std::vector<FaceRecord> gather_faces(Body &leading, MPI_Comm communicator)
{
  int rank;
  MPI_Comm_rank(communicator, &rank);
  const ContactSurface surface = leading.contact_surface();
  const NodalState &nodes = leading.nodes();
  const std::vector<std::array<std::size_t, 8>> behind =
      leading.faces()->cells_behind_faces();
  std::vector<FaceRecord> mine;
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
  {
    FaceRecord record;
    record.id = surface.face_id[f];
    for (int a = 0; a < 4; ++a)
    {
      record.node[a] = nodes.global_id[surface.faces[f][a]];
      record.x[a] = nodes.reference_position[surface.faces[f][a]];
    }
    // A face is known to several ranks; one speaks for it.
    if (leading.node_owner[*std::min_element(record.node.begin(),
                                             record.node.end())] != rank)
      continue;
    record.has_cell =
        f < behind.size() &&
        std::all_of(surface.faces[f].begin(), surface.faces[f].end(),
                    [&](const std::size_t a)
                    {
                      return std::find(behind[f].begin(), behind[f].end(), a) !=
                             behind[f].end();
                    });
    for (int a = 0; a < 8 && record.has_cell; ++a)
    {
      record.cell_node[a] = nodes.global_id[behind[f][a]];
      record.cell_x[a] = nodes.reference_position[behind[f][a]];
    }
    mine.push_back(record);
  }
  std::vector<FaceRecord> all = gather_all(mine, communicator);
  std::sort(all.begin(), all.end(),
            [](const FaceRecord &a, const FaceRecord &b)
            { return a.id < b.id; });
  return all;
}

/** Whether the box around a face, with a margin, has @p x. */
bool is_near(const FaceRecord &face, const Vec x, const double margin)
{
  for (int d = 0; d < 3; ++d)
  {
    double low = face.x[0][d], high = low;
    for (int a = 1; a < 4; ++a)
    {
      low = std::min(low, face.x[a][d]);
      high = std::max(high, face.x[a][d]);
    }
    if (!(x[d] > low - margin && x[d] < high + margin))
      return false;
  }
  return true;
}

/** Faces by the boxes around them, for followers within @p reach [m]. */
class FacesByPlace
{
public:
  /** @p size: about that of a face [m]. */
  FacesByPlace(const std::vector<FaceRecord> &faces, const double reach,
               const double size)
      : faces(faces), reach(reach), buckets(boxes_of(faces, reach), size)
  {
  }
  /** The face closest to @p x and closer than the reach, with its distance;
     null where there is none. Of faces that are equally near (to @p touching)
     the first wins, in global order. */
  const FaceRecord *closest(const Vec x, const double touching,
                            double &distance,
                            std::array<double, 4> &face_weight) const
  {
    distance = reach;
    const FaceRecord *on = nullptr;
    const auto near = buckets.find(x);
    for (const std::int32_t *f = near.first; f != near.second; ++f)
    {
      const FaceRecord &face = faces[*f];
      if (!is_near(face, x, reach))
        continue;
      std::array<double, 4> weight;
      const double here = project(face, x, weight);
      if (here < distance - (on ? touching : 0.))
      {
        distance = here;
        on = &face;
        face_weight = weight;
      }
    }
    return on;
  }

private:
  static std::vector<Box> boxes_of(const std::vector<FaceRecord> &faces,
                                   const double reach)
  {
    constexpr double round_off = 1e-3; // is_near() decides
    std::vector<Box> boxes(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      for (const Vec x : faces[f].x)
        boxes[f].add(x);
      boxes[f].inflate((1. + round_off) * reach);
    }
    return boxes;
  }

  const std::vector<FaceRecord> &faces;
  const double reach;
  const BoxBuckets buckets;
};
} // namespace

void Tie::use_face(Constraint &constraint)
{
  constraint.leader.fill(constraint.face[0]);
  constraint.weight.fill(0.);
  std::copy(constraint.face.begin(), constraint.face.end(),
            constraint.leader.begin());
  std::copy(constraint.face_weight.begin(), constraint.face_weight.end(),
            constraint.weight.begin());
}

std::pair<double, double>
Tie::judge(const std::vector<Constraint> &constraints) const
{
  // With n_f = sum |w_f|, |sum w_f u|^2 <= n_f sum |w_f| u^2, so that
  // K <= omega^2 (m_a + sum n_f |w_fa| m_f) against the mass m_a + sum w_fa
  // m_f.
  int rank;
  MPI_Comm_rank(communicator, &rank);
  std::map<GlobalIndex, std::pair<double, double>> added;
  for (const Constraint &c : constraints)
  {
    double n = 0.;
    for (const double w : c.weight)
      n += std::abs(w);
    for (int a = 0; a < 8; ++a)
      if (bodies[leader]->node_owner[c.leader[a]] == rank)
      {
        added[c.leader[a]].first += c.weight[a] * c.mass;
        added[c.leader[a]].second += n * std::abs(c.weight[a]) * c.mass;
      }
  }
  const NodalState &leads = bodies[leader]->nodes();
  double least[2] = {1., 1.};
  for (std::size_t i = 0; i < leads.n_owned; ++i)
  {
    const auto found = added.find(leads.global_id[i]);
    if (found == added.end())
      continue;
    const double m = leads.lumped_mass[i], mass = m + found->second.first;
    least[0] = std::min(least[0], mass / m);
    least[1] = std::min(least[1], mass / (m + found->second.second));
  }
  MPI_Allreduce(MPI_IN_PLACE, least, 2, MPI_DOUBLE, MPI_MIN, communicator);
  return {least[0], least[1]};
}

std::vector<Tie::Constraint> Tie::find_constraints() const
{
  const std::vector<FaceRecord> faces =
      gather_faces(*bodies[leader], communicator);
  const NodalState &followers = bodies[follower]->nodes();
  const ContactSurface open = bodies[follower]->contact_surface();
  const double reach = tolerance * open.spacing, touching = 1e-9 * open.spacing;
  const FacesByPlace near(
      faces, reach, bodies[leader]->contact_surface().spacing + 2. * reach);
  std::vector<Constraint> mine;
  for (std::size_t i = 0; i < followers.n_owned; ++i)
  {
    const Vec x = followers.reference_position[i];
    double distance;
    Constraint constraint{};
    const FaceRecord *const on =
        near.closest(x, touching, distance, constraint.face_weight);
    if (on == nullptr)
      continue;
    constraint.follower = followers.global_id[i];
    constraint.mass = followers.lumped_mass[i];
    constraint.face = on->node;
    constraint.leader = on->cell_node;
    if (distance <= touching || !on->has_cell ||
        !continue_cell(on->cell_x, x, constraint.weight))
      use_face(constraint);
    mine.push_back(constraint);
  }
  std::vector<Constraint> all = gather_all(mine, communicator);
  std::sort(all.begin(), all.end(),
            [](const Constraint &a, const Constraint &b)
            { return a.follower < b.follower; });
  return all;
}

double Tie::keep_mass(std::vector<Constraint> &constraints) const
{
  const bool has_negative = std::any_of(
      constraints.begin(), constraints.end(),
      [](const Constraint &c)
      { return *std::min_element(c.weight.begin(), c.weight.end()) < 0.; });
  if (!has_negative)
    return 1.;
  // Where coarse particles would take more than half of a fine cell's mass,
  // all stay on the faces.
  constexpr double least_mass = 0.5;
  const auto [mass, step_square] = judge(constraints);
  if (mass >= least_mass)
    return std::sqrt(step_square);
  std::for_each(constraints.begin(), constraints.end(), use_face);
  return 1.;
}
} // namespace sabot
