#include <coplane_contact/detail/Inheritance.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace coplane
{
namespace
{
/// Face 10 slides over a surface of quadrilaterals: 21 (nodes 1 2 3 4) and, beside it, 22 (nodes 2
/// 5 6 3). Face 23 (nodes 7 8 9 10) belongs to another body.
Donor planeOf10And(GlobalId face, std::array<GlobalId, 4> nodes, Real area, Real closure)
{
  Donor donor;
  donor.faceId[0] = 10;
  donor.faceId[1] = face;
  for (int k = 0; k < 4; ++k)
  {
    donor.nodes[0][k] = 101 + k;
    donor.nodes[1][k] = nodes[k];
  }
  donor.normal = {0, 0, 1};
  donor.area = area;
  donor.closure = closure;
  donor.offset = -closure;
  return donor;
}

Plane pairOf10And22()
{
  Plane plane;
  plane.faceId[0] = 10;
  plane.faceId[1] = 22;
  return plane;
}
const PairNodes nodes{{{101, 102, 103, 104}, {2, 5, 6, 3}}};
} // namespace

TEST(Inheritance, givesTheMeansOfTheDonorsByTheirAreas)
{
  Plane plane = pairOf10And22();
  std::vector<Donor> donors{planeOf10And(23, {7, 8, 9, 10}, 1, .04),
                            planeOf10And(21, {1, 2, 3, 4}, 3, .08)};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, donors));
  EXPECT_TRUE(plane.isInherited());
  EXPECT_NEAR(plane.closure, .07, 1e-15);
  EXPECT_NEAR(plane.offset, -.07, 1e-15);
}

TEST(Inheritance, ofACrushedJointThatRestsWhereNoneCarries)
{
  Donor rests = planeOf10And(21, {1, 2, 3, 4}, 1, 0);
  rests.rests = true;
  rests.history.maximumClosure = .02;
  Donor carries = planeOf10And(23, {7, 8, 9, 10}, 3, .04);
  carries.history.maximumClosure = .05;
  Plane plane = pairOf10And22();
  std::vector<Donor> alone{rests};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, alone));
  EXPECT_EQ(plane.history.maximumClosure, .02);
  std::vector<Donor> both{rests, carries};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, both));
  EXPECT_NEAR(plane.history.maximumClosure, .05, 1e-16);
  EXPECT_NE(plane.lineage, Lineage::SlidesOn);
}

TEST(Inheritance, isOfPlanesThatCarryOrAreCrushedOrHaveAbsorbed)
{
  JointLaw law;
  Plane plane;
  plane.fit.normalStiffness = 1e11;
  plane.history.maximumClosure = 1e-3;
  EXPECT_FALSE(isDonor(plane, law)) << "never touched";
  plane.state = PlaneState::Open;
  EXPECT_FALSE(isDonor(plane, law));
  law.curve.crushing.strength = 1e7;
  law.curve.crushing.peak = 1e-4;
  EXPECT_TRUE(isDonor(plane, law));
  EXPECT_TRUE(donorOf(plane).rests);
  EXPECT_EQ(donorOf(plane).area, 1);
  plane.history.maximumClosure = 1e-5;
  EXPECT_FALSE(isDonor(plane, law)) << "elastic until now";
  plane.depthLimit = .1;
  plane.offset = 1e-4;
  EXPECT_FALSE(isDonor(plane, law)) << "by dilation";
  plane.absorb(1e-15);
  EXPECT_FALSE(isDonor(plane, law)) << "round-off of coordinates";
  for (const Real absorbed : {-1e-4, 1e-4})
  {
    plane.absorb(absorbed);
    EXPECT_TRUE(isDonor(plane, law));
    EXPECT_TRUE(donorOf(plane).rests);
  }
  plane.absorb(0);
  plane.area = plane.overlap = .5;
  EXPECT_TRUE(isDonor(plane, law));
  EXPECT_FALSE(donorOf(plane).rests);
  EXPECT_EQ(donorOf(plane).area, .5);
}

