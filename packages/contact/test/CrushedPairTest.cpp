// Pairs of faces whose joint is crushed unevenly, or has absorbed an uneven gap: energy, gradient,
// what crushing costs.
#include "BalancedForces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace coplane
{
namespace
{
using namespace facepairs;

/// What is uneven in the joint of a pair.
struct Uneven
{
  const LinearOnFace* crushing = nullptr;
  const Layers* laid = nullptr;
};

/// Energy and gradient of a pair that is crushed.
template <int Dim>
struct Crushed
{
  Real energy = 0, share = 1, mean = 0, area = 0;
  Vec3 gradient[2][4];

  Crushed(const FaceNodes& a, const FaceNodes& b, const Uneven& joint, Real offset,
          unsigned exits = 0, bool sharing = false)
  {
    const HalfStepFace faceA = stepA_faceAtEnd<Dim>(a), faceB = stepA_faceAtEnd<Dim>(b);
    ContactPotentialScale scale(0.1);
    if (!sharing) // sharing is no gradient
      scale.oneEdge = scale.oneBorder = 0;
    PairPotential<Dim, Real> pair(faceA, faceB, scale);
    if (!pair.plane.opposed)
      return;
    EdgesOf<Real> edges;
    for (int e = 0; e < 8; ++e)
      edges.exits[e] = edges.turns[e] = exits >> e & 1;
    if (joint.laid != nullptr)
      pair.lay(true, joint.laid->parts);
    if (joint.crushing != nullptr)
      pair.beCrushed(*joint.crushing);
    pair.meet(offset, false, edges);
    if (!(pair.moments.volume > 0))
      return;
    EnergyDensity<Real> density;
    const Real stored = pair.press(1, 0, density);
    share = pair.wayOut;
    area = pair.moments.area;
    if (joint.crushing != nullptr)
      mean = pair.meanCrushing();
    pair.growFrom(1.3, .8);
    pair.differentiate(stored, density);
    energy = pair.materialArea * pair.opposedness * stored;
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 4; ++i)
        gradient[f][i] = pair.gradient[f][i];
  }
};

/// Largest difference between the gradient and central differences, over the largest entry.
template <int Dim>
Real errorOfGradient(const RandomPair& pair, const Uneven& joint, unsigned exits = 0)
{
  const Crushed<Dim> e(pair.a, pair.b, joint, 0, exits);
  Real largest = 0, worst = 0;
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < (f == 0 ? pair.a : pair.b).count; ++i)
      for (int c = 0; c < Dim; ++c)
      {
        largest = std::max(largest, std::abs(e.gradient[f][i][c]));
        const auto at = [&](Real h)
        {
          FaceNodes faces[2] = {pair.a, pair.b};
          faces[f].x[i][c] += h;
          return Crushed<Dim>(faces[0], faces[1], joint, 0, exits).energy;
        };
        const Real h = 2e-6;
        const Real slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
        worst = std::max(worst, std::abs(slope - e.gradient[f][i][c]));
      }
  return largest > 0 ? worst / largest : 0;
}

/// Crushing of the size of the closures of random pairs, of one sign or both; or steeper, and
/// nothing somewhere in the strip.
LinearOnFace someCrushing(std::mt19937& random, bool steep)
{
  std::uniform_real_distribution<Real> u(-1, 1);
  if (!steep)
    return {.05 * u(random), {.1 * u(random), .1 * u(random)}};
  const Real along = .6 * u(random);
  return {(.45 + .05 * u(random)) * along, {along, .6 * u(random)}};
}

LinearOnFace someLayer(std::mt19937& random, Real size)
{
  std::uniform_real_distribution<Real> u(-size, size);
  return {.5 * u(random), {u(random), u(random)}};
}

template <int Dim>
RandomPair somePair(std::mt19937& random, Real warp)
{
  return Dim == 2 ? randomSegments(random) : randomPair(random, warp);
}

