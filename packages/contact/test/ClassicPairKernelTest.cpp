#include "CornerBlocks.hpp"

#include <coplane_contact/ClassicLeaders.hpp>

#include <gtest/gtest.h>

using namespace coplane;
using namespace coplane::facepairs;

namespace
{
ContactOptions classicMethod(ContactOptions::Area area = ContactOptions::Area::Penetrating)
{
  ContactOptions o = options(area, ContactOptions::Weights::Pressure);
  o.method = ContactOptions::Method::CommonPlane;
  return o;
}

/// A block whose nodes move with the velocities given by a function of the node.
template <class Velocity>
ElementNodes moving(const ConvexBlock& block, const Velocity& velocity)
{
  ElementNodes nodes;
  nodes.count = block.nodes;
  for (int i = 0; i < block.nodes; ++i)
  {
    nodes.x[i] = block.x[i];
    nodes.v[i] = velocity(i);
  }
  return nodes;
}

FaceNodes faceOf(const ElementNodes& nodes, const ConvexBlock& block, int f)
{
  FaceNodes face;
  face.count = block.faceSize[f];
  for (int i = 0; i < face.count; ++i)
  {
    face.x[i] = nodes.x[block.faceNode[f][i]];
    face.v[i] = nodes.v[block.faceNode[f][i]];
  }
  return face;
}

PairPlane leadingPlane(Real friction = 0)
{
  PairPlane plane = touchingPlane(1, friction);
  plane.leads = true;
  return plane;
}

template <int Dim>
void update(PairPlane& plane, const ElementNodes& a, const FaceNodes& faceA, const ElementNodes& b,
            const FaceNodes& faceB, const ContactOptions& o, Real dt)
{
  updateClassicPlane<Dim>(plane, stepA_halfStepFace<Dim>(faceA, dt),
                          stepA_halfStepFace<Dim>(faceB, dt), a, b, plane.law, o, dt);
  std::copy(&plane.nodal[0][0], &plane.nodal[0][0] + 8, &plane.cornerForce[0][0]);
}

/// Two blocks in a table of nodes, and the elements behind their faces.
struct TwoBlocks
{
  NodeVectors x;
  FaceElement element[2];
  const ConvexBlock block[2];

  TwoBlocks(const ConvexBlock& a, const ConvexBlock& b) : x("x", a.nodes + b.nodes), block{a, b}
  {
    int node = 0;
    for (int k = 0; k < 2; ++k)
    {
      element[k].count = block[k].nodes;
      for (int i = 0; i < block[k].nodes; ++i)
      {
        set(x, node, block[k].x[i]);
        element[k].nodes[i] = node++;
      }
    }
  }
  Face face(int k, int side) const
  {
    Face face;
    face.id = faceId(10 + k, side);
    return face;
  }
  /// Pairs of sides that lead.
  std::vector<std::pair<int, int>> leaders(int dimension) const
  {
    std::vector<std::pair<int, int>> found;
    for (int p = 0; p < block[0].faces; ++p)
      for (int q = 0; q < block[1].faces; ++q)
        if (leaderOf(face(0, p), face(1, q), element[0], element[1], x, dimension, classicMethod())
                .leads)
          found.push_back({p, q});
    return found;
  }
};
} // namespace

TEST(ClassicPair, keepsMomentumAndAngularMomentum)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> u(-1, 1);
  const auto some = [&] { return Vec3{u(random), u(random), u(random)}; };
  const Real dt = 1e-3;
  const ConvexBlock slab = slabBlock3D(), corner = cornerBlock3D(.7, .02);
  int carrying = 0;
  for (int n = 0; n < 200; ++n)
    for (const auto area : allAreas)
    {
      const Mat3 r = rotation(some(), pi * u(random));
      const Mat3 tilt = rotation(some(), .4 * u(random));
      const ConvexBlock blockA = moved(slab, r), blockB = moved(moved(corner, tilt), r);
      const auto speed = [&](int) { return some(); };
      const ElementNodes a = moving(blockA, speed), b = moving(blockB, speed);
      const ClassicPlane now = classicCommonPlane<3>(blockA, blockB, {});
      PairPlane plane = leadingPlane(.5);
      plane.normal = now.normal;
      const FaceNodes faceA = faceOf(a, blockA, now.face[0]),
                      faceB = faceOf(b, blockB, now.face[1]);
      for (int cycle = 0; cycle < 2; ++cycle) // the second with shear traction
        update<3>(plane, a, faceA, b, faceB, classicMethod(area), dt);
      carrying += plane.area > 0;
      const Resultant sum = resultant(faceA, faceB, plane.cornerForce);
      // Couples on the long slab: round-off of forces on arms of 7.
      const Real size = norm(plane.forceOn(1));
      EXPECT_LT(norm(sum.force), 1e-14 * size + 1e-300) << n;
      EXPECT_LT(norm(sum.moment), 1e-12 * size + 1e-300) << n;
    }
  EXPECT_GT(carrying, 300);
}

