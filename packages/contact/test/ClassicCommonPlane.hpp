#pragma once

#include <coplane_core/Vec3.hpp>
#include <coplane_geometry/ConvexPolygon.hpp>
#include <coplane_geometry/FaceMap.hpp>

#include <cmath>
#include <cstdint>

// The common plane of Cundall (1988) between two convex blocks, as pure functions, for comparison
// with the Simple Common Plane. A block is the element behind a face. Dim is 2 or 3; in two
// dimensions blocks are polygons, faces are segments, and "area" is length times unit thickness.

namespace coplane
{
/// Convex polyhedron (2D: polygon) with up to eight nodes, in fixed arrays.
struct ConvexBlock
{
  static constexpr int maxNodes = 8, maxFaces = 6, maxEdges = 12;
  int nodes = 0, faces = 0, edges = 0;
  Vec3 x[maxNodes];                       ///< [m]
  std::int8_t faceSize[maxFaces] = {};    ///< nodes of each face
  std::int8_t faceNode[maxFaces][4] = {}; ///< outward normal by the right-hand rule
  std::int8_t edgeNode[maxEdges][2] = {};

  /// Adds a face of two (2D), three or four nodes, and those of its edges that run from the lower
  /// to the higher node: the face on the other side of an edge runs the other way.
  KOKKOS_INLINE_FUNCTION void addFace(int size, int n0, int n1, int n2 = 0, int n3 = 0)
  {
    const int node[4] = {n0, n1, n2, n3};
    faceSize[faces] = std::int8_t(size);
    for (int i = 0; i < size; ++i)
    {
      const int from = node[i], to = node[(i + 1) % size];
      faceNode[faces][i] = std::int8_t(from);
      if (from < to && edges < maxEdges)
      {
        edgeNode[edges][0] = std::int8_t(from);
        edgeNode[edges][1] = std::int8_t(to);
        ++edges;
      }
    }
    ++faces;
  }

