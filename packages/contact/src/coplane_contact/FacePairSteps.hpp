#pragma once

#include <coplane_contact/Plane.hpp>
#include <coplane_core/Lanes.hpp>
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

/// Corners of a face relative to their mean, and the tensor sum |r|^2 I - r (x) r that turns a spin
/// into a moment; in two dimensions only its zz entry is used.
template <int Dim>
struct FaceInertia
{
  Vec3 r[4];
  Real xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;
  int count = 0;

  KOKKOS_INLINE_FUNCTION FaceInertia(const Vec3* x, int n) : count(n)
  {
    Vec3 mean{};
    for (int i = 0; i < n; ++i)
      mean += x[i];
    mean = (1.0 / n) * mean;
    for (int i = 0; i < n; ++i)
    {
      r[i] = x[i] - mean;
      const Vec3& q = r[i];
      zz += q.x * q.x + q.y * q.y;
      if constexpr (Dim == 3)
      {
        xx += q.y * q.y + q.z * q.z;
        yy += q.z * q.z + q.x * q.x;
        xy -= q.x * q.y;
        yz -= q.y * q.z;
        zx -= q.z * q.x;
      }
    }
  }

  /// inertia^-1 * moment; nothing for a face 3000 times longer than wide: the forces of a couple
  /// about its axis grow without bound, and round-off with them.
  KOKKOS_INLINE_FUNCTION Vec3 solve(const Vec3& m) const
  {
    if constexpr (Dim == 2)
      return {0, 0, m.z / zz};
    else
    {
      const Real cxx = yy * zz - yz * yz, cyy = zz * xx - zx * zx, czz = xx * yy - xy * xy;
      const Real cxy = yz * zx - xy * zz, cyz = zx * xy - yz * xx, czx = xy * yz - zx * yy;
      const Real determinant = xx * cxx + xy * cxy + zx * czx;
      const Real trace = xx + yy + zz;
      if (!(determinant > 1e-8 * trace * trace * trace))
        return {};
      const Real s = 1 / determinant;
      return {s * (cxx * m.x + cxy * m.y + czx * m.z), s * (cxy * m.x + cyy * m.y + cyz * m.z),
              s * (czx * m.x + cyz * m.y + czz * m.z)};
    }
  }

  KOKKOS_INLINE_FUNCTION Vec3 momentOf(const Vec3* v) const
  {
    Vec3 moment{};
    for (int i = 0; i < count; ++i)
      moment += cross(r[i], v[i]);
    return moment;
  }
};

/// Step A's result: all that the pairs of a face have in common in a cycle.
struct HalfStepFace
{
  int count = 0;
  Vec3 x[4]; ///< x(n+1/2) [m]
  Vec3 v[4]; ///< v(n+1/2) [m/s]
  Vec3 center{};
  Vec3 normal{}; ///< outward unit normal; zero for a degenerate face
  Real area = 0; ///< [m^2]
  Vec3 spin{};   ///< of the rigid motion nearest to the corner velocities [1/s]
  /// The same by the corners at x(n) and at x(n+1), on which the forces of the old and the new time
  /// act: what a couple works on.
  Vec3 spinAtStart{}, spinAtEnd{};
  Real inverseMass[4] = {0, 0, 0, 0}; ///< [1/kg]; used by contact damping only
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
    face.v[i] = nodes.v[i];
    face.center += face.x[i];
    face.inverseMass[i] = 1 / nodes.mass[i];
  }
  face.center = (1.0 / nodes.count) * face.center;
  const Vec3 area = vectorArea<Dim>(face.x, face.count);
  face.area = norm(area);
  Real longest = 0;
  for (int i = 0; i < face.count; ++i)
  {
    const Vec3 edge = face.x[i + 1 == face.count ? 0 : i + 1] - face.x[i];
    longest = dot(edge, edge) > longest ? dot(edge, edge) : longest;
  }
  const bool degenerate = Dim == 2 ? !(face.area > 0) : !(face.area > 1e-12 * longest);
  if (degenerate)
    return face;
  face.normal = (1 / face.area) * area;

  const FaceInertia<Dim> inertia(face.x, face.count);
  const Vec3 moment = inertia.momentOf(face.v); // the same at all three times: v x v = 0
  face.spin = inertia.solve(moment);
  Vec3 start[4];
  for (int i = 0; i < face.count; ++i)
    start[i] = nodes.x[i] - dt * nodes.v[i];
  face.spinAtStart = FaceInertia<Dim>(start, face.count).solve(moment);
  face.spinAtEnd = FaceInertia<Dim>(nodes.x, face.count).solve(moment);
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
    // The axis with the smallest component of the normal, less that component.
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

