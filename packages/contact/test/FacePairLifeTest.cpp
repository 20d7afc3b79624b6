#include "FacePairs.hpp"
#include "WithForces.hpp"

#include <coplane_core/Comm.hpp>

#include <gtest/gtest.h>

#include <algorithm>

using namespace coplane;
using namespace coplane::facepairs;

// Birth, history and degenerate states of a plane.

namespace
{
/// A plane in stick with a shear traction along x.
PairPlane sheared(Real traction, Real area)
{
  PairPlane plane = touchingPlane(1e3, 10);
  plane.normal = {0, 0, 1};
  plane.area = area;
  plane.history.shearTraction = {traction, 0, 0};
  return plane;
}

bool finite(const Vec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

struct StepF_CreatePlane : WithForces
{
  /// Velocity of a face that shared no area a step of 1 s ago, which for forces of the half step
  /// would be too late [m/s].
  Vec3 aside() const { return {potential() ? 2.0 : 0.0, 0, 0}; }
};
struct StepG_PlacePointOfContact : WithForces
{
};
struct StepH_UpdatePlaneVariables : WithForces
{
};
struct Bounces : WithForces
{
};
struct OpenUp : WithForces
{
};
struct FacePair_Degenerate : WithForces
{
};
} // namespace

INSTANTIATE_TEST_SUITE_P(, StepF_CreatePlane, WithForces::both(), WithForces::name);
INSTANTIATE_TEST_SUITE_P(, StepG_PlacePointOfContact, WithForces::both(), WithForces::name);
INSTANTIATE_TEST_SUITE_P(, StepH_UpdatePlaneVariables, WithForces::both(), WithForces::name);
INSTANTIATE_TEST_SUITE_P(, Bounces, WithForces::both(), WithForces::name);
INSTANTIATE_TEST_SUITE_P(, FacePair_Degenerate, WithForces::both(), WithForces::name);
INSTANTIATE_TEST_SUITE_P(, OpenUp, WithForces::both(), WithForces::name);

TEST(StepA_HalfStepFace, isHalfAStepBehindTheEndOfTheStep)
{
  const HalfStepFace half = stepA_halfStepFace<3>(squareBelow({0, 0, 4}), .5);
  EXPECT_EQ(half.center.z, -1.0); // 0 - .25 s * 4 m/s
  EXPECT_EQ(half.area, 1.0);
  EXPECT_EQ(half.normal.z, 1.0);
}

TEST(StepA_HalfStepFace, facesWithoutAreaHaveNoNormal)
{
  const FaceNodes line = face({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1.5, 0, 0}});
  EXPECT_EQ(norm(stepA_halfStepFace<3>(line, 0).normal), 0.0);
  const FaceNodes point = face({{1, 2, 0}, {1, 2, 0}});
  EXPECT_EQ(norm(stepA_halfStepFace<2>(point, 0).normal), 0.0);
}

TEST(StepB_TrialPointOfContact, normalIsTheMeanOfTheFacesNormals)
{
  // Face B tilted by 20 degrees about y: the plane is tilted by 10.
  const FaceNodes b = moved(squareAbove(0), rotation({0, 1, 0}, 20 * pi / 180));
  const TrialPlane trial = stepB_trialPointOfContact<3>(stepA_halfStepFace<3>(squareBelow(), 0),
                                                        stepA_halfStepFace<3>(b, 0));
  EXPECT_NEAR(trial.normal.x, std::sin(10 * pi / 180), 1e-15);
  EXPECT_NEAR(trial.normal.z, std::cos(10 * pi / 180), 1e-15);
  EXPECT_NEAR(dot(cross(trial.e1, trial.e2), trial.normal), 1, 1e-15);
}

TEST_P(StepF_CreatePlane, touchBetweenTwoCyclesKeepsAllOfItsClosure)
{
  PairPlane plane = touchingPlane(1e3);
  plane.state = PlaneState::Slot;
  plane.sighting = Sighting::New;
  updatePlane<3>(plane, squareBelow(), squareAbove(-.01), usual, 1);
  EXPECT_FALSE(plane.isBorn());
  EXPECT_NEAR(plane.gap, .01, 1e-15);
  updatePlane<3>(plane, squareBelow(), squareAbove(.01, {0, 0, -.02}), usual, 1);
  EXPECT_TRUE(plane.isBorn());
  EXPECT_NE(plane.sighting, Sighting::FoundLate);
  EXPECT_EQ(plane.offset, 0.0);
  EXPECT_NEAR(plane.forceOn(1).z, 10, 1e-12); // 1e3 * .01 * 1
}

