#pragma once

#include <coplane_core/Vec3.hpp>
#include <coplane_mesh/ElementTopology.hpp>

namespace coplane
{
/// Calls f(point, volume) for points of an element whose sum integrates second moments exactly; in
/// two dimensions of unit thickness.
/// @param x of its nodes [m]
template <class F>
void integrateSolid(ElementType type, const Vec3* x, F&& f)
{
  constexpr Real point[3] = {-0.77459666924148337704, 0, 0.77459666924148337704};
  constexpr Real weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  constexpr int xi[8] = {-1, 1, 1, -1, -1, 1, 1, -1}, eta[8] = {-1, -1, 1, 1, -1, -1, 1, 1},
                zeta[8] = {-1, -1, -1, -1, 1, 1, 1, 1};
  if (type == ElementType::Tri3)
  {
    // Midpoints of the sides: exact to the second degree.
    const Real area = 0.5 * cross(x[1] - x[0], x[2] - x[0]).z;
    for (int k = 0; k < 3; ++k)
      f(0.5 * (x[k] + x[(k + 1) % 3]), area / 3);
    return;
  }
  if (type == ElementType::Tet4)
  {
    // Four points, exact to the second degree (Keast 1986).
    constexpr Real a = 0.58541019662496845446, b = 0.13819660112501051518;
    const Real volume = dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6;
    const Vec3 sum = x[0] + x[1] + x[2] + x[3];
    for (int k = 0; k < 4; ++k)
      f((a - b) * x[k] + b * sum, volume / 4);
    return;
  }
  const bool flat = type == ElementType::Quad4;
  const int nodes = flat ? 4 : 8;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < (flat ? 1 : 3); ++k)
      {
        const Real p = point[i], q = point[j], r = flat ? -1 : point[k];
        Vec3 at{}, g[3]{};
        for (int n = 0; n < nodes; ++n)
        {
          const Real a = 0.5 * (1 + xi[n] * p), b = 0.5 * (1 + eta[n] * q),
                     c = 0.5 * (1 + zeta[n] * r);
          at += (a * b * c) * x[n];
          g[0] += (0.5 * xi[n] * b * c) * x[n];
          g[1] += (a * 0.5 * eta[n] * c) * x[n];
          g[2] += (a * b * 0.5 * zeta[n]) * x[n];
        }
        if (flat)
          f(at, weight[i] * weight[j] * cross(g[0], g[1]).z);
        else
          f(at, weight[i] * weight[j] * weight[k] * dot(cross(g[0], g[1]), g[2]));
      }
}

/// Moments of inertia from sum m r r^T: xx yy zz xy yz zx [kg m^2].
inline Mat3 inertiaFromMoments(const Real* s)
{
  Mat3 j;
  const Real trace = s[0] + s[1] + s[2];
  j(0, 0) = trace - s[0];
  j(1, 1) = trace - s[1];
  j(2, 2) = trace - s[2];
  j(0, 1) = j(1, 0) = -s[3];
  j(1, 2) = j(2, 1) = -s[4];
  j(2, 0) = j(0, 2) = -s[5];
  return j;
}
} // namespace coplane
