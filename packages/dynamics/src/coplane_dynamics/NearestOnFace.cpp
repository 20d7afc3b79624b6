#include <coplane_dynamics/detail/NearestOnFace.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
NearestOnFace with(int corners, const Vec3* c, const Vec3& x, const std::array<Real, 4>& weights)
{
  NearestOnFace found;
  found.weights = weights;
  for (int k = 0; k < corners; ++k)
    found.way += weights[std::size_t(k)] * (c[k] - x);
  return found;
}

/// Place of the foot of x on the line from a to b, within its ends; 0 at a, 1 at b.
Real footOnSegment(const Vec3& a, const Vec3& b, const Vec3& x)
{
  const Vec3 along = b - a;
  const Real square = dot(along, along);
  return square > 0 ? std::clamp(dot(x - a, along) / square, Real(0), Real(1)) : Real(0);
}

NearestOnFace onTriangle(const Vec3* c, const Vec3& x)
{
  const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
  const Real square = dot(normal, normal);
  std::array<Real, 4> weights{};
  bool within = square > 0;
  for (std::size_t k = 0; k < 3 && within; ++k)
  {
    weights[k] = dot(cross(c[(k + 1) % 3] - x, c[(k + 2) % 3] - x), normal) / square;
    within = weights[k] >= 0;
  }
  if (within)
    return with(3, c, x, weights);
  NearestOnFace best;
  Real least = infinity;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const std::size_t next = (k + 1) % 3;
    const Real t = footOnSegment(c[k], c[next], x);
    weights = {};
    weights[k] = 1 - t;
    weights[next] = t;
    const NearestOnFace here = with(3, c, x, weights);
    if (dot(here.way, here.way) < least)
    {
      least = dot(here.way, here.way);
      best = here;
    }
  }
  return best;
}

/// Newton's method for the square of the distance, in the square of natural coordinates: a
/// coordinate at its bound that wants to go beyond is left there.
NearestOnFace onBilinear(const Vec3* c, const Vec3& x)
{
  constexpr int mostSteps = 40;
  constexpr Real roundOff = 1e-15;
  constexpr Real signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  Real xi[2] = {0, 0};
  std::array<Real, 4> weights{};
  const auto weigh = [&]
  {
    for (std::size_t k = 0; k < 4; ++k)
      weights[k] = 0.25 * (1 + signs[k][0] * xi[0]) * (1 + signs[k][1] * xi[1]);
  };
  for (int step = 0; step < mostSteps; ++step)
  {
    weigh();
    Vec3 way{}, slope[2] = {{}, {}}, twist{};
    for (std::size_t k = 0; k < 4; ++k)
    {
      way += weights[k] * (c[k] - x);
      slope[0] += (0.25 * signs[k][0] * (1 + signs[k][1] * xi[1])) * c[k];
      slope[1] += (0.25 * signs[k][1] * (1 + signs[k][0] * xi[0])) * c[k];
      twist += (0.25 * signs[k][0] * signs[k][1]) * c[k];
    }
    const Real g[2] = {dot(way, slope[0]), dot(way, slope[1])};
    const Real a = dot(slope[0], slope[0]), b = dot(slope[1], slope[1]);
    Real mixed = dot(slope[0], slope[1]) + dot(way, twist);
    if (!(a * b > mixed * mixed))
      mixed = dot(slope[0], slope[1]); // far off a twisted face
    const auto held = [&](int i)
    { return (xi[i] >= 1 && g[i] <= 0) || (xi[i] <= -1 && g[i] >= 0); };
    Real change[2] = {0, 0};
    if (held(0) && held(1))
      break;
    if (held(0))
      change[1] = -g[1] / b;
    else if (held(1))
      change[0] = -g[0] / a;
    else
    {
      const Real determinant = a * b - mixed * mixed;
      change[0] = -(g[0] * b - g[1] * mixed) / determinant;
      change[1] = -(g[1] * a - g[0] * mixed) / determinant;
    }
    if (!std::isfinite(change[0]) || !std::isfinite(change[1]))
      break; // a face without area: from its middle, or from where it is
    Real most = 0;
    for (int i = 0; i < 2; ++i)
    {
      const Real next = std::clamp(xi[i] + change[i], Real(-1), Real(1));
      most = std::max(most, std::abs(next - xi[i]));
      xi[i] = next;
    }
    if (most < roundOff)
      break;
  }
  weigh();
  return with(4, c, x, weights);
}
} // namespace

NearestOnFace nearestOnFace(int corners, const Vec3* c, const Vec3& x)
{
  if (corners == 2)
  {
    const Real t = footOnSegment(c[0], c[1], x);
    return with(2, c, x, {1 - t, t, 0, 0});
  }
  return corners == 3 ? onTriangle(c, x) : onBilinear(c, x);
}
} // namespace coplane
