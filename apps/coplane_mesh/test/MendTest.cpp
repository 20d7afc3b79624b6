#include "MendSimplices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
using Solid = TetrahedraWithSurfaces;

/// A cube of edge 1 of which one node inside sees all of the border.
Solid cubeAround(const Vec3& inside)
{
  Solid mesh;
  for (int k = 0; k < 8; ++k)
    mesh.points.push_back({Real(k & 1), Real(k / 2 & 1), Real(k / 4)});
  mesh.points.push_back(inside);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
    {
      const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, low = side << axis;
      Solid::Surface surface;
      surface.normal[axis] = 1;
      surface.point[axis] = side;
      surface.border = Border::Fixed;
      for (const auto& [b, c] : {std::pair(u, u | v), std::pair(u | v, v)})
      {
        Solid::Face face{low, low | b, low | c};
        const std::array<int, 4> nodes = side == 0
                                             ? std::array<int, 4>{face[0], face[1], face[2], 8}
                                             : std::array<int, 4>{face[0], face[2], face[1], 8};
        mesh.simplices.push_back({nodes, 1});
        std::sort(face.begin(), face.end());
        mesh.surfaceOf[face] = int(mesh.surfaces.size());
      }
      mesh.surfaces.push_back(surface);
    }
  return mesh;
}

std::array<Vec3, 4> cornersOf(const Solid& mesh, const Solid::Simplex& element)
{
  std::array<Vec3, 4> corners;
  for (std::size_t k = 0; k < 4; ++k)
    corners[k] = mesh.points[std::size_t(element.nodes[k])];
  return corners;
}

Real worstOf(const Solid& mesh)
{
  Real worst = infinity;
  for (const auto& element : mesh.simplices)
    worst = std::min(worst, worthOf(cornersOf(mesh, element), 1));
  return worst;
}

Real volumeOf(const Solid& mesh)
{
  Real volume = 0;
  for (const auto& element : mesh.simplices)
    volume += volumeOf(cornersOf(mesh, element));
  return volume;
}

const MendLimits limits{1, 0.1, 0.1, 0.5};

TEST(WorthOfElements, isOneForRegularOnesAndGoesWithHeight)
{
  const Real h = std::sqrt(2.0 / 3), r = std::sqrt(0.75);
  const std::array<Vec3, 4> regular{Vec3{0, 0, 0}, {1, 0, 0}, {0.5, r, 0}, {0.5, r / 3, h}};
  EXPECT_NEAR(worthOf(regular, 1), 1, 1e-14);
  EXPECT_NEAR(worthOf(regular, 4), 0.25, 1e-14);
  EXPECT_NEAR(worthOf(std::array<Vec3, 3>{Vec3{0, 0, 0}, {1, 0, 0}, {0.5, r, 0}}, 1), 1, 1e-14);
  EXPECT_EQ(worthOf(std::array<Vec3, 4>{Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, 1), 0);
}

TEST(MendedTetrahedra, areNoLongerFlat)
{
  // Near a face, near an edge, near a corner, and on a face.
  for (const Vec3& inside :
       {Vec3{0.5, 0.4, 1e-4}, Vec3{1e-3, 1e-4, 0.5}, Vec3{1e-4, 2e-4, 1e-4}, Vec3{0.5, 0.4, 0}})
  {
    Solid mesh = cubeAround(inside);
    ASSERT_LT(worstOf(mesh), 1e-3);
    EXPECT_GT(mend(mesh, limits), 0);
    EXPECT_GT(worstOf(mesh), 0.1);
    EXPECT_NEAR(volumeOf(mesh), 1, 1e-14);
    Solid again = cubeAround(inside);
    mend(again, limits);
    ASSERT_EQ(again.simplices.size(), mesh.simplices.size());
    for (std::size_t t = 0; t < mesh.simplices.size(); ++t)
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(
            norm(cornersOf(mesh, mesh.simplices[t])[k] - cornersOf(again, again.simplices[t])[k]),
            0);
  }
}

TEST(MendedTetrahedra, stayAsTheyAreWhenTheyAreGood)
{
  Solid mesh = cubeAround({0.5, 0.5, 0.5});
  EXPECT_EQ(mend(mesh, limits), 0);
  EXPECT_EQ(mesh.simplices.size(), 12u);
}

TEST(MendedTetrahedra, bendJointsByTheToleranceOnly)
{
  // The node is the tip of a joint along x + y = 0.002 that cuts off an edge of the cube.
  for (const Real tolerance : {0.0, 0.1})
  {
    Solid mesh = cubeAround({1e-3, 1e-3, 0.5});
    Solid::Surface joint;
    joint.point = {1e-3, 1e-3, 0};
    joint.normal = normalised(Vec3{1, 1, 0});
    joint.joint = 0;
    mesh.surfaceOf[{0, 1, 8}] = int(mesh.surfaces.size());
    mesh.surfaces.push_back(joint);
    MendLimits own = limits;
    own.tolerance = tolerance;
    mend(mesh, own);
    for (const auto& [face, surface] : mesh.surfaceOf)
      for (const int node : face)
        if (mesh.surfaces[std::size_t(surface)].joint == 0 && node > 7) // its corners are off it
        {
          const Vec3 away = mesh.points[std::size_t(node)] - joint.point;
          EXPECT_LE(std::abs(dot(away, joint.normal)), tolerance + 1e-12);
        }
    EXPECT_NEAR(volumeOf(mesh), 1, 1e-14);
  }
}

/// A square of edge 1 of which one node inside sees all of the border.
TrianglesWithSurfaces squareAround(const Vec3& inside)
{
  TrianglesWithSurfaces mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, inside};
  for (int side = 0; side < 4; ++side)
  {
    const int next = (side + 1) % 4;
    mesh.simplices.push_back({{side, next, 4}, 1});
    mesh.surfaceOf[{std::min(side, next), std::max(side, next)}] = side;
    const Vec3 along = mesh.points[std::size_t(next)] - mesh.points[std::size_t(side)];
    mesh.surfaces.push_back(
        {mesh.points[std::size_t(side)], {-along.y, along.x, 0}, Border::Fixed, -1});
  }
  return mesh;
}

