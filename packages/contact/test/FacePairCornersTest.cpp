#include "FacePairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

using namespace coplane;
using namespace coplane::facepairs;

// Corners and edges pushed into other bodies, unit stiffness, no friction. A joint is just closed
// at zero gap, so the traction is the depth along the normal of the common plane.

namespace
{
/// Corner with the interior angle 2 theta above a long face (Figure 1 of Vorobiev 2006):
///
///        \   |   /   l = length of the corner's faces
///         \th|th/
///   _______\ | /_______   y = 0
///           \|/           apex at y = -depth
std::vector<FaceNodes> corner2D(Real theta, Real depth, Real l, const Vec3& velocity)
{
  const Vec3 apex{0, -depth, 0};
  return {face({apex, apex + Vec3{l * std::sin(theta), l * std::cos(theta), 0}}, velocity),
          face({apex + Vec3{-l * std::sin(theta), l * std::cos(theta), 0}, apex}, velocity)};
}

FaceNodes slab2D()
{
  return face({{5, 0, 0}, {-5, 0, 0}});
}

FaceNodes slab3D()
{
  return face({{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
}

/// The three unit squares at a corner of a cube whose space diagonal is the z axis. turn: angle of
/// the first face's normal about z; the body lies above the apex (up = 1) or below it (up = -1).
std::vector<FaceNodes> cubeCorner(const Vec3& apex, Real turn, int up)
{
  Vec3 edge[3]; // along the cube's edges, away from the apex
  for (int i = 0; i < 3; ++i)
  {
    const Real angle = turn + 2 * pi * i / 3;
    edge[i] = {-std::sqrt(2.0 / 3) * std::cos(angle), -std::sqrt(2.0 / 3) * std::sin(angle),
               up / std::sqrt(3.0)};
  }
  std::vector<FaceNodes> faces;
  for (int i = 0; i < 3; ++i)
  {
    // Outward is against the third edge.
    Vec3 p = edge[(i + 1) % 3], q = edge[(i + 2) % 3];
    if (dot(cross(p, q), edge[i]) > 0)
      std::swap(p, q);
    faces.push_back(face({apex, apex + p, apex + p + q, apex + q}));
  }
  return faces;
}

/// The two faces of a right-angled edge of length 2 through `middle` along `axis`; the body lies on
/// the side of `inward`.
std::vector<FaceNodes> wedge(const Vec3& middle, const Vec3& axis, const Vec3& inward)
{
  const Vec3 aside = cross(axis, inward);
  std::vector<FaceNodes> faces;
  for (const Real side : {1.0, -1.0})
  {
    const Vec3 flank = (1 / std::sqrt(2.0)) * (inward + side * aside);
    const Vec3 from = middle - axis, to = middle + axis;
    std::vector<Vec3> x = {from, to, to + flank, from + flank};
    if (dot(cross(x[1] - x[0], x[3] - x[0]), inward) > 0) // outward is away from the body
      std::swap(x[1], x[3]);
    faces.push_back(face(x));
  }
  return faces;
}

struct Total
{
  Vec3 force{};    ///< on the upper body
  Real stored = 0; ///< energy
  int planes = 0;
};

template <int Dim>
Total pushed(const std::vector<FaceNodes>& lower, const std::vector<FaceNodes>& upper,
             const ContactOptions& o = alongCommonNormal, Real dt = 1)
{
  Total total;
  for (const FaceNodes& a : lower)
    for (const FaceNodes& b : upper)
    {
      if (!(dot(stepA_halfStepFace<Dim>(a, 0).normal, stepA_halfStepFace<Dim>(b, 0).normal) <
            -o.cosOpposed))
        continue; // step 5 makes no candidate of it
      PairPlane plane = touchingPlane();
      updatePlane<Dim>(plane, a, b, o, dt);
      total.force += plane.forceOn(1);
      total.stored += plane.stored;
      total.planes += plane.area > 1e-12;
    }
  return total;
}

/// A second method for flat faces, without clipping and without node weights. The shared region is
/// bounded by lines (the edges of both shadows, and the line of zero gap): its vertices are those
/// of their crossings that violate none of them.
Vec3 forceByCrossings(const FaceNodes& a, const FaceNodes& b)
{
  const auto unitNormal = [](const FaceNodes& f)
  { return normalised(cross(f.x[1] - f.x[0], f.x[2] - f.x[0])); };
  const Vec3 nA = unitNormal(a), nB = unitNormal(b);
  const Vec3 n = normalised(nA - nB), e1 = normalised(cross(n, {.3, .5, .81})), e2 = cross(n, e1);
  struct Line
  {
    Real a, b, c; // a u + b v + c >= 0 inside
  };
  std::vector<Line> lines;
  for (const FaceNodes* f : {&a, &b})
  {
    Real u[4], v[4], mu = 0, mv = 0;
    for (int i = 0; i < f->count; ++i)
    {
      mu += (u[i] = dot(e1, f->x[i])) / f->count;
      mv += (v[i] = dot(e2, f->x[i])) / f->count;
    }
    for (int i = 0; i < f->count; ++i)
    {
      const int j = (i + 1) % f->count;
      const Real size = std::hypot(u[j] - u[i], v[j] - v[i]);
      Line line{-(v[j] - v[i]) / size, (u[j] - u[i]) / size, 0};
      line.c = -line.a * u[i] - line.b * v[i];
      if (line.a * mu + line.b * mv + line.c < 0)
        line = {-line.a, -line.b, -line.c};
      lines.push_back(line);
    }
  }
  // Closure along n: height of A minus height of B, each from m . (x - x0) = 0.
  const auto height = [&](const Vec3& m, const Vec3& x0) {
    return Line{-dot(m, e1) / dot(m, n), -dot(m, e2) / dot(m, n), dot(m, x0) / dot(m, n)};
  };
  const Line hA = height(nA, a.x[0]), hB = height(nB, b.x[0]);
  const Line closure{hA.a - hB.a, hA.b - hB.b, hA.c - hB.c};
  lines.push_back(closure);
  std::vector<Vec2> corners;
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = i + 1; j < lines.size(); ++j)
    {
      const Real d = lines[i].a * lines[j].b - lines[j].a * lines[i].b;
      if (std::abs(d) < 1e-12)
        continue;
      const Vec2 p{(lines[i].b * lines[j].c - lines[j].b * lines[i].c) / d,
                   (lines[j].a * lines[i].c - lines[i].a * lines[j].c) / d};
      bool inside = true;
      for (const Line& line : lines)
        inside = inside && line.a * p.x + line.b * p.y + line.c > -1e-14;
      if (inside)
        corners.push_back(p);
    }
  if (corners.size() < 3)
    return {};
  Vec2 middle;
  for (const Vec2& p : corners)
    middle = middle + (1.0 / corners.size()) * p;
  std::sort(corners.begin(), corners.end(),
            [&](const Vec2& p, const Vec2& q)
            {
              return std::atan2(p.y - middle.y, p.x - middle.x) <
                     std::atan2(q.y - middle.y, q.x - middle.x);
            });
  // Integral of the closure, triangle by triangle: exact for a linear function.
  Real force = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    const Vec2 p = corners[i], q = corners[(i + 1) % corners.size()];
    const Vec2 c = (1.0 / 3) * (middle + p + q);
    force += .5 * cross(p - middle, q - middle) * (closure.a * c.x + closure.b * c.y + closure.c);
  }
  return force * n;
}

Vec3 forceByCrossings(const std::vector<FaceNodes>& lower, const std::vector<FaceNodes>& upper)
{
  Vec3 force{};
  for (const FaceNodes& a : lower)
    for (const FaceNodes& b : upper)
      if (dot(stepA_halfStepFace<3>(a, 0).normal, stepA_halfStepFace<3>(b, 0).normal) < -.1)
        force += forceByCrossings(a, b);
  return force;
}

constexpr Real depth = .01;
constexpr Real depth3 = depth * depth * depth;
} // namespace

TEST(CornerOnFace2D, penetratingAreaGivesSquareOfDepthTimesCosDeltaOverCosTheta)
{
  // delta = (90 deg - theta) / 2 tilts the plane. The corner's face is wet along d / cos(theta):
  // its shadow is d cos(delta) / cos(theta). The depth along the normal is d / cos(delta) at the
  // apex, half of it in the mean. Two planes, each at delta from the vertical: d^2 cos(delta) /
  // cos(theta).
  for (const Real angle : {150.0, 120.0, 90.0, 60.0, 30.0})
    for (const Real d : {.01, .02})
    {
      const Real theta = .5 * angle * pi / 180, delta = .5 * (pi / 2 - theta);
      const Total got = pushed<2>({slab2D()}, corner2D(theta, d, 1, {}));
      const Real expected = d * d * std::cos(delta) / std::cos(theta);
      EXPECT_EQ(got.planes, 2);
      EXPECT_NEAR(got.force.y, expected, 1e-11 * expected) << angle;
      EXPECT_NEAR(got.force.x, 0, 1e-13 * expected) << angle;
    }
}

TEST(CornerOnFace2D, fullAreaGivesTwiceLengthTimesDepthTimesCosDeltaCubed)
{
  // To the letter of the paper: area l cos(delta), closure = displacement along the normal =
  // d cos(delta), two forces at delta from the vertical.
  for (const Real angle : {150.0, 120.0, 90.0, 60.0, 30.0})
    for (const Real d : {.01, .02})
    {
      const Real theta = .5 * angle * pi / 180, delta = .5 * (pi / 2 - theta);
      const Total got = pushed<2>({slab2D()}, corner2D(theta, d, 1, {0, -d, 0}), asInThePaper(), 1);
      const Real expected = 2 * d * std::pow(std::cos(delta), 3);
      EXPECT_EQ(got.planes, 2);
      EXPECT_NEAR(got.force.y, expected, 1e-11 * expected) << angle;
      EXPECT_NEAR(got.force.x, 0, 1e-13 * expected) << angle;
    }
}

TEST(CornerOnFace2D, isStifferThanTheClassicCommonPlaneAndTheMoreSoTheSharperTheCorner)
{
  // Classic plane, parallel to the long face: d^2 tan(theta) with the section at half the depth,
  // 2 l d sin(theta) with the shadow of the whole faces. Ratios cos(delta) / sin(theta) and
  // cos(delta)^3 / sin(theta).
  struct Row
  {
    Real angle, penetrating, full;
  };
  for (const Row& row :
       {Row{150, 1.026419, 1.008932}, Row{120, 1.115355, 1.040640}, Row{90, 1.306563, 1.115221},
        Row{60, 1.732051, 1.299038}, Row{30, 3.065282, 1.929318}})
  {
    const Real theta = .5 * row.angle * pi / 180;
    const Real penetrating = pushed<2>({slab2D()}, corner2D(theta, .01, 1, {})).force.y;
    const Real full =
        pushed<2>({slab2D()}, corner2D(theta, .01, 1, {0, -.01, 0}), asInThePaper(), 1).force.y;
    EXPECT_NEAR(penetrating / (1e-4 * std::tan(theta)), row.penetrating, 5.1e-7) << row.angle;
    EXPECT_NEAR(full / (.02 * std::sin(theta)), row.full, 5.1e-7) << row.angle;
  }
}

TEST(CornerOnFace2D, resultantFollowsTheFaceWhenAllIsTurned)
{
  const Mat3 r = rotation({0, 0, 1}, .7);
  std::vector<FaceNodes> corner = corner2D(pi / 4, .01, 1, {});
  for (FaceNodes& f : corner)
    f = moved(f, r, {3, -2, 0});
  const Total got = pushed<2>({moved(slab2D(), r, {3, -2, 0})}, corner);
  const Vec3 up = r * Vec3{0, 1, 0};
  EXPECT_LT(norm(got.force - dot(got.force, up) * up), 1e-12 * norm(got.force));
  EXPECT_NEAR(norm(got.force), 1e-4 * 1.306562964876, 1e-14);
}

TEST(CornerOnFace3D, cubeCornerOnAPlane)
{
  // The faces' normals are at acos(1/sqrt 3) from the plane's, delta is half of that. Wet triangle
  // (d sqrt 3)^2 / 2, shadow 1.5 d^2 cos(delta), mean depth d / (3 cos(delta)), three planes at
  // delta from the vertical: 1.5 cos(delta) d^3.
  const Total got = pushed<3>({slab3D()}, cubeCorner({0, 0, -depth}, .2, 1));
  const Real expected = 1.5 * std::cos(.5 * std::acos(1 / std::sqrt(3.0)));
  EXPECT_NEAR(expected, 1.3321107510, 1e-10);
  EXPECT_EQ(got.planes, 3);
  EXPECT_NEAR(got.force.z / depth3, expected, 1e-9);
  EXPECT_LT(std::hypot(got.force.x, got.force.y), 1e-12 * got.force.z);
}

TEST(CornerOnFace3D, edgesCrossedAtRightAngles)
{
  // Upper edge along y at z = -d, lower along x at z = 0, both wedges of 90 deg. n = (-1, 1, 2) /
  // sqrt 6 for one of the four pairs; the wet shadow is a triangle of 2.25 d^2 / sqrt 6, the depth
  // sqrt 6 d / 2 at one of its vertices and zero at the others: 4 * .375 d^3 * 2 / sqrt 6 = sqrt 6
  // / 2 d^3.
  const Total got = pushed<3>(wedge({0, 0, 0}, {1, 0, 0}, {0, 0, -1}),
                              wedge({0, 0, -depth}, {0, 1, 0}, {0, 0, 1}));
  EXPECT_EQ(got.planes, 4);
  EXPECT_NEAR(got.force.z / depth3, std::sqrt(6.0) / 2, 1e-9);
  EXPECT_LT(std::hypot(got.force.x, got.force.y), 1e-12 * got.force.z);
}

TEST(CornerOnFace3D, edgeOnAPlaneIsTheExtrudedCorner)
{
  // Two planes; cos(22.5 deg) / cos(45 deg) = 1.306562965 d^2 for each metre of the edge, here 2 m.
  const Total got = pushed<3>({slab3D()}, wedge({0, 0, -depth}, {1, 0, 0}, {0, 0, 1}));
  EXPECT_EQ(got.planes, 2);
  EXPECT_NEAR(got.force.z / (2 * depth * depth), std::cos(pi / 8) / std::cos(pi / 4), 1e-11);
}

TEST(CornerOnFace3D, cubeCornersTipToTipTurnedBy60DegreesMeetFaceToFace)
{
  // The upper corner is the lower one reflected in the apex: three pairs of parallel faces at a
  // distance d / sqrt 3, shared squares of d^2 / 3, at acos(1 / sqrt 3) from the vertical: d^3 / 3.
  const Total got =
      pushed<3>(cubeCorner({0, 0, 0}, .2, -1), cubeCorner({0, 0, -depth}, .2 + pi / 3, 1));
  EXPECT_EQ(got.planes, 3);
  EXPECT_NEAR(got.force.z / depth3, 1.0 / 3, 1e-9);
  EXPECT_LT(std::hypot(got.force.x, got.force.y), 1e-12 * got.force.z);
}

TEST(CornerOnFace3D, cubeCornersTipToTipMirroredMeetInSixPlanes)
{
  const auto lower = cubeCorner({0, 0, 0}, .2, -1), upper = cubeCorner({0, 0, -depth}, .2, 1);
  const Total got = pushed<3>(lower, upper);
  EXPECT_EQ(got.planes, 6);
  EXPECT_NEAR(got.force.z / depth3, .6161878772, 1e-9);
  EXPECT_NEAR(got.force.z / depth3, forceByCrossings(lower, upper).z / depth3, 1e-9);
  EXPECT_LT(std::hypot(got.force.x, got.force.y), 1e-12 * got.force.z);
}

TEST(CornerOnFace3D, cubeCornersThatMissEachOtherALittleAgreeWithASecondMethod)
{
  for (const Real turn : {0.0, pi / 3, .4})
    for (const Real offset : {.001, .003, -.001, -.003})
    {
      const auto lower = cubeCorner({0, 0, 0}, 0, -1),
                 upper = cubeCorner({offset, 0, -depth}, turn, 1);
      const Vec3 got = pushed<3>(lower, upper).force, expected = forceByCrossings(lower, upper);
      EXPECT_LT(norm(got - expected) / depth3, 1e-9) << turn << ' ' << offset;
    }
}

TEST(CornerOnFace3D, mirroredCubeCornersThatMissEachOtherPushAside)
{
  // Numbers of the second method, which the test above holds against the kernel.
  for (const auto& [offset, x, z] :
       {std::tuple{.001, -.0098932387, .6008442894}, std::tuple{.003, -.0206422939, .4853574311}})
  {
    const Total got =
        pushed<3>(cubeCorner({0, 0, 0}, 0, -1), cubeCorner({offset, 0, -depth}, 0, 1));
    EXPECT_NEAR(got.force.x / depth3, x, 1e-9);
    EXPECT_NEAR(got.force.y / depth3, 0, 1e-12);
    EXPECT_NEAR(got.force.z / depth3, z, 1e-9);
  }
}

TEST(CornerOnFace3D, randomCornersAgreeWithASecondMethod)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<Real> u(-1, 1);
  int planes = 0;
  for (int n = 0; n < 300; ++n)
  {
    const auto lower = cubeCorner({0, 0, 0}, pi * u(random), -1);
    auto upper = cubeCorner({.003 * u(random), .003 * u(random), -depth}, pi * u(random), 1);
    const Mat3 tilt = rotation({u(random), u(random), 0}, .3);
    for (FaceNodes& f : upper)
      f = moved(f, tilt);
    const Total got = pushed<3>(lower, upper);
    planes += got.planes;
    EXPECT_LT(norm(got.force - forceByCrossings(lower, upper)) / depth3, 1e-9);
  }
  EXPECT_GT(planes, 600);
}