TEST(Inheritance, tellsTheSameSurfaceFromAnotherBody)
{
  Plane plane = pairOf10And22();
  std::vector<Donor> other{planeOf10And(23, {7, 8, 9, 10}, 1, .04)};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, other));
  EXPECT_NE(plane.lineage, Lineage::SlidesOn);
  std::vector<Donor> beside{planeOf10And(21, {1, 2, 3, 4}, 1, .04)};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, beside));
  EXPECT_EQ(plane.lineage, Lineage::SlidesOn);
  // It has to be a donor that counts: one that looks elsewhere does not.
  beside[0].normal = {1, 0, 0};
  other.push_back(beside[0]);
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, other));
  EXPECT_NE(plane.lineage, Lineage::SlidesOn);
}

TEST(Inheritance, doesNotDependOnWhichFaceHasTheLowerId)
{
  // Face 30 slides over faces 21, where it has the higher id, and 31, where it has the lower one:
  // their normals and tractions are opposite, and so is what they hand on.
  const auto handedOn = [](GlobalId lower, GlobalId higher, Real sign)
  {
    Donor donor;
    donor.faceId[0] = lower;
    donor.faceId[1] = higher;
    donor.normal = {0, 0, sign};
    donor.history.shearTraction = {sign * 5e6, 0, 0};
    donor.area = 1;
    donor.closure = .04;
    Plane plane;
    plane.faceId[0] = 30;
    plane.faceId[1] = 32;
    std::vector<Donor> donors{donor};
    EXPECT_TRUE(inherit(plane, {0, 0, 1}, {}, donors)) << lower << " " << higher;
    EXPECT_NEAR(plane.closure, .04, 1e-15);
    EXPECT_NEAR(norm(plane.history.shearTraction - Vec3{5e6, 0, 0}), 0, 1e-8);
  };
  handedOn(30, 31, 1);
  handedOn(21, 30, -1);
  // A neighbour that looks the other way counts for neither.
  Donor front;
  front.faceId[0] = 21;
  front.faceId[1] = 30;
  front.normal = {0, 0, 1};
  front.area = 1;
  Plane plane;
  plane.faceId[0] = 30;
  plane.faceId[1] = 32;
  std::vector<Donor> donors{front};
  EXPECT_FALSE(inherit(plane, {0, 0, 1}, {}, donors));
}

TEST(Inheritance, facesWithoutNodesAreOnNoSurface)
{
  Plane plane = pairOf10And22();
  std::vector<Donor> donors{planeOf10And(21, {0, 0, 0, 0}, 1, .04)};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, {{{101, 102, 0, 0}, {2, 5, 0, 0}}}, donors));
  EXPECT_NE(plane.lineage, Lineage::SlidesOn);
}

namespace
{
bool continues(const NewPair& pair, const Donor& donor, int dimension, Real reach)
{
  const Continuation continuation(pair, dimension, reach);
  return continuation.isNear(donor) && continuation.goesOn(donor);
}

/// In the plane z = 0 (two dimensions: y = 0): face 10, wide, faces upwards; face 21 lies on it
/// from x = 0 to 1 and carries a plane. Face 22 looks down on it from x0 on, 1 m wide, `gap` above
/// it, and shares a node with face 21, or none.
struct Scene
{
  int dimension = 3;
  Real x0 = 1, gap = 0;
  bool sameSurface = true;
  Real donorOffset = 0, donorGap = -1e-5;
  bool donorRests = false, ofSameBodies = true;
  Real sharedBefore = -1;
  bool wideIsLower = true;

  static void put(int dimension, bool up, Real from, Real to, Real height, Vec3* corners)
  {
    if (dimension == 2)
    {
      // The outward normal lies on the right of the direction.
      corners[0] = {up ? to : from, height, 0};
      corners[1] = {up ? from : to, height, 0};
      return;
    }
    const Vec3 square[4] = {{from, 0, height}, {to, 0, height}, {to, 1, height}, {from, 1, height}};
    for (int k = 0; k < 4; ++k)
      corners[k] = square[up ? k : 3 - k];
  }

