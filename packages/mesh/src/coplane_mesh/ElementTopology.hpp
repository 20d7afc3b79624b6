#pragma once

#include <coplane_core/Real.hpp>

#include <array>
#include <string>

namespace coplane
{
/// Element shapes, with the node order and side numbers of Exodus II.
enum class ElementType
{
  Tri3,  ///< triangle, plane strain, unit thickness; nodes counter-clockwise
  Quad4, ///< quadrilateral, plane strain, unit thickness; nodes counter-clockwise
  Tet4,  ///< tetrahedron; nodes 0-2 counter-clockwise seen from node 3, which lies above
  Hex8   ///< hexahedron; nodes 0-3 counter-clockwise seen from nodes 4-7, which lie above
};

struct ElementTopology
{
  const char* exodusName; ///< as written to element blocks
  int dimension;
  int nodes;
  int sides;
  int nodesPerSide;
  /// Local nodes of each side, ordered so that the normal points outward by the right-hand rule; in
  /// two dimensions from a to b along the counter-clockwise border. Side s of Exodus (counted from
  /// 1) is row s - 1. Rows and entries beyond `sides` and `nodesPerSide` mean nothing.
  std::array<std::array<int, 4>, 6> sideNodes;
};

inline const ElementTopology& topology(ElementType type)
{
  static const ElementTopology tri3{"TRI3", 2, 3, 3, 2, {{{0, 1}, {1, 2}, {2, 0}}}};
  static const ElementTopology quad4{"QUAD4", 2, 4, 4, 2, {{{0, 1}, {1, 2}, {2, 3}, {3, 0}}}};
  static const ElementTopology tet4{"TETRA4", 3, 4,
                                    4,        3, {{{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}}}};
  static const ElementTopology hex8{
      "HEX8",
      3,
      8,
      6,
      4,
      {{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}}}};
  switch (type)
  {
  case ElementType::Tri3:
    return tri3;
  case ElementType::Quad4:
    return quad4;
  case ElementType::Tet4:
    return tet4;
  default:
    return hex8;
  }
}

/// Id of a face: 8 * element id + side, side counted from 0. Does not depend on partition or
/// renumbering. Physics: key of planes.
inline GlobalId faceId(GlobalId element, int side)
{
  return 8 * element + side;
}
inline GlobalId elementOfFace(GlobalId face)
{
  return face / 8;
}
inline int sideOfFace(GlobalId face)
{
  return int(face % 8);
}
} // namespace coplane
