#include <coplane_geometry/FaceMap.hpp>
#include <coplane_geometry/PolygonSides.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace coplane;

namespace
{
ConvexPolygon polygon(const std::vector<Vec2>& vertices)
{
  ConvexPolygon result;
  for (const Vec2& p : vertices)
    result.add(p);
  return result;
}

ConvexPolygon square(Vec2 corner, Real side)
{
  return polygon({corner,
                  {corner.x + side, corner.y},
                  {corner.x + side, corner.y + side},
                  {corner.x, corner.y + side}});
}

/// The polygon turned by an angle about the origin, then scaled, then moved.
ConvexPolygon moved(const ConvexPolygon& p, Real angle, Real scale, Vec2 shift)
{
  ConvexPolygon result;
  const Real c = std::cos(angle), s = std::sin(angle);
  for (int i = 0; i < p.size; ++i)
    result.add(
        scale * Vec2{c * p.vertex[i].x - s * p.vertex[i].y, s * p.vertex[i].x + c * p.vertex[i].y} +
        shift);
  return result;
}

AreaAndCentroid shared(const ConvexPolygon& a, const ConvexPolygon& b)
{
  return areaAndCentroid(intersection(a, b));
}

/// Convex polygon with whole-numbered vertices, counter-clockwise.
struct GridPolygon
{
  int size = 0;
  std::int64_t x[4], y[4];
};

struct ExactArea
{
  long double area = 0, momentX = 0, momentY = 0;
};

/// The same with unordered sides; their cuts never cross a convex border more than twice here.
AreaAndCentroid sharedBySides(const ConvexPolygon& a, const ConvexPolygon& b)
{
  PolygonSides<Real> sides;
  intersect(a.vertex, a.size, b.vertex, b.size, sides);
  EXPECT_FALSE(sides.crossed);
  return areaAndCentroid(sides);
}

/// A second method: Green's theorem over the boundary of the shared region. That boundary is the
/// part of A's edges inside B and the part of B's edges inside A. The ends of each part are
/// quotients of whole numbers, so nothing is rounded before the last line. An edge of B that lies
/// on an edge of A is left out, because A's edge counts already.
void addEdgesInside(const GridPolygon& edges, const GridPolygon& region, bool borderCounts,
                    ExactArea& sum)
{
  for (int i = 0; i < edges.size; ++i)
  {
    const int j = (i + 1) % edges.size;
    const std::int64_t ax = edges.x[i], ay = edges.y[i], bx = edges.x[j], by = edges.y[j];
    long double from = 0, to = 1;
    bool inside = true;
    for (int k = 0; k < region.size && inside; ++k)
    {
      const int l = (k + 1) % region.size;
      const std::int64_t ex = region.x[l] - region.x[k], ey = region.y[l] - region.y[k];
      const std::int64_t da = ex * (ay - region.y[k]) - ey * (ax - region.x[k]);
      const std::int64_t db = ex * (by - region.y[k]) - ey * (bx - region.x[k]);
      if (da == 0 && db == 0)
      {
        // On the border line: the shared region lies on one side of it only if both run alike.
        const bool alike = ex * (bx - ax) + ey * (by - ay) > 0;
        inside = borderCounts && alike;
      }
      else if (da <= 0 && db <= 0)
        inside = false;
      else if (da < 0)
        from = std::max(from, (long double)da / (long double)(da - db));
      else if (db < 0)
        to = std::min(to, (long double)da / (long double)(da - db));
    }
    if (!inside || !(to > from))
      continue;
    const long double c = (to - from) * (long double)(ax * by - ay * bx); // p(from) x p(to)
    const long double px = ax + from * (bx - ax), py = ay + from * (by - ay);
    const long double qx = ax + to * (bx - ax), qy = ay + to * (by - ay);
    sum.area += c / 2;
    sum.momentX += c * (px + qx) / 6;
    sum.momentY += c * (py + qy) / 6;
  }
}

ExactArea exactlyShared(const GridPolygon& a, const GridPolygon& b)
{
  ExactArea sum;
  addEdgesInside(a, b, true, sum);
  addEdgesInside(b, a, false, sum);
  return sum;
}

GridPolygon randomGridPolygon(std::mt19937& random, int half)
{
  std::uniform_int_distribution<int> coordinate(-half, half), count(3, 4);
  for (;;)
  {
    GridPolygon p;
    p.size = count(random);
    Vec2 vertex[4];
    for (int i = 0; i < p.size; ++i)
    {
      p.x[i] = coordinate(random);
      p.y[i] = coordinate(random);
      vertex[i] = {Real(p.x[i]), Real(p.y[i])};
    }
    if (isConvex(vertex, p.size)) // whole numbers: the test is exact
      return p;
  }
}

ConvexPolygon asPolygon(const GridPolygon& p)
{
  ConvexPolygon result;
  for (int i = 0; i < p.size; ++i)
    result.add({Real(p.x[i]), Real(p.y[i])});
  return result;
}

/// Largest difference from the exact area and centroid over random pairs, relative to the size of
/// the grid (round-off of a vertex is relative to that).
void compareWithExact(int half, int pairs, unsigned seed)
{
  std::mt19937 random(seed);
  Real worstArea = 0, worstMoment = 0;
  int overlapping = 0;
  for (int n = 0; n < pairs; ++n)
  {
    const GridPolygon a = randomGridPolygon(random, half), b = randomGridPolygon(random, half);
    const ExactArea exact = exactlyShared(a, b);
    overlapping += exact.area > 0;
    const Real size = half;
    for (const AreaAndCentroid& got :
         {shared(asPolygon(a), asPolygon(b)), sharedBySides(asPolygon(a), asPolygon(b))})
    {
      worstArea = std::max(worstArea, std::abs(got.area - Real(exact.area)) / (size * size));
      worstMoment =
          std::max(worstMoment,
                   std::abs(got.area * got.centroid.x - Real(exact.momentX)) / std::pow(size, 3));
      worstMoment =
          std::max(worstMoment,
                   std::abs(got.area * got.centroid.y - Real(exact.momentY)) / std::pow(size, 3));
    }
  }
  EXPECT_GT(overlapping, pairs / 4)
      << "the random pairs must overlap often enough to mean something";
  EXPECT_LT(worstArea, 1e-13);
  EXPECT_LT(worstMoment, 1e-13);
  ::testing::Test::RecordProperty("worstArea", std::to_string(worstArea * 1e16) + "e-16");
  ::testing::Test::RecordProperty("worstMoment", std::to_string(worstMoment * 1e16) + "e-16");
}
} // namespace

