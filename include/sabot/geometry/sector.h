#ifndef sabot_geometry_sector_h
#define sabot_geometry_sector_h

#include <string>
#include <vector>

namespace sabot
{
class Parameters;

/** The entry "Sector" of round shapes: all of it, a half or a quarter, cut
    along planes through its center. */
struct Sector
{
  /** @p shape: its name in the text; @p sides: which are kept and how the
      planes are called. */
  static void declare(Parameters &prm, const std::string &shape,
                      const std::string &sides);
  static Sector parse(const Parameters &prm);

  bool is_full() const { return n_cuts == 0; }
  /** Append the names of the cut planes, as a box's faces: across @p axis and,
      of a quarter, the next one. */
  void name_cuts(const unsigned int axis,
                 std::vector<std::string> &faces) const;

  unsigned int n_cuts = 0;
};
} // namespace sabot

#endif