/// A strip about as wide as it is deep between edges of both faces.
template <int Dim>
RandomPair someStrip(std::mt19937& random)
{
  std::uniform_real_distribution<Real> u(0, 1);
  if constexpr (Dim == 2)
  {
    const Real width = .05 + .15 * u(random), turn = .05 * (u(random) - .5);
    return {face({{1, 0, 0}, {0, 0, 0}}), face({{1 - width, -.05, 0}, {2, -.05 + turn, 0}})};
  }
  const auto outline = [&](std::initializer_list<Vec3> corners)
  {
    FaceNodes nodes = face(corners);
    for (int i = 0; i < nodes.count; ++i)
      nodes.x[i] += Vec3{.1 * u(random) - .05, .1 * u(random) - .05, .04 * u(random) - .02};
    return nodes;
  };
  const Real low = .8 - .6 * u(random), from = .75 + .2 * u(random), deep = .05 + .25 * u(random);
  RandomPair pair;
  pair.a = u(random) < .5 ? outline({{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}})
                          : outline({{1, 0, 0}, {1, 1, 0}, {0, .5, 0}});
  pair.b = u(random) < .5
               ? outline({{from, low - 1, -deep},
                          {from, low, -deep},
                          {from + 1, low, -deep},
                          {from + 1, low - 1, -deep}})
               : outline({{from, low - 1, -deep}, {from, low, -deep}, {from + 1, low - .5, -deep}});
  return pair;
}

template <int Dim>
void expectGradients(Real warp, bool exits, bool isCrushed = true, bool isLaid = false)
{
  std::mt19937 random(21);
  int mixed = 0, kinds[2][2] = {};
  for (int pairs = 0, tried = 0; pairs < 300; ++tried)
  {
    ASSERT_LT(tried, 100000);
    const RandomPair pair = exits ? someStrip<Dim>(random) : somePair<Dim>(random, warp);
    const LinearOnFace crushing = someCrushing(random, exits);
    const unsigned edges = !exits ? 0 : Dim == 2 ? 1u << 0 | 1u << 4 : unsigned(random() & 255);
    LinearOnFace laid[2];
    for (int f = 0; f < 2 && isLaid; ++f)
      laid[f] = someLayer(random, exits ? .02 : .1);
    const Layers layers(laid);
    const Uneven joint{isCrushed ? &crushing : nullptr, isLaid ? &layers : nullptr};
    const Crushed<Dim> e(pair.a, pair.b, joint, 0, edges);
    const Crushed<Dim> whole(pair.a, pair.b, {nullptr, joint.laid}, 0, edges);
    if (!(e.energy > 1e-5) || !(e.energy < .98 * whole.energy || !isCrushed))
      continue;
    if (exits && !(e.share > .02 && e.share < .98))
      continue;
    ++pairs;
    const LinearOnFace opposite{-crushing.atCenter, {-crushing.along[0], -crushing.along[1]}};
    mixed += e.mean > 1e-4 &&
             Crushed<Dim>(pair.a, pair.b, {&opposite, joint.laid}, 0, edges).mean > 1e-4;
    ++kinds[pair.a.count == 3][pair.b.count == 3];
    EXPECT_LT(errorOfGradient<Dim>(pair, joint, edges), 1e-6)
        << "pair " << pairs << " share " << e.share;

    expectBalanced(pair, e.gradient);
  }
  if (isCrushed)
  {
    EXPECT_GT(mixed, 30);
  }
  if constexpr (Dim == 3)
    for (const auto& of : kinds)
      for (const int kind : of)
      {
        EXPECT_GT(kind, 10);
      }
}
} // namespace

TEST(CrushedPair, gradientIsThatOfTheEnergy)
{
  for (const Real warp : {0., .02, .2, .4})
  {
    SCOPED_TRACE(::testing::Message() << "warp " << warp);
    expectGradients<3>(warp, false);
  }
}

TEST(CrushedPair, evenCrushingIsAnOffset)
{
  std::mt19937 random(22);
  int pairs = 0;
  while (pairs < 200)
  {
    const RandomPair pair = randomPair(random, .1);
    const Crushed<3> offset(pair.a, pair.b, {}, -.03, 0, true);
    if (!(offset.energy > 1e-5))
      continue;
    ++pairs;
    const LinearOnFace even{.03, {0, 0}};
    const Crushed<3> crushed(pair.a, pair.b, {&even, nullptr}, 0, 0, true);
    EXPECT_NEAR(crushed.energy, offset.energy, 1e-12 * offset.energy);
    Real largest = 0;
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 4; ++i)
        largest = std::max(largest, norm(offset.gradient[f][i]));
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 4; ++i)
        EXPECT_LT(norm(crushed.gradient[f][i] - offset.gradient[f][i]), 1e-12 * largest);
  }
}