TEST(ConvexPolygon_Intersection, squareAndItsCopyTurnedBy45DegreesShareARegularOctagon)
{
  // Inradius 1: area of the regular octagon 8 tan(22.5 deg) = 8 (sqrt 2 - 1).
  const ConvexPolygon a = square({-1, -1}, 2);
  const AreaAndCentroid got = shared(a, moved(a, pi / 4, 1, {0, 0}));
  EXPECT_NEAR(got.area, 8 * (std::sqrt(2.0) - 1), 8 * epsilon);
  EXPECT_NEAR(got.centroid.x, 0, 4 * epsilon);
  EXPECT_NEAR(got.centroid.y, 0, 4 * epsilon);
}

TEST(ConvexPolygon_Intersection, unitSquaresShiftedAlongBothAxesShareARectangle)
{
  // [0,1]^2 and [.3,1.3] x [.4,1.4] share [.3,1] x [.4,1]: .7 * .6, centre (.65, .7).
  const AreaAndCentroid got = shared(square({0, 0}, 1), square({.3, .4}, 1));
  EXPECT_NEAR(got.area, .42, 4 * epsilon);
  EXPECT_NEAR(got.centroid.x, .65, 4 * epsilon);
  EXPECT_NEAR(got.centroid.y, .70, 4 * epsilon);
}

TEST(ConvexPolygon_Intersection, triangleWhoseHypotenuseTouchesACornerOfASquareContainsTheSquare)
{
  // x + y <= 2 holds in all of [0,1]^2, with equality at (1,1) only.
  const AreaAndCentroid got = shared(polygon({{0, 0}, {2, 0}, {0, 2}}), square({0, 0}, 1));
  EXPECT_EQ(got.area, 1.0);
  EXPECT_NEAR(got.centroid.x, .5, 2 * epsilon);
  EXPECT_NEAR(got.centroid.y, .5, 2 * epsilon);
}

