#ifndef sabot_base_state_visitor_h
#define sabot_base_state_visitor_h

#include <cstddef>
#include <string>

namespace sabot
{
/**
 * Enumerates everything that a restart needs, in one place: each body and
 * coupling hands over its arrays by name, always in the same order. A visitor
 * may read or overwrite them, bit by bit; names tell what is amiss when a
 * checkpoint does not fit. Local to a rank: nothing is exchanged.
 */
class StateVisitor
{
public:
  virtual ~StateVisitor() = default;
  /**
   * @p n entries of @p size bytes each.
   * Bytes as they lie in memory, so on machines of the same byte order only. @p
   * name tells it apart from what the owner gives before and after.
   */
  virtual void visit(const std::string &name, void *data, std::size_t n,
                     std::size_t size) = 0;
  /** Entries that the next visit of @p name has: @p n when the state is saved,
      what was saved when it is overwritten. */
  virtual std::size_t n_entries(const std::string &name, std::size_t n) const
  {
    (void)name;
    return n;
  }
  /** Whether the arrays are overwritten; what follows from them must then be
      made anew. */
  virtual bool is_restoring() const { return false; }

  /**
   * An array that has the length it must have, of objects without pointers.
   * The owner has made it of that length; a restorer refuses another with
   * IOError.
   */
  template <typename Array>
  void visit_array(const std::string &name, Array &data)
  {
    visit(name, data.data(), data.size(), sizeof(data[0]));
  }
  /**
   * An array whose length is part of the state.
   * Saved, it keeps its length; restored, it takes that of the checkpoint.
   */
  template <typename Array>
  void visit_resized(const std::string &name, Array &data)
  {
    data.resize(n_entries(name, data.size()));
    visit_array(name, data);
  }
  /** A text of any length. */
  void visit_text(const std::string &name, std::string &text)
  {
    visit_resized(name, text);
  }
  /**
   * A number, or another object without pointers.
   * Padding bytes go along: of structures give the members one by one where
   * files are to be compared.
   */
  template <typename T>
  void visit_value(const std::string &name, T &value)
  {
    visit(name, &value, 1, sizeof(value));
  }
};
} // namespace sabot

#endif
