#include <coplane_element/LogarithmicStrain.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace coplane
{
namespace
{
/// Derivatives of the shape functions along the natural coordinates at the middle, of an element
/// of size 1 (triangles, tetrahedra) or 2.
Vec3 slopeAtMiddle(ElementType type, int corner)
{
  static constexpr std::array<Vec3, 8> corners{{{-1, -1, -1},
                                                {1, -1, -1},
                                                {1, 1, -1},
                                                {-1, 1, -1},
                                                {-1, -1, 1},
                                                {1, -1, 1},
                                                {1, 1, 1},
                                                {-1, 1, 1}}};
  const ElementTopology& shape = topology(type);
  const std::size_t k = std::size_t(corner);
  if (shape.nodes == shape.dimension + 1)
  {
    Vec3 slope{corner == 0 ? -1.0 : 0, corner == 0 ? -1.0 : 0, corner == 0 ? -1.0 : 0};
    if (corner > 0)
      slope[corner - 1] = 1;
    return slope;
  }
  return (shape.dimension == 2 ? 0.25 : 0.125) * corners[k];
}

/// A symmetric matrix is turned until it is diagonal (Jacobi): columns of `axes` are its
/// eigenvectors then.
void diagonalise(Mat3& matrix, Mat3& axes)
{
  constexpr int mostSweeps = 20; // five are enough
  axes = {};
  for (int i = 0; i < 3; ++i)
    axes(i, i) = 1;
  for (int sweep = 0; sweep < mostSweeps; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q)
      {
        if (matrix(p, q) == 0)
          continue;
        const Real ratio = (matrix(q, q) - matrix(p, p)) / (2 * matrix(p, q));
        const Real tangent =
            (ratio >= 0 ? 1 : -1) / (std::abs(ratio) + std::sqrt(1 + ratio * ratio));
        const Real cosine = 1 / std::sqrt(1 + tangent * tangent);
        const Real sine = tangent * cosine;
        for (int k = 0; k < 3; ++k)
        {
          const Real left = matrix(k, p), right = matrix(k, q);
          matrix(k, p) = cosine * left - sine * right;
          matrix(k, q) = sine * left + cosine * right;
        }
        for (int k = 0; k < 3; ++k)
        {
          const Real upper = matrix(p, k), lower = matrix(q, k);
          matrix(p, k) = cosine * upper - sine * lower;
          matrix(q, k) = sine * upper + cosine * lower;
          const Real left = axes(k, p), right = axes(k, q);
          axes(k, p) = cosine * left - sine * right;
          axes(k, q) = sine * left + cosine * right;
        }
      }
}

Real meanRadius(const Vec3* corners, int count)
{
  Real sum = 0;
  for (int k = 0; k < count; ++k)
    sum += corners[k].x;
  return sum / count;
}
} // namespace

SymTensor logarithmicStrain(ElementType type, const Vec3* reference, const Vec3* present,
                            bool revolved)
{
  const int count = topology(type).nodes, dimension = topology(type).dimension;
  // Columns: derivatives of the reference place, and of the displacement, along the natural
  // coordinates.
  Mat3 map, moved;
  for (int k = 0; k < count; ++k)
  {
    const Vec3 slope = slopeAtMiddle(type, k);
    for (int a = 0; a < dimension; ++a)
      for (int i = 0; i < dimension; ++i)
      {
        map(i, a) += slope[a] * reference[k][i];
        moved(i, a) += slope[a] * (present[k][i] - reference[k][i]);
      }
  }
  if (dimension == 2)
    map(2, 2) = 1;
  Mat3 gradient = moved * inverse(map); // of the displacement: F - 1
  if (revolved)
  {
    const Real radius = meanRadius(reference, count);
    gradient(2, 2) = (meanRadius(present, count) - radius) / radius;
  }
  // V^2 - 1 = F F^T - 1 from the displacement, so that small strains keep their digits.
  Mat3 square;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      square(i, j) = gradient(i, j) + gradient(j, i);
      for (int k = 0; k < 3; ++k)
        square(i, j) += gradient(i, k) * gradient(j, k);
    }
  Mat3 axes;
  diagonalise(square, axes);
  const bool hasInverse =
      determinant(map) > 0 && square(0, 0) > -1 && square(1, 1) > -1 && square(2, 2) > -1;
  Mat3 strain;
  for (int p = 0; p < 3; ++p)
  {
    const Real stretch =
        hasInverse ? 0.5 * std::log1p(square(p, p)) : std::numeric_limits<Real>::quiet_NaN();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        strain(i, j) += stretch * axes(i, p) * axes(j, p);
  }
  return {strain(0, 0), strain(1, 1), strain(2, 2), strain(0, 1), strain(1, 2), strain(2, 0)};
}
} // namespace coplane
