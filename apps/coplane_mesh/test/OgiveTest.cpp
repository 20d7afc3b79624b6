#include "Ogive.hpp"

#include "MakeMesh.hpp"

#include <coplane_exodus/MeshReport.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace coplane
{
namespace
{
/// Volume of revolution of a plane mesh about y: 2 pi x dA over quadrilaterals, exact for straight
/// sides (a triangle turns about the axis with the mean x of its corners).
Real revolved(const Body& body)
{
  Real sum = 0;
  for (int e = 0; e < body.elements(); ++e)
    for (const auto& triangle : {std::array<int, 3>{0, 1, 2}, std::array<int, 3>{0, 2, 3}})
    {
      const auto p = [&](int k) { return body.points[body.connectivity[4 * e + triangle[k]]]; };
      const Vec3 a = p(1) - p(0), b = p(2) - p(0);
      sum += 2 * pi * (p(0).x + p(1).x + p(2).x) / 3 * (a.x * b.y - a.y * b.x) / 2;
    }
  return sum;
}

/// Exact volume: the outline of the nose is r = R - c + sqrt(c^2 - h^2) at the height h over its
/// base, with R = width / 2 and c = caliber * width; pi r^2 integrated from 0 to
/// L = sqrt(c^2 - (c - R)^2):
/// (c - R)^2 L - 2 (c - R) (L sqrt(c^2 - L^2) + c^2 asin(L / c)) / 2 + c^2 L - L^3 / 3.
Real exactVolume(Real width, Real caliber, Real length)
{
  const Real R = width / 2, c = caliber * width, d = c - R, L = std::sqrt(c * c - d * d);
  const Real nose = d * d * L - d * (L * std::sqrt(c * c - L * L) + c * c * std::asin(L / c)) +
                    c * c * L - L * L * L / 3;
  return pi * (nose + R * R * (length - L));
}
} // namespace

TEST(Ogive, theExactVolumeOfHalfABallIsThatOfHalfABall)
{
  EXPECT_NEAR(exactVolume(2, 0.5, 1), 2 * pi / 3, 1e-14);
}

TEST(Ogive, theNoseOfThreeCalibersIsAsLongAsTheCircleSays)
{
  // L^2 = (3 w)^2 - (2.5 w)^2 = 2.75 w^2.
  EXPECT_NEAR(ogiveLength(0.0254, 3), 0.0254 * std::sqrt(2.75), 1e-15);
}

TEST(Ogive, theHalfSectionTurnsIntoTheVolumeOfTheBody)
{
  // Chords of an arc of angle t in n parts lose about (t / n)^2 / 12 of the volume between arc and
  // chord: below 0.2 % for 12 chords of 0.585 rad, and four times less for twice as many.
  const Real exact = exactVolume(0.0254, 3, 0.1437);
  const Real coarse = 1 - revolved(ogiveNosed(2, 0.0254, 3, 0.1437, 8, 10, 16)) / exact;
  const Real fine = 1 - revolved(ogiveNosed(2, 0.0254, 3, 0.1437, 16, 20, 32)) / exact;
  EXPECT_GT(coarse, 0);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.2);
}

TEST(Ogive, aQuarterIsAQuarterOfTheBody)
{
  const Body body = ogiveNosed(3, 2, 3, 8, 16, 20, 10);
  const MeshReport report = reportMesh(makeMeshFromText(
      "{dimension: 3, parts: [{shape: ogive, block: p, width: 2, length: 8, caliber: 3, across: "
      "16, nose: 20, along: 10}]}",
      "test.yaml"));
  // Chords of 16 parts of a quarter cut off (2 pi / 3) / 64^2 of the circle, and those along the
  // nose a little more.
  const Real ratio = report.blocks[0].volume / (exactVolume(2, 3, 8) / 4);
  EXPECT_GT(ratio, 0.99);
  EXPECT_LT(ratio, 1);
  EXPECT_EQ(report.elements, body.elements());
  EXPECT_NEAR(report.lowest.y, 0, 1e-14);
  EXPECT_NEAR(report.highest.y, 8, 1e-14);
  EXPECT_NEAR(report.lowest.x, 0, 1e-14);
  EXPECT_NEAR(report.highest.z, 1, 1e-14);
  EXPECT_EQ(report.bodies, 1);
  EXPECT_TRUE(report.usable());
  EXPECT_TRUE(meshProblems(report).empty());
}

TEST(Ogive, everyElementOfTheHalfSectionIsConvexAndNoneIsThin)
{
  for (const int across : {4, 8, 10})
  {
    const Body body = ogiveNosed(2, 2, 3, 8, across, across + 2, 6);
    for (const Vec3& x : body.points)
      EXPECT_GE(x.x, 0);
    for (int e = 0; e < body.elements(); ++e)
      for (int k = 0; k < 4; ++k)
      {
        const auto p = [&](int i) { return body.points[body.connectivity[4 * e + (k + i) % 4]]; };
        const Vec3 a = p(1) - p(0), b = p(3) - p(0);
        const Real angle = std::atan2(a.x * b.y - a.y * b.x, dot(a, b)) * 180 / pi;
        // At the tip 33.6 degrees, acos(1 - 1 / (2 * 3)), less half a chord; its neighbours lean.
        EXPECT_GT(angle, 20) << e;
        EXPECT_LT(angle, 165) << e;
      }
  }
}
} // namespace coplane