TEST(EdgeOnFace, forceGrowsWithTheSquareOfTheDepthWithoutJumps)
{
  // A unit square tilted by 5 degrees goes down edge first, 1 mm in 1000 steps. Only its lower face
  // meets the plane: half of the corner's formula with theta = 85 deg.
  const Mat3 tilt = rotation({0, 1, 0}, 5 * pi / 180);
  const FaceNodes square = face({{0, -.5, 0}, {0, .5, 0}, {1, .5, 0}, {1, -.5, 0}});
  const Real last = 1e-3;
  Real before = 0, largestJump = 0;
  for (int step = 1; step <= 1000; ++step)
  {
    const Real d = last * step / 1000;
    // tilted so that the edge at x = 1 is the lowest
    const FaceNodes upper = moved(square, tilt, {0, 0, std::sin(5 * pi / 180) - d});
    const Real force = pushed<3>({slab3D()}, {upper}).force.z;
    const Real expected = d * d * std::cos(2.5 * pi / 180) * std::cos(2.5 * pi / 180) /
                          (2 * std::cos(2.5 * pi / 180) * std::sin(5 * pi / 180));
    ASSERT_NEAR(force, expected, 1e-9 * last * last) << step;
    ASSERT_GT(force, before);
    largestJump = std::max(largestJump, force - before);
    before = force;
  }
  EXPECT_LT(largestJump, 2 * before / 1000)
      << "F ~ d^2: the last increment is just below twice the mean";
}