TEST(CrushedPair, gradientInTwoDimensions)
{
  expectGradients<2>(0, false);
}

TEST(CrushedPair, gradientOfOneThatHasAbsorbedAnUnevenGap)
{
  for (const bool isCrushed : {false, true})
    for (const bool exits : {false, true})
    {
      SCOPED_TRACE(::testing::Message() << "crushed " << isCrushed << " exits " << exits);
      expectGradients<2>(0, exits, isCrushed, true);
      expectGradients<3>(.05, exits, isCrushed, true);
    }
}

TEST(CrushedPair, anUnevenGapThatIsAbsorbedLeavesTheClosureEven)
{
  std::mt19937 random(23);
  int pairs = 0;
  while (pairs < 200)
  {
    const RandomPair pair = randomPair(random, .1);
    const HalfStepFace a = stepA_faceAtEnd<3>(pair.a), b = stepA_faceAtEnd<3>(pair.b);
    PairPotential<3, Real> before(a, b, ContactPotentialScale(.1));
    if (!before.plane.opposed)
      continue;
    before.meet(0, true, {});
    if (!(before.moments.area > .1))
      continue;
    ++pairs;
    LinearOnFace laid[2];
    const Vec2 centroid = (1 / before.moments.area) * before.moments.areaMoment;
    EXPECT_GT(before.unevenGap(centroid, laid), 1e-4);
    const Real gap = -before.moments.volume / before.moments.area;
    PairPotential<3, Real> after(a, b, ContactPotentialScale(.1));
    const Layers layers(laid);
    after.lay(true, layers.parts);
    after.meet(gap + .01, false, {});
    EXPECT_NEAR(after.mostClosure, .01, 1e-14);
    EXPECT_NEAR(after.leastClosure(), .01, 1e-14);
    EXPECT_NEAR(after.moments.area, before.moments.area, 1e-12);
  }
}

TEST(CrushedPair, gradientWhereAWayOutIsNear)
{
  expectGradients<2>(0, true);
  expectGradients<3>(.05, true);
}

namespace
{
/// The joint of V93, or one whose strength is the same from the beginning on.
PairPlane mortar(bool flat = false)
{
  PairPlane plane = touchingPlane(8.2e10);
  Crushing& crushing = plane.law.curve.crushing;
  crushing.strength = 10.5e6;
  crushing.peak = flat ? 1e-14 : 9e-5;
  crushing.length = flat ? 1e6 : Crushing::lengthFrom(10.5e6, 5e3, .1);
  return plane;
}

/// How face 1 lies over face 0: closure at the middle, and by how much more it is closed for each
/// metre along x and y of its own; how far it has slid along x.
struct Pose
{
  Real closure = 0, alongX = 0, alongY = 0, slide = 0;
};

enum class Outlines
{
  Segments,
  Squares,
  TriangleOnSquare,
  Apart ///< squares of which a part lies on each other
};

/// Faces of 0.1 m that face each other.
std::array<FaceNodes, 2> inPose(Outlines outlines, const Pose& pose)
{
  const Real h = .05;
  std::array<FaceNodes, 2> faces;
  if (outlines == Outlines::Segments)
    faces = {face({{h, 0, 0}, {-h, 0, 0}}), face({{-h, 0, 0}, {h, 0, 0}})};
  else
  {
    faces[1] = face({{-h, -h, 0}, {-h, h, 0}, {h, h, 0}, {h, -h, 0}});
    faces[0] = outlines == Outlines::TriangleOnSquare
                   ? face({{-h, -h, 0}, {h, -h, 0}, {0, h, 0}})
                   : face({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}});
  }
  const Vec3 shift = outlines == Outlines::Apart ? Vec3{.6 * h, .3 * h, 0} : Vec3{};
  for (int i = 0; i < faces[1].count; ++i)
  {
    Vec3& x = faces[1].x[i];
    x += shift;
    (outlines == Outlines::Segments ? x.y : x.z) =
        -pose.closure - pose.alongX * x.x - pose.alongY * x.y;
    x.x += pose.slide;
  }
  return faces;
}