/// Faces that lay on each other but for round-off were not closed: what they close by is all
/// theirs, or else round-off would decide who gets it.
TEST(StepsOfThePotential, whatLayOnAFaceButForRoundOffKeepsAllOfItsClosure)
{
  for (const Real unit : {1.0, 1e-3})
    for (const Real before : {-1e-9, 1e-17, 1e-9, 1e-4}) // closure, over the size of the face
    {
      FaceNodes lower = squareBelow(), upper = squareAbove(.01, {0, 0, before - .01});
      for (FaceNodes* nodes : {&lower, &upper})
        for (int i = 0; i < nodes->count; ++i)
        {
          nodes->x[i] = unit * nodes->x[i];
          nodes->v[i] = unit * nodes->v[i];
        }
      PairPlane plane = touchingPlane(1e3);
      plane.state = PlaneState::Slot; // seen before, and has carried nothing
      const bool wasClosed = before > 1e-8;
      updatePlane<3>(plane, lower, upper, ContactOptions{}, 1);
      EXPECT_NEAR(plane.forceOn(1).z, wasClosed ? 0 : 1e3 * .01 * unit * unit * unit,
                  1e-12 * unit * unit * unit)
          << before << " of " << unit;
      EXPECT_EQ(plane.offset < 0, wasClosed);
    }
}

TEST_P(StepF_CreatePlane, overlapFoundLateStartsWithoutForce)
{
  PairPlane plane = touchingPlane(1e3);
  plane.state = PlaneState::Slot;
  plane.sighting = Sighting::New;
  updatePlane<3>(plane, squareBelow(), squareAbove(.01), usual, 1);
  EXPECT_EQ(plane.sighting, Sighting::FoundLate);
  EXPECT_EQ(norm(plane.forceOn(1)), 0.0);
  EXPECT_EQ(plane.offset, plane.gap);
  EXPECT_NEAR(plane.gap, -.01, 1e-15);
  // From there on it reacts as usual.
  updatePlane<3>(plane, squareBelow(), squareAbove(.011), usual, 1);
  EXPECT_NE(plane.sighting, Sighting::FoundLate);
  EXPECT_NEAR(plane.forceOn(1).z, 1, 1e-12); // 1e3 * .001
}

TEST_P(StepF_CreatePlane, tiltedOverlapFoundLateStartsWithoutForceAnywhere)
{
  // A wedge of overlap: no part of it may push, neither now nor in the next cycle.
  const FaceNodes b = moved(squareAbove(.05), rotation({0, 1, 0}, 5 * pi / 180));
  PairPlane plane = touchingPlane(1e3);
  plane.state = PlaneState::Slot;
  plane.sighting = Sighting::New;
  for (int cycle = 0; cycle < 3; ++cycle)
  {
    updatePlane<3>(plane, squareBelow(), b, usual, 1);
    EXPECT_LT(norm(plane.forceOn(1)), 1e-25) << cycle; // 1e3 times the square of round-off
  }
  EXPECT_TRUE(plane.isBorn());
  EXPECT_LT(plane.offset, -.05);
  EXPECT_NEAR(plane.gap, plane.offset, 1e-15);
}

TEST_P(StepF_CreatePlane, overlapFoundBeyondTheDepthLimitIsReleasedUntilTheFacesPart)
{
  PairPlane plane = touchingPlane(1e3);
  plane.state = PlaneState::Slot;
  plane.sighting = Sighting::New;
  plane.depthLimit = .1;
  updatePlane<3>(plane, squareBelow(), squareAbove(.2), usual, 1);
  EXPECT_TRUE(plane.isRefused());
  EXPECT_FALSE(plane.isBorn());
  updatePlane<3>(plane, squareBelow(), squareAbove(.05), usual, 1);
  EXPECT_EQ(norm(plane.forceOn(1)), 0.0) << "not on the way out either";
  updatePlane<3>(plane, squareBelow(), squareAbove(-.01), usual, 1);
  EXPECT_FALSE(plane.isRefused());
  updatePlane<3>(plane, squareBelow(), squareAbove(.01, {0, 0, -.02}), usual, 1);
  EXPECT_NEAR(plane.forceOn(1).z, 10, 1e-12); // 1e3 * .01 * 1
}

TEST_P(StepF_CreatePlane, inheritedClosureExplainsABirthAtThatDepthOnly)
{
  // Sliding on, a pair is born as deep as its neighbours are.
  const auto born = [&](Real depth, Sighting sighting)
  {
    PairPlane plane = touchingPlane(1e3);
    plane.state = PlaneState::Slot;
    plane.sighting = sighting;
    plane.lineage = Lineage::Inherited;
    plane.depthLimit = .1;
    plane.offset = -.05;
    plane.closure = .06; // the neighbours overlap by .11
    updatePlane<3>(plane, squareBelow(), squareAbove(depth, aside()), usual, 1);
    EXPECT_EQ(plane.isRefused(), !plane.isBorn());
    return plane;
  };
  EXPECT_NEAR(born(.11, Sighting::Known).forceOn(1).z, 60, 1e-10); // 1e3 * (.11 - .05) * 1
  EXPECT_TRUE(born(.14, Sighting::Known).isRefused());             // a quarter of the limit deeper
  // The back of a thin body lies far behind the contact on its front, from which it inherits.
  EXPECT_FALSE(born(.2, Sighting::New).isRefused());
  EXPECT_TRUE(born(.22, Sighting::New).isRefused());
  EXPECT_EQ(norm(born(.22, Sighting::New).forceOn(1)), 0.0);
  // What lies in each other when it is found has no energy: the potential begins with none. Along
  // the common normal the force is there at once, and ends at the depth limit.
  EXPECT_NEAR(born(.11, Sighting::New).forceOn(1).z, potential() ? 0 : 60, 1e-10);
  EXPECT_NEAR(born(.2, Sighting::New).forceOn(1).z, potential() ? 0 : 1e3 * Real(.1F), 1e-10);
  if (!potential())
    return;
  PairPlane found = born(.11, Sighting::New);
  updatePlane<3>(found, squareBelow(), squareAbove(.11), usual, 1);
  EXPECT_FALSE(found.isRefused());
  EXPECT_NEAR(found.forceOn(1).z, 0, 1e-10) << "nor with a delay";
  updatePlane<3>(found, squareBelow(), squareAbove(.111), usual, 1);
  EXPECT_NEAR(found.forceOn(1).z, 1, 1e-10);
}