/// Step C. The outline is that of the half step; the heights are those dt / 2 later, at the end of
/// the step: area in contact and centre of pressure come from heights, and like the closure they
/// must not lag behind the positions on which the force acts.
template <int Dim>
KOKKOS_INLINE_FUNCTION Shadow stepC_projectOntoPlane(const TrialPlane& plane,
                                                     const HalfStepFace& face, Real dt)
{
  Shadow shadow;
  shadow.count = face.count;
  for (int i = 0; i < face.count; ++i)
  {
    const Vec3 r = face.x[i] - plane.point;
    shadow.p[i] = {dot(plane.e1, r), Dim == 2 ? 0.0 : dot(plane.e2, r)};
    shadow.height[i] = dot(plane.normal, r) + (0.5 * dt) * dot(plane.normal, face.v[i]);
  }
  return shadow;
}

/// Which part of the overlap carries traction.
enum class AreaInUse : std::uint8_t
{
  Penetrating, ///< where the gap is below the offset
  Full,        ///< all of it, as soon as the gap is below the offset somewhere
  Bonded       ///< all of it, also across an open gap: a joint that carries tension
};

/// Depth of a plane in two dimensions, by which lengths along it become areas: 1 m, or 2 pi r of a
/// body of revolution.
struct Depth
{
  Real atOrigin = 1; ///< at the trial point [m]
  Real slope = 0;    ///< along the first axis of the plane [-]

  KOKKOS_INLINE_FUNCTION Real at(Real along) const { return atOrigin + slope * along; }
};

/// Area of contact and what follows from it.
struct Patch
{
  bool folded = false;             ///< a face is turned over: the pair is skipped
  Real overlap = 0;                ///< whole overlap of the shadows [m^2]
  Real area = 0;                   ///< that carries traction [m^2]
  Real leastGap = infinity;        ///< smallest local gap minus offset over the overlap [m]
  Vec2 centroid;                   ///< of the area that carries traction
  Real weights[2][4] = {};         ///< where force acts and slip is measured
  Real centroidWeights[2][4] = {}; ///< where the closure is measured
};

namespace detail
{
/// The shadow as a polygon; that of the higher face is clockwise and gets reversed.
KOKKOS_INLINE_FUNCTION ConvexPolygon outline(const Shadow& shadow, bool reversed)
{
  ConvexPolygon polygon;
  polygon.size = shadow.count;
  for (int i = 0; i < shadow.count; ++i)
    polygon.vertex[i] = shadow.p[reversed ? shadow.count - 1 - i : i];
  return polygon;
}

/// A quadrilateral warped by more than about 45 degrees, as the two counter-clockwise triangles
/// that one of its diagonals leaves; none where the shadow is folded.
struct Pieces
{
  int count = 0;
  ConvexPolygon polygon[2];

