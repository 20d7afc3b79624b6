#include "CornerBlocks.hpp"

#include <gtest/gtest.h>

using namespace coplane;
using namespace coplane::facepairs;

namespace
{
using Search = ClassicOptions::Search;
using Area = ClassicOptions::Area;
constexpr Search searches[2] = {Search::Rotations, Search::Candidates};

ClassicOptions classicOptions(Search search, Area area = Area::Section)
{
  ClassicOptions o;
  o.search = search;
  o.area = area;
  return o;
}

Real radians(Real degrees)
{
  return degrees * pi / 180;
}

/// Random numbers between -1 and 1.
struct Random
{
  std::mt19937 engine;
  std::uniform_real_distribution<Real> u{-1, 1};
  explicit Random(unsigned seed) : engine(seed) {}
  Real operator()() { return u(engine); }
  Vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }
  Mat3 attitude()
  {
    const Vec3 axis = vector();
    return rotation(axis, pi * (*this)());
  }
};

/// Image of the cube [-1, 1]^3 or a tetrahedron under a projective map: faces stay flat.
ConvexBlock randomBlock(Random& random, bool tetrahedron)
{
  static const Vec3 cube[8] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                               {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  static const Vec3 tet[4] = {{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {0, 0, 1}};
  const int nodes = tetrahedron ? 4 : 8;
  const Vec3 vanishing = .15 * random.vector();
  const Vec3 skewX = .3 * random.vector(), skewY = .3 * random.vector(),
             skewZ = .3 * random.vector();
  const Mat3 r = random.attitude();
  Vec3 x[8];
  for (int i = 0; i < nodes; ++i)
  {
    const Vec3 c = tetrahedron ? tet[i] : cube[i];
    const Vec3 skewed = c + c.x * skewX + c.y * skewY + c.z * skewZ;
    x[i] = r * ((1 / (1 + dot(vanishing, c))) * skewed);
  }
  return blockOfElement<3>(x, nodes);
}

ConvexBlock randomQuadrilateral(Random& random)
{
  const Mat3 r = rotation({0, 0, 1}, pi * random());
  Vec3 x[4];
  for (int i = 0; i < 4; ++i)
  {
    const Real angle = radians(90) * (i + .25 * random()), radius = 1 + .2 * random();
    x[i] = r * Vec3{radius * std::cos(angle), radius * std::sin(angle), 0};
  }
  return blockOfElement<2>(x, 4);
}

/// Largest gap over all directions in which a plane can lie at the least overlap of two convex
/// bodies: in a face of either, or along an edge of each. The second method of these tests.
template <int Dim>
Real largestGap(const ConvexBlock& a, const ConvexBlock& b)
{
  Real largest = -infinity;
  const auto offer = [&](const Vec3& direction)
  {
    for (const Real sign : {1.0, -1.0})
    {
      const Vec3 n = sign * normalised(direction);
      Real low = infinity, high = -infinity;
      for (int i = 0; i < b.nodes; ++i)
        low = std::min(low, dot(n, b.x[i]));
      for (int i = 0; i < a.nodes; ++i)
        high = std::max(high, dot(n, a.x[i]));
      largest = std::max(largest, low - high);
    }
  };
  for (const ConvexBlock* block : {&a, &b})
    for (int f = 0; f < block->faces; ++f)
    {
      const auto* node = block->faceNode[f];
      const Vec3 along = block->x[node[1]] - block->x[node[0]];
      offer(Dim == 2 ? Vec3{along.y, -along.x, 0}
                     : cross(along, block->x[node[2]] - block->x[node[0]]));
    }
  if (Dim == 3)
    for (int i = 0; i < a.edges; ++i)
      for (int j = 0; j < b.edges; ++j)
        offer(cross(a.x[a.edgeNode[i][1]] - a.x[a.edgeNode[i][0]],
                    b.x[b.edgeNode[j][1]] - b.x[b.edgeNode[j][0]]));
  return largest;
}

/// Moves B along a direction until it overlaps A by the given depth, as the second method sees it.
template <int Dim>
void pushInto(const ConvexBlock& a, ConvexBlock& b, const Vec3& direction, Real depth)
{
  const auto at = [&](Real t)
  {
    ConvexBlock c = b;
    for (int i = 0; i < c.nodes; ++i)
      c.x[i] += t * direction;
    return c;
  };
  Real in = 0, out = 20; // overlap, apart
  for (int i = 0; i < 40; ++i)
  {
    const Real middle = .5 * (in + out);
    (largestGap<Dim>(a, at(middle)) < -depth ? in : out) = middle;
  }
  b = at(.5 * (in + out));
}

Real angleBetween(const Vec3& a, const Vec3& b)
{
  return std::atan2(norm(cross(a, b)), dot(a, b));
}
} // namespace

TEST(ClassicCornerOnFace2D, forceIsSquareOfDepthTimesTangentAndShadowIsTheWholeCorner)
{
  // Section half way down: 2 (d / 2) tan(theta) wide; the shadow of both sides: 2 l sin(theta).
  for (const Search search : searches)
    for (const Real angle : {150.0, 120.0, 90.0, 60.0, 30.0})
      for (const Real d : {.01, .02})
      {
        const Real theta = .5 * radians(angle);
        const ConvexBlock slab = slabBlock2D(), corner = cornerBlock2D(theta, d, 1);
        const ClassicPlane section = classicCommonPlane<2>(slab, corner, classicOptions(search));
        EXPECT_NEAR(section.gap, -d, 1e-15) << angle;
        EXPECT_LT(norm(section.normal - Vec3{0, 1, 0}), 1e-15);
        EXPECT_NEAR(classicPush(section).force.y, d * d * std::tan(theta), 1e-12 * d);
        EXPECT_LT(norm(section.point - Vec3{0, -.5 * d, 0}), 1e-14);
        EXPECT_EQ(section.node[1], 0);
        EXPECT_EQ(section.face[0], 2);
        const ClassicPlane shadow =
            classicCommonPlane<2>(slab, corner, classicOptions(search, Area::Shadow));
        EXPECT_NEAR(classicPush(shadow).force.y, 2 * d * std::sin(theta), 1e-14);
      }
}

TEST(ClassicCornerOnFace2D,
     simplePlanesAreStifferByCosDeltaOverSinThetaAndCosDeltaCubedOverSinTheta)
{
  struct Row
  {
    Real angle, penetrating, full;
  };
  for (const Row& row :
       {Row{180, 1, 1}, Row{150, 1.026419, 1.008932}, Row{120, 1.115355, 1.040640},
        Row{90, 1.306563, 1.115221}, Row{60, 1.732051, 1.299038}, Row{30, 3.065282, 1.929318}})
    for (const Search search : searches)
      for (const Real d : {.01, .02})
      {
        const Real theta = .5 * radians(row.angle), delta = .5 * (pi / 2 - theta);
        const ConvexBlock slab = slabBlock2D(), corner = cornerBlock2D(theta, d, 1);
        const ClassicPlane section = classicCommonPlane<2>(slab, corner, classicOptions(search));
        const ClassicPlane shadow =
            classicCommonPlane<2>(slab, corner, classicOptions(search, Area::Shadow));
        const Push penetrating = simplePush<2>(slab, section.face[0], corner, 0, alongCommonNormal);
        const Push full =
            simplePush<2>(slab, section.face[0], corner, 0, asInThePaper(), {0, -d, 0});
        EXPECT_EQ(penetrating.planes, row.angle == 180 ? 1 : 2);
        const Real ratioPenetrating = penetrating.force.y / classicPush(section).force.y;
        const Real ratioFull = full.force.y / classicPush(shadow).force.y;
        EXPECT_NEAR(ratioPenetrating, std::cos(delta) / std::sin(theta), 1e-10) << row.angle;
        EXPECT_NEAR(ratioFull, std::pow(std::cos(delta), 3) / std::sin(theta), 1e-10) << row.angle;
        EXPECT_NEAR(ratioPenetrating, row.penetrating, 5.1e-7) << row.angle;
        EXPECT_NEAR(ratioFull, row.full, 5.1e-7) << row.angle;
      }
}

TEST(ClassicCornerOnFace3D, cubeCornerMeetsThePlaneInATriangle)
{
  // Section at the height h above the apex of a cube on its corner: (3 sqrt 3 / 2) h^2; h = d / 2.
  const Real d = .01, theta = std::asin(1 / std::sqrt(3.0));
  const Real expected = 3 * std::sqrt(3.0) / 8;
  EXPECT_NEAR(expected, .6495191, 5e-8);
  const ConvexBlock slab = slabBlock3D(), cube = cornerBlock3D(theta, d);
  for (const Search search : searches)
  {
    const ClassicPlane plane = classicCommonPlane<3>(slab, cube, classicOptions(search));
    const Vec3 force = classicPush(plane).force;
    EXPECT_NEAR(force.z / (d * d * d), expected, 1e-10);
    EXPECT_LT(std::hypot(force.x, force.y), 1e-13 * force.z);
    EXPECT_LT(norm(plane.point - Vec3{0, 0, -.5 * d}), 1e-14);
    const Push simple = simplePush<3>(slab, plane.face[0], cube, 0, alongCommonNormal);
    EXPECT_EQ(simple.planes, 3);
    // 1.5 cos(delta) against 3 sqrt 3 / 8, where cos(2 delta) = 1 / sqrt 3.
    EXPECT_NEAR(simple.force.z / force.z, 4 / std::sqrt(3.0) * std::sqrt(.5 + .5 / std::sqrt(3.0)),
                1e-9);
    EXPECT_NEAR(simple.force.z / force.z, 2.050919, 5.1e-7);
  }
}

TEST(ClassicCornerOnFace3D, threeFacesGiveFourThirdsOfTheRatioInTwoDimensions)
{
  // The mean depth of three wet faces is a third of the deepest, of two it is a half; the section
  // half way down is a quarter of the one at the surface, or a half.
  for (const Real angle : {150.0, 120.0, 90.0, 60.0, 30.0})
  {
    const Real d = .01, theta = .5 * radians(angle), delta = .5 * (pi / 2 - theta);
    const ConvexBlock slab = slabBlock3D(), corner = cornerBlock3D(theta, d);
    const ClassicPlane section =
        classicCommonPlane<3>(slab, corner, classicOptions(Search::Candidates));
    const ClassicPlane shadow =
        classicCommonPlane<3>(slab, corner, classicOptions(Search::Candidates, Area::Shadow));
    const Real penetrating =
        simplePush<3>(slab, section.face[0], corner, 0, alongCommonNormal).force.z;
    const Real full =
        simplePush<3>(slab, section.face[0], corner, 0, asInThePaper(), {0, 0, -d}).force.z;
    EXPECT_NEAR(penetrating / classicPush(section).force.z,
                4.0 / 3 * std::cos(delta) / std::sin(theta), 1e-8)
        << angle;
    EXPECT_NEAR(full / classicPush(shadow).force.z, std::pow(std::cos(delta), 3) / std::sin(theta),
                1e-10)
        << angle;
  }
}

TEST(ClassicCornerOnFace3D, edgeOnAPlaneIsTheExtrudedCorner)
{
  const Real d = .01, s = std::sqrt(.5);
  const Vec3 corner[4] = {{0, 0, 0}, {0, s, s}, {0, 0, 2 * s}, {0, -s, s}};
  Vec3 x[8];
  for (int i = 0; i < 4; ++i)
  {
    x[i] = corner[i] + Vec3{-1, 0, -d};
    x[i + 4] = corner[i] + Vec3{1, 0, -d};
  }
  const ConvexBlock slab = slabBlock3D(), prism = blockOfElement<3>(x, 8);
  for (const Search search : searches)
  {
    const ClassicPlane plane = classicCommonPlane<3>(slab, prism, classicOptions(search));
    EXPECT_NEAR(classicPush(plane).force.z / (2 * d * d), 1, 1e-11);
    const Push simple = simplePush<3>(slab, plane.face[0], prism, 0, alongCommonNormal);
    EXPECT_NEAR(simple.force.z / classicPush(plane).force.z, std::cos(pi / 8) / std::cos(pi / 4),
                1e-10);
  }
}

TEST(ClassicCornerOnFace3D, crossedEdgesMeetInThePlaneThroughBoth)
{
  // Edges of two cubes that cross at right angles: the sections half way down are strips of the
  // width 2 (d / 2), the area is d^2.
  const Real d = .01, s = std::sqrt(.5);
  const Vec3 corner[4] = {{0, 0, 0}, {0, s, s}, {0, 0, 2 * s}, {0, -s, s}};
  Vec3 x[8];
  for (int i = 0; i < 4; ++i)
  {
    x[i] = corner[i] + Vec3{-1, 0, 0};
    x[i + 4] = corner[i] + Vec3{1, 0, 0};
  }
  const ConvexBlock upper = blockOfElement<3>(x, 8);
  const Mat3 over = rotation({0, 0, 1}, pi / 2) * rotation({1, 0, 0}, pi);
  const ConvexBlock lower = moved(upper, over, {.1, .2, d});
  for (const Search search : searches)
  {
    const ClassicPlane plane = classicCommonPlane<3>(lower, upper, classicOptions(search));
    EXPECT_NEAR(plane.gap, -d, 1e-14);
    EXPECT_LT(norm(plane.normal - Vec3{0, 0, 1}), 1e-14);
    EXPECT_NEAR(plane.area, d * d, 1e-14);
    EXPECT_LT(norm(plane.point - Vec3{.1, 0, .5 * d}), 1e-14);
  }
}

TEST(ClassicFaceOnFace, equalQuadrilateralsAgreeWithTheSimplePlane)
{
  Random random(1);
  const Vec3 square[4] = {{-.5, -.5, 0}, {.5, -.5, 0}, {.5, .5, 0}, {-.5, .5, 0}};
  int checked = 0;
  for (int n = 0; n < 500; ++n)
  {
    // Sideways overlap of more than the depth: else the least overlap is sideways.
    const Real depth = .05 + .049 * random(), shift = .8 * random();
    const Mat3 r = rotation({0, 0, 1}, pi * random());
    const Vec3 place = random.vector();
    const ConvexBlock a = moved(blockOfElement<2>(square, 4), r, {place.x, place.y, 0});
    const ConvexBlock b = moved(a, rotation({0, 0, 1}, 0), r * Vec3{shift, 1 - depth, 0});
    for (const Search search : searches)
      for (const Area area : {Area::Section, Area::Shadow})
      {
        const ClassicPlane plane = classicCommonPlane<2>(a, b, classicOptions(search, area));
        const ContactOptions o = options(area == Area::Section ? ContactOptions::Area::Penetrating
                                                               : ContactOptions::Area::Full,
                                         ContactOptions::Weights::Average);
        ASSERT_EQ(plane.face[0], 2);
        ASSERT_EQ(plane.face[1], 0);
        PairPlane simple = touchingPlane();
        updatePlane<2>(simple, faceOf(a, 2), faceOf(b, 0), o, 1);
        ASSERT_NEAR(plane.area, 1 - std::abs(shift), 1e-12);
        ASSERT_NEAR(plane.area, simple.area, 1e-12);
        ASSERT_NEAR(plane.gap, simple.gap, 1e-12);
        ASSERT_LT(norm(plane.normal - simple.normal), 1e-12);
        ASSERT_LT(norm(classicPush(plane).force - simple.forceOn(1)), 1e-12);
        ASSERT_LT(norm(plane.point - simple.pointOfContact), 1e-12);
        ++checked;
      }
  }
  EXPECT_EQ(checked, 2000);
}

TEST(ClassicFaceOnFace, hexahedraAgreeWithTheSimplePlaneUnderAnyShiftAndTurn)
{
  // Frusta: their sections differ from their faces, but faces that lie in the plane count.
  Random random(2);
  for (int n = 0; n < 500; ++n)
  {
    const Real depth = .05 + .049 * random(), top = 1 + .3 * random();
    Vec3 x[8];
    for (int i = 0; i < 8; ++i)
    {
      const Real half = .5 * (i < 4 ? 1 : top);
      x[i] = {(i % 4 == 1 || i % 4 == 2) ? half : -half, i % 4 >= 2 ? half : -half,
              i < 4 ? 0. : 1.};
    }
    const ConvexBlock upper = blockOfElement<3>(x, 8);
    const Mat3 over = rotation({1, 0, 0}, pi), turn = rotation({0, 0, 1}, pi * random());
    const Mat3 r = random.attitude();
    const Vec3 place = random.vector(), shift{.4 * random(), .4 * random(), -depth};
    const ConvexBlock a = moved(moved(upper, over), r, place);
    const ConvexBlock b = moved(moved(upper, turn, shift), r, place);
    for (const Search search : searches)
      for (const Area area : {Area::Section, Area::Shadow})
      {
        const ClassicPlane plane = classicCommonPlane<3>(a, b, classicOptions(search, area));
        const ContactOptions o = options(area == Area::Section ? ContactOptions::Area::Penetrating
                                                               : ContactOptions::Area::Full,
                                         ContactOptions::Weights::Average);
        ASSERT_EQ(plane.face[0], 4) << n;
        ASSERT_EQ(plane.face[1], 4) << n;
        PairPlane simple = touchingPlane();
        updatePlane<3>(simple, faceOf(a, 4), faceOf(b, 4), o, 1);
        ASSERT_GT(simple.area, .1);
        ASSERT_NEAR(plane.area, simple.area, 1e-12);
        ASSERT_NEAR(plane.gap, simple.gap, 1e-12);
        ASSERT_LT(norm(plane.normal - simple.normal), 1e-12);
        ASSERT_LT(norm(classicPush(plane).force - simple.forceOn(1)), 1e-12);
        ASSERT_LT(norm(plane.point - simple.pointOfContact), 1e-12);
      }
  }
}

namespace
{
/// Two random blocks that overlap by a depth: hexahedron on hexahedron, tetrahedron on hexahedron,
/// tetrahedron on tetrahedron; two quadrilaterals.
struct Blocks
{
  ConvexBlock a, b;
};

template <int Dim>
Blocks overlapping(Random& random, int kind, Real depth)
{
  Blocks pair;
  if constexpr (Dim == 2)
  {
    pair = {randomQuadrilateral(random), randomQuadrilateral(random)};
    const Real angle = pi * random();
    pushInto<2>(pair.a, pair.b, {std::cos(angle), std::sin(angle), 0}, depth);
  }
  else
  {
    pair = {randomBlock(random, kind == 2), randomBlock(random, kind > 0)};
    pushInto<3>(pair.a, pair.b, normalised(random.vector()), depth);
  }
  return pair;
}

/// How often the two searches end within the angle tolerance of each other, and at the least
/// overlap of all.
struct Agreement
{
  int pairs = 0, searches = 0, least = 0;
};

template <int Dim>
Agreement agreement(unsigned seed, int kind, int pairs)
{
  Random random(seed);
  Agreement found;
  for (; found.pairs < pairs; ++found.pairs)
  {
    const Blocks pair = overlapping<Dim>(random, kind, .02);
    const Real largest = largestGap<Dim>(pair.a, pair.b);
    ClassicPlane plane[2];
    bool least = true;
    for (int s = 0; s < 2; ++s)
    {
      plane[s] = classicCommonPlane<Dim>(pair.a, pair.b, classicOptions(searches[s]));
      EXPECT_LE(plane[s].gap, largest + 1e-12);
      least = least && plane[s].gap > largest - 1e-12;
    }
    found.searches += angleBetween(plane[0].normal, plane[1].normal) < radians(.01);
    found.least += least;
  }
  return found;
}
} // namespace

TEST(ClassicFaceOnFace, strikesSidewaysWhereTheOverlapIsNarrowerThanDeep)
{
  const Vec3 square[4] = {{-.5, -.5, 0}, {.5, -.5, 0}, {.5, .5, 0}, {-.5, .5, 0}};
  const ConvexBlock a = blockOfElement<2>(square, 4);
  const ConvexBlock b = moved(a, rotation({0, 0, 1}, 0), {.92, .9, 0});
  for (const Search search : searches)
  {
    const ClassicPlane plane = classicCommonPlane<2>(a, b, classicOptions(search));
    EXPECT_NEAR(plane.gap, -.08, 1e-14);
    EXPECT_NEAR(plane.normal.x, 1, 1e-14);
    EXPECT_NEAR(plane.area, .1, 1e-14);
  }
  PairPlane simple = touchingPlane();
  updatePlane<2>(simple, faceOf(a, 2), faceOf(b, 0), alongCommonNormal, 1);
  EXPECT_NEAR(simple.normal.y, 1, 1e-14);
  EXPECT_NEAR(simple.area, .08, 1e-14);
}

TEST(ClassicSearch, bothSearchesEndAtTheSameNormal)
{
  // Overlap .02 of blocks of the size 2. Where they do not end at the least overlap, the overlap is
  // least among all normals nearby.
  const Agreement plane = agreement<2>(3, 0, 400);
  EXPECT_EQ(plane.searches, 400);
  EXPECT_EQ(plane.least, 400);
  for (int kind = 0; kind < 3; ++kind)
  {
    const Agreement solid = agreement<3>(3, kind, 400);
    EXPECT_GE(solid.searches, 399) << kind;
    EXPECT_GE(solid.least, 392) << kind;
    RecordProperty("same_normal_" + std::to_string(kind), solid.searches);
    RecordProperty("least_overlap_" + std::to_string(kind), solid.least);
  }
}

TEST(ClassicSearch, candidatesRepairWhatRotationsAloneLeave)
{
  // Half of all searches by rotations alone end within the last angle of the best normal. Some stop
  // on a ridge where none of the four turns gains anything.
  Random random(4);
  std::vector<Real> off;
  for (int n = 0; n < 400; ++n)
  {
    const Blocks pair = overlapping<3>(random, n % 2, .02);
    classic::BestNormal best;
    best.normal = startingNormal<3>(pair.a, pair.b);
    best.at = classic::separationAlong(best.normal, pair.a, pair.b);
    best.margin = 1e-13;
    classic::searchByRotations<3>(best, pair.a, pair.b, {});
    const ClassicPlane plane =
        classicCommonPlane<3>(pair.a, pair.b, classicOptions(Search::Rotations));
    ASSERT_GE(plane.gap, best.at.gap() - 1e-12);
    off.push_back(angleBetween(best.normal, plane.normal) * 180 / pi);
  }
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[200], .01);
  EXPECT_LT(off[320], .1);
  RecordProperty("median_degrees", std::to_string(off[200]));
  RecordProperty("ninth_decile_degrees", std::to_string(off[360]));
  const auto within = std::lower_bound(off.begin(), off.end(), .02) - off.begin();
  RecordProperty("within_two_last_angles", int(within));
}