/// A path of a pair through time 0 to 1, walked in so many steps; each(plane, pose) after each.
template <class Path, class Each>
PairPlane walked(PairPlane plane, Outlines outlines, int steps, const Path& path, const Each& each)
{
  const Real dt = 1.0 / steps;
  auto before = inPose(outlines, path(0));
  plane.depthLimit = 1;
  for (int step = 1; step <= steps; ++step)
  {
    const Pose pose = path(step * dt);
    auto faces = inPose(outlines, pose);
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < faces[f].count; ++i)
        faces[f].v[i] = (1 / dt) * (faces[f].x[i] - before[f].x[i]);
    if (outlines == Outlines::Segments)
      updatePlane<2>(plane, faces[0], faces[1], {}, dt);
    else
      updatePlane<3>(plane, faces[0], faces[1], {}, dt);
    before = faces;
    each(plane, pose);
  }
  return plane;
}

/// Springs beside each other, each with the law of first loading.
class Springs
{
public:
  Springs(Outlines outlines, const PairPlane& plane) : law_(plane.law.curve.crushing)
  {
    stiffness_ = plane.fit.normalStiffness;
    const Real h = .05;
    const int many = outlines == Outlines::Segments ? 4000 : 200;
    for (int i = 0; i < many; ++i)
      for (int j = 0; j < (outlines == Outlines::Segments ? 1 : many); ++j)
      {
        const Real x = h * (2 * (i + .5) / many - 1);
        const Real y = outlines == Outlines::Segments ? 0 : h * (2 * (j + .5) / many - 1);
        if (outlines == Outlines::TriangleOnSquare && std::abs(x) > .5 * (h - y))
          continue;
        if (outlines == Outlines::Apart && (x < -.4 * h || y < -.7 * h))
          continue;
        x_.push_back(x);
        y_.push_back(y);
      }
    crushed_.resize(x_.size());
    area_ = outlines == Outlines::Segments ? 2 * h / many : 4 * h * h / many / many;
  }
  /// @returns the force and the moment over its lever of half a face
  std::array<Real, 2> press(const Pose& pose)
  {
    std::array<Real, 2> sum = {0, 0};
    stored = 0;
    for (std::size_t i = 0; i < x_.size(); ++i)
    {
      const Real c = pose.closure + pose.alongX * x_[i] + pose.alongY * y_[i];
      crushed_[i] = std::max(crushed_[i], law_.crushedAt(c, stiffness_));
      const Real elastic = std::max(c - crushed_[i], 0.);
      sum[0] += area_ * stiffness_ * elastic;
      sum[1] += area_ * stiffness_ * elastic * x_[i] / .05;
      stored += .5 * area_ * stiffness_ * elastic * elastic;
    }
    return sum;
  }
  Real lost() const
  {
    Real sum = 0;
    for (const Real k : crushed_)
      sum += area_ * law_.workTo(k);
    return sum;
  }

  Real stored = 0;

private:
  const Crushing law_;
  Real stiffness_ = 0, area_ = 0;
  std::vector<Real> x_, y_, crushed_;
};

/// Force along the normal and moment over half a face, on face 1.
std::array<Real, 2> forceOf(const PairPlane& plane, Outlines outlines, const Pose& pose)
{
  const auto faces = inPose(outlines, pose);
  std::array<Real, 2> sum = {0, 0};
  for (int i = 0; i < faces[1].count; ++i)
  {
    const Vec3& force = plane.cornerForce[1][i];
    const Real normal = outlines == Outlines::Segments ? force.y : force.z;
    sum[0] += normal;
    sum[1] += normal * faces[1].x[i].x / .05;
  }
  return sum;
}

constexpr Outlines allOutlines[] = {Outlines::Segments, Outlines::Squares,
                                    Outlines::TriangleOnSquare, Outlines::Apart};

/// One end is pressed, then the other one, then it opens: closures up to 1 mm.
Pose rocks(Real time)
{
  const Real down = 6e-4 * std::sin(3 * time);
  return {down, .008 * std::sin(7 * time), .003 * std::sin(4 * time)};
}
} // namespace

TEST(CrushedPair, anEvenClosureFollowsTheCurve)
{
  for (const Outlines outlines : allOutlines)
  {
    Springs springs(outlines, mortar());
    walked(
        mortar(), outlines, 200,
        [](Real time) {
          return Pose{8e-4 * std::sin(3 * time), 0, 0};
        },
        [&](const PairPlane& plane, const Pose& pose)
        {
          const Real expected = springs.press(pose)[0], got = forceOf(plane, outlines, pose)[0];
          EXPECT_NEAR(got, expected, 1e-3 * std::max(expected, 1.)) << pose.closure;
        });
  }
}

