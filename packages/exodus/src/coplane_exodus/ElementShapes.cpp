#include <coplane_exodus/MeshReport.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
Real elementVolume(ElementType type, const std::array<Vec3, 8>& c)
{
  if (type == ElementType::Tri3)
    return 0.5 * ((c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y));
  if (type == ElementType::Tet4)
    return dot(cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]) / 6;
  if (type == ElementType::Quad4)
    return 0.5 * ((c[2].x - c[0].x) * (c[3].y - c[1].y) + (c[1].x - c[3].x) * (c[2].y - c[0].y));
  // V = sum_I x_I B_I, with B_1 of Flanagan & Belytschko 1981 and their index permutations for the
  // other nodes.
  static const int order[8][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {1, 2, 3, 0, 5, 6, 7, 4},
                                  {2, 3, 0, 1, 6, 7, 4, 5}, {3, 0, 1, 2, 7, 4, 5, 6},
                                  {4, 7, 6, 5, 0, 3, 2, 1}, {5, 4, 7, 6, 1, 0, 3, 2},
                                  {6, 5, 4, 7, 2, 1, 0, 3}, {7, 6, 5, 4, 3, 2, 1, 0}};
  // Positions relative to the first corner: a small element far from the origin loses no digits.
  Vec3 p[8];
  for (int i = 0; i < 8; ++i)
    p[i] = c[i] - c[0];
  Real volume = 0;
  for (const auto& o : order)
  {
    const auto y = [&](int i) { return p[o[i - 1]].y; };
    const auto z = [&](int i) { return p[o[i - 1]].z; };
    const Real b = y(2) * ((z(6) - z(3)) - (z(4) - z(5))) + y(3) * (z(2) - z(4)) +
                   y(4) * ((z(3) - z(8)) - (z(5) - z(2))) + y(5) * ((z(8) - z(6)) - (z(2) - z(4))) +
                   y(6) * (z(5) - z(2)) + y(8) * (z(4) - z(5));
    volume += p[o[0]].x * b / 12;
  }
  return volume;
}

Real elementQuality(ElementType type, const std::array<Vec3, 8>& c)
{
  // For every corner the ends of its edges, right-handed.
  static const int ends[4][8][3] = {
      {{1, 2, 0}, {2, 0, 0}, {0, 1, 0}},
      {{1, 3, 0}, {2, 0, 0}, {3, 1, 0}, {0, 2, 0}},
      {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}},
      {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};
  // Equilateral triangle: sin 60 degrees; regular tetrahedron: 1 / sqrt(2).
  const int row = type == ElementType::Tri3    ? 0
                  : type == ElementType::Quad4 ? 1
                  : type == ElementType::Tet4  ? 2
                                               : 3;
  const Real ideal[] = {std::sqrt(0.75), 1.0, std::sqrt(0.5), 1.0};
  const ElementTopology& shape = topology(type);
  Real least = infinity;
  for (int k = 0; k < shape.nodes; ++k)
  {
    const int* end = ends[row][k];
    const Vec3 a = c[end[0]] - c[k], b = c[end[1]] - c[k];
    const Vec3 up = shape.dimension == 2 ? Vec3{0, 0, 1} : c[end[2]] - c[k];
    const Real product = norm(a) * norm(b) * norm(up);
    least = std::min(least, product > 0 ? dot(cross(a, b), up) / product : 0.0);
  }
  return least / ideal[row];
}
} // namespace coplane
