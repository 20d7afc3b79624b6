#include "Laws.hpp"
#include "Paths.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Rotate.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/Principal.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

// That lanes have the bits of scalars, that a turned body with turned planes has turned stresses,
// and that nothing is gained, is tested with all laws (LawPropertiesTest.cpp).

using namespace coplane;
using namespace coplane::testing;

namespace
{
constexpr Real degreeOfDip = pi / 180;
const LinearElastic rock = makeLinearElastic(20e9, 0.25, 2500);

/// @param planes cohesion, friction, dilation, tensile strength
UbiquitousJointParameters withPlanes(const MohrCoulombParameters& matrix, const Vec3& normal,
                                     const std::array<Real, 4>& planes)
{
  UbiquitousJointParameters p;
  static_cast<MohrCoulombParameters&>(p) = matrix;
  p.jointNormal = normal;
  p.jointCohesion = planes[0];
  p.jointFriction = planes[1];
  p.jointDilation = planes[2];
  p.jointTensileStrength = planes[3];
  return p;
}

Vec3 tractionOn(const SymTensor& s, const Vec3& n)
{
  return {s.xx * n.x + s.xy * n.y + s.zx * n.z, s.xy * n.x + s.yy * n.y + s.yz * n.z,
          s.zx * n.x + s.yz * n.y + s.zz * n.z};
}

/// How far a stress lies beyond the strength of the planes [Pa].
Real overPlanes(const UbiquitousJoints& law, const SymTensor& s, const Vec3& n)
{
  const Vec3 t = tractionOn(s, n);
  const Real normal = dot(t, n), shear = norm(t - normal * n);
  return std::max(shear + normal * law.friction - law.cohesion, normal - law.tensileStrength);
}
/// The same of the matrix.
Real overMatrix(const MohrCoulomb& law, const SymTensor& stress)
{
  const auto principal = principalOf(stress);
  const Real* const s = principal.value;
  return std::max(law.friction * s[0] - s[2] - 2 * std::sqrt(law.friction) * law.cohesion,
                  s[0] - law.tensileStrength);
}

MaterialPoint<Real> startOf(const UbiquitousJoints& law, const SymTensor& stress = {})
{
  MaterialPoint<Real> point;
  std::fill(std::begin(point.history), std::end(point.history), 0.0);
  law.startFrom(stress, point.history);
  point.stress = stress;
  return point;
}
/// After a strain increment without any turning, of body or planes.
MaterialPoint<Real> strained(const UbiquitousJoints& law, MaterialPoint<Real> point,
                             const SymTensor& strain)
{
  point.strainIncrement = strain;
  point.dissipation = 0;
  law(point);
  return point;
}

/// A random strain: some with much compression or extension.
SymTensor randomStrain(std::mt19937& random, Real size)
{
  std::uniform_real_distribution<Real> uniform(-size, size);
  const Real volume = uniform(random);
  return {uniform(random) + volume, uniform(random) + volume, uniform(random) + volume,
          uniform(random),          uniform(random),          uniform(random)};
}
Vec3 randomNormal(std::mt19937& random)
{
  std::normal_distribution<Real> normal;
  return {normal(random), normal(random), normal(random)};
}

/// Strong matrix, planes across y that dilate; K + 4G/3 = 24 GPa, G = 8 GPa.
UbiquitousJoints acrossY()
{
  return makeLaw(
      withPlanes(rockOf(0.6, 0.2, 100e6, 100e6, 100e6), Vec3{0, 2, 0}, {1e6, 0.5, 0.25, 0.5e6}));
}
} // namespace

