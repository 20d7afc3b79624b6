#pragma once

#include <coplane_core/Vec3.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <array>
#include <functional>
#include <vector>

namespace coplane
{
/// Nodes and elements of one body: quadrilaterals in two dimensions, hexahedra in three, until they
/// are split.
struct Body
{
  ElementType type = ElementType::Hex8;
  std::vector<Vec3> points; ///< [m]
  std::vector<int> connectivity;
  int elements() const { return int(connectivity.size()) / topology(type).nodes; }
};

/// Throws Error(ExitCode::Deck) when a mesh cannot have so many nodes.
void demandCountable(Real nodes);
/// A count that comes from lengths; the same error when it is beyond all numbers.
int countable(Real count);
/// Nodes of a grid of n elements.
Real nodesOfGrid(int dimension, const std::array<int, 3>& n);

/// Grid of n[0] x n[1] (x n[2]) elements whose node (i, j, k) is at position(i, j, k). The images
/// of i, j, k must be right-handed.
Body mappedGrid(int dimension, const std::array<int, 3>& n,
                const std::function<Vec3(int, int, int)>& position);

/// A plane body swept along z: layers of nodes at the given heights [m], ascending.
Body extruded(const Body& plane, const std::vector<Real>& heights);

/// Every quadrilateral split into two triangles, every hexahedron into five tetrahedra, with
/// diagonals that alternate from element to element, so that they agree on common faces. Nodes
/// stay.
Body inSimplices(const Body& body);

/// n + 1 coordinates from a to b [m]; the last element is `bias` times as long as the first, those
/// between in geometric progression.
std::vector<Real> gradedLine(Real a, Real b, int n, Real bias);

/// Straight-sided box between two corners.
Body box(int dimension, const Vec3& lowest, const Vec3& highest, const std::array<int, 3>& n);

/// Straight-sided box whose grid lines lie at the given coordinates [m], ascending, per axis.
Body boxOfLines(int dimension, const std::array<std::vector<Real>, 3>& lines);

/// Quadrilateral or hexahedron between 4 or 8 corners in the order of element nodes, mapped
/// (bi- or trilinear).
Body cornered(int dimension, const std::vector<Vec3>& corners, const std::array<int, 3>& n);

/// How the bricks of a wall lie: courses upward in y (from 0), along x, thickness in z.
enum class Bond
{
  Running, ///< odd courses are shifted by half a brick, with half bricks at their ends
  Stack,   ///< all courses alike
  English, ///< 3D: courses of stretchers, in two leaves, and of headers in turn
  Flemish  ///< 3D: stretchers, in two leaves, and headers in turn in every course
};

/// A hole in a wall.
struct WallOpening
{
  Real from = 0, to = 0;   ///< along x [m]
  int first = 0, last = 0; ///< courses, from 0
};

/// Bricks of a wall, those at openings trimmed. n is for a whole brick: n[0] is even for running
/// bond, a multiple of 4 for English and Flemish bond, where half a header is a queen closer beside
/// the header at each end, bricks are twice as long as wide, and the wall as thick as a brick is
/// long. Flemish bond is 1, 4, 7, ... bricks long. Touching bricks have the same coordinates to the
/// bit.
std::vector<Body> wallOfBricks(int dimension, Bond bond, const Vec3& brick, int courses, int bricks,
                               const std::array<int, 3>& n,
                               const std::vector<WallOpening>& openings = {});

/// Imbricate wall in the plane: layers through the thickness along x (from 0), bricks along y,
/// centred on y = 0. Layers 1, 3, ... begin and end with half bricks, layers 2, 4, ... hold whole
/// ones; n[1] is even.
std::vector<Body> imbricate(Real thickness, Real length, int layers, int bricks,
                            const std::array<int, 3>& n);

/// Rock cut by joint sets at right angles: blocks[0] x blocks[1] (x blocks[2]) equal blocks from
/// the origin.
std::vector<Body> jointedRock(int dimension, const std::array<int, 3>& blocks, const Vec3& size,
                              const std::array<int, 3>& n);

/// Disk about the origin: a rounded square in the middle and rings around it; `across` elements on
/// the diameter (even, >= 4).
Body disk(Real radius, int across);

/// Ball about the origin: a rounded cube in the middle and layers around it; `across` elements on
/// the diameter (even, >= 4), half of them in the cube.
Body ball(Real radius, int across);

/// Annular sectors about the origin, `count` of equal angle between two angles [degrees, from x to
/// y], with nodes of their own; n is radial, around, and along z (3D: from 0 to length); the
/// outermost elements are `bias` times as thick as the innermost. Touching sectors have the same
/// coordinates to the bit.
std::vector<Body> sectors(int dimension, Real inner, Real outer, Real from, Real to, int count,
                          Real length, const std::array<int, 3>& n, Real bias = 1);

/// The same as a barrel vault: each sector is `rows` stones along z, every other sector with half a
/// stone at its ends. n[2] is for a whole stone, and even.
std::vector<Body> barrelVault(Real inner, Real outer, Real from, Real to, int count, Real length,
                              int rows, const std::array<int, 3>& n, Real bias = 1);

/// Part of a spherical shell about the origin between two elevations [degrees] above the plane
/// y = 0: courses upward of `count` stones each, every other one turned by half a stone. n is
/// radial, along the meridian, around (even). Touching stones have the same coordinates to the bit.
std::vector<Body> dome(Real inner, Real outer, Real from, Real to, int courses, int count,
                       const std::array<int, 3>& n);

/// Cross vault over a square bay of side `length` about the origin, axis y: two equal barrels, each
/// an arch of `count` courses (odd) between elevations `from` and 180 - `from` [degrees], meet in
/// groins above the diagonals. Half the bay is `rows` stones long at the crown, every other course
/// is shifted by half a stone. n is radial, around (even), along. Stones that meet in a groin or on
/// a course joint have the same coordinates to the bit where they meet at nodes.
std::vector<Body> crossVault(Real inner, Real outer, Real from, int count, Real length, int rows,
                             const std::array<int, 3>& n);

/// Lower half of a disc of centre (0, radius): its lowest point is the origin. Elements have the
/// length `fine` within `fineRadius` <= radius / 4 of the origin and grow with the distance beyond.
Body halfDisc(Real radius, Real fine, Real fineRadius);

/// Rectangle with a semicircular nose: tip at the origin, axis x, body towards -x. `across`
/// elements on the width (even, >= 4), `along` on the straight part. `length` counts the nose.
Body roundNosed(Real width, Real length, int across, int along);

/// Round bar with a hemispherical nose: tip at the origin, axis x, body towards -x. One grid of
/// across x across elements in the section, mapped to a disk and to half a ball, so four lines of
/// elements have an angle near 180 degrees at the surface.
Body roundBar(Real width, Real length, int across, int along);
} // namespace coplane