namespace
{
const ContactOptions potential;

std::vector<FaceNodes> shifted(std::vector<FaceNodes> faces, const Vec3& shift)
{
  for (FaceNodes& face : faces)
    face = moved(face, rotation({0, 0, 1}, 0), shift);
  return faces;
}
} // namespace

TEST(CornerOfThePotential, wedgeOnAPlane)
{
  // The wet length d / cos(theta) lies at delta from the plane: closure from 0 to 2 sin(delta) of
  // it over its shadow, cos(delta) of it. Two faces: E = C d^3, C = 4/3 sin^2(delta) cos(delta) /
  // cos^3(theta).
  for (const auto& [angle, known] :
       {std::tuple{120, .69018412}, std::tuple{90, .51024458}, std::tuple{60, .44444444}})
  {
    const Real theta = .5 * angle * pi / 180, delta = .5 * (pi / 2 - theta);
    const Real c =
        4. / 3 * std::pow(std::sin(delta), 2) * std::cos(delta) / std::pow(std::cos(theta), 3);
    EXPECT_NEAR(c, known, 5e-9);
    const Total flat = pushed<2>({slab2D()}, corner2D(theta, depth, 1, {}), potential);
    EXPECT_NEAR(flat.stored / depth3, c, 1e-10) << angle;
    EXPECT_NEAR(flat.force.y / (depth * depth), 3 * c, 1e-10) << angle;
    EXPECT_NEAR(flat.force.x / (depth * depth), 0, 1e-12) << angle;
  }
  const Total solid = pushed<3>({slab3D()}, wedge({0, 0, -depth}, {1, 0, 0}, {0, 0, 1}), potential);
  EXPECT_NEAR(solid.stored / (2 * depth3), .51024458, 5e-9); // 2 m of it
  EXPECT_NEAR(solid.force.z / (2 * depth * depth), 3 * .51024458, 2e-8);
}

