#pragma once

#include "ClassicCommonPlane.hpp"
#include "FacePairs.hpp"

#include <algorithm>

// Elements whose corners and faces meet, for the comparison of the classic common plane with the
// Simple Common Plane. Unit stiffness, no friction.

namespace coplane::facepairs
{
/// 10 x 1 with its upper side at y = 0.
inline ConvexBlock slabBlock2D()
{
  const Vec3 x[4] = {{-5, -1, 0}, {5, -1, 0}, {5, 0, 0}, {-5, 0, 0}};
  return blockOfElement<2>(x, 4);
}

/// 10 x 10 x 1 with its upper side at z = 0.
inline ConvexBlock slabBlock3D()
{
  const Vec3 x[8] = {{-5, -5, -1}, {5, -5, -1}, {5, 5, -1}, {-5, 5, -1},
                     {-5, -5, 0},  {5, -5, 0},  {5, 5, 0},  {-5, 5, 0}};
  return blockOfElement<3>(x, 8);
}

/// Rhombus that stands on a corner with the interior angle 2 theta, sides of length l, apex at
/// y = -depth; a square on its side when theta is 90 degrees.
inline ConvexBlock cornerBlock2D(Real theta, Real depth, Real l)
{
  const Real across = l * std::sin(theta), up = l * std::cos(theta);
  if (theta > 1.57)
  {
    const Vec3 x[4] = {{-l, -depth, 0}, {l, -depth, 0}, {l, l - depth, 0}, {-l, l - depth, 0}};
    return blockOfElement<2>(x, 4);
  }
  const Vec3 x[4] = {
      {0, -depth, 0}, {across, up - depth, 0}, {0, 2 * up - depth, 0}, {-across, up - depth, 0}};
  return blockOfElement<2>(x, 4);
}

/// Rhombohedron that stands on the corner where three of its faces meet, each at the angle theta to
/// the vertical axis (cube: asin(1 / sqrt 3)); edges of unit length, apex at z = -depth. At 90
/// degrees a cube on its face.
inline ConvexBlock cornerBlock3D(Real theta, Real depth)
{
  Vec3 edge[3]; // from the apex
  if (theta > 1.57)
  {
    edge[0] = {1, 0, 0};
    edge[1] = {0, 1, 0};
    edge[2] = {0, 0, 1};
  }
  else
    for (int i = 0; i < 3; ++i)
    {
      // A face is nearest to the axis midway between its two edges, where the distance per height
      // is tan(theta); that of an edge is twice as much.
      const Real angle = .2 + 2 * pi * i / 3;
      edge[i] = normalised(
          {2 * std::tan(theta) * std::cos(angle), 2 * std::tan(theta) * std::sin(angle), 1});
    }
  const Vec3 o{0, 0, -depth}, u = edge[0], v = edge[1], w = edge[2];
  const Vec3 x[8] = {o, o + u, o + u + v, o + v, o + w, o + u + w, o + u + v + w, o + v + w};
  return blockOfElement<3>(x, 8);
}

inline ConvexBlock moved(ConvexBlock block, const Mat3& r, const Vec3& shift = {})
{
  for (int i = 0; i < block.nodes; ++i)
    block.x[i] = r * block.x[i] + shift;
  return block;
}

inline FaceNodes faceOf(const ConvexBlock& block, int f, const Vec3& velocity = {})
{
  std::vector<Vec3> x;
  for (int i = 0; i < block.faceSize[f]; ++i)
    x.push_back(block.x[block.faceNode[f][i]]);
  return face(x, velocity);
}

/// What both methods make of two blocks: force on B, and the area of its plane or planes.
struct Push
{
  Vec3 force{};
  Real area = 0;
  int planes = 0;
};

/// Simple Common Planes between a face of A and those faces of B that meet at a node and oppose it.
template <int Dim>
Push simplePush(const ConvexBlock& a, int faceA, const ConvexBlock& b, int nodeOfB,
                const ContactOptions& o, const Vec3& velocityOfB = {})
{
  Push push;
  const FaceNodes nodesA = faceOf(a, faceA);
  const Vec3 normalA = stepA_halfStepFace<Dim>(nodesA, 0).normal;
  for (int f = 0; f < b.faces; ++f)
  {
    const FaceNodes nodesB = faceOf(b, f, velocityOfB);
    if (!classic::faceMeets(b, f, 1u << nodeOfB) ||
        !(dot(normalA, stepA_halfStepFace<Dim>(nodesB, 0).normal) < -o.cosOpposed))
      continue;
    PairPlane plane = touchingPlane();
    updatePlane<Dim>(plane, nodesA, nodesB, o, 1);
    push.force += plane.forceOn(1);
    push.area += plane.area;
    push.planes += plane.area > 0;
  }
  return push;
}

/// Overlap times area.
inline Push classicPush(const ClassicPlane& plane)
{
  return {(plane.gap < 0 ? -plane.gap * plane.area : 0) * plane.normal, plane.area,
          plane.area > 0 ? 1 : 0};
}
} // namespace coplane::facepairs