  KOKKOS_INLINE_FUNCTION explicit Pieces(const ConvexPolygon& whole)
  {
    if (isConvex(whole.vertex, whole.size))
    {
      count = 1;
      polygon[0] = whole;
      return;
    }
    for (int d = 0; d < 2 && whole.size == 4; ++d)
    {
      const Vec2* p = whole.vertex;
      const Vec2 first[3] = {p[d], p[d + 1], p[d + 2]};
      const Vec2 second[3] = {p[d], p[d + 2], p[(d + 3) % 4]};
      if (!isConvex(first, 3) || !isConvex(second, 3))
        continue;
      count = 2;
      for (int i = 0; i < 3; ++i)
      {
        polygon[0].add(first[i]);
        polygon[1].add(second[i]);
      }
      return;
    }
  }
};

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
                                             AreaInUse use, bool byPressure, const Depth& depth)
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
  patch.overlap = (hi - lo) * depth.at(0.5 * (lo + hi));
  const Real gapLo = height(b, lo) - height(a, lo) - offset;
  const Real gapHi = height(b, hi) - height(a, hi) - offset;
  patch.leastGap = gapLo < gapHi ? gapLo : gapHi;
  if (use != AreaInUse::Bonded && !(patch.leastGap < 0))
    return patch;
  // The closed part.
  const Real cut = lo + (hi - lo) * gapLo / (gapLo - gapHi);
  const Real closedLo = gapLo > 0 ? cut : lo, closedHi = gapHi > 0 ? cut : hi;
  if (use == AreaInUse::Penetrating)
  {
    lo = closedLo;
    hi = closedHi;
    if (!(hi > lo))
      return patch;
  }
  const Real middle = 0.5 * (lo + hi), mean = depth.at(middle);
  patch.area = (hi - lo) * mean;
  // The centre of gravity and the centre of pressure of what has this depth.
  patch.centroid = {middle, 0};
  if (depth.slope != 0)
    patch.centroid.x += depth.slope * (hi - lo) * (hi - lo) / (12 * mean);
  Real at = patch.centroid.x;
  if (byPressure && use != AreaInUse::Bonded)
  {
    const Real closureLo = gapLo > 0 ? 0 : -gapLo, closureHi = gapHi > 0 ? 0 : -gapHi;
    if (closureLo + closureHi > 0)
    {
      Real first = closureLo + 2 * closureHi, total = 3 * (closureLo + closureHi);
      if (depth.slope != 0)
      {
        const Real d0 = depth.at(closedLo), d1 = depth.at(closedHi);
        first = closureLo * (d0 + d1) + closureHi * (d0 + 3 * d1);
        total = closureLo * (4 * d0 + 2 * d1) + closureHi * (2 * d0 + 4 * d1);
      }
      at = closedLo + (closedHi - closedLo) * first / total;
    }
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

/// Closure (offset minus gap) between two faces as a function of the point of the plane.
struct ClosureField
{
  Real atOrigin = 0;
  Vec2 slope;
  Real warp[2] = {0, 0};

  KOKKOS_INLINE_FUNCTION ClosureField(const FaceMap (&map)[2], const Shadow& a, const Shadow& b,
                                      Real offset, Real size)
  {
    atOrigin = offset;
    const Shadow* shadows[2] = {&a, &b};
    for (int f = 0; f < 2; ++f)
    {
      const FaceHeights h(map[f], shadows[f]->height);
      const Vec2 gradient = h.xi * map[f].gradXi + h.eta * map[f].gradEta;
      const Real sign = f == 0 ? 1 : -1;
      slope = slope + sign * gradient;
      atOrigin += sign * (h.mean - dot(gradient, map[f].origin));
      warp[f] = std::abs(h.warp) > 1e-14 * size ? sign * h.warp : 0;
    }
  }
  KOKKOS_INLINE_FUNCTION bool linear() const { return warp[0] == 0 && warp[1] == 0; }
  KOKKOS_INLINE_FUNCTION Real at(const FaceMap (&map)[2], const Vec2& p) const
  {
    Real c = atOrigin + dot(slope, p);
    for (int f = 0; f < 2; ++f)
      if (warp[f] != 0)
        c += warp[f] * map[f].product(map[f].straight(p));
    return c;
  }
};

/// Integrals over a polygon of a function that is linear in the triangles of a fan: of itself, and
/// times the coordinates relative to the apex, and their products. Exact.
struct Moments
{
  Real total = 0;
  Vec2 first;
  Real xx = 0, xy = 0, yy = 0;

  KOKKOS_INLINE_FUNCTION void add(const Vec2& a, const Vec2& b, Real c0, Real ca, Real cb)
  {
    const Real area = 0.5 * cross(a, b);
    const Real sum = c0 + ca + cb;
    const Vec2 both = a + b;
    const Vec2 weighted = ca * a + cb * b;
    total += area / 3 * sum;
    first = first + (area / 12) * (sum * both + weighted);
    const Real w = area / 60;
    xx += w * (sum * (both.x * both.x + (a.x * a.x + b.x * b.x)) + 2 * both.x * weighted.x +
               2 * (ca * a.x * a.x + cb * b.x * b.x));
    yy += w * (sum * (both.y * both.y + (a.y * a.y + b.y * b.y)) + 2 * both.y * weighted.y +
               2 * (ca * a.y * a.y + cb * b.y * b.y));
    xy += w * (sum * (both.x * both.y + (a.x * a.y + b.x * b.y)) + both.x * weighted.y +
               both.y * weighted.x + 2 * (ca * a.x * a.y + cb * b.x * b.y));
  }
};

/// Weights of the pair's nodes at the centre of pressure, c at the vertices, or at the mean of the
/// shape functions over the polygon (c = 1 there). Parallelograms: polygon moments in closed form.
/// Other quadrilaterals: the small difference between xi eta and the product of the straight
/// coordinates by a rule of degree 3 on the triangles about the centroid; a fan about a vertex
/// would make it depend on the node that the face happens to start from.
KOKKOS_INLINE_FUNCTION void weightsOver(const FaceMap (&map)[2], const ConvexPolygon& q,
                                        const Real* c, const Vec2& center, Real centerClosure,
                                        bool linear, Real (&weights)[2][4])
{
  const bool aboutVertex = map[0].affine && map[1].affine && linear;
  const Vec2 apex = aboutVertex ? q.vertex[0] : center;
  const Real atApex = aboutVertex ? c[0] : centerClosure;
  Moments moments;
  Real correction[2] = {0, 0};
  for (int v = aboutVertex ? 1 : 0; v < (aboutVertex ? q.size - 1 : q.size); ++v)
  {
    const int next = v + 1 == q.size ? 0 : v + 1;
    const Vec2 a = q.vertex[v] - apex, b = q.vertex[next] - apex;
    moments.add(a, b, atApex, c[v], c[next]);
    if (aboutVertex)
      continue;
    // The four points of the rule side by side.
    const Real sum = atApex + c[v] + c[next];
    const Real third = 1.0 / 3;
    const Real shareA[4] = {0.2, 0.6, 0.2, third}, shareB[4] = {0.2, 0.2, 0.6, third};
    const Real w[4] = {0.2 * sum + 0.4 * atApex, 0.2 * sum + 0.4 * c[v], 0.2 * sum + 0.4 * c[next],
                       third * sum};
    const Real factor = 0.5 * cross(a, b) / 48;
    const Lanes toA(shareA, stdx::element_aligned), toB(shareB, stdx::element_aligned);
    const Lanes x = toA * Lanes(a.x) + toB * Lanes(b.x), y = toA * Lanes(a.y) + toB * Lanes(b.y);
    for (int f = 0; f < 2; ++f)
    {
      const FaceMap& m = map[f];
      if (m.affine)
        continue;
      const Vec2 start = m.straight(apex);
      const Lanes sx = start.x + (m.gradXi.x * x + m.gradXi.y * y);
      const Lanes sy = start.y + (m.gradEta.x * x + m.gradEta.y * y);
      const Lanes q = sx * sy;
      const Lanes half = 1 + m.alpha * sy + m.beta * sx;
      const Lanes discriminant = half * half - (4 * (m.alpha * m.beta)) * q;
      const Lanes denominator = half + stdx::sqrt(lanesMax(discriminant, Lanes(0.0)));
      if (!stdx::all_of(denominator > 1e-14))
      {
        m.lost = true;
        return;
      }
      const Lanes difference = 2 * q / denominator - q;
      correction[f] +=
          factor * (25 * (w[0] * difference[0] + w[1] * difference[1] + w[2] * difference[2]) -
                    27 * (w[3] * difference[3]));
    }
  }
  const Real inverse = 1 / moments.total;
  const Vec2 mean = inverse * moments.first;
  for (int f = 0; f < 2; ++f)
  {
    const FaceMap& m = map[f];
    Real xiEta = 0;
    if (m.nodes == 4)
    {
      const Vec2 s = m.straight(apex);
      const Vec2 &gx = m.gradXi, &gy = m.gradEta;
      xiEta = s.x * s.y + s.x * dot(gy, mean) + s.y * dot(gx, mean) +
              inverse * (gx.x * gy.x * moments.xx + (gx.x * gy.y + gx.y * gy.x) * moments.xy +
                         gx.y * gy.y * moments.yy + correction[f]);
    }
    m.weightsAt(apex + mean, xiEta, weights[f]);
  }
}

/// For convex shadows whose maps can be inverted, which is nearly all; false where they cannot.
KOKKOS_INLINE_FUNCTION bool patchOfPolygons(const Shadow& a, const Shadow& b,
                                            const ConvexPolygon& outlineA,
                                            const ConvexPolygon& outlineB, Real offset,
                                            AreaInUse use, ContactOptions::Weights weights,
                                            Patch& patch)
{
  ConvexPolygon q = intersection(outlineA, outlineB);
  AreaAndCentroid part = areaAndCentroid(q);
  if (!(part.area > 0))
    return true;
  patch.overlap = part.area;
  const FaceMap map[2] = {FaceMap(a.p, a.count), FaceMap(b.p, b.count)};
  if (map[0].lost || map[1].lost)
    return false;
  const ClosureField field(map, a, b, offset, std::sqrt(part.area));
  Real c[ConvexPolygon::capacity];
  Real least = infinity, most = -infinity;
  for (int v = 0; v < q.size; ++v)
  {
    c[v] = field.at(map, q.vertex[v]);
    least = c[v] < least ? c[v] : least;
    most = c[v] > most ? c[v] : most;
  }
  patch.leastGap = -most;
  if (use != AreaInUse::Bonded && !(most > 0))
    return true;
  const bool byPressure = weights == ContactOptions::Weights::Pressure && use != AreaInUse::Bonded;
  const bool partly = use == AreaInUse::Full && byPressure && least < 0;
  ConvexPolygon pressed; // the closed part of a full area
  if (partly)
    pressed = q;
  if (least < 0 && (use == AreaInUse::Penetrating || partly))
  {
    cutWhereNegative(partly ? pressed : q, c);
    if (!partly)
      part = areaAndCentroid(q);
    if (!(part.area > 0))
      return true;
    least = 0;
  }
  patch.area = part.area;
  patch.centroid = part.centroid;
  for (int f = 0; f < 2; ++f)
    map[f].weightsAt(part.centroid, map[f].product(map[f].straight(part.centroid)),
                     patch.centroidWeights[f]);
  if (weights == ContactOptions::Weights::Centroid)
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 4; ++k)
        patch.weights[f][k] = patch.centroidWeights[f][k];
  else
  {
    const ConvexPolygon& used = partly ? pressed : q;
    const bool uneven = byPressure && most - least > 1e-14 * std::sqrt(part.area);
    Vec2 center = part.centroid;
    Real centerClosure = 1;
    if (uneven)
    {
      if (partly)
        center = areaAndCentroid(used).centroid;
      centerClosure = field.at(map, center);
      centerClosure = centerClosure > 0 ? centerClosure : 0;
    }
    else
      for (int v = 0; v < used.size; ++v)
        c[v] = 1;
    weightsOver(map, used, c, center, centerClosure, !uneven || field.linear(), patch.weights);
  }
  return !map[0].lost && !map[1].lost;
}