TEST(CornerOfThePotential, sharpWedgesFadeWithTheirOpposition)
{
  // The faces of a wedge oppose the plane by the sine of half its angle. Fully from three times
  // cos_opposed on, a smooth step of the third degree below.
  ContactOptions blunt;
  blunt.cosOpposed = .1;
  for (const auto& [angle, share] :
       {std::tuple{36., 1.}, std::tuple{30., .8903}, std::tuple{20., .3066}, std::tuple{11.4, 0.}})
  {
    const auto energy = [theta = .5 * angle * pi / 180](const ContactOptions& o)
    { return pushed<2>({slab2D()}, corner2D(theta, depth, 1, {}), o).stored; };
    EXPECT_GT(energy(potential), 0) << angle;
    EXPECT_NEAR(energy(blunt) / energy(potential), share, 1e-3) << angle;
  }
}

TEST(CornerOfThePotential, cubeCornerOnAPlane)
{
  // The normals of its three faces are at 2 delta = acos(1 / sqrt 3) from the plane's. Wet triangle
  // of 1.5 d^2, closure from 0 at its longest side to sqrt 6 d sin(delta) at the tip: the mean
  // square is a sixth of the largest one. E = 9/4 sin^2(delta) cos(delta) d^4.
  const Total got = pushed<3>({slab3D()}, cubeCorner({0, 0, -depth}, .2, 1), potential);
  const Real delta = .5 * std::acos(1 / std::sqrt(3.0));
  const Real c = 9. / 4 * std::pow(std::sin(delta), 2) * std::cos(delta);
  EXPECT_NEAR(c, .4222621877, 5e-11);
  EXPECT_EQ(got.planes, 3);
  EXPECT_NEAR(got.stored / (depth3 * depth), c, 1e-9);
  EXPECT_NEAR(got.force.z / depth3, 4 * c, 1e-8);
  EXPECT_LT(std::hypot(got.force.x, got.force.y), 1e-12 * got.force.z);
}

