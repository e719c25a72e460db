#ifndef sabot_base_state_visitor_h
#define sabot_base_state_visitor_h

#include "sabot/base/types.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace sabot
{
/**
 * Items (nodes, cells, particles) that arrays of a state belong to. The first
 * n_saved of the n_held that this rank has are stored by it; together the ranks
 * store each item at least once. A rank that goes on from a checkpoint gets the
 * entries of all that it holds then, whoever stored them.
 */
struct StateItems
{
  std::string name;        // unique in the state: "body core/nodes"
  const GlobalIndex *keys; // [n_held], the same on every number of ranks
  std::size_t n_saved, n_held;
};

/**
 * Rows of entries, one for each item that this rank stores: row i has length[i]
 * entries from start[i] on.
 */
struct StateRows
{
  const StateItems &items; // n_held == n_saved
  std::string name;        // unique in the state: "body core/bonds"
  const std::size_t *start;
  const std::uint32_t *length;
};

/** To whom the entries of an array belong, so that they can be dealt out among
    another number of ranks. */
enum class StateShare : char
{
  same = '=',      // all ranks have the same
  items = 'i',     // StateItems, each with as many entries
  rows = 'r',      // StateRows
  neighbors = 'n', // StateRows of local numbers of items
  sum = '+',       // entries of all ranks are to be added up
  bound = 'b',     // each rank has one; all want the one that counts
  all = 'a',       // each rank has some, and wants those of all
  anywhere = 'w',  // each rank has some; any rank may have them
  own = 'o'        // of the rank that stored them, for the other kinds
};

/** What a StateVisitor is shown. */
struct StateArray
{
  std::string name;
  StateShare share;
  void *data;
  std::size_t n, size; // entries of this rank; bytes of one
  // Of items and rows
  const StateItems *items = nullptr;
  std::size_t per_item = 1; // entries
  /** Entry c of item e stands at ((e/lanes) per_item + c) lanes + e%lanes. */
  std::size_t lanes = 1;
  const StateRows *rows = nullptr;
  /** Of sums and bounds: add entry @p b to entry @p a; set entry @p a to
   * nothing. */
  void (*add)(void *a, const void *b) = nullptr;
  void (*clear)(void *a) = nullptr;
};

/**
 * Enumerates everything that a restart needs, in one place: each body and
 * coupling hands over its arrays by name, always in the same order and on all
 * ranks alike, and says to whom their entries belong. A visitor may read or
 * overwrite them, bit by bit; names tell what is amiss when a checkpoint does
 * not fit. Nothing is exchanged.
 *
 * Bytes go as they lie in memory, so on machines of the same byte order only;
 * padding bytes go along: of structures give the members one by one where ranks
 * are to have the same.
 */
class StateVisitor
{
public:
  virtual ~StateVisitor() = default;
  virtual void visit(const StateArray &array) = 0;
  /** Entries that the next visit will have: @p array's own when the state is
      saved, what this rank gets when it is overwritten. */
  virtual std::size_t n_entries(const StateArray &array) const
  {
    return array.n;
  }
  /** Whether the arrays are overwritten; what follows from them must then be
      made anew. */
  virtual bool is_restoring() const { return false; }

  /** Put before each name, with a slash: "body core". */
  std::string section;

  // What all ranks have alike.
  /** An array that has the length it must have, of objects without pointers. A
      restorer refuses another with IOError. */
  template <typename Array>
  void visit_array(const std::string &name, Array &data)
  {
    visit(whole(name, StateShare::same, data));
  }
  /** An array whose length is part of the state. */
  template <typename Array>
  void visit_resized(const std::string &name, Array &data)
  {
    visit_resized(name, StateShare::same, data);
  }
  /** A text of any length. */
  void visit_text(const std::string &name, std::string &text)
  {
    visit_resized(name, text);
  }
  /** A number, or another object without pointers. */
  template <typename T>
  void visit_value(const std::string &name, T &value)
  {
    visit(one(name, StateShare::same, value));
  }

  // What is summed, or bounds what ranks have.
  /** A sum over ranks that T::add() adds to without regard to the order. */
  template <typename T>
  void visit_sum(const std::string &name, T &sum)
  {
    visit(summed(one(name, StateShare::sum, sum), &sum));
  }
  /** Several, as many on all ranks. */
  template <typename Array>
  void visit_sums(const std::string &name, Array &sums)
  {
    visit(summed(whole(name, StateShare::sum, sums), sums.data()));
  }
  /** A number of things of this rank. */
  template <typename T>
  void visit_count(const std::string &name, T &count)
  {
    StateArray array = one(name, StateShare::sum, count);
    array.add = [](void *const a, const void *const b)
    { *static_cast<T *>(a) += *static_cast<const T *>(b); };
    array.clear = [](void *const a) { *static_cast<T *>(a) = T(); };
    visit(array);
  }
  /** The largest of what ranks have is what counts; all get it. */
  template <typename T>
  void visit_largest(const std::string &name, T &value)
  {
    StateArray array = one(name, StateShare::bound, value);
    array.add = [](void *const a, const void *const b)
    {
      *static_cast<T *>(a) =
          std::max(*static_cast<T *>(a), *static_cast<const T *>(b));
    };
    array.clear = [](void *const a)
    { *static_cast<T *>(a) = std::numeric_limits<T>::lowest(); };
    visit(array);
  }
  /** The same of the least stable step [s], and whose it is. */
  void visit_step(const std::string &name, double &dt, GlobalIndex &item);

  // What belongs to items.
  /** Before their first array, and again where this rank holds others since. */
  void visit_keys(const StateItems &items)
  {
    StateArray array{items.name + " keys", StateShare::own,
                     const_cast<GlobalIndex *>(items.keys), items.n_saved,
                     sizeof(GlobalIndex)};
    array.items = &items;
    visit(array);
  }
  /** @p per_item entries each, of at least the items that are stored; of those
      that are only held where @p data is as long. Empty on all ranks: nothing.
   */
  template <typename Array>
  void visit_items(const std::string &name, Array &data,
                   const StateItems &items, const std::size_t per_item = 1)
  {
    visit_items(name, data.data(), data.size() / per_item, sizeof(data[0]),
                items, per_item, 1);
  }
  /** @p n: items for which there is room. */
  void visit_items(const std::string &name, void *const data,
                   const std::size_t n, const std::size_t size,
                   const StateItems &items, const std::size_t per_item,
                   const std::size_t lanes);
  /** Starts and lengths, before the first array of rows. */
  void visit_shape(const StateRows &rows);
  template <typename Array>
  void visit_rows(const std::string &name, Array &data, const StateRows &rows)
  {
    visit_rows(name, data.data(), data.size(), rows);
  }
  template <typename T>
  void visit_rows(const std::string &name, T *const data, const std::size_t n,
                  const StateRows &rows)
  {
    StateArray array{full(name), StateShare::rows, data, n, sizeof(T)};
    array.rows = &rows;
    visit(array);
  }
  /** Rows of local numbers [@p n_places], each below @p n_local; @p keys of
      what they count. Restored, they are keys. */
  void visit_neighbors(const std::string &name, std::uint32_t *local,
                       const std::size_t n_places, const GlobalIndex *keys,
                       const std::size_t n_local, const StateRows &rows);
  void restore_neighbors(const std::string &name, GlobalIndex *keys,
                         const std::size_t n_places, const StateRows &rows);

  // Lists.
  /** What this rank has to tell all others; restored, what all had to tell, in
      the order of the ranks. */
  template <typename Array>
  void visit_all(const std::string &name, Array &data)
  {
    visit_resized(name, StateShare::all, data);
  }
  /** Entries that may be on any rank, in any order. */
  template <typename Array>
  void visit_anywhere(const std::string &name, Array &data)
  {
    visit_resized(name, StateShare::anywhere, data);
  }

private:
  std::string full(const std::string &name) const
  {
    return section + "/" + name;
  }
  template <typename T>
  StateArray one(const std::string &name, const StateShare share, T &value)
  {
    return {full(name), share, &value, 1, sizeof(value)};
  }
  template <typename Array>
  StateArray whole(const std::string &name, const StateShare share, Array &data)
  {
    return {full(name), share, data.data(), data.size(), sizeof(data[0])};
  }
  template <typename Array>
  void visit_resized(const std::string &name, const StateShare share,
                     Array &data)
  {
    data.resize(n_entries(whole(name, share, data)));
    visit(whole(name, share, data));
  }
  template <typename T>
  static StateArray summed(StateArray array, const T *)
  {
    array.add = [](void *const a, const void *const b)
    { static_cast<T *>(a)->add(*static_cast<const T *>(b)); };
    array.clear = [](void *const a) { *static_cast<T *>(a) = T(); };
    return array;
  }
};
} // namespace sabot

#endif