TEST_P(StepF_CreatePlane, aJointThatHasClosedForGoodBeginsThere)
{
  // Along the common normal planes go on while faces share area.
  if (!potential())
    return;
  PairPlane plane = touchingPlane(1e3);
  plane.law.curve.inverseMaximumClosure = 1 / .08;
  plane.depthLimit = .1;
  plane.history.maximumClosure = .06; // 240 Pa and 16 kPa/m there: closed by 45 mm for good
  updatePlane<3>(plane, squareBelow(), squareAbove(.04), usual, 1);
  EXPECT_EQ(norm(plane.forceOn(1)), 0.0) << "it has parted";
  updatePlane<3>(plane, squareBelow(), squareAbove(.05), usual, 1);
  EXPECT_FALSE(plane.isRefused());
  EXPECT_NEAR(plane.forceOn(1).z, 16e3 * .005, 1e-10);
  // Deep is what lies a quarter of the limit behind that surface.
  updatePlane<3>(plane, squareBelow(), squareAbove(.04), usual, 1);
  updatePlane<3>(plane, squareBelow(), squareAbove(.075), usual, 1);
  EXPECT_TRUE(plane.isRefused());
}

TEST_P(StepF_CreatePlane, whatIsFoundWithAreaInCommonDoesNotSlideOn)
{
  const auto isRefused = [&](Real depth)
  {
    PairPlane plane = touchingPlane(1e3);
    plane.state = PlaneState::Slot;
    plane.sighting = Sighting::New;
    plane.lineage = Lineage::SlidesOn;
    plane.depthLimit = .1;
    plane.offset = -.05;
    plane.closure = .05;
    updatePlane<3>(plane, squareBelow(), squareAbove(depth), usual, 1);
    return plane.isRefused();
  };
  EXPECT_FALSE(isRefused(.19)); // the limit, beside .1 that its neighbours explain
  EXPECT_TRUE(isRefused(.21));
}

TEST_P(StepF_CreatePlane, aFaceThatSlidesOnOverTheSameSurfaceMeetsItAsDeepAsItLies)
{
  // A rough surface: the next face of it stands higher than the one that was touched. With the
  // potential, by no more than three times the mean closure there, beside a quarter of the limit.
  for (const Real depth : {.06, .08})
  {
    PairPlane plane = touchingPlane(1e3);
    plane.state = PlaneState::Slot;
    plane.lineage = Lineage::SlidesOn;
    plane.sighting = Sighting::Known;
    plane.depthLimit = .1;
    plane.closure = .01;
    updatePlane<3>(plane, squareBelow(), squareAbove(depth, aside()), usual, 1);
    EXPECT_EQ(plane.isRefused(), potential() && depth > 4 * .01 + .25 * .1);
    EXPECT_NEAR(plane.forceOn(1).z, plane.isRefused() ? 0 : 1e3 * depth, 1e-10);
  }
}

namespace
{
/// A segment that shares nothing with another one comes to share `width` with it, `depth` deep.
PairPlane afterItCameAside(Real width, Real depth, unsigned turns, Pairing pairing = Pairing::Usual)
{
  PairPlane plane = touchingPlane(1e3);
  plane.pairing = pairing;
  plane.depthLimit = .1;
  plane.turns = std::uint8_t(turns);
  const auto at = [&](const Vec3& place)
  {
    const FaceNodes a = face({{1, 0, 0}, {0, 0, 0}});
    const FaceNodes b = face({place, place + Vec3{1, 0, 0}});
    updatePlane<2>(plane, a, b, ContactOptions::with(ContactOptions::Forces::Potential), 1e-3);
  };
  at({1.1, -.06, 0});
  EXPECT_EQ(plane.area, 0.0);
  at({1 - width, -depth, 0});
  return plane;
}
/// The same of one that lies behind the other one and turns until they are opposed, `angle` past
/// the right angle.
PairPlane afterItTurned(Real angle, Real depth, unsigned turns)
{
  PairPlane plane = touchingPlane(1e3);
  plane.depthLimit = .1;
  plane.turns = std::uint8_t(turns);
  const auto at = [&](Real turned)
  {
    const FaceNodes a = face({{1, 0, 0}, {0, 0, 0}});
    const Vec3 from{.5, -depth, 0}, to = Vec3{std::sin(turned), std::cos(turned), 0};
    updatePlane<2>(plane, a, face({from, from + .4 * to}),
                   ContactOptions::with(ContactOptions::Forces::Potential), 1e-3);
  };
  at(-.01);
  EXPECT_EQ(plane.area, 0.0);
  at(angle);
  return plane;
}
} // namespace

