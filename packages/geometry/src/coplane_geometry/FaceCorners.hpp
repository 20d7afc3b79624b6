#pragma once

#include <coplane_core/NodeViews.hpp>
#include <coplane_geometry/VectorArea.hpp>

namespace coplane
{
/// Mean of the corners of a face [m].
inline Vec3 centerOf(const Vec3* x, int count)
{
  Vec3 center{};
  for (int k = 0; k < count; ++k)
    center += (1.0 / count) * x[k];
  return center;
}

/// Corners of a face, or of a side of an element, as its nodes lie [m].
struct FaceCorners
{
  int count = 0;
  Vec3 x[4];

  Vec3 center() const { return centerOf(x, count); }
  /// Area along the outward normal [m^2].
  Vec3 area(int dimension) const { return vectorArea(x, count, dimension); }
};

/// @param nodes of the face, places in x
inline FaceCorners cornersAt(const ConstNodeVectors& x, const int* nodes, int count)
{
  FaceCorners corners;
  corners.count = count;
  for (int k = 0; k < count; ++k)
    corners.x[k] = at(x, nodes[k]);
  return corners;
}
/// @param face anything with `nodes` and their `count`
template <class Face>
FaceCorners cornersAt(const ConstNodeVectors& x, const Face& face)
{
  return cornersAt(x, &face.nodes[0], face.count);
}
} // namespace coplane