/// For faces whose shadow is not convex or has no bilinear map: up to four pieces, weights and gaps
/// from affine weights of least norm.
KOKKOS_INLINE_FUNCTION Patch patchOfPieces(const Shadow& a, const Shadow& b,
                                           const ConvexPolygon& outlineA,
                                           const ConvexPolygon& outlineB, Real offset,
                                           AreaInUse use)
{
  Patch patch;
  const Pieces piecesA(outlineA), piecesB(outlineB);
  patch.folded = piecesA.count == 0 || piecesB.count == 0;
  Vec2 moment;
  for (int i = 0; i < piecesA.count; ++i)
    for (int j = 0; j < piecesB.count; ++j)
    {
      ConvexPolygon q = intersection(piecesA.polygon[i], piecesB.polygon[j]);
      AreaAndCentroid part = areaAndCentroid(q);
      if (!(part.area > 0))
        continue;
      patch.overlap += part.area;
      Real c[ConvexPolygon::capacity];
      for (int v = 0; v < q.size; ++v)
      {
        Real wa[4], wb[4];
        affineWeights(a, q.vertex[v], wa);
        affineWeights(b, q.vertex[v], wb);
        Real gap = -offset;
        for (int k = 0; k < b.count; ++k)
          gap += wb[k] * b.height[k];
        for (int k = 0; k < a.count; ++k)
          gap -= wa[k] * a.height[k];
        c[v] = -gap;
        patch.leastGap = gap < patch.leastGap ? gap : patch.leastGap;
      }
      if (use == AreaInUse::Penetrating)
      {
        cutWhereNegative(q, c);
        part = areaAndCentroid(q);
        if (!(part.area > 0))
          continue;
      }
      patch.area += part.area;
      moment = moment + part.area * part.centroid;
    }
  if (!(patch.area > 0) || (use != AreaInUse::Bonded && !(patch.leastGap < 0)))
  {
    patch.area = 0;
    return patch;
  }
  patch.centroid = (1 / patch.area) * moment;
  const Shadow* shadows[2] = {&a, &b};
  for (int f = 0; f < 2; ++f)
  {
    affineWeights(*shadows[f], patch.centroid, patch.centroidWeights[f]);
    for (int k = 0; k < 4; ++k)
      patch.weights[f][k] = patch.centroidWeights[f][k];
  }
  return patch;
}
} // namespace detail

