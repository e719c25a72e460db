// Spring, friction laws and shear strength of contact against closed forms.
#include "sabot/base/parameters.h"
#include "sabot/couplings/contact_points.h"
#include "sabot/couplings/coupling_builder.h"
#include "sabot/couplings/friction/coulomb.h"
#include "sabot/couplings/shared_work.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace sabot;

constexpr double dt = 1e-8, mass = 1e-6;

ContactPoint point_at(const double depth, const Vec velocity)
{
  ContactPoint point;
  point.item = 0;
  point.normal = vec(0., 0., 1.);
  point.velocity = velocity;
  point.depth = depth;
  point.stiffness = 1e6;
  point.reduced_mass = mass;
  point.area = 1e-6;
  point.largest_friction = ShearStrength().value() * point.area;
  return point;
}

ContactPoint answer(const ContactPoint &point, const ContactOptions &options)
{
  ContactPoints points;
  points.add(point);
  points.find_forces(options, dt);
  return *points.begin();
}

TEST(Spring, stiffness_is_bounded_by_mass_over_step_squared)
{
  SpringOptions spring;
  EXPECT_EQ(spring.stable_stiffness(5., mass, dt), 5.);
  // phi m/dt^2 = 0.1 * 1e-6 / 1e-16
  EXPECT_DOUBLE_EQ(spring.stable_stiffness(1e12, mass, dt), 1e9);
}

TEST(Spring, pressure_is_stiffness_times_depth_and_damping_of_approach)
{
  const ContactOptions options;
  // k d = 1e6 * 1e-6 = 1 N; c = 2 * 0.1 * sqrt(1e6 * 1e-6) = 0.2 N s/m
  EXPECT_DOUBLE_EQ(answer(point_at(1e-6, vec(0, 0, -2.)), options).pressing,
                   1.4);
  EXPECT_DOUBLE_EQ(answer(point_at(1e-6, vec(0, 0, 2.)), options).pressing, 1.);
}

TEST(Spring, a_node_found_inside_repels_below_that_depth_only)
{
  ContactMemory memory;
  EXPECT_EQ(memory.effective_depth(3e-6, 1e-7), 0.);
  EXPECT_NEAR(memory.effective_depth(3.05e-6, 1e-7), 0.05e-6, 1e-20);
  // A jump of the depth that motion does not explain does not repel.
  EXPECT_NEAR(memory.effective_depth(9e-6, 1e-7), 0.05e-6, 1e-20);
  // Above the offset nothing repels, and the offset follows outwards.
  EXPECT_EQ(memory.effective_depth(2e-6, 1e-7), 0.);
  EXPECT_NEAR(memory.effective_depth(2.1e-6, 1e-6), 0.1e-6, 1e-20);
  memory.release();
  // A node that was outside comes in from there: all of the depth repels.
  EXPECT_EQ(memory.effective_depth(1e-6, 1.), 1e-6);
}

TEST(Spring, gives_back_no_more_than_it_took)
{
  // In and out along a straight line the books close: all of it comes back.
  ContactMemory memory;
  const double k = 1e6, v = 1.;
  const Vec n = vec(0., 0., 1.);
  double depth = 0., taken = 0.;
  for (int step = 0; step < 100; ++step)
  {
    depth += v * dt;
    EXPECT_EQ(backed_part(memory, {k * depth * n, -v * n, k, mass}, dt), 1.);
    taken = memory.stored;
  }
  EXPECT_NEAR(taken, 0.5 * k * depth * depth, 1e-12 * taken);
  for (int step = 0; step < 100; ++step)
  {
    depth -= v * dt;
    EXPECT_EQ(backed_part(memory, {k * depth * n, v * n, k, mass}, dt), 1.);
  }
  EXPECT_NEAR(memory.stored, 0., 1e-9 * taken);
  // What has taken less gives less: with a tenth of k d^2/2 the work of the
  // next step, in which its own kick takes part, is that and a tenth of what
  // one step's motion is worth, k (v dt)^2/2.
  memory = ContactMemory();
  const double f = 1e3, U = 0.5 * f * f / k, phi = k * dt * dt / mass;
  EXPECT_EQ(backed_part(memory, {f * n, v * n, k, mass}, dt), 0.);
  memory.stored = 0.1 * U;
  const double fast = 3e5,
               part = backed_part(memory, {f * n, fast * n, k, mass}, dt);
  EXPECT_LT(part, 0.5);
  EXPECT_NEAR(part * f * fast * dt + 0.5 * std::pow(part * f * dt, 2) / mass,
              0.1 * (U + 0.5 * k * std::pow(fast * dt, 2) / (1. - phi)),
              1e-12 * U);
  // The half step that a force has already acted for counts in full.
  EXPECT_NEAR(memory.stored, 0.1 * U - 0.5 * part * f * fast * dt, 1e-12 * U);
}

