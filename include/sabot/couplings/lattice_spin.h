#ifndef sabot_couplings_lattice_spin_h
#define sabot_couplings_lattice_spin_h

#include "sabot/couplings/lattice_followers.h"

#include <array>
#include <map>
#include <unordered_map>
#include <vector>

namespace sabot
{
/**
 * Momenta of cells that become lattices. Masses at the corners of a cell have
 * more moment of inertia than its lattice, so that particles with velocities in
 * between lack angular momentum. Cells that turn together and share nodes get
 * it back by the smallest change of velocities that does it,
 *
 *   min sum mu |dv|^2/2,  sum mu dv = P,  sum mu r x dv = L:
 *   dv = u + theta x r where nothing holds the particle,
 *
 * mu the shares of the cells' masses, r from their center. Followers hand their
 * part to the nodes. So both momenta are kept to round-off wherever planes of
 * symmetry and clamps leave it possible.
 */
class LatticeSpin
{
public:
  /** @p followers: numbers of the particles that follow, ascending. */
  LatticeSpin(const LatticeFollowers::Parts &parts,
              const std::vector<GlobalIndex> &followers,
              const std::vector<LatticeFollowers::Turning> &turned);

  using Missing = LatticeFollowers::Missing;
  /** Gives back what @p mine lack, of this rank's particles. @return the
     kinetic energy that owned nodes and particles got [J]. Collective. */
  ExactSum give_back(const std::vector<Missing> &mine);

private:
  using Moment = std::array<std::array<double, 6>, 6>;
  struct Piece
  {
    Vec center = {};
    double n = 0., size = 0.; // cells, length [m]
    Vec u = {}, theta = {};
  };
  /** One particle of a cell. */
  struct Member
  {
    GlobalIndex site;
    std::size_t number; // of the particle
    bool follows;
    double mass; // share, over the density
    Vec free, r;
    SplitMesh::Carrier on;
  };
  struct Part
  {
    std::size_t k; // among the turned cells
    Moment moment; // with lengths over the size of the piece
  };
  using Impulses = std::map<std::size_t, Vec>; // [N s], of owned ones
  void find_pieces();
  std::vector<Member> members(const std::size_t k) const;
  /** Whether any node of turned cell @p k is owned here. */
  bool is_known(const std::size_t k) const;
  /** By cells, the same on all ranks. Collective. */
  std::vector<Part> moments() const;
  /** u and theta of all pieces. Collective. */
  void solve(const std::vector<Missing> &missing);
  /** What turned cell @p k gives to owned nodes and particles. */
  void add_impulses(const std::size_t k, Impulses &of_nodes,
                    Impulses &of_particles) const;

  const LatticeFollowers::Parts body;
  const SplitMesh &lattices;
  const std::vector<GlobalIndex> &followers;
  const std::vector<LatticeFollowers::Turning> &turned;
  std::unordered_map<GlobalIndex, std::size_t> number_of_site;
  std::vector<std::size_t> piece_of; // of turned cells
  std::vector<Piece> pieces;
};
} // namespace sabot

#endif