TEST(ClassicSearch, startsFromTheLastNormal)
{
  // A square on a larger one, pushed in by .1 and .11 beyond its side: two largest gaps, and the
  // search stays at the one it came from.
  const Vec3 square[4] = {{-.5, -.5, 0}, {.5, -.5, 0}, {.5, .5, 0}, {-.5, .5, 0}};
  const ConvexBlock a = blockOfElement<2>(square, 4);
  const ConvexBlock b = moved(a, rotation({0, 0, 1}, 0), {.89, .9, 0});
  for (const Search search : searches)
  {
    const ClassicOptions o = classicOptions(search);
    EXPECT_NEAR(classicCommonPlane<2>(a, b, o).gap, -.1, 1e-14);
    EXPECT_NEAR(classicCommonPlane<2>(a, b, o, {.1, 1, 0}).normal.y, 1, 1e-14);
  }
  const ConvexBlock slab = slabBlock2D();
  const ConvexBlock corner =
      moved(cornerBlock2D(pi / 4, .01, 1), rotation({0, 0, 1}, 0), {4, 0, 0});
  for (const Search search : searches)
    EXPECT_NEAR(classicCommonPlane<2>(slab, corner, classicOptions(search)).gap, -.01, 1e-14)
        << "a corner near the rim of a slab is pushed up, not out";
}

