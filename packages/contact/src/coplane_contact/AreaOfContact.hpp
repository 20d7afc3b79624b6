#pragma once

#include <coplane_contact/Plane.hpp>
#include <coplane_contact/PressureWeights.hpp>
#include <coplane_geometry/AffineWeights.hpp>

#include <cmath>

namespace coplane
{
/// A face projected on the plane: in-plane coordinates and heights of its nodes.
template <class T>
struct ShadowOf
{
  int count = 0;
  Vec2Of<T> p[4];
  T height[4]; ///< along the normal, from the trial point [m]
};
using Shadow = ShadowOf<Real>;

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
template <class T>
struct PatchOf
{
  /// False in lanes where a shadow is not convex or has no bilinear map, or where round-off asks
  /// for the order of the sides: there the rest is void, and stepD_areaOfContact<Real> is needed.
  branchFree::MaskOf<T> regular{true};
  bool folded = false;          ///< a face is turned over: the pair is skipped
  T overlap{};                  ///< whole overlap of the shadows [m^2]
  T area{};                     ///< that carries traction [m^2]
  T leastGap = T(infinity);     ///< smallest local gap minus offset over the overlap [m]
  Vec2Of<T> centroid;           ///< of the area that carries traction
  T weights[2][4] = {};         ///< where force acts and slip is measured
  T centroidWeights[2][4] = {}; ///< where the closure is measured
};
using Patch = PatchOf<Real>;

namespace detail
{
/// The corners of a shadow counter-clockwise; that of the higher face is clockwise and gets
/// reversed.
template <class T>
struct Outline
{
  int count;
  Vec2Of<T> p[4];