TEST(RefusalOfThePotential, whatBeginsWithLittleIsNotDeepWhereItsSurfaceGoesOn)
{
  // It was refused, and a block that was led over lines of the mesh, or whose side rolled onto its
  // floor, fell through it. Between edges at which both surfaces turn it is another pair that
  // meets.
  for (const unsigned turns : {0xFFu, 0x0Fu, 0xF0u, 0u})
  {
    const PairPlane plane = afterItCameAside(.01, .06, turns);
    EXPECT_EQ(plane.isRefused(), turns == 0xFF);
    // k c times the width, times what it carries of that with a share of 0.01: 0.00725.
    EXPECT_NEAR(plane.forceOn(1).y, turns == 0xFF ? 0 : .6 * .00725, 1e-10);
    EXPECT_FALSE(plane.isInherited());
  }
  EXPECT_FALSE(afterItCameAside(.09, .06, 0).isRefused());
  EXPECT_TRUE(afterItCameAside(.11, .06, 0).isRefused()); // at once by more than a tenth
  // Up to 1.25 of the depth limit, and to that where a back may be near.
  EXPECT_FALSE(afterItCameAside(.01, .12, 0).isRefused());
  EXPECT_TRUE(afterItCameAside(.01, .13, 0).isRefused());
  EXPECT_FALSE(afterItCameAside(.01, .09, 0, Pairing::Shallow).isRefused());
  EXPECT_TRUE(afterItCameAside(.01, .11, 0, Pairing::Shallow).isRefused());
  EXPECT_TRUE(afterItCameAside(.01, .06, 0, Pairing::Stiff).isRefused());
}

TEST(RefusalOfThePotential, whatGrowsStaysShallow)
{
  EXPECT_EQ(afterItCameAside(.01, .06, 0).pairing, Pairing::Growing);
  EXPECT_EQ(afterItCameAside(.01, .06, 0, Pairing::Shallow).pairing, Pairing::ShallowGrowing);
  EXPECT_EQ(afterItCameAside(.01, .01, 0, Pairing::ShallowGrowing).pairing, Pairing::Shallow);
  EXPECT_EQ(afterItCameAside(.01, .01, 0, Pairing::Growing).pairing, Pairing::Usual);
}

TEST(RefusalOfThePotential, theStepCountsHowWhatBeginsDeepGrows)
{
  // Twice the row sum, on a hundredth of a face: k (1.69 / 0.2) c^2 / l beside k w.
  const Real growth = 1e3 * 1.69 / .2 * .06 * .06;
  EXPECT_GT(afterItCameAside(.01, .06, 0).nodeStiffness, 2 * growth);
  EXPECT_LT(afterItCameAside(.01, .01, 0).nodeStiffness, growth); // not deep: it does not grow
}

TEST(RefusalOfThePotential, whatTurnsUntilItIsOpposedBeginsWithLittle)
{
  EXPECT_FALSE(afterItTurned(.01, .06, 0).isRefused());
  EXPECT_TRUE(afterItTurned(.9, .06, 0).isRefused()); // at once by a right angle
  EXPECT_TRUE(afterItTurned(.01, .16, 0).isRefused());
}

TEST_P(StepF_CreatePlane, aPlaneThatOpenedBeginsAnewAtItsSurfaceOnly)
{
  // Ends of two bricks, one above the other: the upper brick is lifted off, slides on, and comes
  // down on the lower one, so that the ends share a hair of area deep behind each other.
  const auto after = [&](Real depth, Real offset)
  {
    PairPlane plane = touchingPlane(1e3);
    plane.depthLimit = .4;
    plane.offset = offset;
    updatePlane<3>(plane, squareBelow(), squareAbove(.01 - offset), usual, 1); // closed by .01
    EXPECT_NEAR(plane.forceOn(1).z, 10, 1e-10);
    updatePlane<3>(plane, squareBelow(), squareAbove(-.01 - offset), usual, 1); // open
    EXPECT_EQ(plane.area, 0.0);
    updatePlane<3>(plane, squareBelow(), squareAbove(depth - offset), usual, 1);
    return plane;
  };
  for (const Real offset : {0., -.05})
  {
    // Up to a quarter of the depth limit it meets the surface; its own offset tells where that is.
    EXPECT_FALSE(after(.09, offset).isRefused());
    EXPECT_NEAR(after(.09, offset).forceOn(1).z, 90, 1e-10); // 1e3 * .09 * 1
    EXPECT_TRUE(after(.11, offset).isRefused());
    EXPECT_EQ(norm(after(.11, offset).forceOn(1)), 0.0);
  }
}

