#include <coplane_core/Vec3.hpp>
#include <coplane_element/detail/MeanGradient.hpp>

#include <gtest/gtest.h>

#include <random>

using namespace coplane;

namespace
{
template <ElementType type>
struct Element
{
  using M = Modes<type>;
  Real corner[3][M::nodes];

  explicit Element(unsigned seed)
  {
    static const int order[][8] = {
        {0, 1, 2}, {0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 2, 3, 4, 5, 6, 7}}; // corners of the cube
    const Real xi[] = {-1, 1, 1, -1, -1, 1, 1, -1}, eta[] = {-1, -1, 1, 1, -1, -1, 1, 1};
    std::mt19937 random(seed);
    std::uniform_real_distribution<Real> push(-0.3, 0.3);
    for (int c = 0; c < M::nodes; ++c)
    {
      const int of = order[int(type)][c];
      corner[0][c] = xi[of] + push(random);
      corner[1][c] = eta[of] + push(random);
      corner[2][c] = (of < 4 ? -1 : 1) + push(random);
    }
  }
  Real volume() const
  {
    Real modes[M::dimension][M::count], b[M::dimension][M::gradients];
    gradient(modes, b);
    return M::volume(modes, b);
  }
  void gradient(Real (&modes)[M::dimension][M::count], Real (&b)[M::dimension][M::gradients]) const
  {
    for (int i = 0; i < M::dimension; ++i)
    {
      Real u[M::nodes];
      std::copy(corner[i], corner[i] + M::nodes, u);
      M::fromCorners(u, modes[i]);
    }
    M::volumeGradient(modes, b);
  }
};

template <ElementType type>
void expectGradientOfVolume()
{
  using M = Modes<type>;
  for (unsigned seed = 0; seed < 5; ++seed)
  {
    Element<type> element(seed);
    Real modes[M::dimension][M::count], b[M::dimension][M::gradients];
    element.gradient(modes, b);
    for (int i = 0; i < M::dimension; ++i)
    {
      Real padded[M::count] = {}, corner[M::nodes];
      std::copy(b[i], b[i] + M::gradients, padded);
      M::toCorners(padded, corner);
      for (int c = 0; c < M::nodes; ++c)
      {
        // The volume is linear in each coordinate: a central difference has no error but rounding.
        Element<type> up = element, down = element;
        up.corner[i][c] += 0.01;
        down.corner[i][c] -= 0.01;
        EXPECT_NEAR(corner[c], (up.volume() - down.volume()) / 0.02, 1e-11);
      }
    }
  }
}

template <ElementType type>
void expectModesAndCornersToBeInverse()
{
  using M = Modes<type>;
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> number(-1, 1);
  Real modes[M::count], corner[M::nodes], again[M::count];
  for (Real& mode : modes)
    mode = number(random);
  M::toCorners(modes, corner);
  M::fromCorners(corner, again);
  for (int k = 0; k < M::count; ++k)
    EXPECT_NEAR(again[k], modes[k], 1e-15);
}
} // namespace

TEST(MeanGradient, isTheDerivativeOfTheVolumeOfATriangle)
{
  expectGradientOfVolume<ElementType::Tri3>();
}

TEST(MeanGradient, isTheDerivativeOfTheVolumeOfATetrahedron)
{
  expectGradientOfVolume<ElementType::Tet4>();
}

TEST(MeanGradient, isTheDerivativeOfTheVolumeOfAQuadrilateral)
{
  expectGradientOfVolume<ElementType::Quad4>();
}

TEST(MeanGradient, isTheDerivativeOfTheVolumeOfAHexahedron)
{
  expectGradientOfVolume<ElementType::Hex8>();
}

TEST(MeanGradient, ofAHexahedronHasTheFormulaOfFlanaganAndBelytschko)
{
  const Element<ElementType::Hex8> element(11);
  Real modes[3][7], b[3][6], padded[7] = {}, corner[8];
  element.gradient(modes, b);
  std::copy(b[0], b[0] + 6, padded);
  Modes<ElementType::Hex8>::toCorners(padded, corner);
  const auto y = [&](int node) { return element.corner[1][node - 1]; };
  const auto z = [&](int node) { return element.corner[2][node - 1]; };
  const Real expected =
      (y(2) * ((z(6) - z(3)) - (z(4) - z(5))) + y(3) * (z(2) - z(4)) +
       y(4) * ((z(3) - z(8)) - (z(5) - z(2))) + y(5) * ((z(8) - z(6)) - (z(2) - z(4))) +
       y(6) * (z(5) - z(2)) + y(8) * (z(4) - z(5))) /
      12;
  EXPECT_NEAR(corner[0], expected, 1e-14);
}

TEST(MeanGradient, cubeOfEdgeTwoHasVolumeEight)
{
  Element<ElementType::Hex8> cube(0);
  const Real xi[] = {-1, 1, 1, -1, -1, 1, 1, -1}, eta[] = {-1, -1, 1, 1, -1, -1, 1, 1};
  for (int c = 0; c < 8; ++c)
  {
    cube.corner[0][c] = xi[c];
    cube.corner[1][c] = eta[c];
    cube.corner[2][c] = c < 4 ? -1 : 1;
  }
  EXPECT_EQ(cube.volume(), 8);
}

TEST(MeanGradient, volumesOfTriangleAndTetrahedronAreThoseOfTheirEdges)
{
  const Element<ElementType::Tri3> triangle(4);
  const Element<ElementType::Tet4> tet(4);
  const auto edge = [](const auto& of, int c)
  {
    return Vec3{of.corner[0][c] - of.corner[0][0], of.corner[1][c] - of.corner[1][0],
                of.corner[2][c] - of.corner[2][0]};
  };
  EXPECT_NEAR(triangle.volume(), 0.5 * cross(edge(triangle, 1), edge(triangle, 2)).z, 1e-14);
  EXPECT_NEAR(tet.volume(), dot(cross(edge(tet, 1), edge(tet, 2)), edge(tet, 3)) / 6, 1e-14);
  EXPECT_GT(triangle.volume(), 0);
  EXPECT_GT(tet.volume(), 0);
}

TEST(MeanGradient, modesAndCornerValuesAreInverse)
{
  expectModesAndCornersToBeInverse<ElementType::Tri3>();
  expectModesAndCornersToBeInverse<ElementType::Tet4>();
  expectModesAndCornersToBeInverse<ElementType::Quad4>();
  expectModesAndCornersToBeInverse<ElementType::Hex8>();
}