TEST(CornerOfThePotential, edgesCrossedAtRightAngles)
{
  // Four triangles of 2.25 d^2 / sqrt 6 with the closure sqrt 6 d / 2 at one vertex and zero at the
  // others: E = 9 / (8 sqrt 6) d^4.
  const Total got = pushed<3>(wedge({0, 0, 0}, {1, 0, 0}, {0, 0, -1}),
                              wedge({0, 0, -depth}, {0, 1, 0}, {0, 0, 1}), potential);
  const Real c = 9 / (8 * std::sqrt(6.0));
  EXPECT_EQ(got.planes, 4);
  EXPECT_NEAR(got.stored / (depth3 * depth), c, 1e-9);
  EXPECT_NEAR(got.force.z / depth3, 4 * c, 1e-8);
  EXPECT_LT(std::hypot(got.force.x, got.force.y), 1e-12 * got.force.z);
}

TEST(CornerOfThePotential, vertexOnVertexTurnedBy60DegreesIsFaceToFace)
{
  // Three pairs of parallel faces at a distance d / sqrt 3 with shared squares of d^2 / 3: E = d^4
  // /
  // 6. Their borders add to the force: 4 E / d, twice that of the faces alone.
  const Total got = pushed<3>(cubeCorner({0, 0, 0}, .2, -1),
                              cubeCorner({0, 0, -depth}, .2 + pi / 3, 1), potential);
  EXPECT_EQ(got.planes, 3);
  EXPECT_NEAR(got.stored / (depth3 * depth), 1. / 6, 1e-9);
  EXPECT_NEAR(got.force.z / depth3, 4. / 6, 1e-8);
  EXPECT_LT(std::hypot(got.force.x, got.force.y), 1e-12 * got.force.z);
}

