#ifndef sabot_loads_surface_load_h
#define sabot_loads_surface_load_h

#include "sabot/loads/nodal_forces.h"
#include "sabot/loads/time_course.h"

#include <array>
#include <memory>
#include <vector>

namespace sabot
{
/**
 * What pressure and traction share: faces of one body, the nodes around them
 * and the forces there. Faces that erode bear nothing any more, those that
 * erosion opens never do. Sums at a node run over its faces by their numbers,
 * all of which its rank has.
 */
class SurfaceLoad : public Load
{
public:
  explicit SurfaceLoad(const LoadRequest &request);

  /** InputError, on all ranks, where no face bears the load. */
  void initialize() override;
  void add_forces(const double time) override;
  void accumulate_work(const double half_dt) override;
  void add_energies(EnergyLedger &ledger) const override;
  double total_work() const override;
  std::vector<Resultant> resultants() const override;
  void visit_state(StateVisitor &visitor) override;

  /** Entries "Body" and "Faces", and those of the time course. */
  static void declare(Parameters &prm);

protected:
  /** Slot of a node that another rank owns. */
  static constexpr std::size_t elsewhere = -1;
  struct LoadedFace
  {
    std::array<std::size_t, 4> node; // local
    std::array<std::size_t, 4> slot; // in forces, or elsewhere
  };
  struct LoadedShare
  {
    std::size_t slot;
    LoadedSurface::Share share;
  };

  /** Once the faces are known, and whenever they have changed. */
  virtual void faces_changed() {}
  /** Add the forces of @p factor times the load to force(), which is zero. */
  virtual void compute(const double factor) = 0;
  AlignedVector<Vec> &force() { return forces[0].force; }

  Body &body;
  std::vector<LoadedFace> faces;
  std::vector<LoadedShare> shares;

private:
  void take_faces();

  const std::string path; // of the entry "Faces"
  std::vector<unsigned int> ids;
  const std::unique_ptr<TimeCourse> course;
  MPI_Comm communicator;
  unsigned int version = 0;        // of the body's surface
  std::vector<NodalForces> forces; // one, once it is initialized
};

/** Integrals over a bilinear quadrilateral of its four functions times the
    normal, outward by the right-hand rule [m^2]; by 2x2 Gauss points, exact. */
std::array<Vec, 4> nodal_areas(const std::array<Vec, 4> &x);
} // namespace sabot

#endif
