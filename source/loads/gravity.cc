// Load: a force per mass that is the same everywhere, as the weight is.
#include "sabot/loads/nodal_forces.h"
#include "sabot/loads/time_course.h"

namespace sabot
{
namespace
{
/** f_a = m_a g(t) with the lumped masses: those of ties' followers, too, whose
    forces the ties hand on, and of particles that come. */
class Gravity : public Load
{
public:
  Gravity(const LoadRequest &request, std::vector<Body *> bodies)
      : Load(request.name), bodies(std::move(bodies)),
        course(TimeCourse::make(request)), communicator(request.communicator)
  {
    const auto a = get_vector(request.prm, "Acceleration");
    acceleration = vec(a[0], a[1], a[2]);
  }
  std::string type() const override { return "gravity"; }
  void initialize() override
  {
    for (Body *const body : bodies)
      weights.emplace_back(*body);
  }
  void add_forces(const double time) override
  {
    const Vec now = course->value(time) * acceleration;
    for (NodalForces &weight : weights)
    {
      weight.follow_body();
      const std::vector<double> &mass = weight.body.nodes().lumped_mass;
      for (std::size_t i = 0; i < weight.force.size(); ++i)
        weight.force[i] = mass[i] * now;
      weight.add();
    }
  }
  void accumulate_work(const double half_dt) override
  {
    for (NodalForces &weight : weights)
      weight.accumulate_work(half_dt);
  }
  void add_energies(EnergyLedger &ledger) const override
  {
    for (const NodalForces &weight : weights)
      weight.add_energies(ledger);
  }
  double total_work() const override
  {
    ExactSum work;
    for (const NodalForces &weight : weights)
      work.add(weight.total_work());
    ExactSum::reduce({&work}, communicator);
    return work.value();
  }
  std::vector<Resultant> resultants() const override
  {
    std::vector<Resultant> all;
    for (const NodalForces &weight : weights)
      all.push_back(weight.resultant(name, communicator));
    return all;
  }
  void visit_state(StateVisitor &visitor) override
  {
    for (NodalForces &weight : weights)
      weight.visit_state(visitor);
  }

private:
  const std::vector<Body *> bodies;
  const std::unique_ptr<TimeCourse> course;
  MPI_Comm communicator;
  Vec acceleration; // [m/s^2]
  std::vector<NodalForces> weights;
};

void declare(Parameters &prm)
{
  prm.declare_entry("Acceleration", "0 m/s^2, 0 m/s^2, -9.81 m/s^2",
                    quantities(Dimension::acceleration, 3, 3, -1e12, 1e12),
                    "Force per mass, a vector in the fixed frame.");
  prm.declare_entry("Bodies", "all", name_list(),
                    "Names of the bodies that it acts on; all: every one.");
}

std::unique_ptr<Load> make(const LoadRequest &request)
{
  std::vector<Body *> bodies;
  if (request.prm.get("Bodies") == "all")
    bodies = request.bodies;
  else
    for (const std::string &name : split_names(request.prm.get("Bodies")))
      bodies.push_back(request.body("Bodies", name));
  return std::make_unique<Gravity>(request, bodies);
}

const Registry<Load>::Add registered(
    {"gravity", "a force per mass, on all of a body or of the scene.",
     [](Parameters &prm)
     {
       declare(prm);
       TimeCourse::declare(prm);
     },
     make});
} // namespace
} // namespace sabot
