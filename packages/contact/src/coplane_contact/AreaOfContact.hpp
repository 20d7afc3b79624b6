#pragma once

#include <coplane_contact/Plane.hpp>
#include <coplane_core/Lanes.hpp>
#include <coplane_geometry/ConvexPolygon.hpp>
#include <coplane_geometry/FaceMap.hpp>

#include <cmath>

namespace coplane
{
/// A face projected on the plane: in-plane coordinates and heights of its nodes.
struct Shadow
{
  int count = 0;
  Vec2 p[4];
  Real height[4]; ///< along the normal, from the trial point [m]
};

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
} // namespace coplane