TEST(Spring, without_a_potential_gives_no_energy)
{
  // A node whose depth does not follow its motion comes in, and is thrown back
  // and forth by a stress behind it: what it gets stays below what it had.
  ContactMemory memory;
  const double k = 1e9, depth = 1e-6;
  const Vec n = vec(0., 0., 1.);
  double v = -1., work = 0.;
  for (int step = 0; step < 1000; ++step)
  {
    const double part =
        backed_part(memory, {k * depth * n, v * n, k, mass}, dt);
    const double before = v, f = part * k * depth;
    v += (f / mass + (step % 2 == 0 ? 1e7 : -1e7)) * dt;
    work += 0.5 * f * (before + v) * dt;
  }
  EXPECT_LT(work, 0.5 * mass);
}

TEST(Spring, sliding_moves_work_from_one_node_to_another)
{
  // Of two springs of a pair one came in without work, the other is leaving
  // with what it took: the first is filled from the second, and what is left
  // makes both stiffer.
  const ContactOptions options;
  SharedWork work({{2, 1}, {0, 1}}, MPI_COMM_SELF);
  EXPECT_EQ(work.number_of(1, 2), 1);
  EXPECT_EQ(work.number_of(0, 1), 0);
  const double k = 1e6, small = 1e-6, U = 0.5 * k * small * small;
  ContactMemory memory[2];
  memory[0].stored = 4. * U; // of twice the depth
  const auto step = [&](const double first, const double second)
  {
    ContactPoints points;
    for (int i = 0; i < 2; ++i)
    {
      ContactPoint point = point_at(i == 0 ? first : second, Vec{});
      point.memory = &memory[i];
      memory[i].spring = k * point.depth * point.normal; // it is not new
      point.pair = 1;
      point.is_owned = true;
      points.add(point);
    }
    points.find_forces(options, dt, &work);
    return points.begin()->part * points.begin()->stiffness / k;
  };
  EXPECT_EQ(step(small, small), 1.);
  EXPECT_DOUBLE_EQ(memory[0].stored, U);
  EXPECT_DOUBLE_EQ(memory[1].stored, U);
  EXPECT_DOUBLE_EQ(work.left(1), 2. * U);
  EXPECT_EQ(work.left(0), 0.);
  EXPECT_DOUBLE_EQ(step(small, small), 2.);
  // More than all springs hold makes none stiffer any more,
  step(0.5 * small, 0.5 * small);
  EXPECT_DOUBLE_EQ(work.left(1), 0.5 * U);
  // but those that lack it get it, as long as there is any.
  memory[0].stored = 0.;
  step(small, small);
  EXPECT_DOUBLE_EQ(memory[0].stored, U);
  EXPECT_DOUBLE_EQ(memory[1].stored, U);
  EXPECT_EQ(work.left(1), 0.);
  for (const double gets : {U, 0.75 * U})
  {
    memory[0].stored = 0.;
    EXPECT_EQ(step(small, small), 0.);
    EXPECT_NEAR(memory[0].stored, gets, 1e-12 * U);
  }
}

TEST(Friction, coulomb_with_decay)
{
  const Coulomb law(0.4, 0.1, 0.5);
  EXPECT_EQ(law.coefficient(0.), 0.4);
  EXPECT_NEAR(law.coefficient(2.), 0.1 + 0.3 * std::exp(-1.), 1e-16);
  EXPECT_NEAR(law.coefficient(1e3), 0.1, 1e-16);
  EXPECT_EQ(Coulomb(0.4).coefficient(1e3), 0.4);
}