  bool continued(Real reach = 0.1) const
  {
    const int count = dimension == 2 ? 2 : 4;
    const int wide = wideIsLower ? 0 : 1;
    const GlobalId wideId = wideIsLower ? 10 : 30;
    NewPair pair;
    pair.sharedBefore = sharedBefore;
    Donor donor;
    pair.faceId[wide] = donor.faceId[wide] = wideId;
    pair.faceId[1 - wide] = 22;
    donor.faceId[1 - wide] = 21;
    for (int side = 0; side < 2; ++side)
      pair.count[side] = donor.count[side] = count;
    put(dimension, true, -5, 5, 0, pair.corners[wide]);
    put(dimension, true, -5, 5, 0, donor.corners[wide]);
    put(dimension, false, x0, x0 + 1, gap, pair.corners[1 - wide]);
    put(dimension, false, 0, 1, donorGap, donor.corners[1 - wide]);
    for (int k = 0; k < count; ++k)
    {
      pair.nodes[wide][k] = donor.nodes[wide][k] = 101 + k;
      donor.nodes[1 - wide][k] = 1 + k;
      pair.nodes[1 - wide][k] = (sameSurface ? 2 : 51) + k;
    }
    const Real up = wideIsLower ? 1 : -1;
    pair.normal = donor.normal = dimension == 2 ? Vec3{0, up, 0} : Vec3{0, 0, up};
    donor.offset = donorOffset;
    donor.history.absorbed = donorOffset != 0;
    donor.rests = donorRests;
    donor.ofSameBodies = ofSameBodies;
    return continues(pair, donor, dimension, reach);
  }
};

/// The scene in two and three dimensions, whichever face has the lower id, all alike.
bool continued(Scene scene)
{
  std::vector<bool> answers;
  for (const int dimension : {2, 3})
    for (const bool lower : {false, true})
    {
      scene.dimension = dimension;
      scene.wideIsLower = lower;
      answers.push_back(scene.continued());
    }
  for (const bool answer : answers)
    EXPECT_EQ(answer, answers[0]);
  return answers[0];
}

Scene at(Real x0, Real gap = 0, bool sameSurface = true, Real donorOffset = 0)
{
  Scene scene;
  scene.x0 = x0;
  scene.gap = gap;
  scene.sameSurface = sameSurface;
  scene.donorOffset = donorOffset;
  return scene;
}
} // namespace

TEST(Continuation, ofAnAreaOnTheSameSurface)
{
  EXPECT_TRUE(continued(at(1.0, -1e-5)));
  EXPECT_TRUE(continued(at(1.09, -1e-5))) << "within reach";
  EXPECT_FALSE(continued(at(1.2, -1e-5))) << "beside";
  EXPECT_FALSE(continued(at(2.5, -1e-5)));
  EXPECT_FALSE(continued(at(-2.5, -1e-5)));
}

TEST(Continuation, isNoneWhereTheFacesAreApart)
{
  EXPECT_FALSE(continued(at(1.0, 1e-5)));
  EXPECT_TRUE(continued(at(1.0, 1e-5, true, 2e-5))) << "closed where the donor is closed";
}

TEST(Continuation, isNoneForAnotherBodyThatHasComeDownBesideTheDonor)
{
  EXPECT_FALSE(continued(at(1.0, -1e-5, false)));
  EXPECT_FALSE(continued(at(1.0, 0.01, false, 0.02))) << "below the gap that a joint has absorbed";
}

TEST(Continuation, ofWhatRestsOnlyWhileItsFacesLieInEachOther)
{
  Scene scene = at(1.0, -1e-5);
  scene.donorRests = true;
  EXPECT_TRUE(continued(scene));
  scene.donorGap = 1e-5;
  EXPECT_FALSE(continued(scene));
  scene.donorOffset = 2e-5;
  EXPECT_TRUE(continued(scene));
  scene.donorRests = false;
  scene.donorOffset = 0;
  EXPECT_TRUE(continued(scene)) << "what carries is not asked";
}

