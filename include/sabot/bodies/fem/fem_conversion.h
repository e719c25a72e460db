#ifndef sabot_bodies_fem_fem_conversion_h
#define sabot_bodies_fem_fem_conversion_h

#include "sabot/base/ghost_exchange.h"
#include "sabot/base/ledger.h"
#include "sabot/base/nodal_state.h"
#include "sabot/base/state_visitor.h"
#include "sabot/bodies/conversion.h"
#include "sabot/bodies/fem/hexahedra.h"
#include "sabot/bodies/fem/living_cells.h"

#include <functional>
#include <memory>
#include <vector>

namespace sabot
{
/**
 * Cells of a FEM body that turn into particles: which, and what they hand over.
 * An eighth of a cell's mass, volume and energies goes to each corner, or to
 * every site of its lattice the share of it (SplitMesh), F at the center,
 * stress and state of the law as means over its points.
 *
 * Every rank that has a cell comes to the same verdict on it and hands their
 * shares to the corners that it owns, and to the sites whose carriers' lowest
 * node it owns.
 */
class FemConversion : public CellSource
{
public:
  /** What the body holds; outlives this. */
  struct Parts
  {
    const Material &material;
    NodalState &nodes;
    const GhostExchange &exchange; // of nodes
    Hexahedra &cells;
    /** After distribute(). */
    const std::function<LivingCells &()> living;
    /** Called when cells have gone: what may be touched is another surface. */
    const std::function<void()> surface_has_changed;
  };
  explicit FemConversion(const Parts &parts) : body(parts) {}

  /** Whether cells may be asked for: convert_by() has been called. */
  bool is_on() const { return on; }
  /** After the cells were set up; @p held: nodes of driven and loaded faces, by
      number, around which cells stay. */
  void set_up(const std::vector<GlobalIndex> &held);

  void convert_by(std::vector<std::shared_ptr<const ConversionCriterion>>
                      criteria) override;
  void split_by(std::shared_ptr<const SplitMesh> mesh) override
  {
    lattices = std::move(mesh);
  }
  void keep_around(const std::vector<GlobalIndex> &nodes) override;
  std::vector<std::size_t> unfit_cells(std::vector<char> &is_failed) override;
  std::vector<std::size_t>
  cells_in(const std::function<bool(const std::array<double, 3> &)> &is_inside)
      const override;
  NodalMatter give(const std::vector<std::size_t> &cells,
                   const std::vector<NodalMatter::Entry> &particles) override;
  GlobalIndex cell_number(const std::size_t e) const override
  {
    return body.cells.cell_id[e];
  }
  std::size_t local_node(const GlobalIndex node) const override;
  void refresh_velocities() override
  {
    body.exchange.update(body.nodes.velocity.data());
  }

  /** Hourglass energy of cells that have gone where it is heat already, as of
      viscous control: it stays in the ledger [J]. Local. */
  void add_energies(EnergyLedger &ledger) const
  {
    ledger.hourglass.add(dissipated_modes);
  }
  /** @p initial_cells: LivingCells::items(). */
  void visit_state(StateVisitor &visitor, const StateItems &initial_cells);

private:
  /** Whether cell @p e may turn. */
  bool may_turn(const std::size_t e) const
  {
    return stays.empty() || !stays[body.living().initial_number(e)];
  }
  /** All of cell @p e, and its states. */
  void content_of(const std::size_t e, NodalMatter::Entry &content,
                  double *states) const;
  /** Sites of cell @p e: its corners, or those of its lattice. */
  std::vector<SplitMesh::Member> members(const std::size_t e) const;
  /** The nodes that carry a site, local numbers, and their weights. */
  struct Carrier
  {
    std::vector<std::size_t> node;
    std::vector<double> weight;
  };
  Carrier carrier_of(const GlobalIndex site) const;
  bool owns(const GlobalIndex site) const;
  bool is_bare(const NodalMatter::Entry &entry) const;
  /** Entries for the sites of these cells that are owned here, with their
      places and velocities. */
  NodalMatter begin(const std::vector<std::size_t> &leaving) const;
  /** Bounds, and what is left of bare nodes by round-off. */
  void finish(NodalMatter &matter, const class CornerFields &fields);

  const Parts body;
  bool on = false;
  std::shared_ptr<const SplitMesh> lattices; // null: none
  std::vector<std::shared_ptr<const ConversionCriterion>> criteria;
  std::vector<char> stays;         // by initial cell; empty: none does
  std::vector<double> start_steps; // by initial cell [s], where asked for
  ExactSum dissipated_modes;       // [J], shares of owned nodes
};
} // namespace sabot

#endif
