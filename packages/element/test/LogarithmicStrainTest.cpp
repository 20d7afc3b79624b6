#include "TestMeshes.hpp"

#include <coplane_element/LogarithmicStrain.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace coplane;
using namespace coplane::testMeshes;

namespace
{
/// Corners of an element that is no cube and no square.
std::vector<Vec3> oblique(ElementType type)
{
  switch (type)
  {
  case ElementType::Tri3:
    return {{1, 0.5, 0}, {1.9, 0.7, 0}, {1.2, 1.6, 0}};
  case ElementType::Quad4:
    return {{1, 0.5, 0}, {1.9, 0.7, 0}, {2.2, 1.6, 0}, {0.9, 1.4, 0}};
  case ElementType::Tet4:
    return {{1, 0.5, 0}, {1.9, 0.7, 0.1}, {1.2, 1.6, -0.1}, {1.3, 0.9, 0.8}};
  default:
    return {{1, 0.5, 0},   {1.9, 0.7, 0.1}, {2.2, 1.6, 0.1}, {0.9, 1.4, -0.1},
            {1.1, 0.4, 1}, {2, 0.7, 0.9},   {2.1, 1.5, 1.1}, {1, 1.5, 0.9}};
  }
}

Mat3 turn(const Vec3& axis, Real angle)
{
  const Vec3 n = normalised(axis);
  Mat3 r;
  const Real s = std::sin(angle), c = std::cos(angle);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r(i, j) = (1 - c) * n[i] * n[j] + (i == j ? c : 0);
  r(0, 1) -= s * n.z, r(1, 0) += s * n.z;
  r(0, 2) += s * n.y, r(2, 0) -= s * n.y;
  r(1, 2) -= s * n.x, r(2, 1) += s * n.x;
  return r;
}

SymTensor strainOf(ElementType type, const Mat3& map, const Vec3& moved, bool revolved = false)
{
  const std::vector<Vec3> reference = oblique(type);
  std::vector<Vec3> present;
  for (const Vec3& x : reference)
    present.push_back(map * x + moved);
  return logarithmicStrain(type, reference.data(), present.data(), revolved);
}

void expectNear(const SymTensor& a, const SymTensor& b, Real tolerance)
{
  EXPECT_NEAR(a.xx, b.xx, tolerance);
  EXPECT_NEAR(a.yy, b.yy, tolerance);
  EXPECT_NEAR(a.zz, b.zz, tolerance);
  EXPECT_NEAR(a.xy, b.xy, tolerance);
  EXPECT_NEAR(a.yz, b.yz, tolerance);
  EXPECT_NEAR(a.zx, b.zx, tolerance);
}
} // namespace

TEST(LogarithmicStrain, bodiesThatTurnHaveNone)
{
  for (const ElementType type : allTypes)
    expectNear(strainOf(type, turn(isFlat(type) ? Vec3{0, 0, 1} : Vec3{1, 2, -1}, 2.3), {5, -3, 0}),
               {}, 1e-14);
}

TEST(LogarithmicStrain, ofAStretchThenATurnIsTheLogarithmOnTurnedAxes)
{
  for (const ElementType type : allTypes)
  {
    const Real out = isFlat(type) ? 1 : 0.4; // of the plane
    Mat3 stretch;
    stretch(0, 0) = 1.7, stretch(1, 1) = 0.6, stretch(2, 2) = out;
    const Mat3 r = turn(isFlat(type) ? Vec3{0, 0, 1} : Vec3{1, 2, -1}, 0.7);
    const Real stretches[3] = {std::log(1.7), std::log(0.6), std::log(out)};
    Mat3 exact;
    for (int p = 0; p < 3; ++p)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          exact(i, j) += stretches[p] * r(i, p) * r(j, p);
    expectNear(strainOf(type, r * stretch, {1, 1, 0}),
               {exact(0, 0), exact(1, 1), exact(2, 2), exact(0, 1), exact(1, 2), exact(2, 0)},
               1e-13);
  }
}

TEST(LogarithmicStrain, ofSimpleShearHasItsClosedForm)
{
  // Stretches are exp(+-e) with sinh e = gamma / 2, and the axis of the
  // longer lies at the angle atan2(2, gamma) / 2 to the direction of the shear.
  for (const ElementType type : allTypes)
    for (const Real gamma : {1e-6, 0.3, 2.0})
    {
      Mat3 map;
      map(0, 0) = map(1, 1) = map(2, 2) = 1;
      map(0, 1) = gamma;
      const Real e = std::asinh(gamma / 2), twice = std::atan2(2, gamma);
      expectNear(strainOf(type, map, {}),
                 {e * std::cos(twice), -e * std::cos(twice), 0, e * std::sin(twice), 0, 0}, 1e-14);
    }
}

TEST(LogarithmicStrain, smallStrainsKeepTheirDigits)
{
  Mat3 map;
  map(0, 0) = 1 + 1e-9, map(1, 1) = 1 - 3e-10, map(2, 2) = 1;
  for (const ElementType type : allTypes)
    expectNear(strainOf(type, map, {}), {1e-9, -3e-10, 0, 0, 0, 0}, 1e-15);
}

TEST(LogarithmicStrain, ofRingsHasTheHoop)
{
  Mat3 map;
  map(0, 0) = map(1, 1) = map(2, 2) = 1;
  for (const ElementType type : {ElementType::Tri3, ElementType::Quad4})
  {
    const std::vector<Vec3> corners = oblique(type);
    Real radius = 0;
    for (const Vec3& x : corners)
      radius += x.x / Real(corners.size());
    const SymTensor strain = strainOf(type, map, {0.5, 0, 0}, true);
    expectNear(strain, {0, 0, std::log((radius + 0.5) / radius), 0, 0, 0}, 1e-14);
  }
}

TEST(LogarithmicStrain, ofAnElementThatWasFlatIsNoNumber)
{
  const std::vector<Vec3> flat{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}};
  EXPECT_TRUE(std::isnan(
      logarithmicStrain(ElementType::Quad4, flat.data(), oblique(ElementType::Quad4).data(), false)
          .xx));
}