TEST(CrushedPair, whatYieldsAtOneStrengthIsCrushedAsItsPointsAre)
{
  // First loading to a tilt that stays: at last the crushing of all points is linear in their
  // place.
  for (const Outlines outlines : allOutlines)
  {
    const Pose end{4.5e-4, .002, .0005};
    const auto path = [&](Real time) {
      return Pose{time * end.closure, time * end.alongX, time * end.alongY};
    };
    Springs springs(outlines, mortar(true));
    const PairPlane plane =
        walked(mortar(true), outlines, 400, path, [](const PairPlane&, const Pose&) {});
    const auto expected = springs.press(end), got = forceOf(plane, outlines, end);
    EXPECT_NEAR(got[0], expected[0], 1e-4 * expected[0]) << int(outlines);
    EXPECT_NEAR(got[1], expected[1], 1e-3 * expected[0]) << int(outlines);
  }
}

TEST(CrushedPair, followsItsPointsWhileItRocks)
{
  for (const Outlines outlines : allOutlines)
  {
    Real square = 0, squares = 0;
    Springs springs(outlines, mortar());
    const PairPlane end = walked(mortar(), outlines, 1000, rocks,
                                 [&](const PairPlane& plane, const Pose& pose)
                                 {
                                   const auto expected = springs.press(pose);
                                   const auto got = forceOf(plane, outlines, pose);
                                   for (int i = 0; i < 2; ++i)
                                   {
                                     const Real off = got[i] - expected[i];
                                     square += off * off;
                                     squares += expected[i] * expected[i];
                                   }
                                 });
    EXPECT_TRUE(end.crushedUnevenly);
    // With an even crushing of the pair this is 0.88 for segments, and 0.35 with a linear one. What
    // lies between two crushed ends counts as crushed, too, and then takes less.
    EXPECT_LT(std::sqrt(square / squares), outlines == Outlines::Segments ? .36 : .46);
    EXPECT_NEAR(end.hysteresisWork, springs.lost(), .12 * springs.lost()) << int(outlines);
    // What others are told: the most that it was in the mean where it touched.
    const Real told = mortar().law.curve.crushing.crushedAt(end.history.maximumClosure, 8.2e10);
    EXPECT_GT(told, 5e-4) << int(outlines);
    EXPECT_LT(told, 1e-3) << int(outlines);
  }
}

TEST(CrushedPair, whatItsLedgerLeavesOverIsOfTheSecondOrder)
{
  for (const Outlines outlines : allOutlines)
  {
    const auto leftOver = [&](int steps)
    {
      Real before = 0;
      const PairPlane end = walked(mortar(), outlines, steps, rocks,
                                   [&](const PairPlane& plane, const Pose&)
                                   {
                                     EXPECT_GE(plane.hysteresisWork, before * (1 - 1e-12));
                                     before = plane.hysteresisWork;
                                   });
      return std::abs(end.remainder() / end.work);
    };
    const Real coarse = leftOver(200), fine = leftOver(800);
    EXPECT_LT(coarse, 3e-4);
    EXPECT_LT(fine, 2e-5);
    if (outlines == Outlines::Apart)
    { // elsewhere edges that lie on each other share their rims, which is no gradient
      EXPECT_LT(fine, .08 * coarse);
    }
  }
}

TEST(CrushedPair, isCrushedOnceByWhatRocksAgainAndAgain)
{
  for (const Outlines outlines : allOutlines)
  {
    Real afterOne = 0, time = 0;
    constexpr int cycles = 6, steps = 200;
    const PairPlane end = walked(
        mortar(), outlines, cycles * steps,
        [](Real t)
        {
          return Pose{2.5e-4, .01 * std::sin(2 * cycles * 3.14159265358979323846 * t),
                      .001 * std::cos(2 * cycles * 3.14159265358979323846 * t)};
        },
        [&](const PairPlane& plane, const Pose&)
        {
          time += 1.0 / (cycles * steps);
          if (time < 1.5 / cycles)
            afterOne = plane.hysteresisWork;
        });
    EXPECT_TRUE(end.crushedUnevenly);
    EXPECT_GT(afterOne, 0) << int(outlines);
    EXPECT_LT(end.hysteresisWork, 1.001 * afterOne) << int(outlines);
  }
}