TEST_P(StepF_CreatePlane, needsMoreThanTheSmallestArea)
{
  ContactOptions o = usual;
  o.areaMin = .1;
  PairPlane plane = touchingPlane(1e3);
  plane.state = PlaneState::Slot;
  plane.sighting = Sighting::Known;
  FaceNodes b = squareAbove(.01);
  for (int i = 0; i < 4; ++i)
    b.x[i].x += .95; // 5 % of the face overlap
  updatePlane<3>(plane, squareBelow(), b, o, 1);
  EXPECT_FALSE(plane.isBorn());
  EXPECT_EQ(norm(plane.forceOn(1)), 0.0);
}

TEST_P(StepG_PlacePointOfContact, isHalfWayBetweenTheFacesAtTheCentreOfTheArea)
{
  PairPlane plane = touchingPlane();
  updatePlane<3>(plane, squareBelow(), squareAbove(.02, {}, .5), usual, 1);
  EXPECT_NEAR(plane.pointOfContact.x, .25, 1e-15);
  EXPECT_NEAR(plane.pointOfContact.y, .5, 1e-15);
  EXPECT_NEAR(plane.pointOfContact.z, -.01, 1e-15);
}

TEST_P(StepH_UpdatePlaneVariables, closureIsThatOfTheEndOfTheStep)
{
  // Sinks with 1 m/s, dt = .002: half a step earlier the depth is .009. A force from there would be
  // late by half a step and feed energy in.
  PairPlane plane = touchingPlane(1e3);
  updatePlane<3>(plane, squareBelow(), squareAbove(.01, {0, 0, -1}), usual, .002);
  EXPECT_NEAR(plane.closure, .01, 1e-16);
  EXPECT_NEAR(plane.forceOn(1).z, 10, 1e-12);
}

TEST(StepD_AreaOfContact, forcesDoNotDependOnHowTheFacesCame)
{
  // A face tilted by 1/50 that penetrates over three quarters of its width. It came along the
  // normal, fast or not at all: area and centre of pressure must not lag behind the closure, or
  // else every bounce would gain energy.
  const Mat3 tilt = rotation({0, 1, 0}, -.02);
  for (const auto weights : allWeights)
    for (const auto area : allAreas)
    {
      PairPlane rest, fast;
      for (PairPlane* plane : {&rest, &fast})
      {
        *plane = touchingPlane(1e3);
        FaceNodes b = moved(squareAbove(-.01), tilt);
        const Vec3 normal = rotation({0, 1, 0}, -.01) * Vec3{0, 0, 1};
        for (int i = 0; i < 4; ++i)
        {
          b.x[i] -= .025 * normal;
          b.v[i] = (plane == &fast ? -3.0 : 0.0) * normal;
        }
        updatePlane<3>(*plane, squareBelow(), b, options(area, weights), .002);
      }
      EXPECT_GT(norm(rest.forceOn(1)), 1);
      EXPECT_LT(norm(rest.forceOn(1) - fast.forceOn(1)), 1e-12 * norm(rest.forceOn(1)));
      for (int f = 0; f < 2; ++f)
        for (int i = 0; i < 4; ++i)
          EXPECT_LT(norm(rest.cornerForce[f][i] - fast.cornerForce[f][i]),
                    1e-12 * norm(rest.forceOn(1)));
    }
}