TEST(Friction, acts_against_the_sliding_below_all_limits)
{
  ContactOptions options;
  const Vec v = vec(3., 4., 0.); // 5 m/s
  // 1 N presses.
  const ContactPoint pressed = point_at(1e-6, v);
  EXPECT_EQ(norm(answer(pressed, options).friction_force()), 0.);
  options.friction = coulomb(0.2);
  const Vec friction = answer(pressed, options).friction_force();
  EXPECT_DOUBLE_EQ(friction[0], -0.12);
  EXPECT_DOUBLE_EQ(friction[1], -0.16);
  EXPECT_EQ(friction[2], 0.);
  // A spring of a pair remembers nothing, and has no more than stops the
  // sliding in two steps: m |v|/(2 dt) = 0.5 mN.
  ContactPoint slow = pressed;
  slow.velocity = vec(1e-5, 0., 0.);
  EXPECT_DOUBLE_EQ(answer(slow, options).friction_force()[0], -0.5e-3);
  // No more than the metal bears.
  ContactPoint soft = pressed;
  soft.largest_friction = ShearStrength::given(5e4).value() * soft.area;
  EXPECT_DOUBLE_EQ(norm(answer(soft, options).friction_force()), 0.05);
  EXPECT_DOUBLE_EQ(ShearStrength::of_metals(3e6, 1e6), 1e6 / std::sqrt(3.));
}

TEST(Friction, what_slides_has_all_of_it_and_what_sticks_does_not_creep)
{
  const Vec n = vec(0., 0., 1.);
  const double k = 1e6, c = 0.2, d = 1e-6;
  ContactMemory memory;
  const auto friction = [&](const Vec v, const double largest)
  { return spring_friction(memory, n, v, d, k, c, largest, dt); };
  // What comes in along a slope has slid as far as it is deep.
  EXPECT_DOUBLE_EQ(friction(vec(3., 0., -4.), 10.)[0],
                   -(k * d * 0.6 + k * 3. * dt + c * 3.));
  // Then a spring along the way, until it gives way, against the sliding.
  memory = ContactMemory();
  memory.spring = n;
  EXPECT_DOUBLE_EQ(friction(vec(2., 0., 1.), 1.)[0], -(k * 2. * dt + c * 2.));
  Vec f = {};
  for (int step = 0; step < 20; ++step)
    f = friction(vec(10., 0., 0.), 1.);
  EXPECT_DOUBLE_EQ(f[0], -1.);
  for (int step = 0; step < 200; ++step)
    f = friction(vec(0., 30., 0.), 1.);
  EXPECT_NEAR(f[1], -1., 1e-6);
  EXPECT_NEAR(norm(f), 1., 1e-12);
  // At rest it bears what it bore.
  for (int step = 0; step < 1000; ++step)
    EXPECT_DOUBLE_EQ(friction(Vec{}, 1.)[1], f[1]);
  // It turns with the surface, and holds less where less presses.
  memory.friction = vec(0., 0.3, 0.4);
  EXPECT_DOUBLE_EQ(friction(Vec{}, 1.)[1], 0.5);
  EXPECT_DOUBLE_EQ(friction(Vec{}, 0.25)[1], 0.25);
}

TEST(Spring, its_bound_does_not_follow_every_step)
{
  SteadyStep step;
  EXPECT_EQ(step.follow(1e-8), 1e-8);
  EXPECT_EQ(step.follow(1.1e-8), 1.1e-8);
  EXPECT_DOUBLE_EQ(step.follow(0.9e-8), 0.999 * 1.1e-8);
  // But those that fall by more, as before rigid bodies meet.
  EXPECT_DOUBLE_EQ(step.follow(1e-9), 1.5e-9);
  EXPECT_DOUBLE_EQ(step.follow(1e-9), 0.999 * 1.5e-9);
  // The last step of a run is cut, which says nothing of the bodies.
  step.keep();
  EXPECT_DOUBLE_EQ(step.follow(1e-12), 0.999 * 1.5e-9);
}

