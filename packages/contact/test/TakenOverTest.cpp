#include "FacePairs.hpp"

#include <gtest/gtest.h>

using namespace coplane;
using namespace coplane::facepairs;

// What a pair that begins does with what its neighbours have passed on to it (PotentialKernel.hpp).
// Along the common normal planes begin with all of their closure.

namespace
{
/// A pair that is no plane yet, and a cycle of 1 s with it, by forces from the potential.
struct BeginningPair
{
  PairPlane plane = touchingPlane(1e3);
  ContactOptions options = ContactOptions::with(ContactOptions::Forces::Potential);

  BeginningPair()
  {
    plane.state = PlaneState::Slot;
    plane.depthLimit = .1;
  }
  void takesOver(Real offset)
  {
    plane.lineage = Lineage::SlidesOn;
    plane.absorb(offset);
  }
  void cycle(Real gap, const Vec3& velocity = {}, Real tilt = 0, Real aside = 0)
  {
    FaceNodes face = squareAbove(-gap, velocity);
    for (int k = 0; k < 4; ++k)
    {
      face.x[k].z += tilt * (face.x[k].x - .5);
      face.x[k].x += aside;
    }
    updatePlane<3>(plane, squareBelow(), face, options, 1);
  }
  Real push() const { return plane.forceOn(1).z; }
};
} // namespace

TEST(WhatAPairTakesOver, whileItsFacesLieOnEachOtherHasNoEnergy)
{
  // Faces that are apart by .01, and beside them a joint that has absorbed a gap of .03 comes to
  // bear: it does not push them apart, but from here on they do not come nearer for nothing.
  BeginningPair pair;
  pair.cycle(.01);
  EXPECT_FALSE(pair.plane.isBorn());
  pair.takesOver(.03);
  pair.cycle(.009, {0, 0, -.001});
  EXPECT_TRUE(pair.plane.isBorn());
  EXPECT_EQ(pair.plane.sighting, Sighting::Known) << "nothing was missed";
  EXPECT_EQ(pair.push(), 0.0);
  EXPECT_EQ(pair.plane.stored, 0.0);
  pair.cycle(.008, {0, 0, -.001});
  EXPECT_NEAR(pair.push(), 1, 1e-10);
}

TEST(WhatAPairTakesOver, isMetByWhatComesThereAfterwards)
{
  BeginningPair down;
  down.takesOver(.03);
  down.cycle(.029, {0, 0, -.002});
  EXPECT_NEAR(down.push(), 1, 1e-10);
  BeginningPair fromTheSide;
  fromTheSide.takesOver(.03);
  fromTheSide.plane.closure = .01; // of the joint beside it
  fromTheSide.cycle(.02, {2, 0, 0});
  EXPECT_NEAR(fromTheSide.push(), 10, 1e-10);
}

TEST(WhatAPairTakesOver, isNoLedge)
{
  // What comes in from the side below the height of a joint beside it begins where it is.
  BeginningPair pair;
  pair.takesOver(.03);
  pair.plane.closure = 1e-4;
  pair.cycle(.02, {2, 0, 0});
  EXPECT_EQ(pair.push(), 0.0);
  pair.cycle(.019);
  EXPECT_NEAR(pair.push(), 1, 1e-10);
}

TEST(WhatAPairTakesOver, ofAGapIsRememberedOnceItsFacesLieOverEachOther)
{
  BeginningPair pair;
  pair.takesOver(.03);
  pair.cycle(.031);
  EXPECT_TRUE(pair.plane.isBorn());
  EXPECT_EQ(pair.plane.area, 0.0);
  EXPECT_TRUE(pair.plane.history.absorbed);
  BeginningPair apart;
  apart.takesOver(.03);
  apart.cycle(.031, {}, 0, 2); // beside each other
  EXPECT_FALSE(apart.plane.isBorn());
}

TEST(WhatAPairTakesOver, andLosesAgainHasNoEnergyEither)
{
  // An overlap of .02 that a joint beside had absorbed, when the pair was open by a hair.
  BeginningPair pair;
  for (int cycle = 0; cycle < 2; ++cycle)
    pair.cycle(-.019);
  EXPECT_EQ(pair.push(), 0.0);
}