TEST_P(Bounces, ofATiltedFaceKeepTheirEnergy)
{
  // A rigid tilted face of mass 1 kg falls on a flat one again and again, in some ten steps per
  // contact: the force grows with the square of the depth, like the area and the closure together.
  const Real g = 10, dt = 5e-3;
  const Mat3 tilt = rotation({0, 1, 0}, -.2);
  const Vec3 normal = rotation({0, 1, 0}, -.1) * Vec3{0, 0, 1};
  PairPlane plane = touchingPlane(1e4);
  FaceNodes lower = face({{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
  FaceNodes b = moved(squareAbove(0), tilt);
  Real depth = 0, speed = 0, highest = 0; // the corner x = 1 is the deepest
  for (int i = 0; i < 4; ++i)
    depth = std::max(depth, -b.x[i].z);
  const Real start = -.1;
  for (int i = 0; i < 4; ++i)
    b.x[i] += (depth - start) * normal;
  Real height = -start, bounces = 0;
  for (int step = 0; step < 20000; ++step)
  {
    const Real before = speed;
    speed += dt * (dot(plane.forceOn(1), normal) - g);
    if (before > 0 && speed <= 0)
    {
      ++bounces;
      highest = std::max(highest, height);
    }
    height += dt * speed;
    for (int i = 0; i < 4; ++i)
    {
      b.x[i] += (dt * speed) * normal;
      b.v[i] = speed * normal;
    }
    updatePlane<3>(plane, lower, b, usual, dt);
  }
  EXPECT_GT(bounces, 100);
  EXPECT_LT(highest, -start * 1.02);
}

TEST_P(StepH_UpdatePlaneVariables, shearTractionOpposesTheSlipOfTheHigherFace)
{
  // ks = 500 Pa/m, 1e-3 m along x: -.5 Pa on face 1.
  PairPlane plane = touchingPlane(1e3, 10);
  updatePlane<3>(plane, squareBelow(), squareAbove(.01, {.1, 0, 0}), usual, .01);
  EXPECT_NEAR(plane.history.shearTraction.x, -.5, 1e-13);
  EXPECT_LT(plane.forceOn(1).x, 0);
}

TEST_P(StepH_UpdatePlaneVariables, newAreaCarriesNoShear)
{
  // Half of the area carried 2 Pa. Along the common normal all of it carries 1 Pa now, the same
  // force; with the potential sqrt(2) Pa, the same energy.
  PairPlane plane = sheared(2, .5);
  const Real energy = plane.shearEnergy();
  updatePlane<3>(plane, squareBelow(), squareAbove(.01), usual, 1);
  const Real traction = potential() ? std::sqrt(2.0) : 1;
  EXPECT_NEAR(plane.history.shearTraction.x, traction, 1e-14);
  EXPECT_NEAR(plane.forceOn(1).x, traction, 1e-14);
  EXPECT_NEAR(plane.shearEnergy(), potential() ? energy : .5 * energy, 1e-14);
}

TEST_P(StepH_UpdatePlaneVariables, lostAreaTakesItsShearAway)
{
  // Along the common normal the rest keeps its traction; with the potential the plane its energy.
  PairPlane plane = sheared(2, 1);
  FaceNodes b = squareAbove(.01, {}, .5);
  for (int i = 0; i < 4; ++i)
    b.x[i].x += .25; // away from the borders of the other face
  updatePlane<3>(plane, squareBelow(), b, usual, 1);
  const Real traction = potential() ? 2 * std::sqrt(2.0) : 2;
  EXPECT_NEAR(plane.history.shearTraction.x, traction, 1e-14);
  EXPECT_NEAR(plane.forceOn(1).x, .5 * traction, 1e-14);
}

TEST(StepH_AlongCommonNormal, withoutTheAreaRuleTheTractionStays)
{
  ContactOptions o = alongCommonNormal;
  o.areaRule = false;
  PairPlane plane = sheared(2, .5);
  updatePlane<3>(plane, squareBelow(), squareAbove(.01), o, 1);
  EXPECT_NEAR(plane.history.shearTraction.x, 2, 1e-14);
}

TEST_P(StepH_UpdatePlaneVariables, depthBeyondTheLimitIsTold)
{
  // Along the common normal the force is frozen there; that of the potential goes on.
  PairPlane plane = touchingPlane(1e3);
  plane.depthLimit = 1.F / 64;
  updatePlane<3>(plane, squareBelow(), squareAbove(.003), usual, 1); // begins at the surface
  updatePlane<3>(plane, squareBelow(), squareAbove(1. / 64), usual, 1);
  EXPECT_FALSE(plane.tooDeep);
  const Real atTheLimit = plane.forceOn(1).z;
  updatePlane<3>(plane, squareBelow(), squareAbove(.05), usual, 1);
  EXPECT_TRUE(plane.tooDeep);
  EXPECT_NEAR(plane.forceOn(1).z, potential() ? 50 : atTheLimit, 1e-12);
  updatePlane<3>(plane, squareBelow(), squareAbove(.01), usual, 1);
  EXPECT_FALSE(plane.tooDeep);
  EXPECT_NEAR(plane.forceOn(1).z, 10, 1e-12);
}

TEST_P(StepH_UpdatePlaneVariables, dampingNeverPulls)
{
  ContactOptions o = usual;
  o.dampNormal = 1;
  for (const Real speed : {.1, 1.0, 10.0, 1000.0})
  {
    PairPlane plane = touchingPlane(1e3);
    updatePlane<3>(plane, squareBelow(), squareAbove(.01, {0, 0, speed}), o, 1e-6);
    EXPECT_GE(plane.forceOn(1).z, 0) << speed;
    EXPECT_LT(plane.forceOn(1).z, 10) << speed;
  }
}

TEST_P(StepH_UpdatePlaneVariables, dampingHasTheCriticalConstantOfTheSurfacesPerArea)
{
  // Surfaces of 2 and 6 kg/m^2, of 1.5 together, on a spring of 1e3 Pa/m: the pressure
  // 2 zeta sqrt(k m) v on top of the 10 Pa of the closure; on half of the area half of that.
  ContactOptions o = usual;
  o.dampNormal = .1;
  const Real pressure = 10 + .2 * std::sqrt(1500.0) * .5;
  FaceNodes lower = squareBelow(), upper = squareAbove(.01, {0, 0, -.5});
  lower.mass = 2;
  upper.mass = 6;
  PairPlane whole = touchingPlane(1e3);
  updatePlane<3>(whole, lower, upper, o, 1e-9);
  EXPECT_NEAR(whole.forceOn(1).z, pressure, 1e-10);

  for (Vec3& x : upper.x)
    x.x += .5;
  PairPlane half = touchingPlane(1e3);
  updatePlane<3>(half, lower, upper, o, 1e-9);
  EXPECT_NEAR(half.forceOn(1).z, .5 * pressure, 1e-10);

  // A face that is stretched to twice its area spreads the same mass.
  for (Vec3& x : upper.x)
    x.x = 2 * (x.x - .5);
  for (Vec3& x : lower.x)
    x.x *= 2;
  PairPlane stretched = touchingPlane(1e3);
  updatePlane<3>(stretched, lower, upper, o, 1e-9);
  EXPECT_NEAR(stretched.forceOn(1).z, 2 * (10 + .2 * std::sqrt(750.0) * .5), 1e-10);
}

TEST_P(StepH_UpdatePlaneVariables, dampingOfSlipHasTheCriticalConstantToo)
{
  // Held by friction of 9 Pa: the traction 2 zeta sqrt(k_s m) v, k_s = 500 Pa/m.
  ContactOptions o = usual;
  o.dampShear = .1;
  FaceNodes lower = squareBelow(), upper = squareAbove(.01, {.05, 0, 0});
  lower.mass = 2;
  upper.mass = 6;
  PairPlane plane = touchingPlane(1e3, .9);
  updatePlane<3>(plane, lower, upper, o, 1e-9);
  EXPECT_EQ(plane.state, PlaneState::Stick);
  EXPECT_NEAR(plane.forceOn(1).x, -.2 * std::sqrt(500 * 1.5) * .05 - 500 * .05e-9, 1e-10);
}

TEST_P(StepH_UpdatePlaneVariables, workOfNodesIsStoredDuringFrictionlessLoading)
{
  // Flat faces, constant area: the trapezoid is exact for a linear joint.
  PairPlane plane = touchingPlane(1e3);
  for (int step = 1; step <= 10; ++step)
    updatePlane<3>(plane, squareBelow(), squareAbove(.001 * step, {0, 0, -1}), usual, .001);
  EXPECT_NEAR(plane.stored, .5 * 1e3 * 1e-4, 1e-15);
  EXPECT_NEAR(plane.work, plane.stored, 1e-15);
}

TEST_P(StepH_UpdatePlaneVariables, workIsStoredOrDissipatedWhileSlipping)
{
  // Pressed by 10 Pa, then dragged: work = stored + friction while the gap changes neither the arm
  // nor the area. The couple does no work on a translation.
  PairPlane plane = touchingPlane(1e3, .5);
  const FaceNodes lower = face({{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
  updatePlane<3>(plane, lower, squareAbove(.01, {0, 0, -1}), usual, .01);
  for (int step = 1; step <= 100; ++step)
  {
    FaceNodes b = squareAbove(.01, {1, 0, 0});
    for (int i = 0; i < 4; ++i)
      b.x[i].x += .001 * step;
    updatePlane<3>(plane, lower, b, usual, .001);
  }
  EXPECT_EQ(plane.state, PlaneState::Slip);
  EXPECT_NEAR(plane.history.slip, .1 - .01, 1e-14); // elastic part 5 Pa / 500 Pa/m
  EXPECT_NEAR(plane.work, plane.stored + plane.frictionWork, 1e-13);
}

TEST_P(OpenUp, clearsTheShearTractionAndKeepsTheLargestClosure)
{
  PairPlane plane = sheared(2, 1);
  updatePlane<3>(plane, squareBelow(), squareAbove(.01), usual, 1);
  EXPECT_EQ(plane.state, PlaneState::Stick);
  updatePlane<3>(plane, squareBelow(), squareAbove(-.01), usual, 1);
  EXPECT_EQ(plane.state, PlaneState::Open);
  EXPECT_TRUE(plane.isBorn());
  EXPECT_EQ(norm(plane.history.shearTraction), 0.0);
  EXPECT_NEAR(plane.history.maximumClosure, .01, 1e-16);
  EXPECT_EQ(plane.area, 0.0);
  EXPECT_EQ(norm(plane.forceOn(1)), 0.0);
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(norm(plane.cornerForce[f][i]), 0.0);
}

TEST(TurnIntoPlane, keepsTheLengthAndLiesInTheNewPlane)
{
  std::mt19937 random(31);
  std::uniform_real_distribution<Real> u(-1, 1);
  for (int n = 0; n < 1000; ++n)
  {
    const Vec3 from = normalised({u(random), u(random), u(random)});
    const Vec3 to = normalised(from + .5 * Vec3{u(random), u(random), u(random)});
    const Vec3 any{u(random), u(random), u(random)};
    const Vec3 tau = any - dot(any, from) * from;
    const Vec3 got = turnIntoPlane<Real>(tau, from, to, {u(random), u(random), u(random)}, .3);
    EXPECT_NEAR(norm(got), norm(tau), 1e-14);
    EXPECT_NEAR(dot(got, to), 0, 1e-14);
  }
}

TEST(TurnIntoPlane, turnsWithTheSpinAboutTheNormal)
{
  const Vec3 got = turnIntoPlane<Real>({2, 0, 0}, {0, 0, 1}, {0, 0, 1}, {5, 7, .3}, .5);
  // The spin is a Cayley vector: .3 * .5 = 2 tan(angle / 2).
  const Real angle = 2 * std::atan(.075);
  EXPECT_NEAR(got.x, 2 * std::cos(angle), 1e-15);
  EXPECT_NEAR(got.y, 2 * std::sin(angle), 1e-15);
}

TEST(TurnIntoPlane, followsTheLeastRotation)
{
  // Normal from z towards x by 30 degrees: y stays, x goes to the new in-plane direction.
  const Real c = std::cos(pi / 6), s = std::sin(pi / 6);
  const Vec3 y = turnIntoPlane<Real>({0, 1, 0}, {0, 0, 1}, {s, 0, c}, {}, 1);
  EXPECT_NEAR(y.y, 1, 1e-15);
  const Vec3 x = turnIntoPlane<Real>({1, 0, 0}, {0, 0, 1}, {s, 0, c}, {}, 1);
  EXPECT_NEAR(x.x, c, 1e-15);
  EXPECT_NEAR(x.z, -s, 1e-15);
}

TEST_P(FacePair_Degenerate, millionSliversStayFiniteWithinTheirAreaAndInBalance)
{
  // Flattened, nearly collapsed and nearly coincident faces: coordinates are rounded to a coarse
  // grid and then disturbed by 0 to 1e-3. The ranks share the work.
  constexpr int pairs = 1000000;
  const Comm comm;
  std::mt19937 random(32 + comm.rank());
  std::uniform_real_distribution<Real> u(-1, 1);
  std::uniform_int_distribution<int> grid(-2, 2), magnitude(0, 15), corners(3, 4);
  int touching = 0;
  Real worstMoment = 0;
  for (int n = comm.rank(); n < pairs; n += comm.size())
  {
    FaceNodes f[2];
    const Real disturbance = std::pow(10.0, -3 - magnitude(random));
    for (int k = 0; k < 2; ++k)
    {
      f[k].count = corners(random);
      for (int i = 0; i < f[k].count; ++i)
      {
        f[k].x[i] = {.5 * grid(random) + disturbance * u(random),
                     .5 * grid(random) + disturbance * u(random), disturbance * u(random)};
        f[k].v[i] = {u(random), u(random), u(random)};
      }
      // Turn it over if it looks away.
      if ((vectorArea<3>(f[k].x, f[k].count).z > 0) != (k == 0))
        std::reverse(f[k].x, f[k].x + f[k].count);
    }
    PairPlane plane = touchingPlane(1e3, .5);
    updatePlane<3>(plane, f[0], f[1],
                   potential() ? usual : options(allAreas[touching % 2], allWeights[touching % 3]),
                   1e-4);
    ASSERT_TRUE(finite(plane.forceOn(1)) && finite(plane.normal) && std::isfinite(plane.gap) &&
                std::isfinite(plane.work))
        << n;
    ASSERT_GE(plane.area, 0) << n;
    if (!(plane.area > 0))
      continue;
    // Faces shrunk to a point move by many of their own sizes in a step: finite is all that counts.
    Real shortest = infinity;
    for (int k = 0; k < 2; ++k)
    {
      Real extent = 0;
      for (int i = 1; i < f[k].count; ++i)
        extent = std::max(extent, norm(f[k].x[i] - f[k].x[0]));
      shortest = std::min(shortest, extent);
    }
    if (shortest < .01)
      continue;
    const Real back = potential() ? 0 : 1e-4;
    const HalfStepFace a = stepA_halfStepFace<3>(f[0], back), b = stepA_halfStepFace<3>(f[1], back);
    // Of needles a millionth as wide as long, forces have no digits left.
    if (potential() && std::min(a.area, b.area) < 1e-6)
      continue;
    ++touching;
    // Of a face that is folded what lies right side up carries, within a triangle of its corners;
    // its vector area is smaller.
    const Real most =
        potential() ? std::min(areaOrTriangle(a), areaOrTriangle(b)) : std::min(a.area, b.area);
    ASSERT_LE(plane.area, most * (1 + 1e-10) + 1e-14) << n;
    ASSERT_LE(plane.area, plane.overlap * (1 + 1e-12)) << n;
    Real largest = norm(plane.forceOn(1));
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < f[k].count; ++i)
      {
        ASSERT_TRUE(finite(plane.cornerForce[k][i])) << n;
        largest = std::max(largest, norm(plane.cornerForce[k][i]));
      }
    const Resultant sum = resultant(f[0], f[1], plane.cornerForce);
    // Round-off of the couple grows with the square of the aspect ratio; beyond 3000 there is none.
    // The potential moves the force to its place by turning faces: there is no such bound for faces
    // of little area, folded ones above all.
    if (!potential())
    {
      ASSERT_LE(largest, 1e3 * norm(plane.forceOn(1))) << n;
    }
    // Closures of round-off give forces without digits.
    const Real size = potential() ? largest + 1e-7 : norm(plane.forceOn(1));
    // Round-off of needles; of those with less than 2e-5 m^2 it grows as their area falls: 6.8e-7
    // of the forces at 1.4e-6 m^2, the most in four million pairs.
    const Real thin = std::min(a.area, b.area);
    ASSERT_LE(norm(sum.force), (potential() ? std::max(1e-7, 2e-12 / thin) : 1e-9) * size) << n;
    worstMoment = std::max(worstMoment, norm(sum.moment) / size);
  }
  EXPECT_GT(touching, pairs / comm.size() / 10);
  EXPECT_LT(worstMoment, potential() ? 1e-5 : 2e-3)
      << "without a couple: the gap, at most the disturbance of 1e-3";
}