  KOKKOS_INLINE_FUNCTION Vec3 center() const
  {
    Vec3 sum{};
    for (int i = 0; i < nodes; ++i)
      sum += x[i];
    return (1.0 / nodes) * sum;
  }
};

/// Block of an element, nodes and sides in the order of Exodus. 2D: 3 or 4 nodes,
/// counter-clockwise; 3D: 4 (tetrahedron) or 8 (hexahedron).
template <int Dim>
KOKKOS_INLINE_FUNCTION ConvexBlock blockOfElement(const Vec3* x, int nodes)
{
  ConvexBlock block;
  block.nodes = nodes;
  for (int i = 0; i < nodes; ++i)
    block.x[i] = x[i];
  if constexpr (Dim == 2)
  {
    for (int i = 0; i < nodes; ++i)
      block.addFace(2, i, (i + 1) % nodes);
  }
  else if (nodes == 4)
  {
    block.addFace(3, 0, 1, 3);
    block.addFace(3, 1, 2, 3);
    block.addFace(3, 0, 3, 2);
    block.addFace(3, 0, 2, 1);
  }
  else
  {
    block.addFace(4, 0, 1, 5, 4);
    block.addFace(4, 1, 2, 6, 5);
    block.addFace(4, 2, 3, 7, 6);
    block.addFace(4, 0, 4, 7, 3);
    block.addFace(4, 0, 3, 2, 1);
    block.addFace(4, 4, 5, 6, 7);
  }
  return block;
}

struct ClassicOptions
{
  enum class Search : std::uint8_t
  {
    Rotations, ///< turn the normal by ever smaller angles (Cundall 1988), then as `Candidates`
    Candidates ///< try normals that faces, edges and closest vertices offer (Nezami et al. 2004)
  };
  enum class Area : std::uint8_t
  {
    Section, ///< what the plane cuts out of both blocks, half way down the penetration
    Shadow   ///< overlap of the blocks' projections on the plane
  };
  Search search = Search::Candidates;
  Area area = Area::Section;
  Real coarsestTurn = 5 * pi / 180;  ///< first angle of `Rotations` [rad]
  Real finestTurn = 0.01 * pi / 180; ///< last angle; a face nearer to the plane lies in it [rad]
};

struct ClassicPlane
{
  Vec3 normal{}; ///< unit, from block A to block B
  Real gap = 0;  ///< along the normal, positive when the blocks are apart [m]
  Vec3 point{};  ///< on the plane: centroid of the area; without area between the closest nodes [m]
  Vec3 e1{}, e2{};      ///< axes in the plane, as in step B of the Simple Common Plane
  Real area = 0;        ///< [m^2]; zero unless the blocks overlap
  int node[2] = {0, 0}; ///< of A and B, closest to the plane (deepest, when they overlap), of equal
                        ///< ones the lowest
  int face[2] = {0, 0}; ///< of A and B, the one that looks most along the normal
};

namespace classic
{
/// Nodes at one height, and points that are one, up to this fraction of the blocks' size.
constexpr Real sameLevel = 1e-9;

/// Largest height of A and least height of B along a direction [m].
struct Separation
{
  Real topOfA = 0, bottomOfB = 0;
  KOKKOS_INLINE_FUNCTION Real gap() const { return bottomOfB - topOfA; }
};

KOKKOS_INLINE_FUNCTION Separation separationAlong(const Vec3& n, const ConvexBlock& a,
                                                  const ConvexBlock& b)
{
  Separation s{dot(n, a.x[0]), dot(n, b.x[0])};
  for (int i = 1; i < a.nodes; ++i)
  {
    const Real height = dot(n, a.x[i]);
    s.topOfA = height > s.topOfA ? height : s.topOfA;
  }
  for (int i = 1; i < b.nodes; ++i)
  {
    const Real height = dot(n, b.x[i]);
    s.bottomOfB = height < s.bottomOfB ? height : s.bottomOfB;
  }
  return s;
}

/// Outward unit normal; zero for a face without area.
template <int Dim>
KOKKOS_INLINE_FUNCTION Vec3 faceNormal(const ConvexBlock& block, int face)
{
  const std::int8_t* node = block.faceNode[face];
  const Vec3* x = block.x;
  Vec3 area;
  if constexpr (Dim == 2)
    area = {x[node[1]].y - x[node[0]].y, x[node[0]].x - x[node[1]].x, 0};
  else if (block.faceSize[face] == 3)
    area = cross(x[node[1]] - x[node[0]], x[node[2]] - x[node[0]]);
  else
    area = cross(x[node[2]] - x[node[0]], x[node[3]] - x[node[1]]);
  const Real size = norm(area);
  return size > 0 ? (1 / size) * area : Vec3{};
}

/// Two axes that make a right-handed frame with the normal; 2D: the first lies in the x-y plane.
template <int Dim>
KOKKOS_INLINE_FUNCTION void axesOfPlane(const Vec3& n, Vec3& e1, Vec3& e2)
{
  if constexpr (Dim == 2)
    e1 = {-n.y, n.x, 0};
  else
  {
    const Vec3 size{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const int k = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    Vec3 axis{};
    axis[k] = 1;
    e1 = normalised(axis - n[k] * n);
  }
  e2 = cross(n, e1);
}

/// A normal and its gap. A rival takes over when its gap is larger by more than round-off, so that
/// of equal normals the first one tried stays.
struct BestNormal
{
  Vec3 normal{};
  Separation at;
  Real margin = 0;

  KOKKOS_INLINE_FUNCTION bool offer(const Vec3& n, const ConvexBlock& a, const ConvexBlock& b)
  {
    if (!(dot(n, n) > 0.5)) // of a face without area
      return false;
    const Separation s = separationAlong(n, a, b);
    if (!(s.gap() > at.gap() + margin))
      return false;
    normal = n;
    at = s;
    return true;
  }
};

/// Cundall's search: the normal is turned by an angle about two axes in the plane, forth and back;
/// it moves to the best of the four as long as the gap grows. Then the angle is halved. The axes
/// are turned by one radian at every halving: with fixed axes the search stops on ridges that run
/// between them.
template <int Dim>
KOKKOS_INLINE_FUNCTION void searchByRotations(BestNormal& best, const ConvexBlock& a,
                                              const ConvexBlock& b, const ClassicOptions& options)
{
  Real axesTurn = 0;
  for (Real angle = options.coarsestTurn; angle > 0.5 * options.finestTurn; angle *= 0.5)
  {
    const Real c = std::cos(angle), s = std::sin(angle);
    const Real cosAxes = std::cos(axesTurn), sinAxes = std::sin(axesTurn);
    axesTurn += 1;
    for (int move = 0; move < 100; ++move)
    {
      const Vec3 n = best.normal;
      Vec3 e1, e2;
      axesOfPlane<Dim>(n, e1, e2);
      bool moved = false;
      for (int axis = 0; axis < Dim - 1; ++axis)
      {
        Vec3 towards = e1;
        if constexpr (Dim == 3)
          towards = axis == 0 ? cosAxes * e1 + sinAxes * e2 : cosAxes * e2 - sinAxes * e1;
        for (int side = 0; side < 2; ++side)
          moved |= best.offer(normalised(c * n + (side == 0 ? s : -s) * towards), a, b);
      }
      if (!moved)
        break;
    }
  }
}

/// Offers a direction of any length, turned to the side of the normal `n`.
KOKKOS_INLINE_FUNCTION bool offerDirection(BestNormal& best, const Vec3& n, const Vec3& direction,
                                           Real tooShort, const ConvexBlock& a,
                                           const ConvexBlock& b)
{
  const Real size = norm(direction);
  if (!(size > tooShort))
    return false;
  return best.offer((dot(direction, n) < 0 ? -1 / size : 1 / size) * direction, a, b);
}

/// Nodes of a block as bits of a number.
using NodeSet = unsigned;

/// Nodes of A at its top, of B at its bottom, up to a tolerance [m]: all nodes of a face that lies
/// in the plane.
KOKKOS_INLINE_FUNCTION NodeSet nodesAtLevel(const ConvexBlock& block, const Vec3& n, Real level,
                                            Real tolerance)
{
  NodeSet set = 0;
  for (int i = 0; i < block.nodes; ++i)
    if (std::abs(dot(n, block.x[i]) - level) <= tolerance)
      set |= 1u << i;
  return set;
}

/// Mean of the positions of a set of nodes, and the lowest node in it.
KOKKOS_INLINE_FUNCTION Vec3 meanOf(const ConvexBlock& block, NodeSet nodes, int& lowest)
{
  Vec3 sum{};
  int count = 0;
  for (int i = block.nodes - 1; i >= 0; --i)
    if (nodes & (1u << i))
    {
      sum += block.x[i];
      lowest = i;
      ++count;
    }
  return (1.0 / count) * sum;
}

KOKKOS_INLINE_FUNCTION bool faceMeets(const ConvexBlock& block, int face, NodeSet nodes)
{
  for (int i = 0; i < block.faceSize[face]; ++i)
    if (nodes & (1u << block.faceNode[face][i]))
      return true;
  return false;
}

KOKKOS_INLINE_FUNCTION bool edgeMeets(const ConvexBlock& block, int edge, NodeSet nodes)
{
  return nodes & ((1u << block.edgeNode[edge][0]) | (1u << block.edgeNode[edge][1]));
}

KOKKOS_INLINE_FUNCTION Vec3 alongEdge(const ConvexBlock& block, int edge)
{
  return block.x[block.edgeNode[edge][1]] - block.x[block.edgeNode[edge][0]];
}

/// Nezami's fast search: at the largest gap the plane lies in a face, or along an edge of each
/// block, or (blocks apart) across the shortest line between the closest node and a node or an
/// edge. Only what meets at the closest nodes is tried; a better normal may have other closest
/// nodes, then again.
template <int Dim>
KOKKOS_INLINE_FUNCTION void searchByCandidates(BestNormal& best, const ConvexBlock& a,
                                               const ConvexBlock& b, Real size)
{
  const Real tooShort = sameLevel * size; // a line without direction
  for (int pass = 0; pass < 50; ++pass)
  {
    const Vec3 n = best.normal;
    const NodeSet topOfA = nodesAtLevel(a, n, best.at.topOfA, sameLevel * size);
    const NodeSet bottomOfB = nodesAtLevel(b, n, best.at.bottomOfB, sameLevel * size);
    bool better = false;
    for (int f = 0; f < a.faces; ++f)
      if (faceMeets(a, f, topOfA))
        better |= best.offer(faceNormal<Dim>(a, f), a, b);
    for (int f = 0; f < b.faces; ++f)
      if (faceMeets(b, f, bottomOfB))
        better |= best.offer(-faceNormal<Dim>(b, f), a, b);
    if constexpr (Dim == 3)
      for (int i = 0; i < a.edges; ++i)
        if (edgeMeets(a, i, topOfA))
          for (int j = 0; j < b.edges; ++j)
            if (edgeMeets(b, j, bottomOfB))
            {
              // Nearly parallel edges have no plane in common.
              const Vec3 p = alongEdge(a, i), q = alongEdge(b, j);
              better |= offerDirection(best, n, cross(p, q), 1e-6 * norm(p) * norm(q), a, b);
            }
    for (int i = 0; i < a.nodes; ++i)
      for (int j = 0; j < b.nodes; ++j)
      {
        if (!(topOfA & (1u << i)) || !(bottomOfB & (1u << j)))
          continue;
        const Vec3 line = b.x[j] - a.x[i];
        better |= offerDirection(best, n, line, tooShort, a, b);
        if constexpr (Dim == 3)
          for (int side = 0; side < 2; ++side)
          {
            const ConvexBlock& block = side == 0 ? a : b;
            for (int e = 0; e < block.edges; ++e)
              if (edgeMeets(block, e, 1u << (side == 0 ? i : j)))
              {
                const Vec3 p = alongEdge(block, e);
                better |=
                    offerDirection(best, n, line - (dot(line, p) / dot(p, p)) * p, tooShort, a, b);
              }
          }
      }
    if (!better)
      break;
  }
}

/// The face that looks most along a direction; of equal ones the first.
template <int Dim>
KOKKOS_INLINE_FUNCTION int faceAlong(const ConvexBlock& block, const Vec3& n, Real& cosine)
{
  int found = 0;
  cosine = -2;
  for (int f = 0; f < block.faces; ++f)
  {
    const Real c = dot(n, faceNormal<Dim>(block, f));
    if (c > cosine + 1e-9)
    {
      cosine = c;
      found = f;
    }
  }
  return found;
}

/// Points of which the outline is the convex hull. A block has at most 8 nodes and 12 edges.
struct OutlinePoints
{
  static constexpr int capacity = ConvexBlock::maxNodes + ConvexBlock::maxEdges;
  int count = 0;
  Vec2 p[capacity];
};

/// Convex hull, counter-clockwise (monotone chain, Andrew 1979); reorders the points.
KOKKOS_INLINE_FUNCTION ConvexPolygon convexHull(OutlinePoints& points)
{
  for (int i = 1; i < points.count; ++i)
  {
    const Vec2 p = points.p[i];
    int j = i;
    for (; j > 0 &&
           (p.x < points.p[j - 1].x || (p.x == points.p[j - 1].x && p.y < points.p[j - 1].y));
         --j)
      points.p[j] = points.p[j - 1];
    points.p[j] = p;
  }
  Vec2 chain[2 * OutlinePoints::capacity];
  int size = 0;
  for (int side = 0; side < 2; ++side)
  {
    const int start = size;
    for (int i = 0; i < points.count; ++i)
    {
      const Vec2 p = points.p[side == 0 ? i : points.count - 1 - i];
      while (size >= start + 2 &&
             !(cross(chain[size - 1] - chain[size - 2], p - chain[size - 1]) > 0))
        --size;
      chain[size++] = p;
    }
    --size; // where a chain ends the other begins
  }
  ConvexPolygon polygon;
  for (int i = 0; i < size; ++i)
    polygon.add(chain[i]);
  return polygon;
}

/// What a block lays on the plane at height `level` along plane.normal: its face when that lies in
/// the plane, else its section or its shadow.
KOKKOS_INLINE_FUNCTION OutlinePoints outline(const ConvexBlock& block, int face, bool faceInPlane,
                                             const ClassicPlane& plane, Real level,
                                             ClassicOptions::Area area)
{
  OutlinePoints points;
  const auto add = [&](const Vec3& x)
  {
    if (points.count < OutlinePoints::capacity)
      points.p[points.count++] = {dot(plane.e1, x), dot(plane.e2, x)};
  };
  if (faceInPlane)
    for (int i = 0; i < block.faceSize[face]; ++i)
      add(block.x[block.faceNode[face][i]]);
  else if (area == ClassicOptions::Area::Shadow)
    for (int i = 0; i < block.nodes; ++i)
      add(block.x[i]);
  else
  {
    Real height[ConvexBlock::maxNodes];
    for (int i = 0; i < block.nodes; ++i)
    {
      height[i] = dot(plane.normal, block.x[i]) - level;
      if (height[i] == 0)
        add(block.x[i]);
    }
    for (int e = 0; e < block.edges; ++e)
    {
      const int i = block.edgeNode[e][0], j = block.edgeNode[e][1];
      if ((height[i] < 0 && height[j] > 0) || (height[i] > 0 && height[j] < 0))
        add(block.x[i] + (height[i] / (height[i] - height[j])) * (block.x[j] - block.x[i]));
    }
  }
  return points;
}

/// Area that two outlines share, and its centroid.
template <int Dim>
KOKKOS_INLINE_FUNCTION AreaAndCentroid sharedArea(OutlinePoints& a, OutlinePoints& b)
{
  AreaAndCentroid result;
  if (a.count < Dim || b.count < Dim)
    return result;
  if constexpr (Dim == 3)
    return areaAndCentroid(intersection(convexHull(a), convexHull(b)));
  Real low[2], high[2];
  const OutlinePoints* outlines[2] = {&a, &b};
  for (int k = 0; k < 2; ++k)
  {
    low[k] = high[k] = outlines[k]->p[0].x;
    for (int i = 1; i < outlines[k]->count; ++i)
    {
      low[k] = std::fmin(low[k], outlines[k]->p[i].x);
      high[k] = std::fmax(high[k], outlines[k]->p[i].x);
    }
  }
  const Real from = std::fmax(low[0], low[1]), to = std::fmin(high[0], high[1]);
  if (to > from)
  {
    result.area = to - from;
    result.centroid = {0.5 * (from + to), 0};
  }
  return result;
}
} // namespace classic

/// Normal to start from when there is none of the last cycle: of the line between the centres and
/// the normals of all faces, the one with the largest gap. The line alone is a poor start for flat
/// blocks: a corner that stands near the rim of a slab would be pushed out sideways.
template <int Dim>
KOKKOS_INLINE_FUNCTION Vec3 startingNormal(const ConvexBlock& a, const ConvexBlock& b)
{
  const Vec3 line = b.center() - a.center();
  const Real size = norm(line);
  classic::BestNormal best;
  best.normal = size > 0 ? (1 / size) * line : Vec3{1, 0, 0};
  best.at = classic::separationAlong(best.normal, a, b);
  best.margin = 1e-12 * size;
  for (int f = 0; f < a.faces; ++f)
    best.offer(classic::faceNormal<Dim>(a, f), a, b);
  for (int f = 0; f < b.faces; ++f)
    best.offer(-classic::faceNormal<Dim>(b, f), a, b);
  return best.normal;
}

/// The common plane of two convex blocks: the one across which the gap between their nodes is
/// largest (the overlap least), half way between them. The search climbs from `start` (the normal
/// of the last cycle) to a largest gap near it; a zero vector stands for `startingNormal`.
template <int Dim>
KOKKOS_INLINE_FUNCTION ClassicPlane classicCommonPlane(const ConvexBlock& blockA,
                                                       const ConvexBlock& blockB,
                                                       const ClassicOptions& options,
                                                       const Vec3& start = {})
{
  using namespace classic;
  // Near the origin no digits are lost.
  const Vec3 origin = 0.5 * (blockA.center() + blockB.center());
  ConvexBlock a = blockA, b = blockB;
  Real size = 0;
  for (int i = 0; i < a.nodes; ++i)
  {
    a.x[i] -= origin;
    size = std::fmax(size, norm(a.x[i]));
  }
  for (int i = 0; i < b.nodes; ++i)
  {
    b.x[i] -= origin;
    size = std::fmax(size, norm(b.x[i]));
  }

  BestNormal best;
  best.normal = dot(start, start) > 0 ? normalised(start) : startingNormal<Dim>(a, b);
  best.at = separationAlong(best.normal, a, b);
  best.margin = 1e-13 * size;
  if (options.search == ClassicOptions::Search::Rotations)
    searchByRotations<Dim>(best, a, b, options);
  // Rotations end within an angle of the best normal; the faces and edges there give it to
  // round-off.
  searchByCandidates<Dim>(best, a, b, size);

  ClassicPlane plane;
  plane.normal = best.normal;
  plane.gap = best.at.gap();
  axesOfPlane<Dim>(plane.normal, plane.e1, plane.e2);
  Real cosine[2];
  plane.face[0] = faceAlong<Dim>(a, plane.normal, cosine[0]);
  plane.face[1] = faceAlong<Dim>(b, -plane.normal, cosine[1]);

  const Real level = 0.5 * (best.at.topOfA + best.at.bottomOfB);
  const NodeSet topOfA = nodesAtLevel(a, plane.normal, best.at.topOfA, sameLevel * size);
  const NodeSet bottomOfB = nodesAtLevel(b, plane.normal, best.at.bottomOfB, sameLevel * size);
  const Vec3 between =
      0.5 * (meanOf(a, topOfA, plane.node[0]) + meanOf(b, bottomOfB, plane.node[1]));
  Vec2 at{dot(plane.e1, between), dot(plane.e2, between)};
  if (plane.gap < 0)
  {
    const Real inPlane = std::cos(options.finestTurn);
    OutlinePoints outlineA =
        outline(a, plane.face[0], cosine[0] >= inPlane, plane, level, options.area);
    OutlinePoints outlineB =
        outline(b, plane.face[1], cosine[1] >= inPlane, plane, level, options.area);
    const AreaAndCentroid shared = sharedArea<Dim>(outlineA, outlineB);
    plane.area = shared.area;
    if (shared.area > 0)
      at = shared.centroid;
  }
  plane.point = origin + (at.x * plane.e1 + at.y * plane.e2 + level * plane.normal);
  return plane;
}

/// Shares of the nodes of a face in a force at the plane's point: their sum is 1, and their mean of
/// the nodes lies on the line through the point along the normal, inside the face or not. Shape
/// functions; of least norm where the face has none at that point.
template <int Dim>
KOKKOS_INLINE_FUNCTION void classicWeights(const ClassicPlane& plane, const Vec3* x, int count,
                                           Real* w)
{
  Vec2 p[4]; // from the point
  Vec2 mean;
  for (int i = 0; i < count; ++i)
  {
    const Vec3 r = x[i] - plane.point;
    p[i] = {dot(plane.e1, r), Dim == 2 ? 0.0 : dot(plane.e2, r)};
    mean = mean + (1.0 / count) * p[i];
    w[i] = 1.0 / count; // for a face that stands on the plane
  }
  if constexpr (Dim == 2)
  {
    const Real length = p[1].x - p[0].x;
    if (length != 0)
    {
      w[1] = -p[0].x / length;
      w[0] = 1 - w[1];
    }
    return;
  }
  const FaceMap map(p, count);
  const Vec2 at = map.coordinates({0, 0});
  // Beyond the face by more than its own size the shape functions are of no use.
  if (!map.lost && std::abs(at.x) <= 3 && std::abs(at.y) <= 3)
  {
    map.weights(at.x, at.y, at.x * at.y, w);
    return;
  }
  Real xx = 0, xy = 0, yy = 0;
  for (int i = 0; i < count; ++i)
  {
    const Vec2 r = p[i] - mean;
    xx += r.x * r.x;
    xy += r.x * r.y;
    yy += r.y * r.y;
  }
  const Real determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-14 * (xx + yy) * (xx + yy)))
    return;
  const Vec2 slope{(xy * mean.y - yy * mean.x) / determinant,
                   (xy * mean.x - xx * mean.y) / determinant};
  for (int i = 0; i < count; ++i)
    w[i] += dot(p[i] - mean, slope);
}
} // namespace coplane
