#include "FaceClouds.hpp"
#include "MovingPairs.hpp"

// Step 5: reasons to refuse a pair.

namespace coplane::testing
{
namespace
{
/// Two squares of side 1 face to face, `gap` apart along z; judged with a skin of 0.1 m.
Verdict judgeSquares(Real gap, Real thickness, const std::function<void(Face&, Face&)>& change = {},
                     const Vec3& secondNormal = {0, 0, -1}, CandidateRules rules = {})
{
  Scene scene;
  scene.add(faceId(1, 0), {0, 0, 0}, {0, 0, 1}, 1, thickness);
  scene.add(faceId(2, 0), {0.2, 0.1, gap}, secondNormal, 1, thickness);
  Face a = scene.faces[0], b = scene.faces[1];
  a.local = b.local = true;
  if (change)
    change(a, b);
  const NodeVectors x = positions(scene);
  rules.skin = rules.reach = 0.1;
  const FacePlane planeA = facePlane(a, x, 3), planeB = facePlane(b, x, 3);
  return judgePair(a, b, contactBox(a, planeA, x, rules), contactBox(b, planeB, x, rules), planeA,
                   planeB, x, rules);
}
} // namespace

TEST(Step5CandidatePairs, squaresFaceToFaceWithinTheSkinAreACandidate)
{
  EXPECT_EQ(judgeSquares(0.05, 1), Verdict::Candidate);
  EXPECT_EQ(judgeSquares(-0.05, 1), Verdict::Candidate); // overlapping
}

TEST(Step5CandidatePairs, squaresFartherApartThanTheSkinAreNot)
{
  EXPECT_EQ(judgeSquares(0.11, 1), Verdict::TooFarApart);
}

TEST(Step5CandidatePairs, facesOfTheSameElementAreNeverPaired)
{
  EXPECT_EQ(judgeSquares(0.05, 1, [](Face& a, Face& b) { b.id = faceId(elementOfFace(a.id), 3); }),
            Verdict::SameElement);
}

TEST(Step5CandidatePairs, twoGhostsAreLeftToTheRanksThatOwnThem)
{
  EXPECT_EQ(judgeSquares(0.05, 1, [](Face& a, Face& b) { a.local = b.local = false; }),
            Verdict::BothGhost);
  EXPECT_EQ(judgeSquares(0.05, 1, [](Face& a, Face&) { a.local = false; }), Verdict::Candidate);
}

TEST(Step5CandidatePairs, onlyAPairThatWasACandidateBeforeWasMissed)
{
  // Two squares near each other that have become candidates while n0.n1 can have turned by 0.05.
  const auto wasMissed = [](Real cosine, bool sharesNode, Real gap)
  {
    Scene scene;
    scene.add(faceId(1, 0), {0, 0, 0}, {0, 0, 1}, 1, 1);
    scene.add(faceId(2, 0), {0, 0, gap}, {std::sqrt(1 - cosine * cosine), 0, -cosine}, 1, 1);
    if (sharesNode)
      scene.faces[1].nodes[2] = scene.faces[0].nodes[0];
    CandidateRules rules;
    rules.skin = rules.reach = 0.1;
    rules.declared = [](int, int) { return true; };
    const NodeVectors x = positions(scene);
    Scene apart = scene; // planes as if each had its own nodes
    apart.faces[1].nodes[2] = 6;
    const FacePlane planeA = facePlane(apart.faces[0], x, 3),
                    planeB = facePlane(apart.faces[1], x, 3);
    return hadToBeFound(scene.faces[0], scene.faces[1], planeA, planeB, rules, 0.1, 0.05);
  };
  EXPECT_TRUE(wasMissed(0.5, false, 0.05));
  const Real least = CandidateRules().cosOpposed;
  EXPECT_TRUE(wasMissed(least + 0.06, false, 0.05));
  EXPECT_FALSE(wasMissed(least + 0.04, false, 0.05)); // opposed by turning
  EXPECT_FALSE(wasMissed(0.99, false, -0.55));        // risen from below the largest depth
  EXPECT_TRUE(wasMissed(0.99, true, 0.05));           // the tip of a joint
  EXPECT_FALSE(wasMissed(0.91, true, 0.05));          // just folded onto each other
  EXPECT_FALSE(wasMissed(0.99, true, 0.55));          // just come near each other
  EXPECT_FALSE(wasMissed(0.5, true, 0.05));           // neighbours
}

TEST(Step5CandidatePairs, aPairBesideEachOtherThatHasTurnedIntoTheDepthLimitWasNotMissed)
{
  // Two squares whose centres are 0.8 m apart along their plane and 0.53 m in each other, both
  // turned together by so much [rad]. The deepest candidates lie 0.6 m in each other.
  struct Pair
  {
    Scene scene;
    CandidateRules rules;
    FacePlane planeA, planeB;
    NodeVectors x;
    explicit Pair(Real turned, Real deeper = 0)
    {
      const Vec3 n{std::sin(turned), 0, std::cos(turned)};
      scene.add(faceId(1, 0), {0, 0, 0}, n, 1, 1).local = true;
      scene.add(faceId(2, 0), {.8, 0, -.53 - deeper}, -1.0 * n, 1, 1).local = true;
      rules.skin = rules.reach = .1;
      x = positions(scene);
      planeA = facePlane(scene.faces[0], x, 3);
      planeB = facePlane(scene.faces[1], x, 3);
    }
  };
  // Just before, 0.05 m of motion and 0.05 of turning ago, it was too deep.
  const Pair before(-.05, .05), now(0);
  const auto box = [](const Pair& pair, int f) {
    return contactBox(pair.scene.faces[f], f == 0 ? pair.planeA : pair.planeB, pair.x, pair.rules);
  };
  EXPECT_EQ(judgePair(before.scene.faces[0], before.scene.faces[1], box(before, 0), box(before, 1),
                      before.planeA, before.planeB, before.x, before.rules),
            Verdict::TooFarApart);
  const auto wasMissed = [&](Real moved, Real turned)
  {
    return hadToBeFound(now.scene.faces[0], now.scene.faces[1], now.planeA, now.planeB, now.rules,
                        moved, turned);
  };
  EXPECT_FALSE(wasMissed(.05, .05));
  EXPECT_TRUE(wasMissed(.05, .02)); // too little turning to have been out of reach
  EXPECT_FALSE(wasMissed(.08, 0));
}

// Warped faces too, whose planes meet where their nodes are apart.
TEST(Step5CandidatePairs, whatActsUntilTheNextSearchIsACandidate)
{
  constexpr int count = 300000;
  constexpr Real stray = 1e-3; // [m]
  for (const Real swiftness : {0.0, 0.3})
  {
    movingpairs::MovingPairs pairs(count, 11, swiftness, stray);
    CandidateRules rules = pairs.rules;
    rules.skin = rules.reach = 2 * std::sqrt(3.0) * stray;
    for (int f = 0; f < 2 * count; ++f)
    {
      Face& face = pairs.faces(f);
      face.id = faceId(f, 0);
      face.local = true;
      face.thickness = 0.1;
    }
    const auto verdict = [&](int p)
    {
      const int a = 2 * p, b = a + 1;
      const auto box = [&](int f)
      { return contactBox(pairs.faces(f), pairs.planes(f), pairs.x, rules); };
      return judgePair(pairs.faces(a), pairs.faces(b), box(a), box(b), pairs.planes(a),
                       pairs.planes(b), pairs.x, rules);
    };
    const auto centersGap = [&](int p)
    {
      const FacePlane &a = pairs.planes(2 * p), &b = pairs.planes(2 * p + 1);
      return dot(normalised(a.normal - b.normal), b.center - a.center);
    };
    for (const Real since : {0.0, movingpairs::ahead})
    {
      pairs.goOn(since);
      int acting = 0;
      for (int p = 0; p < count; ++p)
      {
        const Plane plane = movingpairs::looked(pairs.faceNow(2 * p), pairs.faceNow(2 * p + 1), 3,
                                                PlaneState::Open);
        const Real deepest = -rules.depthMax * pairs.faces(2 * p).thickness;
        if (!(plane.area > 0) || plane.gap < deepest || centersGap(p) < deepest)
          continue;
        ++acting;
        EXPECT_EQ(verdict(p), Verdict::Candidate)
            << "pair " << p << " at " << swiftness << " m/s after " << since << " s";
      }
      EXPECT_GT(acting, count / 100);
    }
  }
}

TEST(Step5CandidatePairs, facesThatShareANodeAreNeighboursOfOneBody)
{
  EXPECT_EQ(judgeSquares(0.05, 1, [](Face& a, Face& b) { b.nodes[2] = a.nodes[0]; }),
            Verdict::SharedNode);
}

TEST(Step5CandidatePairs, onlyFacesAtTheTipOfADeclaredJointShareNodes)
{
  CandidateRules rules;
  rules.declared = [](int, int) { return true; };
  const auto judge = [&](const std::function<void(Face&, Face&)>& change) {
    return judgeSquares(0.05, 1, change, {0, 0, -1}, rules);
  };
  const auto tip = [](Face& a, Face& b) { b.nodes[2] = a.nodes[0]; };
  EXPECT_EQ(judge(tip), Verdict::Candidate);
  // Neighbours on a surface that has folded: their elements share nodes below it, too.
  EXPECT_EQ(judge(
                [&](Face& a, Face& b)
                {
                  tip(a, b);
                  a.far[0] = b.far[2] = 77;
                }),
            Verdict::SharedNode);
}

TEST(Step5CandidatePairs, frontAndBackOfAThinBodyAreNoPair)
{
  // Elements beside each other, whose faces have no node in common.
  EXPECT_EQ(judgeSquares(0.05, 1,
                         [](Face& a, Face& b)
                         {
                           a.far[1] = 77;
                           b.far[3] = 77;
                         }),
            Verdict::SharedNode);
  EXPECT_EQ(judgeSquares(0.05, 1, [](Face& a, Face& b) { b.far[3] = a.nodes[1]; }),
            Verdict::SharedNode);
  EXPECT_EQ(judgeSquares(0.05, 1,
                         [](Face& a, Face& b)
                         {
                           a.far[1] = 77;
                           b.far[3] = 78;
                         }),
            Verdict::Candidate);
}

TEST(Step5CandidatePairs, aGhostFaceIsJudgedLikeTheFaceItComesFrom)
{
  const auto sendSecond = [](int node)
  {
    return [node](Face& a, Face& b)
    {
      a.far[1] = 8;
      b.far[3] = node;
      std::vector<GlobalId> ids;
      for (int n = 0; n < 10; ++n)
        ids.push_back(1000 - n);
      const std::uint8_t mirrors[4] = {3, 1, 0, 2};
      std::copy_n(mirrors, 4, b.mirrors);
      b = toFace(toGhostFace(b, ids), [](GlobalId id) { return int(1000 - id); });
      EXPECT_TRUE(std::equal(mirrors, mirrors + 4, b.mirrors));
      b.local = false;
    };
  };
  EXPECT_EQ(judgeSquares(0.05, 1, sendSecond(8)), Verdict::SharedNode);
  EXPECT_EQ(judgeSquares(0.05, 1, sendSecond(9)), Verdict::Candidate);
}

TEST(Step5CandidatePairs, facesThatLookTheSameWayAreNotOpposed)
{
  EXPECT_EQ(judgeSquares(0.05, 1, {}, {0, 0, 1}), Verdict::NotOpposed);
  // At right angles, as the top of one brick and the side of the next.
  EXPECT_EQ(judgeSquares(0.05, 1, {}, {1, 0, 0}), Verdict::NotOpposed);
}

TEST(Step5CandidatePairs, oppositeFacesOfAThinBodyDoNotFaceEachOther)
{
  // A plate 0.1 m thick, two elements of 0.05 m: its bottom (looking down) lies 0.1 m below its
  // top. As a pair they would overlap by twice the elements' thickness; the limit is 0.6 of it.
  EXPECT_EQ(judgeSquares(-0.1, 0.05), Verdict::TooFarApart);
  EXPECT_EQ(judgeSquares(-0.02, 0.05), Verdict::Candidate);
}

TEST(Step5CandidatePairs, excludedGroupsAreNotPaired)
{
  CandidateRules rules;
  rules.excluded = [](int a, int b) { return a == 0 && b == 0; };
  EXPECT_EQ(judgeSquares(0.05, 1, {}, {0, 0, -1}, rules), Verdict::Excluded);
}

TEST(Step5CandidatePairs, facesThatMeetBeforeTheNextSearchAreACandidate)
{
  // 0.5 m apart, with a skin of 0.1 m; the next search comes after 0.1 s. They close at 3, 4.1 and
  // 6 m/s, a common motion of any size aside.
  const auto closingAt = [](Real speed, Real common, Real gap = 0.5)
  {
    const NodeVectors v("v", 8);
    for (int n = 0; n < 8; ++n)
      set(v, n, {common, 0, n < 4 ? common + 0.25 * speed : common - 0.75 * speed});
    CandidateRules rules;
    rules.motion.v = v;
    rules.motion.ahead = 0.1;
    rules.motion.frame = {common, 0, common};
    return judgeSquares(gap, 1, {}, {0, 0, -1}, rules);
  };
  for (const Real common : {0.0, 100.0})
  {
    EXPECT_EQ(closingAt(3, common), Verdict::TooFarApart);
    EXPECT_EQ(closingAt(4.1, common), Verdict::Candidate);
    EXPECT_EQ(closingAt(6, common), Verdict::Candidate);
    EXPECT_EQ(closingAt(-6, common), Verdict::TooFarApart);
    EXPECT_EQ(closingAt(-6, common, 0.05), Verdict::Candidate); // within the skin now
  }
}

TEST(Step5CandidatePairs, aFaceThatTurnsOverBeforeTheNextSearchIsACandidate)
{
  // The second square looks the same way as the first, and is crushed along x: after 0.1 s it is as
  // wide as before, inside out.
  const auto crushed = [](Real by)
  {
    Scene scene;
    scene.add(faceId(1, 0), {0, 0, 0}, {0, 0, 1}, 1, 1);
    scene.add(faceId(2, 0), {0.2, 0.1, 0.05}, {0, 0, 1}, 1, 1);
    Face a = scene.faces[0], b = scene.faces[1];
    a.local = b.local = true;
    const NodeVectors x = positions(scene), v("v", 8);
    for (const int node : b.nodes)
      set(v, node, {by * (0.2 - x(node, 0)) / 0.1, 0, 0});
    CandidateRules rules;
    rules.skin = rules.reach = 0.1;
    rules.turning = 0.01;
    rules.motion = {v, 0.1, {}};
    const FacePlane planeA = rules.planeOf(a, x, 3), planeB = rules.planeOf(b, x, 3);
    return judgePair(a, b, contactBox(a, planeA, x, rules), contactBox(b, planeB, x, rules), planeA,
                     planeB, x, rules);
  };
  EXPECT_EQ(crushed(0.9), Verdict::NotOpposed); // thinner, the same side up
  EXPECT_EQ(crushed(2), Verdict::Candidate);
}

TEST(Step5CandidatePairs, aFaceCrushedToAlmostNoWidthIsACandidateHoweverItLies)
{
  // Almost upright beside another, it looks the same way; it is no longer than what nodes may move
  // unforeseen: it may lie on the other in the next step.
  const auto upright = [](Real length)
  {
    Scene scene;
    scene.dimension = 2;
    scene.add(faceId(1, 0), {0, 0, 0}, {0, 1, 0}, 1, 1);
    scene.add(faceId(2, 0), {0, 0.02 + 0.5 * length, 0}, {1, 0.3, 0}, length, 1);
    Face a = scene.faces[0], b = scene.faces[1];
    a.local = b.local = true;
    const NodeVectors x = positions(scene);
    CandidateRules rules = rulesWithSkin(0.1);
    rules.turning = 0.01;
    rules.smallestFace = 1;
    rules.strays = rules.skin;
    const FacePlane planeA = rules.planeOf(a, x, 2), planeB = rules.planeOf(b, x, 2);
    return judgePair(a, b, contactBox(a, planeA, x, rules), contactBox(b, planeB, x, rules), planeA,
                     planeB, x, rules);
  };
  EXPECT_EQ(upright(1), Verdict::NotOpposed);
  EXPECT_EQ(upright(0.6), Verdict::NotOpposed);
  EXPECT_EQ(upright(0.04), Verdict::Candidate);
}
} // namespace coplane::testing
