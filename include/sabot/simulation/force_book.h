#ifndef sabot_simulation_force_book_h
#define sabot_simulation_force_book_h

#include "sabot/output/history.h"
#include "sabot/simulation/scene.h"

#include <array>
#include <vector>

namespace sabot
{
/**
 * Who pushes whom in a scene: resultants of what holds bodies from outside and
 * of every coupling on every body, as the tables `forces` and `impulses` of the
 * histories, a column for each source, body and axis:
 *
 *     "impact on projectile z [N]", "clamped faces on plate x [N s]"
 *
 * The impulses on a body since the start are the change of its momentum, what
 * eroded with it included. Of the whole scene this is watched where something
 * holds it from outside (a free one is watched by EnergyBalance):
 *   |sum m v + p_eroded - p_0 - sum of reactions - sum of images|
 *     / max over time sum sqrt(2 E_kin m),
 * where couplings may push from outside across planes of symmetry alone, as the
 * mirror images that they meet there.
 */
class ForceBook
{
public:
  /** The scene is kept by reference, and may still be without state. */
  explicit ForceBook(const Scene &scene) : scene(scene) {}

  /** Take the momentum that there is as that of the start. @p bodies: measures
      of all bodies, by number. */
  void start(const std::vector<BodyMeasures> &bodies);
  /** Ask for all resultants, and look at the momentum. Collective. */
  void look(const std::vector<BodyMeasures> &bodies);
  /** A row of both tables with what look() found; nothing where nobody pushes.
      @p time in s. */
  void append(History &history, const double time) const;
  /** Largest residual of the momentum so far. */
  double largest_momentum_residual() const { return largest; }
  void visit_state(StateVisitor &visitor);

private:
  const Scene &scene;
  std::vector<Resultant> resultants;
  std::array<double, 3> initial_momentum{}; // [kg m/s]
  double scale = 0., largest = 0.;
};
} // namespace sabot

#endif
