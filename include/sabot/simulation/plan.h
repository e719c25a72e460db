#ifndef sabot_simulation_plan_h
#define sabot_simulation_plan_h

#include "sabot/bodies/body_facts.h"
#include "sabot/simulation/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <mpi.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sabot
{
/**
 * A number that tells which physics a scene needs.
 * For example impact pressure over bulk modulus, v Z1 Z2/(Z1 + Z2)/K with the
 * impedances Z = rho c: below 0.05 a constant bulk modulus will do, from 0.3 on
 * an equation of state is needed. @p formula is for reading, not for parsing.
 */
struct PlanNumber
{
  std::string name, formula;
  double value;
  std::string verdict;
};

/** A body before the run, as the estimates see it. */
struct PlannedBody
{
  std::string name;
  BodyFacts facts;
  /**
   * Von Mises stress at about 1e3 1/s [Pa]; nothing: never yields.
   * Found with the law itself: pure shear at a strain increment of 1e-4
   * (tensor) in 1e-7 s, from the initial state, until the return sets in;
   * sqrt(3) |tau| then. Up to a tensor shear strain of one half. Rigid bodies
   * have none.
   */
  std::optional<double> yield_stress;
  std::array<double, 3> low, high; // bounds of the nodes [m]
  std::array<bool, 3> is_cut{};    // by a plane of symmetry across this axis
};

/**
 * Where the fastest body meets those at rest.
 * Of all pairs of bodies the one with the largest relative speed, the faster
 * body being the projectile; of equals the target is that with the larger
 * bounding box.
 */
struct ImpactFacts
{
  bool exists = false;
  std::size_t projectile = 0, target = 0; // bodies; the target's largest
  double speed = 0.;                      // relative [m/s]
  /**
   * 0, 1, 2: x, y, z, that of the largest component of the relative velocity.
   */
  int axis = 2; // along which they meet
  /**
   * Half of the smaller of the two extents of its bounding box across the axis.
   */
  double radius = 0.; // of the projectile across it [m]
  /** Compression of the finest cells at the interface, which meets the bodies
      at U = v/2: rho U^2 / Y = e^2 / (1 - e) for the engineering strain e there
      (G. I. Taylor, Proc. R. Soc. A 194 (1948) 289), with the lower yield
      stress Y; as logarithmic strain -ln(1 - e), at most ln 4, a cell flattened
      to a quarter. It grows at the rate U/radius (own estimate). */
  double largest_strain = 0., strain_rate = 0.; // [1, 1/s]
};

/**
 * Estimates from boxes, velocities and material constants alone: each is a
 * number with a verdict, and none changes the scene.
 */
struct PhysicsPlan
{
  std::vector<PlannedBody> bodies;
  ImpactFacts impact;
  std::vector<PlanNumber> numbers;
  std::vector<std::string> warnings; // where the scene's switches disagree
};

/** Adds what the plan warns of to what the scene has of its own, each once:
    check, plan and run say the same. */
void add_warnings(const PhysicsPlan &plan, Scene &scene);

/**
 * What a run would cost.
 * From a short calibration on this machine, as busy as it is: memory is the
 * peak of all ranks together so far, wall time is set-up + steps times the
 * median cost of a step + outputs.
 */
struct CostPlan
{
  /** @p neighbors: bonds over particles, over all ranks. */
  struct Item
  {
    std::string body, kind; // "cells" or "particles"
    double n, neighbors;    // mean, initial; 0 for cells
  };
  std::vector<Item> items;
  /**
   * Before the step factor and after it: the first proposal of bodies and
   * couplings, and the mean of the second half of the steps made.
   */
  double first_stable_step, mean_step; // [s]
  std::string accuracy;                // the scene's choice
  std::string limiter;
  double steps, seconds_per_step, set_up_seconds, seconds; // wall
  double memory_bytes, output_bytes, checkpoint_bytes;
  /** At least six unless the run ends or goes wrong before. */
  unsigned int calibration_steps;
  std::string problem; // what ended the first steps, if anything did
  /** What is expected to turn into particles during the run. */
  struct Conversion
  {
    std::string zone, host, basis; // what the estimate rests on, for reading
    double n_particles;            // at the end
    double first, last;            // when cells turn [s]
  };
  std::vector<Conversion> conversions;
  double conversion_seconds = 0.; // of `seconds`, what they add
};

/**
 * Dimensionless numbers of a scene, from its parameters alone; before its
 * bodies are distributed.
 * Not collective; changes nothing.
 */
PhysicsPlan plan_physics(const Scene &scene);

/**
 * Bytes by array of every body that has items, as Markdown tables: per item and
 * in all, with the arrays of all ranks together, and the peak of the process
 * beside them. Sets the scene up and makes one step, so that arrays are there
 * that a step asks for. What only set-up and kernel updates need for a while is
 * in the peak alone. Collective; the scene is used up.
 */
std::string plan_memory(Scene &scene, MPI_Comm communicator);

/**
 * Sets the scene up and makes its first steps for about @p seconds of wall
 * time. Steps: the rest of the run at the mean step of the second half of
 * them, shrunk as the cells at an impact are flattened. Collective.
 * With the strain e(t) = min(e_max, t U/radius) of ImpactFacts the steps left
 * are
 *   n = 1/dt int exp(e(t) - e(now)) dt,
 * dt the mean step. A PhysicsError within the calibration ends it and is told
 * in `problem`; the numbers are then of the steps made. The scene is used up:
 * its bodies have moved.
 */
CostPlan plan_cost(Scene &scene, const PhysicsPlan &physics,
                   const double seconds, MPI_Comm communicator);

/**
 * Bytes that the fields of one time take: as they are now, and when every
 * motion and stress has become an arbitrary number. This rank's share.
 * After the compression that the VTU files have (zlib, level 1, in blocks),
 * with which fields at rest take next to nothing.
 */
struct FieldSize
{
  double quiet, disturbed;
};
/**
 * @p all_yield: whether the plastic fields become arbitrary, too. Not
 * collective; sums over ranks are the caller's.
 */
FieldSize field_size(const OutputMesh &mesh, const bool all_yield);

/** SI units throughout, keys with underscores; what scripts read. */
nlohmann::ordered_json to_json(const PhysicsPlan &physics,
                               const CostPlan &cost);
/**
 * Numbers with formula and verdict, warnings, then the cost; for the screen.
 */
std::string to_text(const PhysicsPlan &physics, const CostPlan &cost);
} // namespace sabot

#endif
