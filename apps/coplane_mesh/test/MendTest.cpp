#include "MendTetrahedra.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
using Mesh = TetrahedraWithSurfaces;

/// A cube of edge 1 of which one node inside sees all of the border.
Mesh cubeAround(const Vec3& inside)
{
  Mesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.points.push_back({Real(k & 1), Real(k / 2 & 1), Real(k / 4)});
  mesh.points.push_back(inside);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
    {
      const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, low = side << axis;
      Mesh::Surface surface;
      surface.normal[axis] = 1;
      surface.point[axis] = side;
      surface.exact = true;
      for (const auto& [b, c] : {std::pair(u, u | v), std::pair(u | v, v)})
      {
        Mesh::Face face{low, low | b, low | c};
        const std::array<int, 4> nodes = side == 0
                                             ? std::array<int, 4>{face[0], face[1], face[2], 8}
                                             : std::array<int, 4>{face[0], face[2], face[1], 8};
        mesh.tetrahedra.push_back({nodes, 1});
        std::sort(face.begin(), face.end());
        mesh.surfaceOf[face] = int(mesh.surfaces.size());
      }
      mesh.surfaces.push_back(surface);
    }
  return mesh;
}

std::array<Vec3, 4> cornersOf(const Mesh& mesh, const Mesh::Tetrahedron& element)
{
  std::array<Vec3, 4> corners;
  for (std::size_t k = 0; k < 4; ++k)
    corners[k] = mesh.points[std::size_t(element.nodes[k])];
  return corners;
}

Real worstOf(const Mesh& mesh)
{
  Real worst = infinity;
  for (const auto& element : mesh.tetrahedra)
    worst = std::min(worst, worthOf(cornersOf(mesh, element), 1));
  return worst;
}

Real volumeOf(const Mesh& mesh)
{
  Real volume = 0;
  for (const auto& element : mesh.tetrahedra)
  {
    const auto x = cornersOf(mesh, element);
    volume += dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6;
  }
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
    Mesh mesh = cubeAround(inside);
    ASSERT_LT(worstOf(mesh), 1e-3);
    EXPECT_GT(mendTetrahedra(mesh, limits), 0);
    EXPECT_GT(worstOf(mesh), 0.1);
    EXPECT_NEAR(volumeOf(mesh), 1, 1e-14);
    Mesh again = cubeAround(inside);
    mendTetrahedra(again, limits);
    ASSERT_EQ(again.tetrahedra.size(), mesh.tetrahedra.size());
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(
            norm(cornersOf(mesh, mesh.tetrahedra[t])[k] - cornersOf(again, again.tetrahedra[t])[k]),
            0);
  }
}

TEST(MendedTetrahedra, stayAsTheyAreWhenTheyAreGood)
{
  Mesh mesh = cubeAround({0.5, 0.5, 0.5});
  EXPECT_EQ(mendTetrahedra(mesh, limits), 0);
  EXPECT_EQ(mesh.tetrahedra.size(), 12u);
}

TEST(MendedTetrahedra, bendJointsByTheToleranceOnly)
{
  // The node is the tip of a joint along x + y = 0.002 that cuts off an edge of the cube.
  for (const Real tolerance : {0.0, 0.1})
  {
    Mesh mesh = cubeAround({1e-3, 1e-3, 0.5});
    Mesh::Surface joint;
    joint.point = {1e-3, 1e-3, 0};
    joint.normal = normalised(Vec3{1, 1, 0});
    joint.joint = 0;
    mesh.surfaceOf[{0, 1, 8}] = int(mesh.surfaces.size());
    mesh.surfaces.push_back(joint);
    MendLimits own = limits;
    own.tolerance = tolerance;
    mendTetrahedra(mesh, own);
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
} // namespace
} // namespace coplane