TEST(UbiquitousJoints, haveJaegersStrengthOverTheDip)
{
  // sigma1 - sigma3 = 2 (c + sigma3 tan phi) / ((1 - tan phi cot dip) sin 2 dip), or the matrix's.
  const Real c = 1e6, friction = std::tan(25 * degreeOfDip);
  int sliding = 0, crushed = 0;
  for (const Real lateral : {2e6, 10e6})
    for (int dip = 0; dip <= 90; dip += 5)
    {
      const Real b = dip * degreeOfDip;
      const UbiquitousJoints law =
          makeLaw(withPlanes(rockOf(35 * degreeOfDip, 10 * degreeOfDip, 5e6, 5e6, 2e6),
                             Vec3{std::cos(b), std::sin(b), 0}, {c, friction, 0.1, 0.5e6}));
      const Real ofMatrix =
          2 * 5e6 * std::sqrt(law.matrix.friction) + (law.matrix.friction - 1) * lateral;
      const auto strengthAt = [&](Real at)
      {
        const Real grip = 1 - friction / std::tan(at), s = std::sin(2 * at);
        const Real ofPlanes =
            grip > 0 && s > 1e-12 ? 2 * (c + lateral * friction) / (grip * s) : infinity;
        return std::min(ofPlanes, ofMatrix);
      };
      // The planes turn with the shortening of the body, at first yield by less than a tenth of a
      // degreeOfDip: that is up to a per cent of the strength near the steepest part of its curve.
      const auto dipOf = [](const MaterialProbe& probe)
      {
        return std::atan2(
            std::hypot(probe.history("plane_normal_y"), probe.history("plane_normal_z")),
            probe.history("plane_normal_x"));
      };
      MaterialProbe probe(law, 0.1, {-lateral, -lateral, -lateral, 0, 0, 0});
      ProbeStep step;
      step.stressGiven = {false, true, true, true, true, true};
      step.value = {-5e-5, -lateral, -lateral, 0, 0, 0};
      Real first = 0, most = 0;
      for (int i = 0; i < 80; ++i)
      {
        probe.advance(step);
        const Real load = -probe.stress().xx - lateral;
        most = std::max(most, load / strengthAt(dipOf(probe)));
        if (first == 0 && probe.history("plane_slip") + probe.history("plastic_shear") > 0)
          first = load;
      }
      EXPECT_NEAR(most, 1, 1e-9) << dip << " under " << lateral;
      EXPECT_NEAR(first / strengthAt(b), 1, 1e-2) << dip << " under " << lateral;
      // The probe keeps the stresses that are given to 1e-9 of all stress, here some times that.
      const Real last = -probe.stress().xx - lateral;
      EXPECT_NEAR(last / strengthAt(dipOf(probe)), 1, 1e-8) << dip << " under " << lateral;
      ++(probe.history("plane_slip") > 0 ? sliding : crushed);
    }
  EXPECT_GE(sliding, 20);
  EXPECT_GE(crushed, 12);
}

TEST(UbiquitousJoints, slipAndDilationHaveTheClosedForm)
{
  // Shear g = 1e-3 under -2 MPa: 8 MPa at first, 2 MPa are borne; slip (8 - 2) / (8 + 3) e-3.
  const UbiquitousJoints law = acrossY();
  const auto start = startOf(law, {-2e6, -2e6, -2e6, 0, 0, 0});
  const auto point = strained(law, start, {0, 0, 0, 0.5e-3, 0, 0});
  const Real slip = 6e6 / 11e9;
  EXPECT_NEAR(point.history[UbiquitousJoints::Slip], slip, 1e-12 * slip);
  EXPECT_NEAR(point.history[UbiquitousJoints::Opening], 0.25 * slip, 1e-12 * slip);
  EXPECT_NEAR(point.stress.xy, 8e6 - 8e9 * slip, 1e-3);
  EXPECT_NEAR(point.stress.yy, -2e6 - 24e9 * 0.25 * slip, 1e-3);
  EXPECT_NEAR(point.stress.xx, -2e6 - 8e9 * 0.25 * slip, 1e-3); // lambda = G
  EXPECT_NEAR(point.stress.zz, -2e6 - 8e9 * 0.25 * slip, 1e-3);
  EXPECT_NEAR(point.stress.xy, 1e6 - 0.5 * point.stress.yy, 1e-3);
  EXPECT_NEAR(point.dissipation, slip * (point.stress.xy + 0.25 * point.stress.yy), 1e-6);
  EXPECT_EQ(point.history[0] + point.history[1] + point.history[2], 0);
  // Back by the same shear: elastic until the other sign slips.
  const auto back = strained(law, point, {0, 0, 0, -0.25e-3, 0, 0});
  EXPECT_NEAR(back.stress.xy, point.stress.xy - 4e6, 1e-3);
  EXPECT_EQ(back.dissipation, 0);
}

