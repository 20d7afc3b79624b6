#include "TestMeshes.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>

using namespace coplane;
using namespace coplane::testMeshes;

namespace
{
const Material blockSteel = makeLinearElastic(200e9, 0.3, 7850);

/// Velocities without any structure: every strain and hourglass mode at once.
NodeVectors wild(const TestMesh& mesh, Real size)
{
  std::mt19937 random(9);
  std::uniform_real_distribution<Real> number(-size, size);
  return field(
      mesh.x,
      [&](const Vec3&) {
        return Vec3{number(random), number(random), isFlat(mesh.type) ? 0 : number(random)};
      });
}
} // namespace

TEST(ElementBlock, forcesOfAnElementHaveNoResultantAndNoMoment)
{
  for (const ElementType type : allTypes)
  {
    const TestMesh mesh = distorted(type, 3, 0.2);
    ElementBlock block(type, blockSteel, {0.1, 0.1}, {}, mesh.connectivity);
    block.initialise(mesh.x);
    const Real dt = 1e-5;
    const NodeVectors v = wild(mesh, 500);
    const NodeVectors x = plus(mesh.x, dt, v);
    block.update(x, v, dt);
    for (int e = 0; e < block.count(); ++e)
    {
      Vec3 force{}, moment{};
      Real size = 0;
      for (int c = 0; c < mesh.corners(); ++c)
      {
        const Vec3 f{block.cornerForce()(e, c, 0), block.cornerForce()(e, c, 1),
                     block.cornerForce()(e, c, 2)};
        force += f;
        moment += cross(at(x, block.connectivity()(e, c)), f);
        size += norm(f);
      }
      EXPECT_LT(norm(force), 1e-14 * size);
      EXPECT_LT(norm(moment), 1e-14 * size); // lever arms up to 1 m
    }
  }
}

TEST(ElementBlock, tensionPullsTheNodesOfABarTogether)
{
  // A unit cube under sigma_xx = 8 Pa: 8 N on the face x = 1, 2 N on each of its four corners,
  // pulling inward.
  const TestMesh mesh = distorted(ElementType::Hex8, 1, 0);
  ElementBlock block(ElementType::Hex8, blockSteel, {}, {}, mesh.connectivity);
  block.initialise(mesh.x);
  block.setInitialStress({8, 0, 0, 0, 0, 0});
  block.update(mesh.x, NodeVectors("v", 8), 0);
  for (int c = 0; c < 8; ++c)
  {
    const bool right = mesh.x(mesh.connectivity[c], 0) > 0.5;
    EXPECT_NEAR(block.cornerForce()(0, c, 0), right ? -2 : 2, 1e-14);
    EXPECT_NEAR(block.cornerForce()(0, c, 1), 0, 1e-14);
  }
  EXPECT_NEAR(block.cornerMass(0, 0), 7850.0 / 8, 1e-10);
  EXPECT_NEAR(block.volume()(0), 1, 1e-15);
}

TEST(ElementBlock, aTetrahedronUnderPressureIsPushedAtEveryCornerByAThirdOfItsThreeFaces)
{
  // The corner of a unit cube: faces of 1/2 m^2 on the coordinate planes, and B = dV/dx: node 0 has
  // -(1,1,1)/6, the others unit vectors over 6. Force sigma B with sigma = -6 Pa, taken negative.
  TestMesh mesh{ElementType::Tet4, NodeVectors("x", 4), {0, 1, 2, 3}, {}};
  for (int i = 0; i < 3; ++i)
    mesh.x(i + 1, i) = 1;
  ElementBlock block(ElementType::Tet4, blockSteel, {}, {}, mesh.connectivity);
  block.initialise(mesh.x);
  block.setInitialStress({-6, -6, -6, 0, 0, 0});
  block.update(mesh.x, NodeVectors("v", 4), 0);
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_NEAR(block.cornerForce()(0, 0, i), -1, 1e-14);
    for (int c = 1; c < 4; ++c)
      EXPECT_NEAR(block.cornerForce()(0, c, i), c == i + 1 ? 1 : 0, 1e-14);
  }
  EXPECT_NEAR(block.volume()(0), 1.0 / 6, 1e-16);
  EXPECT_NEAR(block.cornerMass(0, 0), 7850.0 / 24, 1e-11);
}

