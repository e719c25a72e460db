#ifndef sabot_geometry_outline_h
#define sabot_geometry_outline_h

#include "sabot/geometry/hex_mesh.h"
#include "sabot/kernels/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace sabot
{
/**
 * The true shape of a body before the run: what is inside of it, and the closed
 * skin around that, planes of symmetry included. The same on every rank, in the
 * configuration at time 0; nothing here is collective.
 */
struct Outline
{
  /** Nodes, then points between them, none of which is outside: centers of
      cells where there are some, in coarse meshes more [m]. */
  AlignedVector<Vec> points;
  /** Quadrilaterals of points, outwards by the right-hand rule. */
  std::vector<std::array<std::size_t, 4>> faces;
  /** Parallel to faces: whether it lies on a plane of symmetry, where nothing
      can touch it. */
  std::vector<char> is_cut;
  Vec low = {}, high = {}; // bounds of the points [m]

  /** Sets the bounds; once, when the points are there. */
  void find_bounds();
  /** Distance of neighboring points on the skin: root of the mean area of a
      face [m]. */
  double spacing() const;
  /**
   * How far the flat faces may lie off the smooth surface that they stand for:
   * twice the largest sagitta h theta/8 of an arc over a face of size h that
   * turns by theta to the next one [m]. Edges of 60 degrees and more are real
   * and count as none, so that a box has 0.
   */
  double chord_error() const;
};

/** Of a mesh whose faces with the boundary ids @p cut are on planes of
    symmetry. */
Outline outline_of(const HexMesh &mesh, const std::vector<unsigned int> &cut);

/** How deep a point of one body lies inside of the other. */
struct Overlap
{
  double depth = 0.; // [m], 0: nowhere
  Vec place{};       // where it is deepest [m]
};

/**
 * The deepest point of either shape inside of the other one: of nodes and
 * centers of cells, below the nearest face.
 * Inside is where a ray meets the skin an odd number of times, by three rays.
 */
Overlap deepest_overlap(const Outline &a, const Outline &b);

/**
 * The way [m] that @p a goes along the unit vector @p direction until a node or
 * a middle of a face of one meets a face of the other, at most @p longest;
 * nothing where they miss each other. Both keep their shape. Faces on planes of
 * symmetry do not count, and bodies that touch and part do not meet.
 */
std::optional<double> way_to_meeting(const Outline &a, const Outline &b,
                                     const Vec direction, const double longest);

/**
 * Whether @p a comes within about @p margin [m] of @p b on the way: false only
 * where that is certain, by boxes around each of the faces.
 */
bool may_come_near(const Outline &a, const Outline &b, const Vec direction,
                   const double longest, const double margin);

/** Whether the middle of a face of one lies on a face of the other that looks
    at it, within @p tolerance [m]: along an area, not only at an edge. */
bool touch(const Outline &a, const Outline &b, const double tolerance);
} // namespace sabot

#endif