TEST(UbiquitousJoints, openingAndTheCornerHaveTheClosedForm)
{
  const UbiquitousJoints law = acrossY();
  // 1e-4 across the planes: 2.4 MPa, 0.5 are borne; the others keep what is along the planes.
  const auto open = strained(law, startOf(law), {0, 1e-4, 0, 0, 0, 0});
  EXPECT_NEAR(open.stress.yy, 0.5e6, 1e-6);
  EXPECT_NEAR(open.stress.xx, 0.8e6 - 8e9 * 1.9e6 / 24e9, 1e-6);
  EXPECT_NEAR(open.history[UbiquitousJoints::Opening], 1.9e6 / 24e9, 1e-16);
  EXPECT_EQ(open.history[UbiquitousJoints::Slip], 0);
  EXPECT_NEAR(open.dissipation, 0.5e6 * 1.9e6 / 24e9, 1e-9);
  // With shear of 1.55 MPa: down to c - st tan(phi) = 0.75 MPa.
  const auto corner = strained(law, startOf(law), {0, 1e-4, 0, 1.55e6 / 16e9, 0, 0});
  EXPECT_NEAR(corner.stress.yy, 0.5e6, 1e-6);
  EXPECT_NEAR(corner.stress.xy, 0.75e6, 1e-6);
  EXPECT_NEAR(corner.history[UbiquitousJoints::Slip], 1e-4, 1e-15);
  EXPECT_NEAR(corner.history[UbiquitousJoints::Opening], 1.9e6 / 24e9, 1e-16);
}

TEST(UbiquitousJoints, bothCriteriaHoldOnRandomPaths)
{
  // Steps from a hundredth of the elastic range to far beyond it; matrix and planes, the first
  // with associated flow, the last two with cohesionless planes and with a sharp tip.
  const MohrCoulombParameters rocks[] = {rockOf(35 * degreeOfDip, 35 * degreeOfDip, 5e6, 5e6, 2e6),
                                         rockOf(35 * degreeOfDip, 10 * degreeOfDip, 5e6, 5e6, 2e6),
                                         rockOf(0, 0, 5e6, 5e6, 20e6),
                                         rockOf(45 * degreeOfDip, 0, 5e6, 5e6, 0),
                                         rockOf(35 * degreeOfDip, 10 * degreeOfDip, 5e6, 5e6, 2e6)};
  const std::array<Real, 4> planes[] = {{1e6, 0.5, 0.5, 0.5e6},
                                        {1e6, 0.5, 0.2, 0.5e6},
                                        {1e6, 0, 0, 20e6},
                                        {0, 0.6, 0, 0},
                                        {1e6, 0.5, 0.2, 2e6}};
  std::mt19937 random(11);
  std::uniform_real_distribution<Real> uniform(0, 1);
  int both = 0, onlyPlanes = 0, onlyMatrix = 0;
  Real worstMatrix = 0, worstPlanes = 0;
  for (int path = 0; path < 10000; ++path)
  {
    const int k = path % 5;
    const UbiquitousJoints law = makeLaw(withPlanes(rocks[k], randomNormal(random), planes[k]));
    const Real p = 20e6 * uniform(random), size = 1e-5 * std::pow(10, 2.5 * uniform(random));
    auto point = startOf(law, {-p, -p, -p, 0, 0, 0});
    for (int i = 0; i < 8; ++i)
    {
      const auto before = point;
      point = strained(law, point, randomStrain(random, size));
      worstMatrix = std::max(worstMatrix, overMatrix(law.matrix, point.stress));
      worstPlanes = std::max(worstPlanes, overPlanes(law, point.stress, law.normal));
      EXPECT_GE(point.dissipation, -1e-9);
      const bool flows =
          point.history[0] > before.history[0] || point.history[2] > before.history[2];
      const bool slips =
          point.history[UbiquitousJoints::Slip] > before.history[UbiquitousJoints::Slip] ||
          point.history[UbiquitousJoints::Opening] > before.history[UbiquitousJoints::Opening];
      both += flows && slips;
      onlyPlanes += slips && !flows;
      onlyMatrix += flows && !slips;
    }
  }
  EXPECT_LT(worstMatrix, 1e-9 * 5e6);
  EXPECT_LT(worstPlanes, 1e-9 * 1e6);
  EXPECT_GT(both, 10000);
  EXPECT_GT(onlyPlanes, 5000);
  EXPECT_GT(onlyMatrix, 1000);
  RecordProperty("worstMatrix", std::to_string(worstMatrix));
  RecordProperty("worstPlanes", std::to_string(worstPlanes));
}

