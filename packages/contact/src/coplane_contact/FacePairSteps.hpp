#pragma once

#include <coplane_contact/Plane.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_geometry/ConvexPolygon.hpp>
#include <coplane_geometry/FaceMap.hpp>

// Steps A to G of the Simple Common Plane algorithm for one pair of faces (Vorobiev 2006), as pure
// functions. Dim is 2 or 3; in two dimensions a face is a segment, "area" is length times unit
// thickness, and only the first in-plane axis is used.

namespace coplane
{
/// What the kernel needs of a face: nodes at the end of the step and velocities in the middle of
/// it.
struct FaceNodes
{
  int count = 0;
  Vec3 x[4];                   ///< x(n+1) [m]
  Vec3 v[4];                   ///< v(n+1/2) [m/s]
  Real mass[4] = {1, 1, 1, 1}; ///< [kg]; used by contact damping only
};

struct HalfStepFace
{
  int count = 0;
  Vec3 x[4]; ///< x(n+1/2) [m]
  Vec3 center{};
  Vec3 normal{}; ///< outward unit normal; zero for a degenerate face
  Real area = 0; ///< [m^2]
};

/// Vector area of a face: exact for the bilinear patch of a warped quadrilateral.
template <int Dim>
KOKKOS_INLINE_FUNCTION Vec3 vectorArea(const Vec3* x, int count)
{
  if constexpr (Dim == 2)
    return {x[1].y - x[0].y, x[0].x - x[1].x, 0};
  else
    return count == 3 ? 0.5 * cross(x[1] - x[0], x[2] - x[0])
                      : 0.5 * cross(x[2] - x[0], x[3] - x[1]);
}

/// Step A: the face half a step ahead of the last known positions, x(n+1/2) = x(n+1) - dt/2
/// v(n+1/2).
template <int Dim>
KOKKOS_INLINE_FUNCTION HalfStepFace stepA_halfStepFace(const FaceNodes& nodes, Real dt)
{
  HalfStepFace face;
  face.count = nodes.count;
  for (int i = 0; i < nodes.count; ++i)
  {
    face.x[i] = nodes.x[i] - (0.5 * dt) * nodes.v[i];
    face.center += face.x[i];
  }
  face.center = (1.0 / nodes.count) * face.center;
  const Vec3 area = vectorArea<Dim>(face.x, face.count);
  face.area = norm(area);
  Real longest = 0;
  for (int i = 0; i < face.count; ++i)
  {
    const Vec3 edge = face.x[(i + 1) % face.count] - face.x[i];
    longest = dot(edge, edge) > longest ? dot(edge, edge) : longest;
  }
  const bool degenerate = Dim == 2 ? !(face.area > 0) : !(face.area > 1e-12 * longest);
  face.normal = degenerate ? Vec3{} : (1 / face.area) * area;
  return face;
}

/// Common plane of a pair: normal from face A to face B, a point on it, and two axes in it.
struct TrialPlane
{
  bool opposed = false;
  Vec3 normal{}, point{}, e1{}, e2{};
};

/// Step B: midpoint of the segment that connects the faces' centres, and the mean of n_A and -n_B
/// as normal. The projection is parallel to the normal, so area and centroid do not depend on where
/// along it the point lies.
template <int Dim>
KOKKOS_INLINE_FUNCTION TrialPlane stepB_trialPointOfContact(const HalfStepFace& a,
                                                            const HalfStepFace& b)
{
  TrialPlane plane;
  plane.opposed = dot(a.normal, b.normal) < 0;
  if (!plane.opposed)
    return plane;
  plane.normal = normalised(a.normal - b.normal);
  plane.point = 0.5 * (a.center + b.center);
  const Vec3& n = plane.normal;
  if constexpr (Dim == 2)
    plane.e1 = {-n.y, n.x, 0};
  else
  {
    const Vec3 size{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const int k = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    Vec3 axis{};
    axis[k] = 1;
    plane.e1 = normalised(axis - n[k] * n);
    plane.e2 = cross(n, plane.e1);
  }
  return plane;
}

/// A face projected on the plane: in-plane coordinates and heights of its nodes.
struct Shadow
{
  int count = 0;
  Vec2 p[4];
  Real height[4]; ///< along the normal, from the trial point [m]
};

/// Step C.
template <int Dim>
KOKKOS_INLINE_FUNCTION Shadow stepC_projectOntoPlane(const TrialPlane& plane,
                                                     const HalfStepFace& face)
{
  Shadow shadow;
  shadow.count = face.count;
  for (int i = 0; i < face.count; ++i)
  {
    const Vec3 r = face.x[i] - plane.point;
    shadow.p[i] = {dot(plane.e1, r), Dim == 2 ? 0.0 : dot(plane.e2, r)};
    shadow.height[i] = dot(plane.normal, r);
  }
  return shadow;
}

/// Means over the patch of 1, xi, eta and xi eta of one face's map, which determine its node
/// weights.
struct MapMeans
{
  Real xi = 0, eta = 0, xiEta = 0;
};

/// Area of contact and what follows from it.
struct Patch
{
  bool folded = false;      ///< a face is turned over: the pair is skipped
  Real overlap = 0;         ///< whole overlap of the shadows [m^2]
  Real area = 0;            ///< that carries traction [m^2]
  Real leastGap = infinity; ///< smallest local gap minus offset over the overlap [m]
  Vec2 centroid;            ///< of the area that carries traction
  Vec2 overlapCentroid;
  Real weights[2][4] = {};         ///< where force acts and slip is measured
  Real centroidWeights[2][4] = {}; ///< where the closure is measured
};

namespace detail
{
/// A shadow as one or two convex counter-clockwise pieces; the shadow of the higher face is
/// clockwise and gets reversed.
struct Pieces
{
  int count = 0;
  ConvexPolygon polygon[2];
};

KOKKOS_INLINE_FUNCTION Pieces convexPieces(const Shadow& shadow, bool reversed)
{
  Vec2 p[4];
  for (int i = 0; i < shadow.count; ++i)
    p[i] = shadow.p[reversed ? shadow.count - 1 - i : i];
  Pieces pieces;
  if (isConvex(p, shadow.count))
  {
    pieces.count = 1;
    for (int i = 0; i < shadow.count; ++i)
      pieces.polygon[0].add(p[i]);
    return pieces;
  }
  if (shadow.count == 3)
    return pieces;
  // A quadrilateral warped by more than about 45 degrees: the diagonal that leaves two
  // counter-clockwise triangles.
  for (int d = 0; d < 2; ++d)
  {
    const Vec2 first[3] = {p[d], p[d + 1], p[d + 2]};
    const Vec2 second[3] = {p[d], p[d + 2], p[(d + 3) % 4]};
    if (isConvex(first, 3) && isConvex(second, 3))
    {
      pieces.count = 2;
      for (int i = 0; i < 3; ++i)
      {
        pieces.polygon[0].add(first[i]);
        pieces.polygon[1].add(second[i]);
      }
      return pieces;
    }
  }
  return pieces;
}

/// Node weights that reproduce a point from any points that are not collinear, affine and of least
/// norm: for faces whose bilinear map cannot be inverted.
KOKKOS_INLINE_FUNCTION void affineWeights(const Shadow& shadow, const Vec2& at, Real* w)
{
  Vec2 mean;
  for (int i = 0; i < shadow.count; ++i)
    mean = mean + (1.0 / shadow.count) * shadow.p[i];
  Real xx = 0, xy = 0, yy = 0;
  for (int i = 0; i < shadow.count; ++i)
  {
    const Vec2 r = shadow.p[i] - mean;
    xx += r.x * r.x;
    xy += r.x * r.y;
    yy += r.y * r.y;
  }
  const Real determinant = xx * yy - xy * xy;
  const Vec2 d = at - mean;
  const Vec2 s{(yy * d.x - xy * d.y) / determinant, (xx * d.y - xy * d.x) / determinant};
  for (int i = 0; i < shadow.count; ++i)
    w[i] = 1.0 / shadow.count + dot(shadow.p[i] - mean, s);
}

KOKKOS_INLINE_FUNCTION Patch patchOfSegments(const Shadow& a, const Shadow& b, Real offset,
                                             const ContactOptions& options)
{
  Patch patch;
  const auto parameter = [](const Shadow& s, Real at)
  { return (at - s.p[0].x) / (s.p[1].x - s.p[0].x); };
  const auto height = [&](const Shadow& s, Real at)
  { return s.height[0] + parameter(s, at) * (s.height[1] - s.height[0]); };
  const auto low = [](const Shadow& s) { return s.p[0].x < s.p[1].x ? s.p[0].x : s.p[1].x; };
  const auto high = [](const Shadow& s) { return s.p[0].x < s.p[1].x ? s.p[1].x : s.p[0].x; };
  Real lo = low(a) > low(b) ? low(a) : low(b);
  Real hi = high(a) < high(b) ? high(a) : high(b);
  if (!(hi > lo))
    return patch;
  patch.overlap = hi - lo;
  patch.overlapCentroid = {0.5 * (lo + hi), 0};
  Real gapLo = height(b, lo) - height(a, lo) - offset;
  Real gapHi = height(b, hi) - height(a, hi) - offset;
  patch.leastGap = gapLo < gapHi ? gapLo : gapHi;
  if (options.area == ContactOptions::Area::Penetrating)
  {
    if (!(patch.leastGap < 0))
      return patch;
    const Real cut = lo + (hi - lo) * gapLo / (gapLo - gapHi);
    if (gapLo > 0)
    {
      lo = cut;
      gapLo = 0;
    }
    if (gapHi > 0)
    {
      hi = cut;
      gapHi = 0;
    }
  }
  else if (!(patch.leastGap < 0))
    return patch;
  if (!(hi > lo))
    return patch;
  patch.area = hi - lo;
  patch.centroid = {0.5 * (lo + hi), 0};
  Real at = patch.centroid.x;
  if (options.weights == ContactOptions::Weights::Pressure)
  {
    // Only the closed part of a full area carries pressure.
    Real from = lo, to = hi, closureFrom = -gapLo, closureTo = -gapHi;
    const Real cut = lo + (hi - lo) * gapLo / (gapLo - gapHi);
    if (closureFrom < 0)
    {
      from = cut;
      closureFrom = 0;
    }
    if (closureTo < 0)
    {
      to = cut;
      closureTo = 0;
    }
    if (closureFrom + closureTo > 0)
      at = from + (to - from) * (closureFrom + 2 * closureTo) / (3 * (closureFrom + closureTo));
  }
  const Shadow* shadows[2] = {&a, &b};
  for (int f = 0; f < 2; ++f)
  {
    const Real t = parameter(*shadows[f], at), tc = parameter(*shadows[f], patch.centroid.x);
    patch.weights[f][0] = 1 - t;
    patch.weights[f][1] = t;
    patch.centroidWeights[f][0] = 1 - tc;
    patch.centroidWeights[f][1] = tc;
  }
  return patch;
}

/// Adds weight * (xi, eta, xi eta) of a point.
KOKKOS_INLINE_FUNCTION void accumulate(MapMeans& means, Real weight, const Vec2& c)
{
  means.xi += weight * c.x;
  means.eta += weight * c.y;
  means.xiEta += weight * (c.x * c.y);
}

/// `byMaps`: weights and gaps from the faces' inverse maps; without, from affine weights of least
/// norm, for faces that have no such map. `lost` is set where a map was asked for but failed.
KOKKOS_INLINE_FUNCTION Patch patchOfPolygons(const Shadow& a, const Shadow& b, Real offset,
                                             const ContactOptions& options, bool byMaps, bool& lost)
{
  using Options = ContactOptions;
  Patch patch;
  const Pieces piecesA = convexPieces(a, false), piecesB = convexPieces(b, true);
  if (piecesA.count == 0 || piecesB.count == 0)
  {
    patch.folded = true;
    return patch;
  }
  const FaceMap map[2] = {FaceMap(a.p, a.count), FaceMap(b.p, b.count)};
  const bool invertible = byMaps && piecesA.count == 1 && piecesB.count == 1;

  // Up to four pieces; closure (minus gap plus offset) at the vertices of each.
  ConvexPolygon polygon[4];
  Real closure[4][ConvexPolygon::capacity];
  int count = 0;
  ConvexPolygon pressed; // the closed part of a full area, and its closure
  Real pressedClosure[ConvexPolygon::capacity];
  Real leastClosure = infinity, mostClosure = 0, thickness = 0;
  Vec2 moment, overlapMoment;
  for (int i = 0; i < piecesA.count; ++i)
    for (int j = 0; j < piecesB.count; ++j)
    {
      ConvexPolygon& q = polygon[count];
      q = intersection(piecesA.polygon[i], piecesB.polygon[j]);
      const AreaAndCentroid whole = areaAndCentroid(q);
      if (!(whole.area > 0))
        continue;
      patch.overlap += whole.area;
      overlapMoment = overlapMoment + whole.area * whole.centroid;
      Real* c = closure[count];
      bool allClosed = true;
      for (int v = 0; v < q.size; ++v)
      {
        Real gap;
        if (invertible)
          gap = map[1].interpolate(b.height, map[1].coordinates(q.vertex[v])) -
                map[0].interpolate(a.height, map[0].coordinates(q.vertex[v])) - offset;
        else
        {
          Real wa[4], wb[4];
          affineWeights(a, q.vertex[v], wa);
          affineWeights(b, q.vertex[v], wb);
          gap = -offset;
          for (int k = 0; k < b.count; ++k)
            gap += wb[k] * b.height[k];
          for (int k = 0; k < a.count; ++k)
            gap -= wa[k] * a.height[k];
        }
        c[v] = -gap;
        allClosed = allClosed && gap <= 0;
        patch.leastGap = gap < patch.leastGap ? gap : patch.leastGap;
      }
      AreaAndCentroid part = whole;
      if (options.area == Options::Area::Penetrating && !allClosed)
      {
        cutWhereNegative(q, c);
        part = areaAndCentroid(q);
      }
      else if (options.weights == Options::Weights::Pressure && !allClosed)
      {
        pressed = q;
        for (int v = 0; v < q.size; ++v)
          pressedClosure[v] = c[v];
        cutWhereNegative(pressed, pressedClosure);
      }
      if (!(part.area > 0))
        continue;
      for (int v = 0; v < q.size; ++v)
      {
        c[v] = c[v] > 0 ? c[v] : 0;
        leastClosure = c[v] < leastClosure ? c[v] : leastClosure;
        mostClosure = c[v] > mostClosure ? c[v] : mostClosure;
      }
      patch.area += part.area;
      moment = moment + part.area * part.centroid;
      ++count;
    }
  if (patch.overlap > 0)
    patch.overlapCentroid = (1 / patch.overlap) * overlapMoment;
  if (!(patch.leastGap < 0) || !(patch.area > 0))
  {
    lost = map[0].lost || map[1].lost;
    patch.area = 0;
    return patch;
  }
  patch.centroid = (1 / patch.area) * moment;
  thickness = std::sqrt(patch.area);

  const Shadow* shadows[2] = {&a, &b};
  if (!invertible)
  {
    for (int f = 0; f < 2; ++f)
    {
      affineWeights(*shadows[f], patch.centroid, patch.centroidWeights[f]);
      for (int k = 0; k < 4; ++k)
        patch.weights[f][k] = patch.centroidWeights[f][k];
    }
    return patch;
  }
  for (int f = 0; f < 2; ++f)
  {
    const Vec2 c = map[f].coordinates(patch.centroid);
    map[f].weights(c.x, c.y, c.x * c.y, patch.centroidWeights[f]);
  }
  lost = map[0].lost || map[1].lost;
  if (lost)
    return patch;
  if (options.weights == Options::Weights::Centroid)
  {
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 4; ++k)
        patch.weights[f][k] = patch.centroidWeights[f][k];
    return patch;
  }
  const bool byPressure = options.weights == Options::Weights::Pressure &&
                          mostClosure - leastClosure > 1e-14 * thickness;
  // Triangles of the polygon. Mid-edge rule, exact to degree 2, for the average; four-point rule,
  // exact to degree 3, for the pressure (shape functions of a parallelogram are of degree 2, the
  // closure is linear). Where the rule is exact any fan will do. Elsewhere the fan is about the
  // centroid: about a vertex it would depend on the node that the face happens to start from.
  const auto flat = [](const Shadow& s, Real size)
  {
    return s.count == 3 ||
           std::abs((s.height[0] - s.height[1]) + (s.height[2] - s.height[3])) <= 1e-14 * size;
  };
  const bool exact =
      map[0].affine && map[1].affine && (!byPressure || (flat(a, thickness) && flat(b, thickness)));
  // Invertible maps: there is one piece.
  const bool partly = byPressure && pressed.size > 0;
  const ConvexPolygon& q = partly ? pressed : polygon[0];
  const Real* closureAt = partly ? pressedClosure : closure[0];
  Vec2 apex = q.vertex[0];
  Real apexClosure = closureAt[0];
  if (!exact)
  {
    apex = areaAndCentroid(q).centroid;
    const Real gap = map[1].interpolate(b.height, map[1].coordinates(apex)) -
                     map[0].interpolate(a.height, map[0].coordinates(apex)) - offset;
    apexClosure = gap < 0 ? -gap : 0;
  }
  MapMeans means[2];
  Real total = 0;
  for (int v = exact ? 1 : 0; v < (exact ? q.size - 1 : q.size); ++v)
  {
    const int next = v + 1 == q.size ? 0 : v + 1;
    const Vec2 p[3] = {apex, q.vertex[v], q.vertex[next]};
    const Real c[3] = {apexClosure, closureAt[v], closureAt[next]};
    const Real triangle = 0.5 * cross(p[1] - p[0], p[2] - p[0]);
    const int points = byPressure ? 4 : 3;
    for (int g = 0; g < points; ++g)
    {
      Real l[3];
      Real weight = triangle;
      if (byPressure)
      {
        for (int k = 0; k < 3; ++k)
          l[k] = g == 3 ? 1.0 / 3 : k == g ? 0.6 : 0.2;
        weight *= g == 3 ? -27.0 / 48 : 25.0 / 48;
        weight *= l[0] * c[0] + l[1] * c[1] + l[2] * c[2];
      }
      else
      {
        for (int k = 0; k < 3; ++k)
          l[k] = k == g ? 0 : 0.5;
        weight *= 1.0 / 3;
      }
      const Vec2 at = l[0] * p[0] + (l[1] * p[1] + l[2] * p[2]);
      total += weight;
      accumulate(means[0], weight, map[0].coordinates(at));
      accumulate(means[1], weight, map[1].coordinates(at));
    }
  }
  for (int f = 0; f < 2; ++f)
    map[f].weights(means[f].xi / total, means[f].eta / total, means[f].xiEta / total,
                   patch.weights[f]);
  lost = map[0].lost || map[1].lost;
  return patch;
}
} // namespace detail

/// Step D: area shared by the shadows; with Area::Penetrating only where the local gap is below the
/// offset. With it, where force acts (weights of the nodes): sums of the weights are 1 and they
/// reproduce one and the same in-plane point for both faces.
template <int Dim>
KOKKOS_INLINE_FUNCTION Patch stepD_areaOfContact(const Shadow& a, const Shadow& b, Real offset,
                                                 const ContactOptions& options)
{
  if constexpr (Dim == 2)
    return detail::patchOfSegments(a, b, offset, options);
  else
  {
    bool lost = false;
    const Patch patch = detail::patchOfPolygons(a, b, offset, options, true, lost);
    return lost ? detail::patchOfPolygons(a, b, offset, options, false, lost) : patch;
  }
}

/// Step E: whether the pair has its plane already. Every candidate pair has a slot, so this is a
/// flag and not a lookup.
KOKKOS_INLINE_FUNCTION bool stepE_planeExists(const Plane& plane)
{
  return plane.born;
}

/// Step F: the slot becomes a plane. A pair that was penetrated already when it was found starts
/// without force.
KOKKOS_INLINE_FUNCTION void stepF_createPlane(Plane& plane, const Vec3& normal, Real gap)
{
  plane.born = true;
  plane.normal = normal;
  if (plane.fresh && !plane.declared && !plane.inherited && gap < plane.offset)
    plane.offset = gap;
}

/// Weighted mean of node vectors.
KOKKOS_INLINE_FUNCTION Vec3 weighted(const Real* w, const Vec3* x, int count)
{
  Vec3 sum{};
  for (int i = 0; i < count; ++i)
    sum += w[i] * x[i];
  return sum;
}

/// Step G: half way between the two material points that project to the centre of gravity of the
/// area.
KOKKOS_INLINE_FUNCTION Vec3 stepG_placePointOfContact(const Patch& patch, const HalfStepFace& a,
                                                      const HalfStepFace& b)
{
  return 0.5 * (weighted(patch.centroidWeights[0], a.x, a.count) +
                weighted(patch.centroidWeights[1], b.x, b.count));
}
} // namespace coplane