/// Step D: area shared by the shadows, or the part of it that is in use. With it, where force acts
/// (weights of the nodes): sums of the weights are 1 and they reproduce one and the same in-plane
/// point for both faces.
template <int Dim>
KOKKOS_INLINE_FUNCTION Patch stepD_areaOfContact(const Shadow& a, const Shadow& b, Real offset,
                                                 AreaInUse use, ContactOptions::Weights weights,
                                                 const Depth& depth = {})
{
  if constexpr (Dim == 2)
    return detail::patchOfSegments(a, b, offset, use, weights == ContactOptions::Weights::Pressure,
                                   depth);
  else
  {
    const ConvexPolygon outlineA = detail::outline(a, false), outlineB = detail::outline(b, true);
    Patch patch;
    if (!isConvex(outlineA.vertex, outlineA.size) || !isConvex(outlineB.vertex, outlineB.size) ||
        !detail::patchOfPolygons(a, b, outlineA, outlineB, offset, use, weights, patch))
      patch = detail::patchOfPieces(a, b, outlineA, outlineB, offset, use);
    return patch;
  }
}

/// What a plane's lengths are to be multiplied with.
KOKKOS_INLINE_FUNCTION Depth depthOf(const TrialPlane& plane, const ContactOptions& options)
{
  return options.axisymmetric ? Depth{2 * pi * plane.point.x, 2 * pi * plane.e1.x} : Depth{};
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