TEST(UbiquitousJoints, associatedFlowGivesTheNearestStress)
{
  // Where matrix and planes both flow along their normals, the end is the stress that both bear
  // that is nearest to the trial stress, by elastic energy: (trial - end) : C^-1 : (other - end) is
  // not positive for any other stress that both bear. So no order of the two is left in it.
  std::mt19937 random(12);
  int both = 0;
  for (int trial = 0; trial < 300; ++trial)
  {
    const UbiquitousJoints law =
        makeLaw(withPlanes(rockOf(35 * degreeOfDip, 35 * degreeOfDip, 5e6, 5e6, 2e6),
                           randomNormal(random), {1e6, 0.5, 0.5, 0.5e6}));
    const SymTensor strain = randomStrain(random, 4e-4);
    const auto end = strained(law, startOf(law), strain);
    both += end.history[0] > 0 && end.history[UbiquitousJoints::Slip] > 0;
    SymTensor elastic;
    rock.addElasticIncrement(strain, elastic);
    const SymTensor back = sumOf(elastic, -1.0, end.stress);
    const auto energy = [](const SymTensor& a, const SymTensor& b)
    {
      return contract(deviatorOf(a), deviatorOf(b)) / (2 * rock.shearModulus) +
             meanOf(a) * meanOf(b) / rock.bulkModulus;
    };
    for (int k = 0; k < 50; ++k)
    {
      const auto other = strained(law, startOf(law), randomStrain(random, 4e-4)).stress;
      const SymTensor way = sumOf(other, -1.0, end.stress);
      EXPECT_LE(energy(back, way), 1e-8 * std::sqrt(energy(back, back) * energy(way, way)) + 1e-6);
    }
  }
  EXPECT_GT(both, 80);
}

TEST(UbiquitousJoints, matrixAndPlanesFlowAtTheEndOfTheStep)
{
  // What slip along the shear traction at the end and the opening take away, taken from the trial
  // stress, is what the matrix alone returns to the same end; and the opening is that of the
  // dilation unless the cut-off is reached. Without associated flow.
  std::mt19937 random(14);
  int both = 0, corners = 0;
  for (int trial = 0; trial < 2000; ++trial)
  {
    const UbiquitousJoints law =
        makeLaw(withPlanes(rockOf(35 * degreeOfDip, 10 * degreeOfDip, 5e6, 5e6, 2e6),
                           randomNormal(random), {1e6, 0.5, 0.2, 0.5e6}));
    const Vec3 n = law.normal;
    const SymTensor strain = randomStrain(random, 3e-4);
    const auto end = strained(law, startOf(law), strain);
    const Real slip = end.history[UbiquitousJoints::Slip],
               opening = end.history[UbiquitousJoints::Opening];
    if (!(end.history[0] + end.history[2] > 0 && slip > 0))
      continue;
    const Vec3 t = tractionOn(end.stress, n);
    const Vec3 shear = t - dot(t, n) * n, g = (slip / norm(shear)) * shear;
    SymTensor left;
    const auto e = [&](int i, int j)
    { return opening * n[i] * n[j] + 0.5 * (g[i] * n[j] + n[i] * g[j]); };
    rock.addElasticIncrement(strain, left);
    rock.addElasticIncrement({-e(0, 0), -e(1, 1), -e(2, 2), -e(0, 1), -e(1, 2), -e(2, 0)}, left);
    MaterialPoint<Real> matrix;
    std::fill(std::begin(matrix.history), std::end(matrix.history), 0.0);
    matrix.stress = left;
    law.matrix(matrix);
    const SymTensor apart = sumOf(matrix.stress, -1.0, end.stress);
    EXPECT_LT(std::sqrt(contract(apart, apart)), 1e-9 * 7e6) << trial;
    EXPECT_NEAR(norm(shear) + 0.5 * dot(t, n), 1e6, 1e-3);
    const bool corner = dot(t, n) > 0.5e6 - 1e-3;
    if (!corner)
      EXPECT_NEAR(opening, 0.2 * slip, 1e-12);
    else
      EXPECT_GE(opening, 0.2 * slip - 1e-12);
    ++both;
    corners += corner;
  }
  EXPECT_GT(both, 500);
  EXPECT_GT(corners, 30);
}