TEST(ConvexPolygon_Intersection, rightTriangleAndItsShiftedCopyShareASimilarTriangle)
{
  // x, y >= 1/4, x + y <= 1: legs of 1/2, area 1/8, centroid 1/4 + 1/6.
  const AreaAndCentroid got =
      shared(polygon({{0, 0}, {1, 0}, {0, 1}}), polygon({{.25, .25}, {1.25, .25}, {.25, 1.25}}));
  EXPECT_NEAR(got.area, .125, epsilon);
  EXPECT_NEAR(got.centroid.x, 5.0 / 12, 2 * epsilon);
  EXPECT_NEAR(got.centroid.y, 5.0 / 12, 2 * epsilon);
}

TEST(ConvexPolygon_Intersection, disjointPolygonsShareNothing)
{
  EXPECT_EQ(shared(square({0, 0}, 1), square({3, 0}, 1)).area, 0.0);
  EXPECT_EQ(shared(square({0, 0}, 1), polygon({{2, 2}, {3, 2}, {2, 3}})).area, 0.0);
}

TEST(ConvexPolygon_Intersection, polygonsThatTouchAlongAnEdgeShareNoArea)
{
  EXPECT_EQ(shared(square({0, 0}, 1), square({1, 0}, 1)).area, 0.0);
  EXPECT_EQ(shared(square({0, 0}, 1), square({1, .5}, 1)).area, 0.0);
}

TEST(ConvexPolygon_Intersection, polygonsThatTouchAtAVertexShareNoArea)
{
  EXPECT_EQ(shared(square({0, 0}, 1), square({1, 1}, 1)).area, 0.0);
  EXPECT_EQ(shared(square({0, 0}, 1), polygon({{1, .5}, {2, 0}, {2, 1}})).area, 0.0);
}

TEST(ConvexPolygon_Intersection, identicalPolygonsShareAllOfThem)
{
  const ConvexPolygon kite = polygon({{0, 0}, {2, -1}, {3, 0}, {2, 1}});
  EXPECT_NEAR(shared(kite, kite).area, 3, 8 * epsilon); // diagonals 3 and 2
  const ConvexPolygon triangle = polygon({{.1, .2}, {1.3, .7}, {.4, 1.9}});
  EXPECT_EQ(shared(triangle, triangle).area, areaAndCentroid(triangle).area);
}

TEST(ConvexPolygon_Intersection, containedPolygonIsSharedWhole)
{
  const ConvexPolygon small = polygon({{.2, .2}, {.7, .3}, {.5, .8}});
  EXPECT_EQ(shared(small, square({0, 0}, 1)).area, areaAndCentroid(small).area);
  EXPECT_NEAR(shared(square({0, 0}, 1), small).area, areaAndCentroid(small).area, epsilon);
}

TEST(ConvexPolygon_Intersection, areaScalesWithTheSquareOfTheSize)
{
  for (const Real scale : {1e6, 1e-6})
  {
    const ConvexPolygon a = moved(square({-1, -1}, 2), .3, scale, {0, 0});
    const AreaAndCentroid got = shared(a, moved(square({-1, -1}, 2), .3 + pi / 4, scale, {0, 0}));
    EXPECT_NEAR(got.area / (scale * scale), 8 * (std::sqrt(2.0) - 1), 1e-14) << scale;
  }
}

TEST(ConvexPolygon_Intersection, polygonsFarFromTheOriginKeepTenDigits)
{
  // Vertices at 1e4 carry a round-off of 1e4 * 1.1e-16 = 1e-12, on a length of 1.
  const Vec2 far{1e4, -1e4};
  const AreaAndCentroid got =
      shared(moved(square({0, 0}, 1), 0, 1, far), moved(square({.3, .4}, 1), 0, 1, far));
  EXPECT_NEAR(got.area, .42, .42e-10);
  EXPECT_NEAR(got.centroid.x - far.x, .65, 1e-10);
  EXPECT_NEAR(got.centroid.y - far.y, .70, 1e-10);
}

TEST(ConvexPolygon_Intersection, hundredThousandRandomPairsAgreeWithExactArithmetic)
{
  compareWithExact(1000, 100000, 1);
}

TEST(ConvexPolygon_Intersection, pairsWithManyCommonVerticesAndEdgesAgreeWithExactArithmetic)
{
  // On a grid of 5 x 5 points vertices, edges and whole polygons coincide in a large part of the
  // pairs.
  compareWithExact(2, 10000, 2);
  compareWithExact(1, 1000, 3);
}

