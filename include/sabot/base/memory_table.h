#ifndef sabot_base_memory_table_h
#define sabot_base_memory_table_h

#include <cstddef>
#include <string>
#include <vector>

namespace sabot
{
/**
 * Bytes of the arrays of a body on this rank, by what they hold: capacities, as
 * that is what has been taken. Rows in the order in which rooms give them, the
 * same on all ranks, also where an array is empty.
 */
class MemoryTable
{
public:
  struct Row
  {
    std::string array;
    double bytes;
  };

  /** A vector of objects without pointers. */
  template <typename Array>
  void add(const std::string &name, const Array &array)
  {
    rows.push_back({name, double(array.capacity()) * sizeof(array[0])});
  }
  /** Rows of their own length each, themselves included. */
  template <typename T>
  void add_rows(const std::string &name, const std::vector<std::vector<T>> &of)
  {
    add(name, of);
    for (const auto &row : of)
      rows.back().bytes += double(row.capacity()) * sizeof(T);
  }

  std::vector<Row> rows;
};

/** What can say where its memory goes. */
class MemoryView
{
public:
  virtual ~MemoryView() = default;
  /** Append the arrays that are kept from step to step. Local. */
  virtual void list_memory(MemoryTable &table) const = 0;
};
} // namespace sabot

#endif
