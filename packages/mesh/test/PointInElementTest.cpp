#include <coplane_mesh/PointInElement.hpp>

#include <gtest/gtest.h>

#include <random>

namespace coplane
{
namespace
{
struct Sample
{
  ElementType type;
  std::vector<Vec3> corners;
};

const std::vector<Sample>& samples()
{
  static const std::vector<Sample> all{
      {ElementType::Tri3, {{0, 0, 0}, {2, 0.1, 0}, {0.3, 1.5, 0}}},
      {ElementType::Quad4, {{0, 0, 0}, {2, 0.2, 0}, {1.7, 1.5, 0}, {-0.1, 1, 0}}},
      {ElementType::Tet4, {{0, 0, 0}, {2, 0.1, 0}, {0.3, 1.5, 0.2}, {0.4, 0.5, 1}}},
      {ElementType::Hex8,
       {{0, 0, 0},
        {2, 0.2, 0.1},
        {1.7, 1.5, 0},
        {-0.1, 1, -0.1},
        {0, 0.1, 1},
        {2.1, 0, 1.2},
        {1.9, 1.4, 1},
        {0, 1.2, 0.9}}}};
  return all;
}
} // namespace

TEST(PointInElement, givesBackTheWeightsThatMadeThePoint)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> number(0, 1);
  for (const Sample& sample : samples())
    for (int trial = 0; trial < 50; ++trial)
    {
      const int n = int(sample.corners.size());
      const bool simplex = n == topology(sample.type).dimension + 1;
      Real xi[3] = {number(random), number(random), number(random)};
      std::vector<Real> weights(std::size_t(n), 0);
      if (simplex)
      {
        Real sum = 0;
        for (Real& w : weights)
          sum += w = number(random);
        for (Real& w : weights)
          w /= sum;
      }
      else
        for (int k = 0; k < n; ++k)
        {
          const bool right = k % 4 == 1 || k % 4 == 2, back = k % 4 > 1, top = k > 3;
          weights[std::size_t(k)] = (right ? xi[0] : 1 - xi[0]) * (back ? xi[1] : 1 - xi[1]) *
                                    (n == 4 ? 1
                                     : top  ? xi[2]
                                            : 1 - xi[2]);
        }
      // A far away origin, as of coordinates of a survey.
      const Vec3 origin{1000, -500, n == 4 || n == 3 ? 0.0 : 200.0};
      std::vector<Vec3> corners;
      Vec3 x{};
      for (int k = 0; k < n; ++k)
      {
        corners.push_back(sample.corners[std::size_t(k)] + origin);
        x += weights[std::size_t(k)] * corners.back();
      }
      if (topology(sample.type).dimension == 2)
        for (Vec3& c : corners)
          c.z = 0;
      const PointInElement found = pointInElement(sample.type, corners.data(), x);
      EXPECT_LT(found.outside, 1e-9);
      for (int k = 0; k < n; ++k)
        EXPECT_NEAR(found.weights[std::size_t(k)], weights[std::size_t(k)], 1e-9);
    }
}

TEST(PointInElement, isFoundFarFromTheOrigin)
{
  // Coordinates of a national grid: their round-off is 1e-9 m.
  const Vec3 origin{4.5e6, -5.6e6, 0};
  for (const Sample& sample : samples())
  {
    std::vector<Vec3> corners;
    Vec3 x{};
    for (const Vec3& c : sample.corners)
    {
      corners.push_back(c + origin);
      x += (1.0 / Real(sample.corners.size())) * (corners.back() - origin);
    }
    const PointInElement found = pointInElement(sample.type, corners.data(), x + origin);
    EXPECT_LT(found.outside, 0);
    for (std::size_t k = 0; k < corners.size(); ++k)
      EXPECT_NEAR(found.weights[k], 1.0 / Real(corners.size()), 1e-8);
  }
}

TEST(PointInElement, saysHowFarAPointLiesOutside)
{
  const Vec3 square[] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  EXPECT_NEAR(pointInElement(ElementType::Quad4, square, {2.5, 1, 0}).outside, 0.5, 1e-12);
  EXPECT_NEAR(pointInElement(ElementType::Quad4, square, {1, 1, 0}).outside, -1, 1e-12);
  const Vec3 triangle[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_NEAR(pointInElement(ElementType::Tri3, triangle, {-0.25, 0.5, 0}).outside, 0.25, 1e-12);
  const Vec3 flat[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(pointInElement(ElementType::Tri3, flat, {1, 1, 0}).outside, infinity);
}
} // namespace coplane