std::array<Vec3, 3> cornersOf(const TrianglesWithSurfaces& mesh,
                              const TrianglesWithSurfaces::Simplex& triangle)
{
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = mesh.points[std::size_t(triangle.nodes[k])];
  return corners;
}

TEST(MendedTriangles, areNoLongerFlat)
{
  // Near a side, near a corner, on a side.
  for (const Vec3& inside : {Vec3{0.4, 1e-4, 0}, Vec3{1e-3, 2e-3, 0}, Vec3{0.4, 0, 0}})
  {
    TrianglesWithSurfaces mesh = squareAround(inside);
    EXPECT_GT(mend(mesh, limits), 0);
    Real area = 0;
    for (const auto& triangle : mesh.simplices)
    {
      const auto x = cornersOf(mesh, triangle);
      EXPECT_GT(volumeOf(x), 0);
      EXPECT_GT(worthOf(x, 1), 0.1);
      area += volumeOf(x);
    }
    EXPECT_NEAR(area, 1, 1e-14);
    for (const auto& [edge, surface] : mesh.surfaceOf) // the border stays where it is
      for (const int node : edge)
      {
        const auto& line = mesh.surfaces[std::size_t(surface)];
        EXPECT_NEAR(dot(mesh.points[std::size_t(node)] - line.point, line.normal), 0, 1e-12);
      }
  }
  TrianglesWithSurfaces good = squareAround({0.5, 0.5, 0});
  EXPECT_EQ(mend(good, limits), 0);
}

TEST(MendedTriangles, bendJointsByTheToleranceOnly)
{
  // A joint from a corner to a node near the side, where it would end: it goes on to the side.
  for (const Real height : {0.03, 0.3})
  {
    TrianglesWithSurfaces mesh = squareAround({0.5, height, 0});
    TrianglesWithSurfaces::Surface joint{
        {0, 1, 0}, normalised(Vec3{1 - height, 0.5, 0}), Border::None, 0};
    mesh.surfaceOf[{3, 4}] = int(mesh.surfaces.size());
    mesh.surfaces.push_back(joint);
    const int changes = mend(mesh, limits);
    EXPECT_EQ(changes > 0, height < 0.1);
    for (const auto& [edge, surface] : mesh.surfaceOf)
    {
      if (mesh.surfaces[std::size_t(surface)].joint < 0)
        continue;
      for (const int node : edge)
        EXPECT_LE(std::abs(dot(mesh.points[std::size_t(node)] - joint.point, joint.normal)),
                  limits.tolerance + 1e-12);
    }
  }
}

TEST(MendedTriangles, giveWayAtDrawnBordersOnly)
{
  // The lower side has a corner 5e-4 m below it and 1e-3 m from its end.
  for (const Border border : {Border::Fixed, Border::Wall, Border::Drawn})
  {
    TrianglesWithSurfaces mesh = squareAround({0.5, 0.5, 0});
    mesh.points.push_back({1e-3, -5e-4, 0});
    mesh.simplices[0].nodes = {5, 1, 4};
    mesh.simplices.push_back({{0, 5, 4}, 1});
    mesh.surfaceOf.erase({0, 1});
    mesh.surfaceOf[{0, 5}] = int(mesh.surfaces.size());
    mesh.surfaces.push_back({{0, 0, 0}, normalised(Vec3{1, 2, 0}), border, -1});
    mesh.surfaceOf[{1, 5}] = int(mesh.surfaces.size());
    mesh.surfaces.push_back({{1, 0, 0}, normalised(Vec3{5e-4, -0.999, 0}), border, -1});
    mend(mesh, limits);
    Real area = 0, worst = 1;
    for (const auto& triangle : mesh.simplices)
    {
      area += volumeOf(cornersOf(mesh, triangle));
      worst = std::min(worst, worthOf(cornersOf(mesh, triangle), 1));
    }
    const bool gives = border == Border::Drawn;
    EXPECT_EQ(worst > 0.1, gives);
    EXPECT_NEAR(area, gives ? 1 : 1 + 5e-4 / 2, 1e-9);
  }
}
} // namespace
} // namespace coplane