TEST(CornerOfThePotential, vertexOnVertexIsTheGradientOfItsEnergyHoweverTheyMiss)
{
  // Cube corners that stand on each other, with or without an offset: no length but the depth, so
  // the energy is of the fourth degree in it; the force is minus its change when the upper body is
  // moved as it is.
  const auto lower = cubeCorner({0, 0, 0}, 0, -1);
  for (const Real turn : {0.0, .4, pi / 3})
    for (const Vec3& miss : {Vec3{}, Vec3{.17, .08, 0}, Vec3{.2, -.3, 0}, Vec3{-.25, .05, 0}})
    {
      SCOPED_TRACE(::testing::Message() << turn << ", " << miss.x << ", " << miss.y);
      const auto at = [&](const Vec3& place) {
        return pushed<3>(lower, shifted(cubeCorner({0, 0, 0}, turn, 1), place), potential);
      };
      const Vec3 place = .1 * (miss - Vec3{0, 0, 1});
      const Total got = at(place);
      EXPECT_GT(got.force.z, 0);
      EXPECT_NEAR(at(.5 * place).stored, got.stored / 16, 1e-9 * got.stored);
      // Edges within 0.0002 of a face of each other share what they have, which is no gradient: of
      // sides so short, k c^2 / 2 on each length. Corners that are mirror images have all of them.
      if (turn == 0 && norm(miss) == 0)
        continue;
      const Real shared = 2e-4 * .5 * dot(place, place);
      for (int c = 0; c < 3; ++c)
      {
        const Real h = 1e-6;
        Vec3 step{};
        step[c] = h;
        const Real slope = (8 * (at(place + step).stored - at(place - step).stored) -
                            (at(place + 2 * step).stored - at(place - 2 * step).stored)) /
                           (12 * h);
        EXPECT_NEAR(got.force[c], -slope, shared) << c;
      }
    }
}
