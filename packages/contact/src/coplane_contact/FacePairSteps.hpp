#pragma once

#include <coplane_contact/AreaOfContact.hpp>
#include <coplane_contact/HalfStepFace.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_geometry/PlaneAxes.hpp>

// Steps A to G of the Simple Common Plane algorithm for one pair of faces (Vorobiev 2006), as pure
// functions. T is Real, or Lanes for several pairs side by side, which then have the same numbers
// of nodes. Dim is 2 or 3; in two dimensions a face is a segment, "area" is length times unit
// thickness, and only the first in-plane axis is used.

namespace coplane
{
/// Common plane of a pair: normal from face A to face B, a point on it, and two axes in it.
template <class T>
struct TrialPlaneOf
{
  branchFree::MaskOf<T> opposed{false};
  Vec3Of<T> normal{}, point{}, e1{}, e2{};
};
using TrialPlane = TrialPlaneOf<Real>;

/// What a plane's lengths are to be multiplied with.
KOKKOS_INLINE_FUNCTION Depth depthOf(const TrialPlane& plane, const ContactOptions& options)
{
  return options.axisymmetric ? Depth{2 * pi * plane.point.x, 2 * pi * plane.e1.x} : Depth{};
}

/// Step B: midpoint of the segment that connects the faces' centres, and the mean of n_A and -n_B
/// as normal. The projection is parallel to the normal, so area and centroid do not depend on where
/// along it the point lies.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION TrialPlaneOf<T> stepB_trialPointOfContact(const HalfStepFaceOf<T>& a,
                                                                 const HalfStepFaceOf<T>& b)
{
  using namespace branchFree;
  TrialPlaneOf<T> plane;
  plane.opposed = dot(a.normal, b.normal) < 0.0;
  if (!anyOf(plane.opposed))
    return plane;
  plane.normal = normalised(a.normal - b.normal);
  plane.point = 0.5 * (a.center + b.center);
  const PlaneAxesOf<T> axes = planeAxes<Dim>(plane.normal);
  plane.e1 = axes.e1;
  plane.e2 = axes.e2;
  return plane;
}

/// Step C. The outline is that of the half step; the heights are those dt / 2 later, at the end of
/// the step: area in contact and centre of pressure come from heights, and like the closure they
/// must not lag behind the positions on which the force acts.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION ShadowOf<T> stepC_projectOntoPlane(const TrialPlaneOf<T>& plane,
                                                          const HalfStepFaceOf<T>& face, Real dt)
{
  ShadowOf<T> shadow;
  shadow.count = face.count;
  for (int i = 0; i < face.count; ++i)
  {
    const Vec3Of<T> r = face.x[i] - plane.point;
    shadow.p[i] = {dot(plane.e1, r), Dim == 2 ? T(0.0) : dot(plane.e2, r)};
    shadow.height[i] = dot(plane.normal, r) + (0.5 * dt) * dot(plane.normal, face.v[i]);
  }
  return shadow;
}

/// Whether a shadow lies on one side of one of its edges, and the other shadow beyond it. `sign`: 1
/// where the corners go round counter-clockwise, -1 where they go the other way.
template <class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T> edgeParts(const ShadowOf<T>& of,
                                                       const ShadowOf<T>& other, Real sign)
{
  using namespace branchFree;
  MaskOf<T> parted(false);
  for (int e = 0; e < of.count; ++e)
  {
    const Vec2Of<T>& start = of.p[e];
    const Vec2Of<T> edge = sign * (of.p[e + 1 == of.count ? 0 : e + 1] - start);
    T own(infinity), most(-infinity);
    for (int i = 0; i < of.count; ++i)
      own = smaller(cross(edge, of.p[i] - start), own);
    for (int i = 0; i < other.count; ++i)
      most = larger(cross(edge, other.p[i] - start), most);
    parted = parted || (own >= 0.0 && most <= 0.0);
  }
  return parted;
}

/// Whether an edge of one of two shadows has all of that shadow on one side and the other one
/// beyond. Seen against the normal of their plane, the corners of a go round counter-clockwise and
/// those of b the other way.
template <class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T> edgesPart(const ShadowOf<T>& a, const ShadowOf<T>& b)
{
  return edgeParts(a, b, 1) || edgeParts(b, a, -1);
}

/// Area that the bounding boxes of two shadows share, in two dimensions length: the shadows do not
/// share more. Not positive where the boxes are apart [m^2].
template <class T>
KOKKOS_INLINE_FUNCTION T sharedByBoxes(const ShadowOf<T>& a, const ShadowOf<T>& b)
{
  using namespace branchFree;
  Vec2Of<T> low[2], high[2];
  const ShadowOf<T>* shadows[2] = {&a, &b};
  for (int f = 0; f < 2; ++f)
  {
    low[f] = high[f] = shadows[f]->p[0];
    for (int i = 1; i < shadows[f]->count; ++i)
    {
      const Vec2Of<T>& p = shadows[f]->p[i];
      low[f] = {smaller(p.x, low[f].x), smaller(p.y, low[f].y)};
      high[f] = {larger(p.x, high[f].x), larger(p.y, high[f].y)};
    }
  }
  const T x = smaller(high[0].x, high[1].x) - larger(low[0].x, low[1].x);
  if (a.count == 2)
    return x;
  const T y = smaller(high[0].y, high[1].y) - larger(low[0].y, low[1].y);
  return choose(x > 0.0 && y > 0.0, x * y, smaller(x, y));
}

/// Whether they share none: most candidates are neighbours that only touch along an edge.
template <class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T> shadowsApart(const ShadowOf<T>& a,
                                                          const ShadowOf<T>& b)
{
  return !(sharedByBoxes(a, b) > 0.0);
}

/// Step E: whether the pair has its plane already. Every candidate pair has a slot, so this is
/// its state and not a lookup.
KOKKOS_INLINE_FUNCTION bool stepE_planeExists(const Plane& plane)
{
  return plane.isBorn();
}

/// Step F: the slot becomes a plane. A pair that was penetrated already when it was found starts
/// without force.
/// @param gap where the faces are deepest in each other; with the area of the whole overlap, at its
///        centre of gravity [m]
KOKKOS_INLINE_FUNCTION void stepF_createPlane(Plane& plane, const Vec3& normal, Real gap)
{
  if (!plane.isBorn())
    plane.state = PlaneState::Open;
  plane.normal = normal;
  if (plane.isNew() && !plane.declared && !plane.isInherited() && gap < plane.offset)
    plane.absorb(gap);
}

/// Weighted mean of node vectors.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Vec3Of<T> weighted(const T* w, const Vec3Of<T>* x, int count)
{
  Vec3Of<T> sum{};
  for (int i = 0; i < count; ++i)
    sum += w[i] * x[i];
  return sum;
}

/// Step G: half way between the two material points that project to the centre of gravity of the
/// area.
template <class T>
KOKKOS_INLINE_FUNCTION Vec3Of<T> stepG_placePointOfContact(const PatchOf<T>& patch,
                                                           const HalfStepFaceOf<T>& a,
                                                           const HalfStepFaceOf<T>& b)
{
  return 0.5 * (weighted(patch.centroidWeights[0], a.x, a.count) +
                weighted(patch.centroidWeights[1], b.x, b.count));
}
} // namespace coplane
