#include <coplane_mesh/PointInElement.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
PointInElement inSimplex(int corners, const Vec3* c, const Vec3& x)
{
  PointInElement found;
  Real sum = 0;
  if (corners == 3)
    for (int k = 0; k < 3; ++k)
    {
      found.weights[std::size_t(k)] = cross(c[(k + 1) % 3] - x, c[(k + 2) % 3] - x).z;
      sum += found.weights[std::size_t(k)];
    }
  else
    for (int k = 0; k < 4; ++k)
    {
      // The volume with x in the place of corner k.
      Vec3 p[4] = {c[0], c[1], c[2], c[3]};
      p[k] = x;
      found.weights[std::size_t(k)] = dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0]));
      sum += found.weights[std::size_t(k)];
    }
  found.outside = -infinity;
  for (int k = 0; k < corners; ++k)
  {
    found.weights[std::size_t(k)] /= sum;
    found.outside = std::max(found.outside, -found.weights[std::size_t(k)]);
  }
  if (!std::isfinite(found.outside))
    found.outside = infinity;
  return found;
}

constexpr Real signs[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                              {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

/// Factor of corner k along an axis, and its derivative.
Real factor(int k, int axis, Real xi)
{
  return 0.5 * (1 + signs[k][axis] * xi);
}
Real slope(int k, int axis)
{
  return 0.5 * signs[k][axis];
}

PointInElement inBrick(int dimension, const Vec3* c, const Vec3& x)
{
  constexpr int mostSteps = 50;
  constexpr Real roundOff = 1e-14;
  const int corners = dimension == 2 ? 4 : 8;
  Real xi[3] = {0, 0, 0};
  PointInElement found;
  for (int step = 0; step < mostSteps; ++step)
  {
    Vec3 miss{}; // all places relative to x, so that those far from the origin are not rounded
    Mat3 map;    // columns: derivatives of the place along the natural coordinates
    map(2, 2) = dimension == 2 ? 1 : 0;
    for (int k = 0; k < corners; ++k)
    {
      Real weight = 1;
      for (int a = 0; a < dimension; ++a)
        weight *= factor(k, a, xi[a]);
      found.weights[std::size_t(k)] = weight;
      const Vec3 corner = c[k] - x;
      miss -= weight * corner;
      for (int a = 0; a < dimension; ++a)
      {
        Real change = slope(k, a);
        for (int b = 0; b < dimension; ++b)
          if (b != a)
            change *= factor(k, b, xi[b]);
        for (int i = 0; i < dimension; ++i)
          map(i, a) += change * corner[i];
      }
    }
    if (dimension == 2)
      miss.z = 0;
    const Vec3 way = inverse(map) * miss;
    Real most = 0;
    for (int a = 0; a < dimension; ++a)
    {
      xi[a] += way[a];
      most = std::max(most, std::abs(way[a]));
    }
    if (!std::isfinite(most) || most > 1e3)
      break;
    if (most < roundOff || (step > 8 && most < 1e-10)) // round-off in oblique elements
    {
      found.outside = -infinity;
      for (int a = 0; a < dimension; ++a)
        found.outside = std::max(found.outside, std::abs(xi[a]) - 1);
      return found;
    }
  }
  found.outside = infinity;
  return found;
}
} // namespace

PointInElement pointInElement(ElementType type, const Vec3* corners, const Vec3& x)
{
  const ElementTopology& shape = topology(type);
  return shape.nodes == shape.dimension + 1 ? inSimplex(shape.nodes, corners, x)
                                            : inBrick(shape.dimension, corners, x);
}
} // namespace coplane