TEST(ClassicPair, meetsTheGapOfTheEndAndTheSectionOfTheMiddleOfAStep)
{
  // A right-angled corner that sinks in at the speed v: section of the half step, closure of the
  // end.
  const Real d = .01, v = 1, dt = 1e-3;
  const ConvexBlock slab = slabBlock2D(), corner = cornerBlock2D(pi / 4, d, 1);
  const ElementNodes a = moving(slab, [](int) { return Vec3{}; });
  const ElementNodes b = moving(corner, [&](int) { return Vec3{0, -v, 0}; });
  PairPlane plane = leadingPlane();
  plane.normal = {0, 1, 0};
  update<2>(plane, a, faceOf(a, slab, 2), b, faceOf(b, corner, 0), classicMethod(), dt);
  EXPECT_NEAR(plane.gap, -d, 1e-16);
  EXPECT_NEAR(plane.area, d - .5 * dt * v, 1e-15);
  EXPECT_NEAR(plane.forceOn(1).y, d * (d - .5 * dt * v), 1e-16);
  EXPECT_NEAR(plane.forceOn(1).x, 0, 1e-17);
  EXPECT_EQ(norm(plane.nodal[1][1]), 0); // all on the node in the corner
}

TEST(ClassicPair, carriesNothingUnlessItLeads)
{
  const ConvexBlock slab = slabBlock2D(), corner = cornerBlock2D(pi / 4, .01, 1);
  const ElementNodes a = moving(slab, [](int) { return Vec3{}; });
  const ElementNodes b = moving(corner, [](int) { return Vec3{}; });
  PairPlane plane = leadingPlane();
  plane.normal = {0, 1, 0};
  update<2>(plane, a, faceOf(a, slab, 2), b, faceOf(b, corner, 0), classicMethod(), 0);
  EXPECT_GT(plane.area, 0);
  plane.leads = false;
  update<2>(plane, a, faceOf(a, slab, 2), b, faceOf(b, corner, 0), classicMethod(), 0);
  EXPECT_EQ(plane.area, 0);
  EXPECT_EQ(norm(plane.forceOn(1)), 0);
  EXPECT_EQ(plane.state, PlaneState::Open);
}

TEST(ClassicLeaders, onePairOfFacesLeads)
{
  using Pairs = std::vector<std::pair<int, int>>;
  // Of the two equal sides of a corner the first.
  EXPECT_EQ(TwoBlocks(slabBlock2D(), cornerBlock2D(pi / 4, .01, 1)).leaders(2), (Pairs{{2, 0}}));
  EXPECT_EQ(TwoBlocks(slabBlock2D(), cornerBlock2D(pi / 4, -.01, 1)).leaders(2), (Pairs{{2, 0}}));
  // Turned a little the side that looks down more.
  EXPECT_EQ(TwoBlocks(slabBlock2D(), moved(cornerBlock2D(pi / 4, .01, 1), rotation({0, 0, 1}, .1)))
                .leaders(2),
            (Pairs{{2, 3}}));
  EXPECT_EQ(TwoBlocks(slabBlock3D(), cornerBlock3D(.7, .01)).leaders(3).size(), 1u);
}

TEST(ClassicLeaders, planesOfElementsComeFromWhereverTheyAre)
{
  // Every rank counts the plane of elements (r, 100 + r) and asks for those of all ranks, and for
  // one that nobody has.
  const Comm comm;
  Donor mine;
  mine.faceId[0] = faceId(1 + comm.rank(), 2);
  mine.faceId[1] = faceId(100 + comm.rank(), 3);
  mine.slip = comm.rank();
  std::vector<ElementPair> wanted{{50, 60}};
  for (int r = comm.size() - 1; r >= 0; --r)
    wanted.push_back({1 + r, 100 + r});
  const std::vector<Donor> found = planesOfElements(wanted, {mine}, comm);
  ASSERT_EQ(int(found.size()), comm.size());
  for (int r = 0; r < comm.size(); ++r)
  {
    EXPECT_EQ(found[r].faceId[0], faceId(1 + r, 2));
    EXPECT_EQ(found[r].slip, r);
    const auto range = planesOf(found, {1 + r, 100 + r});
    EXPECT_EQ(range.second - range.first, 1);
  }
  const auto none = planesOf(found, {50, 60});
  EXPECT_EQ(none.first, none.second);
}
