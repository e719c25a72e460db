// Candidates of contact from the ranks that found them to those that compute
// them.
#include "sabot/couplings/share_candidates.h"

#include "sabot/base/send_some.h"
#include "sabot/couplings/faces_of_nodes.h"

#include <algorithm>

namespace sabot
{
namespace
{
NodeKey key_of(const FaceNodes &face)
{
  return {face.body, 0, face.id};
}

bool come_in_order(const FaceNodes &a, const FaceNodes &b)
{
  return key_of(a) < key_of(b);
}

void make_unique(std::vector<std::size_t> &numbers)
{
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/** What one rank is told. */
struct Letters
{
  std::vector<std::vector<ContactCandidate>> candidates;
  std::vector<std::vector<NodeKey>> faces_of_candidates;
  std::vector<std::vector<std::size_t>> faces; // numbers here, repeated

  explicit Letters(const std::size_t n_ranks)
      : candidates(n_ranks), faces_of_candidates(n_ranks), faces(n_ranks)
  {
  }
};

/** Candidates @p first to @p last - 1 are those of one node. */
void write_letters(const SearchResult &result, const std::size_t first,
                   const std::size_t last, const std::vector<Body *> &bodies,
                   const int rank, FacesOfNodes &faces, Letters &letters)
{
  const auto &c = result.candidates;
  // What it may touch, and its own faces, with a place of which it may press.
  const FacesOfNodes::Range own = faces.around(c[first].node);
  std::vector<std::size_t> concerned(own.begin(), own.end());
  for (auto k = c[first].first_face; k < c[last - 1].last_face; ++k)
    concerned.push_back(result.face_of_candidate[k]);
  make_unique(concerned);
  std::vector<std::size_t> owners = {std::size_t(rank)};
  for (const std::size_t f : concerned)
    for (const GlobalIndex a : result.faces[f].node)
      owners.push_back(bodies[result.faces[f].body]->node_owner[a]);
  make_unique(owners);
  std::vector<std::size_t> around;
  if (owners.size() > 1)
    for (const std::size_t f : concerned)
      for (const GlobalIndex a : result.faces[f].node)
      {
        const FacesOfNodes::Range its =
            faces.around({result.faces[f].body, 0, a});
        around.insert(around.end(), its.begin(), its.end());
      }
  make_unique(around);
  for (const std::size_t r : owners)
  {
    letters.candidates[r].insert(letters.candidates[r].end(), c.begin() + first,
                                 c.begin() + last);
    for (auto k = c[first].first_face; k < c[last - 1].last_face; ++k)
      letters.faces_of_candidates[r].push_back(
          key_of(result.faces[result.face_of_candidate[k]]));
    if (int(r) != rank) // which has its own
      letters.faces[r].insert(letters.faces[r].end(), around.begin(),
                              around.end());
  }
}

/** By node, then by the body of the faces; lists of faces follow. */
void sort_candidates(SearchResult &result)
{
  const auto body_of_faces = [&](const ContactCandidate &c)
  { return result.faces[result.face_of_candidate[c.first_face]].body; };
  std::sort(result.candidates.begin(), result.candidates.end(),
            [&](const ContactCandidate &a, const ContactCandidate &b)
            {
              return a.node == b.node ? body_of_faces(a) < body_of_faces(b)
                                      : a.node < b.node;
            });
  std::vector<std::int64_t> sorted;
  sorted.reserve(result.face_of_candidate.size());
  for (ContactCandidate &c : result.candidates)
  {
    const std::int64_t begin = sorted.size();
    sorted.insert(sorted.end(), result.face_of_candidate.begin() + c.first_face,
                  result.face_of_candidate.begin() + c.last_face);
    c.first_face = begin;
    c.last_face = sorted.size();
  }
  result.face_of_candidate.swap(sorted);
}
} // namespace

void share_candidates(SearchResult &result, const std::vector<Body *> &bodies,
                      MPI_Comm communicator)
{
  int n_ranks, rank;
  MPI_Comm_size(communicator, &n_ranks);
  MPI_Comm_rank(communicator, &rank);
  sort_candidates(result);
  if (n_ranks == 1)
    return;
  Letters letters(n_ranks);
  FacesOfNodes around(result.faces, bodies);
  const auto &c = result.candidates;
  for (std::size_t first = 0, last; first < c.size(); first = last)
  {
    for (last = first; last < c.size() && c[last].node == c[first].node;)
      ++last;
    write_letters(result, first, last, bodies, rank, around, letters);
  }
  std::vector<std::vector<FaceNodes>> faces(n_ranks);
  for (int r = 0; r < n_ranks; ++r)
  {
    make_unique(letters.faces[r]);
    for (const std::size_t f : letters.faces[r])
      faces[r].push_back(result.faces[f]);
  }
  faces[rank] = std::move(result.faces);
  result.faces = send_some(faces, communicator);
  std::sort(result.faces.begin(), result.faces.end(), come_in_order);
  result.faces.erase(std::unique(result.faces.begin(), result.faces.end(),
                                 [](const FaceNodes &a, const FaceNodes &b)
                                 { return key_of(a) == key_of(b); }),
                     result.faces.end());
  result.candidates = send_some(letters.candidates, communicator);
  result.face_of_candidate.clear();
  for (const NodeKey &key :
       send_some(letters.faces_of_candidates, communicator))
    result.face_of_candidate.push_back(
        std::lower_bound(result.faces.begin(), result.faces.end(), key,
                         [](const FaceNodes &face, const NodeKey &k)
                         { return key_of(face) < k; }) -
        result.faces.begin());
  // Their lists stand one after the other.
  std::int64_t begin = 0;
  for (ContactCandidate &candidate : result.candidates)
  {
    candidate.last_face += begin - candidate.first_face;
    candidate.first_face = begin;
    begin = candidate.last_face;
  }
  sort_candidates(result);
}
} // namespace sabot