TEST(ClassicPlane, turnsAndMovesWithTheBlocks)
{
  Random random(5);
  const Mat3 r = oblique();
  const Vec3 shift{1000, -2000, 500};
  int same[2] = {0, 0};
  const int pairs = 200;
  for (int n = 0; n < pairs; ++n)
  {
    const Blocks pair = overlapping<3>(random, n % 3, .02);
    for (int s = 0; s < 2; ++s)
    {
      const ClassicOptions o = classicOptions(searches[s]);
      const ClassicPlane here = classicCommonPlane<3>(pair.a, pair.b, o);
      const ClassicPlane there =
          classicCommonPlane<3>(moved(pair.a, r, shift), moved(pair.b, r, shift), o);
      // Coordinates of 2000 have lost 2e-13.
      if (angleBetween(r * here.normal, there.normal) > 1e-9)
        continue; // another largest gap
      ++same[s];
      ASSERT_NEAR(here.gap, there.gap, 1e-11);
      ASSERT_NEAR(here.area, there.area, 1e-10);
      ASSERT_LT(norm(r * here.point + shift - there.point), 1e-9);
      ASSERT_EQ(here.face[0], there.face[0]);
      ASSERT_EQ(here.face[1], there.face[1]);
    }
  }
  // The axes of the rotations are not those of the blocks, so another largest gap can be found.
  EXPECT_GE(same[0], 199);
  EXPECT_EQ(same[1], pairs);
}