TEST(CrushedPair, thatRestsOnWhatItTookOverIsAPlane)
{
  // The bed beside was crushed by 1 mm; here its surface is met for the first time, 0.4 mm deep.
  for (const Outlines outlines : allOutlines)
    for (const bool tookOver : {true, false})
    {
      PairPlane plane = mortar();
      plane.state = PlaneState::Slot;
      if (tookOver)
      {
        plane.lineage = Lineage::Inherited;
        plane.history.maximumClosure =
            1e-3 + plane.law.curve.crushing.strengthAt(1e-3) / plane.fit.normalStiffness;
      }
      const PairPlane rested = walked(
          plane, outlines, 10,
          [](Real t) {
            return Pose{4e-4 * t, 0, 0};
          },
          [](const PairPlane&, const Pose&) {});
      EXPECT_TRUE(rested.isBorn()) << int(outlines);
      if (!tookOver)
      {
        EXPECT_GT(rested.hysteresisWork, 0) << int(outlines);
        continue;
      }
      EXPECT_EQ(rested.stored, 0) << int(outlines);
      EXPECT_EQ(rested.hysteresisWork, 0) << int(outlines);
      // From there on it is its own: nobody passes anything on any more.
      const PairPlane end = walked(
          rested, outlines, 200,
          [](Real t) {
            return Pose{4e-4 + 8e-4 * t, 0, 0};
          },
          [](const PairPlane&, const Pose&) {});
      EXPECT_GT(end.hysteresisWork, 0) << int(outlines);
      EXPECT_LT(std::abs(end.remainder()), 1e-3 * end.work) << int(outlines);
    }
}

TEST(CrushedPair, costsNoMoreThanItHas)
{
  // One end is crushed deep, and then the pair is pressed evenly: as soon as the other end yields,
  // all of the line rises, by much more than what is closed elastically.
  for (const Outlines outlines : allOutlines)
  {
    PairPlane before = mortar();
    Real largest = 0;
    walked(
        mortar(), outlines, 4000,
        [](Real t)
        {
          const Real tilted = std::max(1 - std::abs(4 * t - 1), 0.),
                     pressed = std::max(2 * t - 1, 0.);
          return Pose{1e-4 * tilted + 6e-5 * pressed, .02 * tilted, 0};
        },
        [&](const PairPlane& plane, const Pose& pose)
        {
          const Real lost = plane.hysteresisWork - before.hysteresisWork;
          const Real had = before.stored + plane.work - before.work;
          EXPECT_LE(lost, had + 0.01 * plane.work) << pose.closure;
          if (pose.alongX == 0 && had > 0)
            largest = std::max(largest, lost / had);
          before = plane;
        });
    EXPECT_TRUE(before.crushedUnevenly);
    EXPECT_GT(largest, .2) << int(outlines);
    EXPECT_LT(std::abs(before.remainder()), 0.01 * before.work) << int(outlines);
  }
}

TEST(CrushedPair, itsLedgerClosesWhereItIsCrushedAtOneEndAndShears)
{
  PairPlane sheared = mortar();
  sheared.law.friction = .7;
  sheared.law.bond.kind = Bond::Kind::Exponential; // broken
  sheared.fit.shearStiffness = 3.6e10;
  for (const Real loss : {0., .5})
    for (const Outlines outlines : allOutlines)
    {
      sheared.law.curve.crushing.loss = loss;
      const auto leftOver = [&](int steps)
      {
        const PairPlane end = walked(
            sheared, outlines, steps,
            [](Real t)
            {
              const Real pressed = std::min(2 * t, 1.), slid = std::max(2 * t - 1, 0.);
              return Pose{1e-4 * pressed, .012 * pressed, 0, 2e-3 * slid};
            },
            [](const PairPlane&, const Pose&) {});
        EXPECT_EQ(end.crushedUnevenly, loss == 0);
        EXPECT_GT(end.hysteresisWork, .15 * end.work);
        return std::abs(end.remainder() / end.work);
      };
      const Real coarse = leftOver(500), fine = leftOver(4000);
      if (outlines == Outlines::TriangleOnSquare || outlines == Outlines::Apart)
      {
        EXPECT_LT(coarse, 5e-5) << int(outlines);
        EXPECT_LT(fine, .15 * coarse) << int(outlines);
      }
      else // edges that share are no gradient: something is left over at any step
        EXPECT_LT(coarse, 6e-4) << int(outlines);
    }
}