TEST(ElementBlock, triangleAndTetrahedronHaveNoHourglassForces)
{
  for (const ElementType type : {ElementType::Tri3, ElementType::Tet4})
  {
    const TestMesh mesh = distorted(type, 2, 0.2);
    ElementBlock with(type, blockSteel, {0.5, 0.5}, noViscosity, mesh.connectivity);
    ElementBlock without(type, blockSteel, {0, 0}, noViscosity, mesh.connectivity);
    const NodeVectors v = wild(mesh, 100);
    const NodeVectors x = plus(mesh.x, 1e-5, v);
    for (ElementBlock* block : {&with, &without})
    {
      block->initialise(mesh.x);
      block->update(x, v, 1e-5);
    }
    EXPECT_EQ(
        largest(plus(nodalForces(with, mesh.nodes()), -1, nodalForces(without, mesh.nodes()))), 0);
    for (int e = 0; e < with.count(); ++e)
      EXPECT_EQ(with.energy(e, ElementEnergy::Hourglass), 0);
    EXPECT_EQ(with.smallestStableStep(), without.smallestStableStep());
  }
}

TEST(ElementBlock, hourglassMotionIsResistedWithTheFrequencyThatTheOptionNames)
{
  // Square of edge 1: hourglass frequency^2 = eps omega_max^2, omega_max^2 = (n/rho) M S2 with n =
  // 4, S2 = tr g = 2.
  const Real eps = 0.05;
  const TestMesh mesh = distorted(ElementType::Quad4, 1, 0);
  ElementBlock block(ElementType::Quad4, blockSteel, {eps, 0}, noViscosity, mesh.connectivity);
  block.initialise(mesh.x);
  const Real amplitude = 1e-6;
  NodeVectors u("u", 4);
  for (int c = 0; c < 4; ++c)
    u(mesh.connectivity[c], 0) = c % 2 ? -amplitude : amplitude;
  block.update(plus(mesh.x, 0.5, u), u, 1.0);
  const Real omegaSquared = eps * 4 / 7850.0 * pWaveModulus(blockSteel) * 2;
  for (int c = 0; c < 4; ++c) // relative error: the motion over the edge
    EXPECT_NEAR(block.cornerForce()(0, c, 0),
                -omegaSquared * block.cornerMass(0, 0) * u(mesh.connectivity[c], 0),
                2 * amplitude * omegaSquared * amplitude * 2000);
  // its energy: 1/2 sum m omega^2 u^2 over four corners
  EXPECT_NEAR(block.energy(0, ElementEnergy::Hourglass) /
                  (0.5 * 7850 * omegaSquared * amplitude * amplitude),
              1, 1e-10);
  EXPECT_NEAR(block.energy(0, ElementEnergy::Internal), 0, 1e-20);
}

