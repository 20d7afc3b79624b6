#pragma once

#include <coplane_core/Vec3.hpp>

#include <array>
#include <map>
#include <vector>

namespace coplane
{
/// Whether a surface is a border of the domain or between groups of elements; what is none is a
/// joint, which may give way.
enum class Border
{
  None,
  Fixed, ///< stays where it is
  Wall,  ///< the same, but where it meets a drawn one
  Drawn  ///< of a solid of a file: facets of what is round; may give way
};

/// Triangles (2) that fill a plane z = const, or tetrahedra (3) that fill space, without gaps, and
/// the straight lines or plane surfaces between and around them. Volumes are areas, faces edges in
/// two dimensions.
template <int Dimension>
struct SimplicesWithSurfaces
{
  static constexpr std::size_t dimension = Dimension, corners = Dimension + 1;
  /// A face of the geometry that faces of simplices make up.
  struct Surface
  {
    Vec3 point{}, normal{}; ///< of unit length
    Border border = Border::None;
    int joint = -1; ///< -1: none
  };
  struct Simplex
  {
    std::array<int, corners> nodes{}; ///< so that the volume is positive
    int group = 0; ///< volumes of groups stay as they are, but where drawn borders give way
  };
  using Face = std::array<int, dimension>; ///< nodes, ascending
  std::vector<Vec3> points;
  std::vector<Simplex> simplices;
  std::map<Face, int> surfaceOf;
  std::vector<Surface> surfaces;
};
using TrianglesWithSurfaces = SimplicesWithSurfaces<2>;
using TetrahedraWithSurfaces = SimplicesWithSurfaces<3>;

/// Area or volume; negative when inside out [m^2, m^3].
Real volumeOf(const std::array<Vec3, 3>& corners);
Real volumeOf(const std::array<Vec3, 4>& corners);

/// How well a tetrahedron or triangle serves an explicit computation: 1 for a regular one with
/// edges of the size, 0 for a flat one. The lesser of its shape, which is that of `coplane_mesh
/// check`, and its least height over that of a regular one. A tetrahedron inside out is worth less
/// than 0.
Real worthOf(const std::array<Vec3, 4>& corners, Real size);
Real worthOf(const std::array<Vec3, 3>& corners, Real size);

struct MendLimits
{
  Real size = 0;      ///< of elements, the least that was asked for [m]
  Real worth = 0;     ///< what is below is mended
  Real tolerance = 0; ///< by which joints and drawn borders may leave their lines or planes [m]
  Real reach = 0;     ///< by which their ends and edges may move along them [m]
};

/// Mends triangles or tetrahedra whose worth is less than the limit: edges collapse, are split or
/// turned, nodes move, until nothing gets better. What stands near a joint or a border moves onto
/// it. Nodes that nothing uses any more stay. Returns the number of changes.
int mend(TrianglesWithSurfaces& mesh, const MendLimits& limits);
int mend(TetrahedraWithSurfaces& mesh, const MendLimits& limits);
} // namespace coplane
