#ifndef sabot_output_state_blocks_h
#define sabot_output_state_blocks_h

#include "sabot/base/state_visitor.h"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sabot
{
/** What is known of one array of a saved state without its bytes. */
struct StateLine
{
  char share = '=';     // StateShare
  std::size_t n = 0;    // entries
  std::size_t size = 0; // of an entry [bytes]
  std::string hash;     // SHA-256 of the bytes; may be empty
  std::string name;     // "body core/position"
  std::size_t n_bytes() const { return n * size; }
};

/** Shows the arrays that it visits to a function, one after the other and
    without a copy. Changes nothing of what it visits. Not collective. */
class StateSaver : public StateVisitor
{
public:
  using Take = std::function<void(const StateLine &, const void *data)>;
  explicit StateSaver(Take take) : take(std::move(take)) {}
  void visit(const StateArray &array) override;

private:
  const Take take;
};

/** A state that was saved by some ranks: lines in the order of the visits, the
    same names on each rank, and their bytes. */
class StateSource
{
public:
  virtual ~StateSource() = default;
  virtual int n_ranks() const = 0;
  virtual const std::vector<StateLine> &lines(const int rank) const = 0;
  /** Of line @p number of @p rank. IOError where they are not what was saved.
   */
  virtual std::vector<char> read(const int rank,
                                 const std::size_t number) const = 0;
};

/** In memory: for tests. */
class StateCopies : public StateSource
{
public:
  /** Save what @p visit shows as the state of one more rank. */
  void add_rank(const std::function<void(StateVisitor &)> &visit);
  int n_ranks() const override { return saved.size(); }
  const std::vector<StateLine> &lines(const int rank) const override
  {
    return saved[rank].lines;
  }
  std::vector<char> read(const int rank,
                         const std::size_t number) const override
  {
    return saved[rank].bytes[number];
  }

private:
  struct OfRank
  {
    std::vector<StateLine> lines;
    std::vector<std::vector<char>> bytes;
  };
  std::vector<OfRank> saved;
};

/**
 * Overwrites the arrays that it visits, in the order in which they were saved,
 * by what any number of ranks saved: each array by its StateShare, one array of
 * one rank in memory at a time. IOError, which names both, when name or size
 * differ from what was saved: the checkpoint is of another scene or of another
 * version of the program. What follows from the arrays the owners make anew
 * (StateVisitor::is_restoring()).
 *
 * Entries that belong to no item (sums, lists that may be anywhere) go from
 * rank w of the n that saved to rank w mod m of the m that there are now.
 *
 * After an IOError what was visited before is overwritten already: the run
 * cannot go on. Not collective: each rank reads what it needs.
 */
class StateRestorer : public StateVisitor
{
public:
  /** For rank @p rank of @p n_ranks. */
  StateRestorer(std::shared_ptr<const StateSource> source, const int rank,
                const int n_ranks);
  void visit(const StateArray &array) override;
  std::size_t n_entries(const StateArray &array) const override;
  bool is_restoring() const override { return true; }

private:
  /** Items of this rank among those that a rank saved: there, here. */
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  /** The line that is next, as rank 0 saved it. IOError where the @p array is
      another one. */
  const StateLine &next(const StateArray &array) const;
  /** Ranks whose lists this rank gets: all, or every n_ranks-th. */
  std::vector<int> ranks_of(const StateArray &array) const;
  void restore_same(const StateArray &array);
  void restore_list(const StateArray &array);
  void restore_sum(const StateArray &array);
  void restore_items(const StateArray &array);
  void restore_rows(const StateArray &array);
  /** Of each rank that saved. IOError where items are missing. */
  const std::vector<Pairs> &pairs_of(const StateItems &items);
  /** Bytes of the array @p name of @p rank as numbers. */
  template <typename T>
  std::vector<T> numbers(const int rank, const std::string &name) const;
  [[noreturn]] void misfit(const StateArray &array,
                           const StateLine &line) const;

  const std::shared_ptr<const StateSource> source;
  const int rank, n_ranks;
  std::size_t position = 0;                  // of the next line
  std::map<std::string, std::size_t> places; // of lines, by name
  struct Known
  {
    std::size_t n_held = 0;
    std::vector<Pairs> pairs;
  };
  std::map<std::string, Known> known; // by name of the items
};
} // namespace sabot

#endif