TEST(ElementBlock, plasticElementStaysOnTheYieldSurfaceAndBooksWhatItDissipates)
{
  // Pure shear v_x = rate y of a unit cube with Y = 100 MPa, H = 0: tau = Y/sqrt(3), dissipation
  // about tau times plastic shear.
  const TestMesh mesh = distorted(ElementType::Hex8, 1, 0);
  ElementBlock block(ElementType::Hex8,
                     makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 100e6, 0), {},
                     noViscosity, mesh.connectivity);
  block.initialise(mesh.x);
  const NodeVectors v = field(mesh.x, [](const Vec3& p) { return Vec3{p.y, 0, 0}; });
  NodeVectors x = plus(mesh.x, 0, mesh.x);
  const int steps = 1000;
  const Real shear = 0.02, dt = shear / steps;
  for (int step = 0; step < steps; ++step)
  {
    x = plus(x, dt, v);
    block.update(x, v, dt);
  }
  EXPECT_NEAR(block.vonMises(0), 100e6, 1e-6);
  // plastic shear = total - tau/G; ep = plastic shear / sqrt(3); small rotation terms below 1e-3
  const Real tau = 100e6 / std::sqrt(3.0), g = 200e9 / 2.6;
  const Real strain = (shear - tau / g) / std::sqrt(3.0);
  EXPECT_NEAR(block.history()(0, 0), strain, 1e-3 * strain);
  EXPECT_NEAR(block.energy(0, ElementEnergy::PlasticDissipation), 100e6 * strain,
              1e-3 * 100e6 * strain);
  // the rest of the work is elastic: tau^2 / 2G
  EXPECT_NEAR(block.energy(0, ElementEnergy::Internal) -
                  block.energy(0, ElementEnergy::PlasticDissipation),
              tau * tau / (2 * g), 0.02 * tau * tau / (2 * g));
}

TEST(ElementBlock, bulkViscosityPushesBackAgainstCompressionOnly)
{
  // Unit cube, v_x = -r x: q = rho l r (b1 c + b2 l r) with l = V^(1/3), about 1, and rho of the
  // small compression.
  const TestMesh mesh = distorted(ElementType::Hex8, 1, 0);
  const Real dt = 1e-9, rate = 100;
  for (const Real sign : {-1.0, 1.0})
  {
    ElementBlock block(ElementType::Hex8, blockSteel, {}, {0.06, 1.5}, mesh.connectivity);
    block.initialise(mesh.x);
    const NodeVectors v = field(mesh.x,
                                [=](const Vec3& p) {
                                  return Vec3{sign * rate * p.x, 0, 0};
                                });
    block.update(plus(mesh.x, dt, v), v, dt);
    const Real q = 7850 * rate * (0.06 * soundSpeed(blockSteel) + 1.5 * rate);
    EXPECT_NEAR(block.viscousPressure(0), sign < 0 ? q : 0, 1e-6 * q);
    // work of the mean of 0 and q over the step
    EXPECT_NEAR(block.energy(0, ElementEnergy::Viscous), sign < 0 ? 0.5 * q * rate * dt : 0,
                1e-6 * q * rate * dt);
  }
}

TEST(ElementBlock, invertedElementIsReportedAsTheLowestIndexAndStopsTheStep)
{
  const TestMesh mesh = distorted(ElementType::Hex8, 3, 0.1);
  ElementBlock block(ElementType::Hex8, blockSteel, {}, {}, mesh.connectivity);
  block.initialise(mesh.x);
  block.update(mesh.x, NodeVectors("v", mesh.nodes()), 0);
  EXPECT_EQ(block.invertedElement(), -1);
  EXPECT_GT(block.smallestStableStep(), 0);
  // corner 0 of element 13, the middle one, far behind the opposite corner: volumes of some
  // neighbours turn negative too
  NodeVectors x = plus(mesh.x, 0, mesh.x);
  set(x, block.connectivity()(13, 0), Vec3{5, 5, 5});
  block.update(x, NodeVectors("v", mesh.nodes()), 0);
  int lowest = -1;
  for (int e = block.count() - 1; e >= 0; --e)
    if (block.volume()(e) <= 0)
      lowest = e;
  ASSERT_GE(lowest, 0);
  EXPECT_EQ(block.invertedElement(), lowest);
  EXPECT_EQ(block.smallestStableStep(), 0);
}

TEST(ElementBlock, notANumberIsReportedToo)
{
  const TestMesh mesh = distorted(ElementType::Quad4, 3, 0.1);
  ElementBlock block(ElementType::Quad4, blockSteel, {}, {}, mesh.connectivity);
  block.initialise(mesh.x);
  NodeVectors v("v", mesh.nodes());
  v(block.connectivity()(7, 2), 1) = std::nan("");
  block.update(mesh.x, v, 1e-9);
  // upper right corner of element 7 in the last row of three: shared with element 8 only
  EXPECT_EQ(block.invertedElement(), 7);
}

