#pragma once

#include <coplane_geometry/FaceMap.hpp>
#include <coplane_geometry/PolygonSides.hpp>

// Weights of the nodes at the centre of pressure of a polygon: the integrals of step D. T is Real,
// or Lanes for several pairs side by side.

namespace coplane::detail
{
/// Integrals over a polygon of a function that is linear in the triangles from a point, the apex,
/// to its sides: of itself, and times the coordinates relative to the apex, and their products.
/// Exact.
template <class T>
struct Moments
{
  T total{};
  Vec2Of<T> first;
  T xx{}, xy{}, yy{};

  KOKKOS_FORCEINLINE_FUNCTION void add(const Vec2Of<T>& a, const Vec2Of<T>& b, const T& c0,
                                       const T& ca, const T& cb)
  {
    const T area = 0.5 * cross(a, b);
    const T sum = c0 + ca + cb;
    const Vec2Of<T> both = a + b;
    const Vec2Of<T> weighted = ca * a + cb * b;
    total += area / 3.0 * sum;
    first = first + (area / 12.0) * (sum * both + weighted);
    const T w = area / 60.0;
    xx += w * (sum * (both.x * both.x + (a.x * a.x + b.x * b.x)) + 2.0 * both.x * weighted.x +
               2.0 * (ca * a.x * a.x + cb * b.x * b.x));
    yy += w * (sum * (both.y * both.y + (a.y * a.y + b.y * b.y)) + 2.0 * both.y * weighted.y +
               2.0 * (ca * a.y * a.y + cb * b.y * b.y));
    xy += w * (sum * (both.x * both.y + (a.x * a.y + b.x * b.y)) + both.x * weighted.y +
               both.y * weighted.x + 2.0 * (ca * a.x * a.y + cb * b.x * b.y));
  }
};

/// Integral of the small difference between xi eta and the product of the straight coordinates,
/// times a function that is linear in the triangle (apex, apex + a, apex + b) with the values c0,
/// ca and cb: by a rule of degree 3.
template <class T>
KOKKOS_INLINE_FUNCTION T differenceOver(const FaceMapOf<T>& map, const Vec2Of<T>& apex,
                                        const Vec2Of<T>& a, const Vec2Of<T>& b, const T& c0,
                                        const T& ca, const T& cb)
{
  using namespace branchFree;
  const T factor = 0.5 * cross(a, b) / 48.0;
  const auto wanted = factor != 0.0 && !map.affine;
  const T sum = c0 + ca + cb;
  const Vec2Of<T> start = map.straight(apex);
  const Vec2Of<T> alongA{dot(map.gradXi, a), dot(map.gradEta, a)};
  const Vec2Of<T> alongB{dot(map.gradXi, b), dot(map.gradEta, b)};
  const auto difference = [&](Real shareA, Real shareB)
  {
    const Vec2Of<T> s = start + (shareA * alongA + shareB * alongB);
    const T q = s.x * s.y;
    const T half = 1.0 + map.alpha * s.y + map.beta * s.x;
    const T discriminant = half * half - 4.0 * (map.alpha * map.beta) * q;
    const T denominator = half + squareRoot(positivePart(discriminant));
    const auto found = denominator > 1e-14;
    map.lost = map.lost || (wanted && !found);
    return choose(found, 2.0 * q / denominator - q, T(0.0));
  };
  return factor * (25.0 * ((0.2 * sum + 0.4 * c0) * difference(0.2, 0.2) +
                           (0.2 * sum + 0.4 * ca) * difference(0.6, 0.2) +
                           (0.2 * sum + 0.4 * cb) * difference(0.2, 0.6)) -
                   27.0 * (sum / 3.0 * difference(1.0 / 3, 1.0 / 3)));
}

/// Weights of the pair's nodes at the centre of pressure, c at the ends of the sides, or at the
/// mean of the shape functions over the polygon (c = 1 there). Parallelograms: polygon moments in
/// closed form. Other quadrilaterals: with differenceOver(). All triangles start from the center; a
/// vertex would make the result depend on the node that the face happens to start from.
template <class T>
KOKKOS_INLINE_FUNCTION void weightsOver(const FaceMapOf<T> (&map)[2], const PolygonSides<T>& q,
                                        const T* cFrom, const T* cTo, const Vec2Of<T>& center,
                                        const T& centerClosure, T (&weights)[2][4])
{
  using namespace branchFree;
  Moments<T> moments;
  for (int k = 0; k < q.size; ++k)
    moments.add(q.from[k] - center, q.to[k] - center, centerClosure, cFrom[k], cTo[k]);
  const T inverse = 1.0 / moments.total;
  const Vec2Of<T> mean = inverse * moments.first;
  for (int f = 0; f < 2; ++f)
  {
    const FaceMapOf<T>& m = map[f];
    T xiEta{};
    if (m.nodes == 4)
    {
      T difference{};
      if (!allOf(m.affine))
        for (int k = 0; k < q.size; ++k)
          difference += differenceOver(m, center, q.from[k] - center, q.to[k] - center,
                                       centerClosure, cFrom[k], cTo[k]);
      const Vec2Of<T> s = m.straight(center);
      const Vec2Of<T>&gx = m.gradXi, &gy = m.gradEta;
      xiEta = s.x * s.y + s.x * dot(gy, mean) + s.y * dot(gx, mean) +
              inverse * (gx.x * gy.x * moments.xx + (gx.x * gy.y + gx.y * gy.x) * moments.xy +
                         gx.y * gy.y * moments.yy + choose(m.affine, T(0.0), difference));
    }
    m.weightsAt(center + mean, xiEta, weights[f]);
  }
}
} // namespace coplane::detail