  KOKKOS_INLINE_FUNCTION Outline(const ShadowOf<T>& shadow, bool reversed) : count(shadow.count)
  {
    for (int i = 0; i < count; ++i)
      p[i] = shadow.p[reversed ? count - 1 - i : i];
  }
  KOKKOS_INLINE_FUNCTION ConvexPolygon polygon() const
  {
    ConvexPolygon result;
    for (int i = 0; i < count; ++i)
      result.add(p[i]);
    return result;
  }
};

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

/// Where the pressure between two segments acts, as a place along the plane [m]: the closure is
/// linear between the ends of the part that is closed, and counts with the depth there.
/// @param lo, hi ends of that part [m]; closureLo, closureHi closures there [m], not both 0
KOKKOS_INLINE_FUNCTION Real centreOfPressure(Real lo, Real hi, Real closureLo, Real closureHi,
                                             const Depth& depth)
{
  Real first = closureLo + 2 * closureHi, total = 3 * (closureLo + closureHi);
  if (depth.slope != 0)
  {
    const Real d0 = depth.at(lo), d1 = depth.at(hi);
    first = closureLo * (d0 + d1) + closureHi * (d0 + 3 * d1);
    total = closureLo * (4 * d0 + 2 * d1) + closureHi * (2 * d0 + 4 * d1);
  }
  return lo + (hi - lo) * first / total;
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
      at = centreOfPressure(closedLo, closedHi, closureLo, closureHi, depth);
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
template <class T>
struct ClosureField
{
  T atOrigin{};
  Vec2Of<T> slope;
  T warp[2];
  branchFree::MaskOf<T> warped[2];

  KOKKOS_INLINE_FUNCTION ClosureField(const FaceMapOf<T> (&map)[2], const ShadowOf<T>& a,
                                      const ShadowOf<T>& b, const T& offset, const T& size)
      : atOrigin(offset)
  {
    const ShadowOf<T>* shadows[2] = {&a, &b};
    for (int f = 0; f < 2; ++f)
    {
      const FaceHeightsOf<T> h(map[f], shadows[f]->height);
      const Vec2Of<T> gradient = h.xi * map[f].gradXi + h.eta * map[f].gradEta;
      const Real sign = f == 0 ? 1 : -1;
      slope = slope + sign * gradient;
      atOrigin += sign * (h.mean - dot(gradient, map[f].origin));
      warp[f] = sign * h.warp;
      warped[f] = branchFree::absolute(h.warp) > 1e-14 * size;
    }
  }

  /// @param wanted where nobody wants it, a point without coordinates does no harm
  KOKKOS_FORCEINLINE_FUNCTION T at(const FaceMapOf<T> (&map)[2], const Vec2Of<T>& p,
                                   const branchFree::MaskOf<T>& wanted) const
  {
    using namespace branchFree;
    T c = atOrigin + dot(slope, p);
    for (int f = 0; f < 2; ++f)
    {
      const auto bent = warped[f] && wanted;
      if (anyOf(bent))
        c = choose(bent, c + warp[f] * map[f].product(map[f].straight(p), bent), c);
    }
    return c;
  }
};

/// The overlap of two convex outlines.
/// @param inOrder keep the sides in order; T is Real
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void overlapOf(const Outline<T>& a, const Outline<T>& b, bool inOrder,
                                           PolygonSides<T>& q)
{
  if constexpr (branchFree::widthOf<T> == 1)
    if (inOrder)
    {
      q = sidesOf(intersection(a.polygon(), b.polygon()));
      return;
    }
  intersect(a.p, a.count, b.p, b.count, q);
}

/// Closures at both ends of the sides of a polygon, and their extremes.
template <class T>
struct ClosuresOf
{
  T from[PolygonSides<T>::capacity], to[PolygonSides<T>::capacity];
  T least = T(infinity), most = T(-infinity);

  KOKKOS_FORCEINLINE_FUNCTION ClosuresOf(const ClosureField<T>& field, const FaceMapOf<T> (&map)[2],
                                         const PolygonSides<T>& q)
  {
    using namespace branchFree;
    for (int k = 0; k < q.size; ++k)
    {
      const auto isThere = q.isThere(k);
      from[k] = field.at(map, q.from[k], isThere);
      to[k] = field.at(map, q.to[k], isThere);
      least = choose(isThere, smaller(from[k], least), least);
      most = choose(isThere, larger(from[k], most), most);
    }
  }

  /// 1 in the lanes where the closures do not count.
  KOKKOS_FORCEINLINE_FUNCTION void keepWhere(const branchFree::MaskOf<T>& they, int size)
  {
    const T one(1.0);
    for (int k = 0; k < size; ++k)
    {
      from[k] = branchFree::choose(they, from[k], one);
      to[k] = branchFree::choose(they, to[k], one);
    }
  }
};

/// Cuts off what is open. @returns area and centre of gravity of the rest
template <class T>
KOKKOS_FORCEINLINE_FUNCTION AreaAndCentroidOf<T> cutOpenPart(PolygonSides<T>& q, ClosuresOf<T>& c,
                                                             bool inOrder, PatchOf<T>& patch)
{
  if constexpr (branchFree::widthOf<T> == 1)
    inOrder ? cutInOrder(q, c.from, c.to) : cutWhereNegative(q, c.from, c.to);
  else
    cutWhereNegative(q, c.from, c.to);
  patch.regular = patch.regular && !q.crossed;
  return areaAndCentroid(q);
}

/// Weights where the force acts: at the centre of gravity of the patch, or of the pressure on it.
/// @param pressed area and centre of gravity of q, where the pressure is
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void
weightsOfForce(const FaceMapOf<T> (&map)[2], const ClosureField<T>& field, const PolygonSides<T>& q,
               ClosuresOf<T>& c, const AreaAndCentroidOf<T>& pressed,
               const branchFree::MaskOf<T>& bonded, const branchFree::MaskOf<T>& used,
               ContactOptions::Weights weights, PatchOf<T>& patch)
{
  using namespace branchFree;
  if (weights == ContactOptions::Weights::Centroid)
  {
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 4; ++k)
        patch.weights[f][k] = patch.centroidWeights[f][k];
    return;
  }
  const auto uneven = MaskOf<T>(weights == ContactOptions::Weights::Pressure) && !bonded &&
                      c.most - positivePart(c.least) > 1e-14 * squareRoot(patch.area);
  const T centerClosure =
      choose(uneven, positivePart(field.at(map, pressed.centroid, uneven && used)), T(1.0));
  c.keepWhere(uneven, q.size);
  weightsOver(map, q, c.from, c.to, pressed.centroid, centerClosure, patch.weights);
}

/// For convex shadows whose maps can be inverted, which is nearly all; where they cannot, or where
/// only the order of the sides tells what a cut leaves, the patch is not regular.
/// @param bonded the plane's joint holds: the whole overlap carries
/// @param inOrder keep the sides in order; T is Real
template <class T>
KOKKOS_INLINE_FUNCTION void
patchOfPolygons(const ShadowOf<T>& a, const ShadowOf<T>& b, const T& offset,
                const branchFree::MaskOf<T>& bonded, ContactOptions::Area areaInUse,
                ContactOptions::Weights weights, bool inOrder, PatchOf<T>& patch)
{
  using namespace branchFree;
  const Outline<T> outlineA(a, false), outlineB(b, true);
  patch.regular = isConvex(outlineA.p, a.count) && isConvex(outlineB.p, b.count);
  if (!anyOf(patch.regular))
    return;
  PolygonSides<T> q;
  overlapOf(outlineA, outlineB, inOrder, q);
  patch.regular = patch.regular && !q.crossed;
  AreaAndCentroidOf<T> part = areaAndCentroid(q);
  const auto overlaps = part.area > 0.0;
  if (!anyOf(overlaps))
    return;
  patch.overlap = positivePart(part.area);
  const FaceMapOf<T> map[2] = {FaceMapOf<T>(a.p, a.count), FaceMapOf<T>(b.p, b.count)};
  const ClosureField<T> field(map, a, b, offset, squareRoot(patch.overlap));
  ClosuresOf<T> closures(field, map, q);
  patch.leastGap = choose(overlaps, -closures.most, patch.leastGap);
  patch.regular = patch.regular && !map[0].lost && !map[1].lost;
  const auto carries = overlaps && (bonded || closures.most > 0.0);
  if (!anyOf(carries))
    return;

  const bool penetrating = areaInUse == ContactOptions::Area::Penetrating;
  AreaAndCentroidOf<T> pressed = part;
  if (penetrating || weights == ContactOptions::Weights::Pressure)
  {
    closures.keepWhere(!bonded, q.size);
    if (anyOf(closures.least < 0.0 && !bonded))
      pressed = cutOpenPart(q, closures, inOrder, patch);
    if (penetrating)
      part = pressed;
  }
  patch.area = choose(carries, positivePart(part.area), T(0.0));
  patch.centroid = part.centroid;
  const auto used = patch.area > 0.0;
  if (!anyOf(used))
    return;
  for (int f = 0; f < 2; ++f)
    map[f].weightsAt(part.centroid, map[f].product(map[f].straight(part.centroid), used),
                     patch.centroidWeights[f]);
  weightsOfForce(map, field, q, closures, pressed, bonded, used, weights, patch);
  patch.regular = patch.regular && (!used || (!map[0].lost && !map[1].lost));
}

/// For faces whose shadow is not convex or has no bilinear map: up to four pieces, weights and gaps
/// from affine weights of least norm.
KOKKOS_INLINE_FUNCTION Patch patchOfPieces(const Shadow& a, const Shadow& b, Real offset,
                                           AreaInUse use)
{
  Patch patch;
  const Pieces piecesA(Outline(a, false).polygon()), piecesB(Outline(b, true).polygon());
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
        affineWeights(a.p, a.count, q.vertex[v], wa);
        affineWeights(b.p, b.count, q.vertex[v], wb);
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
    affineWeights(shadows[f]->p, shadows[f]->count, patch.centroid, patch.centroidWeights[f]);
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
    const bool bonded = use == AreaInUse::Bonded;
    const auto area =
        use == AreaInUse::Full ? ContactOptions::Area::Full : ContactOptions::Area::Penetrating;
    for (const bool inOrder : {false, true})
    {
      Patch patch;
      detail::patchOfPolygons<Real>(a, b, offset, bonded, area, weights, inOrder, patch);
      if (patch.regular)
        return patch;
    }
    return detail::patchOfPieces(a, b, offset, use);
  }
}

/// Step D for several pairs of quadrilaterals or triangles side by side; whether a joint is bonded
/// is the pair's own.
inline PatchOf<Lanes> stepD_areaOfContact(const ShadowOf<Lanes>& a, const ShadowOf<Lanes>& b,
                                          const Lanes& offset, const LaneMask& bonded,
                                          ContactOptions::Area area,
                                          ContactOptions::Weights weights)
{
  PatchOf<Lanes> patch;
  detail::patchOfPolygons<Lanes>(a, b, offset, bonded, area, weights, false, patch);
  return patch;
}
} // namespace coplane