TEST(ElementBlock, farOriginAndCommonSpeedCostNoDigits)
{
  const TestMesh mesh = distorted(ElementType::Hex8, 1, 0.2);
  const Real dt = 1e-6;
  const NodeVectors v = wild(mesh, 10);
  ElementBlock here(ElementType::Hex8, blockSteel, {}, {}, mesh.connectivity);
  ElementBlock there(ElementType::Hex8, blockSteel, {}, {}, mesh.connectivity);
  here.initialise(mesh.x);
  here.update(plus(mesh.x, dt, v), v, dt);
  const NodeVectors away = field(mesh.x, [](const Vec3& p) { return p + Vec3{1024, -2048, 512}; });
  there.initialise(away);
  there.update(plus(away, dt, v), v, dt);
  // positions there are rounded to 2.3e-13 of the edge, strains of 1e-5 to 2e-8 of themselves
  EXPECT_NEAR(there.vonMises(0) / here.vonMises(0), 1, 1e-7);
}

TEST(ElementBlock, emptyBlockIsQuiet)
{
  ElementBlock block(ElementType::Hex8, blockSteel, {}, {}, {});
  NodeVectors none("x", 0);
  block.initialise(none);
  block.update(none, none, 1);
  EXPECT_EQ(block.count(), 0);
  EXPECT_EQ(block.smallestStableStep(), infinity);
  EXPECT_EQ(block.invertedElement(), -1);
}

TEST(ElementBlock, outOfPlaneShearIsRefusedInPlaneStrain)
{
  const TestMesh mesh = distorted(ElementType::Quad4, 1, 0);
  ElementBlock block(ElementType::Quad4, blockSteel, {}, {}, mesh.connectivity);
  EXPECT_THROW(block.setInitialStress({0, 0, 0, 0, 1, 0}), Error);
}

TEST(ElementBlock, anErodedElementGivesNoForceAndStaysAsItWas)
{
  for (const ElementType type : allTypes)
  {
    const TestMesh mesh = distorted(type, 3, 0.2);
    const Material soft = makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 1e6, 0);
    ElementBlock block(type, soft, {0.1, 0.1}, {}, mesh.connectivity);
    ElementBlock whole(type, soft, {0.1, 0.1}, {}, mesh.connectivity);
    block.initialise(mesh.x);
    whole.initialise(mesh.x);
    const Real dt = 1e-6;
    const NodeVectors v = wild(mesh, 500);
    NodeVectors x = plus(mesh.x, dt, v);
    block.update(x, v, dt);
    whole.update(x, v, dt);
    const int last = block.count() - 1; // also what the padding behind it copies
    const Real strain = block.history()(0, last), volume = block.volume()(last);
    ASSERT_GT(strain, 0);
    block.erode(last);
    for (int cycle = 0; cycle < 3; ++cycle)
    {
      EXPECT_FALSE(block.isAlive(last));
      EXPECT_EQ(block.stableStep()(last), infinity);
      EXPECT_EQ(block.history()(0, last), strain);
      EXPECT_EQ(block.volume()(last), volume);
      EXPECT_EQ(block.vonMises(last), 0);
      for (int kind = 0; kind < elementEnergies; ++kind)
        EXPECT_EQ(block.energy(last, ElementEnergy(kind)), 0);
      for (int c = 0; c < mesh.corners(); ++c)
        for (int i = 0; i < 3; ++i)
          EXPECT_EQ(block.cornerForce()(last, c, i), 0);
      EXPECT_TRUE(block.isAlive(0));
      EXPECT_EQ(block.stress()(0, 0), whole.stress()(0, 0)); // the others do not notice
      x = plus(x, dt, v);
      block.update(x, v, dt);
      whole.update(x, v, dt);
    }
    EXPECT_EQ(block.mass(last), whole.mass(last)); // the nodes keep it
  }
}