TEST(Continuation, ofWhatHasAbsorbedAGapOrAnOverlapWhetherItTouchesOrNot)
{
  for (const Real absorbed : {-0.02, 0.02})
  {
    SCOPED_TRACE(absorbed);
    Scene scene = at(1.0, absorbed + 1e-5);
    scene.donorRests = true;
    scene.donorOffset = absorbed;
    scene.donorGap = absorbed + 1e-5;
    scene.gap = std::min(absorbed, 0.0) - 1e-5; // shares area: closed
    EXPECT_TRUE(continued(scene));
    scene.gap = std::max(absorbed, 0.0) + 0.2; // apart, by less than joints absorb
    EXPECT_TRUE(continued(scene));
    scene.gap = std::max(absorbed, 0.0) + 0.3;
    EXPECT_FALSE(continued(scene));
    // It knows as much of what comes over a gap between two bodies as joints absorb, whatever the
    // skin is.
    scene.gap = -0.5;
    scene.x0 = 1.2;
    EXPECT_TRUE(continued(scene)) << "within a quarter of a face";
    scene.x0 = 1.3;
    EXPECT_FALSE(continued(scene));
  }
}

TEST(Continuation, ofWhatTwoBodiesHaveAbsorbedToAThirdOneWhereThatIsLevel)
{
  // A brick stands over a gap of 0.02 that its bed joint has absorbed. Another one comes beside it.
  Scene scene = at(1.05, 0, false, 0.02);
  scene.donorRests = true;
  scene.donorGap = 0.02;
  scene.ofSameBodies = false;
  scene.sharedBefore = 0; // it comes in from the side
  for (const Real gap : {1e-4, 0.02, 0.04})
  {
    scene.gap = gap;
    EXPECT_EQ(continued(scene), gap == 0.02) << gap;
  }
}

TEST(Inheritance, isBetweenTheSameTwoBodiesWhereTheyHaveSome)
{
  Plane plane = pairOf10And22();
  std::vector<Donor> donors{planeOf10And(23, {7, 8, 9, 10}, 1, .04),
                            planeOf10And(21, {1, 2, 3, 4}, 3, .08)};
  donors[0].ofSameBodies = false;
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, donors));
  EXPECT_NEAR(plane.offset, -.08, 1e-15);
}

TEST(Continuation, overASeamBetweenTwoBodies)
{
  // A face of 1 m slides from face 21 to face 22 of another body, which begins where 21 ends. Until
  // it gets there it shares no area with it.
  for (const int dimension : {2, 3})
    for (const Real way : {-0.05, 0.0, 0.5})
    {
      SCOPED_TRACE(way);
      NewPair pair;
      Donor donor;
      pair.faceId[0] = donor.faceId[0] = 10;
      pair.faceId[1] = 22;
      donor.faceId[1] = 21;
      for (int side = 0; side < 2; ++side)
        pair.count[side] = donor.count[side] = dimension == 2 ? 2 : 4;
      Scene::put(dimension, true, way, 1 + way, 0, pair.corners[0]);
      Scene::put(dimension, true, way, 1 + way, 0, donor.corners[0]);
      Scene::put(dimension, false, 1, 2, -1e-5, pair.corners[1]);
      Scene::put(dimension, false, 0, 1, -1e-5, donor.corners[1]);
      for (int k = 0; k < 4; ++k)
      {
        donor.nodes[1][k] = 1 + k;
        pair.nodes[1][k] = 51 + k;
      }
      pair.normal = donor.normal = dimension == 2 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
      // Once there is area it would have been born: a pair that is new then has come from
      // elsewhere.
      EXPECT_EQ(continues(pair, donor, dimension, 0.1), way <= 0);
    }
}

TEST(Inheritance, bondsGoOnWhereMostOfTheAreaIsBonded)
{
  for (const Real bondedArea : {1.0, 3.0})
  {
    Plane plane = pairOf10And22();
    std::vector<Donor> donors{planeOf10And(21, {1, 2, 3, 4}, bondedArea, .04),
                              planeOf10And(23, {7, 8, 9, 10}, 2, .04)};
    donors[0].history.bonded = true;
    donors[0].history.opening = 3e-4;
    donors[0].history.shearing = 2e-4;
    EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, donors));
    EXPECT_EQ(plane.history.bonded, bondedArea > 2);
    EXPECT_EQ(plane.history.opening, bondedArea > 2 ? 3e-4 : 0);
    EXPECT_EQ(plane.history.shearing, bondedArea > 2 ? 2e-4 : 0);
    // Bricks that are bonded to each other are not to what slides over their seam.
    donors[0].ofSameBodies = false;
    plane = pairOf10And22();
    EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, donors));
    EXPECT_FALSE(plane.history.bonded);
  }
}
} // namespace coplane
