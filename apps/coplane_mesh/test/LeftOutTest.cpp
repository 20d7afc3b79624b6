#include "LeftOut.hpp"

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
CutReport openOf(Real area)
{
  CutReport cut{"plane"};
  cut.opened = 4;
  cut.area = area;
  return cut;
}

/// One joint of 40 m.
JointMeasure jointOf(Real slivers, Real stubs)
{
  JointMeasure measure;
  measure.asked = 40;
  measure.slivers = slivers;
  measure.stubs = stubs;
  measure.leaveOut(slivers, {1, 2, 0});
  measure.leaveOut(stubs, {3, 4, 0});
  return measure;
}

TEST(WhatIsLeftOutOfJoints, isToldWithItsPlaceAndItsMeaning)
{
  const auto notes = notesOfLeftOut({jointOf(2, 0)}, {openOf(38)}, 2, 0.1);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0],
            "joint 'plane': 2 of 40 m are not open (where slivers were joined to neighbours), the "
            "largest piece, of 2 m, at (1, 2, 0) m");
  EXPECT_EQ(notes[1],
            "where joints are not open both sides hang together: rock bridges, which carry without "
            "limit, so that a factor of safety comes out too large. Smaller slivers.volume, "
            "slivers.thickness keep them open");
}

TEST(WhatIsLeftOutOfJoints, hasAllItsReasons)
{
  CutReport cut = openOf(30);
  cut.closed = 2;
  cut.largestClosed = 5;
  cut.closedPlace = {7, 8, 9};
  const auto notes = notesOfLeftOut({jointOf(1, 3)}, {cut}, 3, 0.1);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0],
            "joint 'plane': 10 of 40 m^2 are not open (1 m^2 where slivers were joined to "
            "neighbours, 3 m^2 as short ends, 6 m^2 closed on rims or by mending), the largest "
            "piece, of 5 m^2, at (7, 8, 9) m");
  EXPECT_NE(notes[1].find("Smaller slivers.volume, slivers.thickness, slivers.stub, elements.size "
                          "keep them open"),
            std::string::npos)
      << notes[1];
}

TEST(WhatIsLeftOutOfJoints, isNotToldUpToAThousandth)
{
  const JointMeasure whole = jointOf(0, 0);
  const auto countOf = [&](Real open) {
    return notesOfLeftOut({whole, whole}, {openOf(40), openOf(open)}, 2, 0.1).size();
  };
  EXPECT_EQ(countOf(40.5), 0u); // nodes of a joint have moved
  EXPECT_EQ(countOf(40), 0u);
  EXPECT_EQ(countOf(39.97), 0u);
  EXPECT_EQ(countOf(39.95), 2u); // with what it means
}
} // namespace
} // namespace coplane