namespace
{
/// Forces on the faces along the path of rocks(), by outlines that are changed, back in the order
/// of the nodes of inPose().
template <class Change, class Back>
std::vector<Vec3> forcesOf(Outlines outlines, const Change& change, const Back& back)
{
  PairPlane plane = mortar();
  plane.depthLimit = 1;
  std::vector<Vec3> forces;
  constexpr int steps = 300;
  for (int step = 1; step <= steps; ++step)
  {
    auto faces = inPose(outlines, rocks(Real(step) / steps));
    const auto before = inPose(outlines, rocks(Real(step - 1) / steps));
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < faces[f].count; ++i)
        faces[f].v[i] = steps * (faces[f].x[i] - before[f].x[i]);
    const auto changed = change(faces);
    if (outlines == Outlines::Segments)
      updatePlane<2>(plane, changed[0], changed[1], {}, 1.0 / steps);
    else
      updatePlane<3>(plane, changed[0], changed[1], {}, 1.0 / steps);
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < faces[f].count; ++i)
        forces.push_back(back(plane.cornerForce, faces, f, i));
  }
  EXPECT_TRUE(plane.crushedUnevenly);
  return forces;
}

Real difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
  Real largest = 0, off = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    largest = std::max(largest, norm(a[i]));
    off = std::max(off, norm(a[i] - b[i]));
  }
  return off / largest;
}
} // namespace

TEST(CrushedPair, doesNotDependOnNumbersNorOnHowItLies)
{
  using Faces = std::array<FaceNodes, 2>;
  using Forces = Vec3[2][4];
  for (const Outlines outlines : allOutlines)
  {
    const std::vector<Vec3> expected = forcesOf(
        outlines, [](const Faces& faces) { return faces; },
        [](const Forces& forces, const Faces&, int f, int i) { return forces[f][i]; });

    const Mat3 turn = outlines == Outlines::Segments ? rotation({0, 0, 1}, 1) : oblique();
    Mat3 back;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        back(i, j) = turn(j, i);
    EXPECT_LT(difference(expected, forcesOf(
                                       outlines,
                                       [&](const Faces& faces) -> Faces {
                                         return {moved(faces[0], turn), moved(faces[1], turn)};
                                       },
                                       [&](const Forces& forces, const Faces&, int f, int i)
                                       { return back * forces[f][i]; })),
              1e-6)
        << "turned, " << int(outlines);

    if (outlines != Outlines::Segments)
    {
      EXPECT_LT(difference(expected,
                           forcesOf(
                               outlines,
                               [&](const Faces& faces) -> Faces {
                                 return {startedAt(faces[0], 1), startedAt(faces[1], 2)};
                               },
                               [&](const Forces& forces, const Faces& faces, int f, int i) {
                                 return forces[f][(i + faces[f].count - 1 - f) % faces[f].count];
                               })),
                1e-6)
          << "renumbered, " << int(outlines);
    }

    const auto mirrored = [](const FaceNodes& face)
    {
      FaceNodes result = face;
      for (int i = 0; i < face.count; ++i)
      {
        result.x[i] = face.x[face.count - 1 - i];
        result.v[i] = face.v[face.count - 1 - i];
        result.x[i].x *= -1;
        result.v[i].x *= -1;
      }
      return result;
    };
    EXPECT_LT(difference(expected, forcesOf(
                                       outlines,
                                       [&](const Faces& faces) -> Faces {
                                         return {mirrored(faces[0]), mirrored(faces[1])};
                                       },
                                       [&](const Forces& forces, const Faces& faces, int f, int i)
                                       {
                                         Vec3 force = forces[f][faces[f].count - 1 - i];
                                         force.x *= -1;
                                         return force;
                                       })),
              1e-6)
        << "mirrored, " << int(outlines);

    // The other face carries the crushing along, whose slope pushes along the plane: by 0.009.
    const Real swapped = difference(expected, forcesOf(
                                                  outlines,
                                                  [](const Faces& faces) -> Faces {
                                                    return {faces[1], faces[0]};
                                                  },
                                                  [](const Forces& forces, const Faces&, int f,
                                                     int i) { return forces[1 - f][i]; }));
    EXPECT_LT(swapped, 1e-2) << "swapped, " << int(outlines);
  }
}
} // namespace coplane
