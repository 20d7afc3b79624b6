#include <coplane_contact/SubsteppedPairs.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
/// Segments in a row, each with nodes of its own: face f has nodes 2f and 2f + 1.
std::vector<Face> segments(int count)
{
  std::vector<Face> faces(static_cast<std::size_t>(count));
  for (int f = 0; f < count; ++f)
  {
    faces[std::size_t(f)].id = f + 1;
    faces[std::size_t(f)].count = 2;
    faces[std::size_t(f)].nodes[0] = 2 * f;
    faces[std::size_t(f)].nodes[1] = 2 * f + 1;
  }
  return faces;
}

SubsteppedPairs::SlotTable slotsOf(const std::vector<std::pair<int, int>>& pairs)
{
  SubsteppedPairs::SlotTable slots("slots", pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p)
  {
    slots(p).face[0] = pairs[p].first;
    slots(p).face[1] = pairs[p].second;
  }
  return slots;
}

Array<Real> stepsWith(int nodes, const std::vector<int>& substepped)
{
  Array<Real> steps("steps", std::size_t(nodes));
  Kokkos::deep_copy(steps, 1.0);
  for (const int n : substepped)
    steps(n) = 4;
  return steps;
}
} // namespace

TEST(SubsteppedPairs, areThoseAtASubsteppedNodeWithAllNodesOfTheirFaces)
{
  SubsteppedPairs pairs;
  // Faces 0 to 3 are of this rank, 4 is a ghost; nodes from 8 on are of others.
  const auto slots = slotsOf({{0, 1}, {0, 4}, {1, 2}, {2, 3}, {-1, -1}});
  pairs.list(slots, segments(5), 4, 8, stepsWith(10, {1}));
  EXPECT_TRUE(pairs.has(0));
  EXPECT_TRUE(pairs.has(1));
  for (const std::size_t slot : {2, 3, 4, 5})
    EXPECT_FALSE(pairs.has(slot)) << slot;
  EXPECT_EQ(pairs.nodes(), (std::vector<int>{0, 1, 2, 3}));
  pairs.listNear(slots, [](int slot) { return slot != 0; });
  EXPECT_EQ(pairs.near(), std::vector<int>{1});
  EXPECT_EQ(pairs.nearFaces(), (std::vector<int>{0, 4}));
  EXPECT_EQ(pairs.othersOf({0, 1, 2, 3}), (std::vector<int>{2, 3}));
  // Of a ghost, too.
  pairs.list(slots, segments(5), 4, 8, stepsWith(10, {9}));
  EXPECT_TRUE(pairs.has(1));
  EXPECT_EQ(pairs.nodes(), (std::vector<int>{0, 1}));
  pairs.list(slots, segments(5), 4, 8, stepsWith(10, {}));
  EXPECT_TRUE(pairs.empty());
}

TEST(SubsteppedPairs, ofRigidBodiesActOnceInACycle)
{
  SubsteppedPairs pairs;
  std::vector<Face> faces = segments(3);
  faces[1].rigid = true;
  pairs.list(slotsOf({{0, 1}, {0, 2}}), faces, 3, 6, stepsWith(6, {0}));
  EXPECT_FALSE(pairs.has(0));
  EXPECT_TRUE(pairs.has(1));
}

TEST(SubsteppedPairs, giveTheForcesOfLoadedPlanesToOwnedNodes)
{
  SubsteppedPairs pairs;
  pairs.list(slotsOf({{0, 1}, {0, 2}, {1, 2}}), segments(3), 3, 5, stepsWith(6, {0}));
  Plane a, b, c;
  for (Plane* plane : {&a, &b, &c})
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 2; ++k)
        plane->nodal[side][k] = {plane == &a   ? 1.0
                                 : plane == &b ? 10.0
                                               : 100.0,
                                 Real(side), Real(k)};
  Plane* const planes[] = {&a, &b, &c};
  Array<Activity> activity("activity", 3);
  Kokkos::deep_copy(activity, Activity::Loaded);
  const NodeVectors force("force", 5);
  pairs.addForces(planes, activity, force);
  const Real along[] = {11, 11, 1, 1, 10}; // not of the third pair; node 5 is another rank's
  for (int n = 0; n < 5; ++n)
    EXPECT_EQ(force(n, 0), along[n]) << n;
  EXPECT_EQ(force(2, 1), 1);
  activity(0) = Activity::Asleep;
  pairs.addForces(planes, activity, force);
  EXPECT_EQ(force(0, 0), 21);
  EXPECT_EQ(force(2, 0), 1);
}
} // namespace coplane
