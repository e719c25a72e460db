// Arrays of items and rows as visitors of a state are shown them.
#include "sabot/base/state_visitor.h"

namespace sabot
{
void StateVisitor::visit_step(const std::string &name, double &dt,
                              GlobalIndex &item)
{
  struct Step
  {
    double dt;
    GlobalIndex item;
  } least{dt, item};
  StateArray array = one(name, StateShare::bound, least);
  // Of equal ones the lowest item is named.
  array.add = [](void *const a, const void *const b)
  {
    Step &mine = *static_cast<Step *>(a);
    const Step &its = *static_cast<const Step *>(b);
    if (its.dt < mine.dt || (its.dt == mine.dt && its.item < mine.item))
      mine = its;
  };
  array.clear = [](void *const a)
  {
    *static_cast<Step *>(a) = {std::numeric_limits<double>::max(),
                               std::numeric_limits<GlobalIndex>::max()};
  };
  visit(array);
  dt = least.dt;
  item = least.item;
}

void StateVisitor::visit_items(const std::string &name, void *const data,
                               const std::size_t n, const std::size_t size,
                               const StateItems &items,
                               const std::size_t per_item,
                               const std::size_t lanes)
{
  // What is held beside is what others store.
  const std::size_t n_items = is_restoring() ? n : std::min(n, items.n_saved),
                    n_groups = (n_items + lanes - 1) / lanes;
  StateArray array{full(name), StateShare::items, data,
                   n_groups * lanes * per_item, size};
  array.items = &items;
  array.per_item = per_item;
  array.lanes = lanes;
  visit(array);
}

void StateVisitor::visit_shape(const StateRows &rows)
{
  const auto whole = [&](const char *const what, auto *const data)
  {
    StateArray array{rows.name + what, StateShare::own,
                     const_cast<void *>(static_cast<const void *>(data)),
                     rows.items.n_saved, sizeof(data[0])};
    array.rows = &rows;
    visit(array);
  };
  whole(" starts", rows.start);
  whole(" lengths", rows.length);
}

void StateVisitor::visit_neighbors(const std::string &name,
                                   std::uint32_t *const local,
                                   const std::size_t n_places,
                                   const GlobalIndex *const keys,
                                   const std::size_t n_local,
                                   const StateRows &rows)
{
  StateArray numbers{rows.name + " numbers", StateShare::own,
                     const_cast<GlobalIndex *>(keys), n_local,
                     sizeof(GlobalIndex)};
  numbers.rows = &rows;
  visit(numbers);
  StateArray array{full(name), StateShare::neighbors, local, n_places,
                   sizeof(std::uint32_t)};
  array.rows = &rows;
  visit(array);
}

void StateVisitor::restore_neighbors(const std::string &name,
                                     GlobalIndex *const keys,
                                     const std::size_t n_places,
                                     const StateRows &rows)
{
  StateArray numbers{rows.name + " numbers", StateShare::own, nullptr, 0,
                     sizeof(GlobalIndex)};
  numbers.rows = &rows;
  visit(numbers);
  StateArray array{full(name), StateShare::neighbors, keys, n_places,
                   sizeof(GlobalIndex)};
  array.rows = &rows;
  visit(array);
}
} // namespace sabot