TEST(WhatAPairTakesOver, isNotTakenForDepth)
{
  // Its offset is more than a quarter of the depth limit beyond the gap, but the faces are apart.
  BeginningPair pair;
  pair.cycle(.004);
  pair.takesOver(.03);
  pair.cycle(.004);
  EXPECT_FALSE(pair.plane.isRefused());
  EXPECT_EQ(pair.push(), 0.0);
  pair.cycle(.003);
  EXPECT_NEAR(pair.push(), 1, 1e-10);
}

TEST(WhatAPairTakesOver, ofAClosureCurveBearsFromThere)
{
  BeginningPair pair;
  pair.plane.law.curve.inverseMaximumClosure = 1 / .08;
  pair.cycle(.03);
  pair.takesOver(.08);
  pair.plane.history.maximumClosure = .06; // 16 kPa/m there: closed by 45 mm for good
  pair.cycle(.029);
  EXPECT_EQ(pair.push(), 0.0);
  pair.cycle(.028);
  EXPECT_NEAR(pair.push(), 16, 1e-9);
}

TEST(WhatAPairTakesOver, ofABondIsWithoutStressWhereItIs)
{
  for (const Real gap : {.029, .0301}) // closed, and open by a hair
  {
    BeginningPair pair;
    pair.plane.law.bond.kind = Bond::Kind::Brittle;
    pair.plane.law.bond.tensileStrength = pair.plane.law.cohesion = 1e9;
    const auto cycle = [&] { pair.cycle(gap, {}, .01); };
    cycle();
    pair.takesOver(.03);
    pair.plane.history.bonded = true;
    cycle();
    cycle();
    EXPECT_TRUE(pair.plane.area > 0) << "it holds";
    EXPECT_NEAR(pair.push(), 0, 1e-12);
    EXPECT_NEAR(pair.plane.stored, 0, 1e-12);
  }
}

TEST(WhatAPairTakesOver, isKeptByWhatSlidesInSlowlyWhateverTheSmallestArea)
{
  for (const Real smallest : {1e-8, 1e-3})
  {
    BeginningPair pair;
    pair.options.areaMin = smallest;
    pair.takesOver(.03);
    pair.plane.closure = .001;
    const Real step = 1e-4;
    for (int cycle = 1; !pair.plane.isBorn() && cycle < 100; ++cycle)
      pair.cycle(.029, {-step, 0, 0}, 0, 1 - cycle * step);
    pair.cycle(.029);
    EXPECT_NEAR(pair.push(), 1, 1e-10) << smallest;
  }
}

TEST(WhatAPairTakesOver, ofShearIsNoMoreThanItHolds)
{
  // Its neighbour's area shrinks, which raises the traction that it passes on.
  BeginningPair pair;
  pair.plane.law.friction = .5;
  pair.plane.law.shearRatio = 1;
  pair.plane.fit = pair.plane.law.fittedTo(1, 1, 1, 1);
  pair.takesOver(.03);
  pair.plane.normal = {0, 0, 1};
  pair.plane.history.shearTraction = {1e9, 0, 0};
  pair.plane.closure = .01;
  pair.cycle(.02, {2, 0, 0}); // comes from the side
  EXPECT_NEAR(pair.push(), 10, 1e-10);
  EXPECT_NEAR(norm(pair.plane.history.shearTraction), 5, 1e-10);
  EXPECT_LT(pair.plane.history.slip, 2 + 1e-12) << "it has not slid farther";
  EXPECT_LT(pair.plane.frictionWork, 10 + 1e-10);
}

TEST(WhatAPairTakesOver, orHadWhenItWasLastSeenHasNoEnergyWhereItWakesClosed)
{
  BeginningPair pair;
  pair.plane.state = PlaneState::Open;
  pair.plane.sighting = Sighting::Woken;
  pair.plane.offset = .03;
  for (int cycle = 0; cycle < 2; ++cycle)
    pair.cycle(.01);
  EXPECT_NEAR(pair.push(), 0, 1e-12);
  pair.cycle(.009);
  EXPECT_NEAR(pair.push(), 1, 1e-10);
}