TEST(UbiquitousJoints, strongPlanesLeaveTheMatrixAsItIs)
{
  UbiquitousJointParameters p = jointedRock();
  static_cast<MohrCoulombParameters&>(p) = rockOf(0.6, 0.2, 5e6, 1e6, 2e6, 500, 100);
  p.jointCohesion = p.jointTensileStrength = 1e12;
  MaterialProbe jointed(makeLaw(p), 0.1),
      plain(makeLaw(static_cast<const MohrCoulombParameters&>(p)), 0.1);
  std::mt19937 random(13);
  std::uniform_real_distribution<Real> uniform(-3e-4, 3e-4);
  for (int i = 0; i < 100; ++i)
  {
    Mat3 l;
    for (auto& row : l.a)
      for (Real& v : row)
        v = uniform(random);
    jointed.advance(l, 1e-6);
    plain.advance(l, 1e-6);
    EXPECT_EQ(jointed.stress().xx, plain.stress().xx);
    EXPECT_EQ(jointed.stress().yz, plain.stress().yz);
    EXPECT_EQ(jointed.dissipation(), plain.dissipation());
  }
  EXPECT_GT(plain.dissipation(), 0);
  EXPECT_EQ(jointed.history("plastic_shear"), plain.history("plastic_shear"));
}

TEST(UbiquitousJoints, planesAreASurfaceOfTheMaterial)
{
  const Vec3 n = normalised({1, 2, -2});
  UbiquitousJointParameters p = jointedRock();
  p.jointNormal = n;
  const auto normalAfter = [&](const Mat3& l, int steps)
  {
    MaterialProbe probe(makeLaw(p), 0.1);
    for (int i = 0; i < steps; ++i)
      probe.advance(l, 1e-6);
    return Vec3{probe.history("plane_normal_x"), probe.history("plane_normal_y"),
                probe.history("plane_normal_z")};
  };
  // Turned about z: 100 steps of Cayley's rotation by 2 atan(0.005).
  const Real angle = 200 * std::atan(0.005), c = std::cos(angle), s = std::sin(angle);
  const Vec3 turned = normalAfter(Mat3{{{0, -0.01, 0}, {0.01, 0, 0}, {0, 0, 0}}}, 100);
  EXPECT_LT(norm(turned - Vec3{c * n.x - s * n.y, s * n.x + c * n.y, n.z}), 1e-13);
  // Slip along the planes, twice their distance, leaves them where they are.
  const Vec3 m = normalised({2, -1, 0});
  Mat3 slip;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      slip(i, j) = 0.02 * m[i] * n[j];
  EXPECT_LT(norm(normalAfter(slip, 100) - n), 1e-13);
  // Shortened along x to half: x of a normal doubles against the others.
  const Real l = 2 * (std::pow(0.5, 0.01) - 1) / (std::pow(0.5, 0.01) + 1);
  const Vec3 shortened = normalAfter(Mat3{{{l, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, 100);
  EXPECT_LT(norm(shortened - normalised({2, 2, -2})), 1e-13);
}

TEST(UbiquitousJoints, badParametersAreRefused)
{
  const auto refused = [](auto change)
  {
    UbiquitousJointParameters p = jointedRock();
    change(p);
    EXPECT_THROW(makeLaw(p), Error);
  };
  EXPECT_NO_THROW(makeLaw(jointedRock()));
  refused([](auto& p) { p.jointNormal = {0, 0, 0}; });
  refused([](auto& p) { p.jointNormal.x = infinity; });
  refused([](auto& p) { p.jointCohesion = -1; });
  refused([](auto& p) { p.jointCohesion = p.jointFriction = p.jointDilation = 0; });
  refused([](auto& p) { p.jointFriction = -0.1; });
  refused([](auto& p) { p.jointDilation = 0.6; }); // beyond the friction
  refused([](auto& p) { p.jointDilation = -0.1; });
  refused([](auto& p) { p.jointTensileStrength = 2.1e6; }); // beyond the tip
  refused([](auto& p) { p.jointTensileStrength = -1; });
  refused([](auto& p) { p.cohesion = 0; });
  const UbiquitousJoints law = makeLaw(jointedRock());
  EXPECT_NEAR(norm(law.normal), 1, 1e-15);
}
