#pragma once

#include <coplane_core/Vec3.hpp>

#include <array>
#include <map>
#include <vector>

namespace coplane
{
/// Tetrahedra that fill space without gaps, and the plane surfaces between and around them.
struct TetrahedraWithSurfaces
{
  /// A face of the geometry that faces of tetrahedra make up.
  struct Surface
  {
    Vec3 point{}, normal{}; ///< of unit length
    bool exact = false;     ///< a border, which stays where it is; joints may give way
    int joint = -1;         ///< -1: none
  };
  struct Tetrahedron
  {
    std::array<int, 4> nodes{};
    int group = 0; ///< volumes of groups stay as they are
  };
  using Face = std::array<int, 3>; ///< nodes, ascending
  std::vector<Vec3> points;
  std::vector<Tetrahedron> tetrahedra;
  std::map<Face, int> surfaceOf;
  std::vector<Surface> surfaces;
};

/// How well a tetrahedron or triangle serves an explicit computation: 1 for a regular one with
/// edges of the size, 0 for a flat one. The lesser of its shape, which is that of `coplane_mesh
/// check`, and its least height over that of a regular one.
Real worthOf(const std::array<Vec3, 4>& corners, Real size);
Real worthOf(const std::array<Vec3, 3>& corners, Real size);

struct MendLimits
{
  Real size = 0;      ///< of elements, the least that was asked for [m]
  Real worth = 0;     ///< what is below is mended
  Real tolerance = 0; ///< by which joints may leave their planes [m]
  Real reach = 0;     ///< by which their edges may move along them [m]
};

/// Mends tetrahedra whose worth is less than the limit: edges collapse, are split or turned, nodes
/// move, until nothing gets better. What stands near a joint or a border moves onto it. Nodes that
/// nothing uses any more stay. Returns the number of changes.
int mendTetrahedra(TetrahedraWithSurfaces& mesh, const MendLimits& limits);
} // namespace coplane