TEST(ConvexPolygon_Intersection, doesNotDependOnWhichPolygonIsCut)
{
  std::mt19937 random(4);
  for (int n = 0; n < 1000; ++n)
  {
    const ConvexPolygon a = asPolygon(randomGridPolygon(random, 50)),
                        b = asPolygon(randomGridPolygon(random, 50));
    EXPECT_NEAR(shared(a, b).area, shared(b, a).area, 2500e-14);
  }
}

TEST(ConvexPolygon_Intersection, emptyPolygonHasNoArea)
{
  EXPECT_EQ(areaAndCentroid(ConvexPolygon{}).area, 0.0);
  EXPECT_EQ(shared(ConvexPolygon{}, square({0, 0}, 1)).area, 0.0);
}

TEST(ConvexPolygon_Cut, keepsThePartWhereALinearFunctionIsPositive)
{
  // Unit square, f = 1/4 - x: [0, 1/4] x [0, 1].
  ConvexPolygon p = square({0, 0}, 1);
  Real f[ConvexPolygon::capacity] = {.25, -.75, -.75, .25};
  cutWhereNegative(p, f);
  const AreaAndCentroid got = areaAndCentroid(p);
  EXPECT_EQ(got.area, .25);
  EXPECT_EQ(got.centroid.x, .125);
  for (int i = 0; i < p.size; ++i)
    EXPECT_NEAR(f[i], .25 - p.vertex[i].x, epsilon) << "the carried values belong to the vertices";
}

TEST(ConvexPolygon_Cut, octagonWithAlternatingSignsFitsTheFixedArray)
{
  // The worst case: every second corner goes and leaves two vertices, 4 + 8 = 12.
  ConvexPolygon p;
  Real f[ConvexPolygon::capacity];
  for (int i = 0; i < 8; ++i)
  {
    p.add({std::cos(pi * i / 4), std::sin(pi * i / 4)});
    f[i] = i % 2 ? -1 : 1;
  }
  cutWhereNegative(p, f);
  EXPECT_EQ(p.size, 12);
  // Each corner cut off: half of both edges, 1/2 (s/2)^2 sin 135 deg with s = 2 sin 22.5 deg.
  const Real s = 2 * std::sin(pi / 8);
  const Real cut = 4 * 0.5 * (s / 2) * (s / 2) * std::sin(.75 * pi);
  EXPECT_NEAR(areaAndCentroid(p).area, 2 * std::sqrt(2.0) - cut, 1e-14);
}

TEST(PolygonSides_Cut, leavesThePolygonThatACutInOrderLeaves)
{
  // Unit square, f = 3/4 - x - y: one corner goes.
  PolygonSides<Real> sides = sidesOf(square({0, 0}, 1));
  Real from[PolygonSides<Real>::capacity] = {.75, -.25, -1.25, -.25};
  Real to[PolygonSides<Real>::capacity] = {-.25, -1.25, -.25, .75};
  cutWhereNegative(sides, from, to);
  EXPECT_FALSE(sides.crossed);
  const AreaAndCentroid got = areaAndCentroid(sides);
  EXPECT_NEAR(got.area, .28125, 1e-16);
  EXPECT_NEAR(got.centroid.x, .25, 1e-16);
  EXPECT_NEAR(got.centroid.y, .25, 1e-16);
  for (int k = 0; k < sides.size; ++k)
    if (sides.isThere(k))
    {
      EXPECT_NEAR(from[k], .75 - sides.from[k].x - sides.from[k].y, 1e-16);
      EXPECT_NEAR(to[k], .75 - sides.to[k].x - sides.to[k].y, 1e-16);
    }
}

TEST(PolygonSides_Cut, tellsWhenTheBorderIsCrossedMoreThanTwice)
{
  PolygonSides<Real> sides = sidesOf(square({0, 0}, 1));
  Real from[PolygonSides<Real>::capacity] = {1, -1, 1, -1};
  Real to[PolygonSides<Real>::capacity] = {-1, 1, -1, 1};
  PolygonSides<Real> ordered = sides;
  cutWhereNegative(sides, from, to);
  EXPECT_TRUE(sides.crossed);
  Real f[PolygonSides<Real>::capacity] = {1, -1, 1, -1}, g[PolygonSides<Real>::capacity];
  cutInOrder(ordered, f, g);
  EXPECT_EQ(ordered.size, 6);
  EXPECT_NEAR(areaAndCentroid(ordered).area, .75, 1e-16);
}