/** A law of its own: one object in one file. */
class Constant : public FrictionLaw
{
public:
  explicit Constant(const double stress) : stress(stress) {}
  void find_friction(const SlidingContacts &contacts,
                     std::vector<double> &friction) const override
  {
    for (std::size_t i = 0; i < friction.size(); ++i)
      friction[i] = stress * contacts.area[i];
  }

private:
  const double stress; // [Pa]
};

const Registry<FrictionLaw>::Add constant(
    {"Constant of the test", "a stress, whatever presses.",
     [](Parameters &prm)
     {
       prm.declare_entry("Friction stress", "0 Pa",
                         quantity(Dimension::pressure, 0.), "Of sliding.");
     },
     [](const Parameters &prm, const std::string &) {
       return std::make_unique<Constant>(get_quantity(prm, "Friction stress"));
     }});

/** Options as a scene's contact reads them, after @p entries were set. */
ContactOptions
parse(const std::vector<std::pair<std::string, std::string>> &entries)
{
  Parameters prm;
  ContactOptions::declare_parameters(prm);
  for (const auto &[name, value] : entries)
    EXPECT_TRUE(prm.set(name, value)) << name << " = " << value;
  ContactOptions options;
  options.parse_parameters(prm, "Couplings/impact");
  return options;
}

double friction_of(const ContactOptions &options)
{
  return norm(
      answer(point_at(1e-6, vec(2., 0., 0.)), options).friction_force());
}

TEST(Friction, a_law_is_chosen_by_name_and_brings_its_entries)
{
  EXPECT_EQ(friction_of(parse({})), 0.);
  EXPECT_DOUBLE_EQ(friction_of(parse({{"Friction coefficient", "0.3"}})), 0.3);
  EXPECT_DOUBLE_EQ(friction_of(parse({{"Friction law", "Constant of the test"},
                                      {"Friction stress", "0.1 MPa"}})),
                   0.1);
  EXPECT_DOUBLE_EQ(friction_of(parse({{"Friction coefficient", "0.3"},
                                      {"Dynamic friction coefficient", "0.1"},
                                      {"Friction decay", "0.5"}})),
                   0.1 + 0.2 * std::exp(-1.));
}

TEST(Friction, words_and_the_numbers_that_they_stand_for)
{
  for (const char *const at_rest : {"as at rest", "-1"})
    EXPECT_DOUBLE_EQ(
        friction_of(parse({{"Friction coefficient", "0.3"},
                           {"Dynamic friction coefficient", at_rest}})),
        0.3);
  for (const char *const none : {"none", "0", "0 MPa"})
    EXPECT_FALSE(parse({{"Shear strength", none}}).shear_strength.is_limited());
  const ShearStrength yield =
                          parse({{"Shear strength", "yield"}}).shear_strength,
                      given =
                          parse({{"Shear strength", "2 MPa"}}).shear_strength;
  EXPECT_TRUE(yield.is_limited() && yield.needs_flow_stress());
  EXPECT_TRUE(given.is_limited() && !given.needs_flow_stress());
  EXPECT_DOUBLE_EQ(given.value(), 2e6);
}

TEST(Friction, contradictory_entries_are_refused)
{
  EXPECT_THROW(parse({{"Friction coefficient", "0.1"},
                      {"Dynamic friction coefficient", "0.2"}}),
               InputError);
  EXPECT_THROW(parse({{"Friction decay", "1"}}), InputError);
}

TEST(Couplings, types_are_built_before_those_that_must_know_of_them)
{
  const auto order = [](const std::string &type)
  { return Registry<CouplingBuilder>::get("Type", type).make()->order(); };
  EXPECT_LT(order("tie"), order("contact"));
  EXPECT_LT(order("contact"), order("self-contact"));
  EXPECT_TRUE(
      Registry<CouplingBuilder>::get("Type", "tie").make()->acts_last());
  EXPECT_THROW(Registry<CouplingBuilder>::get("Type", "glue"), InputError);
}
} // namespace
