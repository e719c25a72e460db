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
/** A number that tells which physics a scene needs. */
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
  /** Von Mises stress at about 1e3 1/s [Pa]; nothing: never yields. */
  std::optional<double> yield_stress;
  std::array<double, 3> low, high; // bounds of the nodes [m]
};

/** Where the fastest body meets those at rest. */
struct ImpactFacts
{
  bool exists = false;
  std::size_t projectile = 0, target = 0; // bodies; the target's largest
  double speed = 0.;                      // relative [m/s]
  int axis = 2;                           // along which they meet
  double radius = 0.;                     // of the projectile across it [m]
  /** Compression of the finest cells at the interface, which meets the bodies
      at U = v/2: rho U^2 / Y = e^2 / (1 - e) for the engineering strain e there
      (G. I. Taylor, Proc. R. Soc. A 194 (1948) 289), with the lower yield
      stress Y; as logarithmic strain -ln(1 - e), at most ln 4, a cell flattened
      to a quarter. It grows at the rate U/radius (own estimate). */
  double largest_strain = 0., strain_rate = 0.; // [1, 1/s]
};

struct PhysicsPlan
{
  std::vector<PlannedBody> bodies;
  ImpactFacts impact;
  std::vector<PlanNumber> numbers;
  std::vector<std::string> warnings; // where the scene's switches disagree
};

/** What a run would cost. */
struct CostPlan
{
  struct Item
  {
    std::string body, kind; // "cells" or "particles"
    double n, neighbors;    // mean, initial; 0 for cells
  };
  std::vector<Item> items;
  double first_stable_step, mean_step; // [s]
  std::string limiter;
  double steps, seconds_per_step, set_up_seconds, seconds; // wall
  double memory_bytes, output_bytes, checkpoint_bytes;
  unsigned int calibration_steps;
  std::string problem; // what ended the first steps, if anything did
};

/** Dimensionless numbers of a scene, from its parameters alone; before its
    bodies are distributed. */
PhysicsPlan plan_physics(const Scene &scene);

/**
 * Sets the scene up and makes its first steps for about @p seconds of wall
 * time. Steps: the rest of the run at the mean step of the second half of
 * them, shrunk as the cells at an impact are flattened. Collective.
 */
CostPlan plan_cost(Scene &scene, const PhysicsPlan &physics,
                   const double seconds, MPI_Comm communicator);

/** Bytes that the fields of one time take: as they are now, and when every
    motion and stress has become an arbitrary number. This rank's share. */
struct FieldSize
{
  double quiet, disturbed;
};
FieldSize field_size(const OutputMesh &mesh, const bool all_yield);

nlohmann::ordered_json to_json(const PhysicsPlan &physics,
                               const CostPlan &cost);
std::string to_text(const PhysicsPlan &physics, const CostPlan &cost);
} // namespace sabot

#endif