TEST(ClassicPlane, doesNotDependOnWhichBlockIsTheFirst)
{
  Random random(6);
  for (int n = 0; n < 200; ++n)
  {
    const Blocks pair = overlapping<3>(random, n % 3, .02);
    for (const Search search : searches)
    {
      const ClassicOptions o = classicOptions(search);
      const ClassicPlane one = classicCommonPlane<3>(pair.a, pair.b, o);
      const ClassicPlane other = classicCommonPlane<3>(pair.b, pair.a, o);
      ASSERT_LT(norm(one.normal + other.normal), 1e-12);
      ASSERT_NEAR(one.gap, other.gap, 1e-12);
      ASSERT_NEAR(one.area, other.area, 1e-12);
      ASSERT_LT(norm(one.point - other.point), 1e-12);
      ASSERT_EQ(one.face[0], other.face[1]);
      ASSERT_EQ(one.node[0], other.node[1]);
    }
  }
}

TEST(ClassicPlane, apartTheGapIsTheDistanceAndThereIsNoArea)
{
  const Vec3 cube[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const ConvexBlock a = blockOfElement<3>(cube, 8);
  const Mat3 same = rotation({0, 0, 1}, 0);
  for (const Search search : searches)
  {
    const ClassicOptions o = classicOptions(search);
    // Face to face, edge to edge, node to node.
    for (const Vec3& away : {Vec3{.2, .3, 1.5}, Vec3{.2, 1.3, 1.4}, Vec3{1.2, 1.3, 1.6}})
    {
      const ClassicPlane plane = classicCommonPlane<3>(a, moved(a, same, away), o);
      const Vec3 gap{std::max(away.x - 1, 0.), std::max(away.y - 1, 0.), std::max(away.z - 1, 0.)};
      EXPECT_NEAR(plane.gap, norm(gap), 1e-14);
      EXPECT_LT(norm(plane.normal - normalised(gap)), 1e-13);
      EXPECT_EQ(plane.area, 0);
    }
    // Touching: closed by nothing.
    const ClassicPlane touching = classicCommonPlane<3>(a, moved(a, same, {.2, .3, 1}), o);
    EXPECT_EQ(touching.gap, 0);
    EXPECT_EQ(touching.area, 0);
  }
  // Node to edge: only the line across the edge gives the distance.
  const ConvexBlock turned = moved(cornerBlock3D(std::asin(1 / std::sqrt(3.0)), 0),
                                   rotation({1, 0, 0}, -pi / 4), {.5, 1.3, 1.3});
  EXPECT_NEAR(classicCommonPlane<3>(a, turned, {}).gap, .3 * std::sqrt(2.0), 1e-13);
}

TEST(ClassicPlane, staysFiniteAndWithinTheShadowsForWarpedBlocks)
{
  Random random(7);
  int withArea = 0;
  for (int n = 0; n < 3000; ++n)
  {
    ConvexBlock block[2];
    for (ConvexBlock& b : block)
    {
      b = randomBlock(random, false);
      for (int i = 0; i < 8; ++i)
        b.x[i] += .2 * random.vector();
    }
    for (int i = 0; i < 8; ++i)
      block[1].x[i] += Vec3{1.7 + .5 * random(), 0, 0};
    if (n % 10 == 0) // a face without area
      for (int i = 0; i < 4; ++i)
        block[0].x[block[0].faceNode[1][i]] = block[0].x[block[0].faceNode[1][0]];
    const Search search = searches[n % 2];
    const ClassicPlane section = classicCommonPlane<3>(block[0], block[1], classicOptions(search));
    const ClassicPlane shadow =
        classicCommonPlane<3>(block[0], block[1], classicOptions(search, Area::Shadow));
    ASSERT_NEAR(norm(section.normal), 1, 1e-14);
    ASSERT_TRUE(std::isfinite(norm(section.point)));
    ASSERT_GE(section.area, 0);
    ASSERT_LE(section.area, shadow.area + 1e-12);
    withArea += section.area > 0;
    if (section.gap >= 0)
    {
      ASSERT_EQ(shadow.area, 0);
    }
  }
  EXPECT_GT(withArea, 1000);
}

TEST(ClassicWeights, meetThePointFromBothFaces)
{
  Random random(8);
  const auto check = [](const auto dim, const ClassicPlane& plane, const ConvexBlock& block, int f)
  {
    constexpr int Dim = decltype(dim)::value;
    Vec3 x[4];
    for (int i = 0; i < block.faceSize[f]; ++i)
      x[i] = block.x[block.faceNode[f][i]];
    Real w[4], sum = 0;
    classicWeights<Dim>(plane, x, block.faceSize[f], w);
    Vec3 off = Vec3{} - plane.point;
    for (int i = 0; i < block.faceSize[f]; ++i)
    {
      sum += w[i];
      off += w[i] * x[i];
    }
    ASSERT_NEAR(sum, 1, 1e-12);
    ASSERT_LT(norm(off - dot(off, plane.normal) * plane.normal), 1e-11);
  };
  for (int n = 0; n < 200; ++n)
  {
    const Blocks solid = overlapping<3>(random, n % 3, .02), flat = overlapping<2>(random, 0, .02);
    for (const Area area : {Area::Section, Area::Shadow})
    {
      const ClassicOptions o = classicOptions(Search::Candidates, area);
      const ClassicPlane plane = classicCommonPlane<3>(solid.a, solid.b, o);
      check(std::integral_constant<int, 3>(), plane, solid.a, plane.face[0]);
      check(std::integral_constant<int, 3>(), plane, solid.b, plane.face[1]);
      const ClassicPlane line = classicCommonPlane<2>(flat.a, flat.b, o);
      check(std::integral_constant<int, 2>(), line, flat.a, line.face[0]);
      check(std::integral_constant<int, 2>(), line, flat.b, line.face[1]);
    }
  }
}

TEST(ClassicWeights, putTheForceOfACornerOnItsNode)
{
  const ConvexBlock slab = slabBlock3D();
  const ConvexBlock cube = cornerBlock3D(std::asin(1 / std::sqrt(3.0)), .01);
  const ClassicPlane plane = classicCommonPlane<3>(slab, cube, {});
  Vec3 x[4];
  for (int i = 0; i < 4; ++i)
    x[i] = cube.x[cube.faceNode[plane.face[1]][i]];
  Real w[4];
  classicWeights<3>(plane, x, 4, w);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(w[i], cube.faceNode[plane.face[1]][i] == 0 ? 1 : 0, 1e-12);
}
