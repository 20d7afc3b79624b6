#include "TestMeshes.hpp"

#include <coplane_element/StableStep.hpp>

#include <gtest/gtest.h>

using namespace coplane;
using namespace coplane::testMeshes;

namespace
{
Real stepOverTransit(ElementType type, Real poissonRatio)
{
  const Real edge = 0.1;
  const Material law = makeLinearElastic(30e9, poissonRatio, 2500);
  TestMesh mesh = distorted(type, 1, 0);
  for (int node = 0; node < mesh.nodes(); ++node)
    set(mesh.x, node, edge * at(mesh.x, node));
  ElementBlock block(type, law, {}, noViscosity, mesh.connectivity);
  block.initialise(mesh.x);
  block.update(mesh.x, NodeVectors("v", mesh.nodes()), 0);
  return block.stableStep()(0) * soundSpeed(law) / edge;
}

/// Largest frequency squared of one element by power iteration on its own forces.
Real omegaSquared(ElementBlock& block, const TestMesh& mesh)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<Real> number(-1, 1);
  const bool flat = isFlat(mesh.type);
  NodeVectors u = field(mesh.x,
                        [&](const Vec3&) {
                          return Vec3{number(random), number(random), flat ? 0 : number(random)};
                        });
  Real value = 0;
  for (int round = 0; round < 150; ++round)
  {
    const Real scale = 1e-9 / largest(u); // small: the forces are linear in u
    u = field(u, [scale](const Vec3& a) { return scale * a; });
    block.initialise(mesh.x);
    advance(block, plus(mesh.x, 0.5, u), u, 1.0);
    Real fu = 0, uu = 0;
    NodeVectors next("u", mesh.nodes());
    for (int c = 0; c < mesh.corners(); ++c)
    {
      const int node = block.connectivity()(0, c);
      const Vec3 f{block.cornerForce()(0, c, 0), block.cornerForce()(0, c, 1),
                   block.cornerForce()(0, c, 2)};
      const Real mass = block.cornerMass(0, c);
      fu -= dot(f, at(u, node));
      uu += mass * dot(at(u, node), at(u, node));
      set(next, node, (1 / mass) * f);
      if (block.options().geometry == Geometry::Axisymmetric && mesh.x(node, 0) == 0)
        next(node, 0) = 0; // a point on the axis stays there
    }
    value = fu / uu;
    u = next;
  }
  return value;
}
} // namespace

TEST(StableStep, ofACubeIsExact)
{
  // omega^2 = 4 (3 lambda + 2 mu) / (rho h^2), dt = 2/omega: dt c / h = sqrt((lambda + 2 mu) / (3
  // lambda + 2 mu)) nu = 0.2: lambda = 2/3 mu, sqrt(2/3) = .816; nu = 0.3: lambda = 3/2 mu,
  // sqrt(7/13) = .734
  EXPECT_NEAR(stepOverTransit(ElementType::Hex8, 0.2), std::sqrt(2.0 / 3), 1e-12);
  EXPECT_NEAR(stepOverTransit(ElementType::Hex8, 0.3), std::sqrt(7.0 / 13), 1e-12);
}

TEST(StableStep, ofASquareIsExact)
{
  // Two dimensions: the same with 2 lambda + 2 mu: omega^2 = 4 (2 lambda + 2 mu) / (rho h^2)
  EXPECT_NEAR(stepOverTransit(ElementType::Quad4, 0.3), std::sqrt(3.5 / 5), 1e-12);
}

TEST(StableStep, ofATriangleAndATetrahedronIsThatOfTheirStrainModes)
{
  // No hourglass modes: only Newton's three rounds (a few per mille) stand between bound and truth.
  for (const ElementType type : {ElementType::Tri3, ElementType::Tet4})
    for (unsigned seed = 0; seed < 6; ++seed)
    {
      const TestMesh mesh = single(type, 0.2, seed);
      ElementBlock block(type, makeLinearElastic(30e9, 0.25, 2500), {}, noViscosity,
                         mesh.connectivity);
      const Real exact = 2 / std::sqrt(omegaSquared(block, mesh));
      EXPECT_LE(block.stableStep()(0), exact * (1 + 1e-6));
      EXPECT_GT(block.stableStep()(0), (isFlat(type) ? 1 - 1e-6 : 0.98) * exact);
    }
}

TEST(StableStep, largestRootIsFoundFromAbove)
{
  // g = diag(1, 1/4, 1/4), c = 1: the matrix c s s^T + diag(g) has its largest eigenvalue in the
  // span of (1,0,0) and (0,1,1):
  // [[2, .5 sqrt2], [.5 sqrt2, .75]]: y = 1.375 + sqrt(.625^2 + .5)
  const Real exact = 1.375 + std::sqrt(0.625 * 0.625 + 0.5);
  const Real found = fastestStrainMode(1.5, 0.25 + 0.25 + 0.0625, 0.0625, 1.0);
  EXPECT_GE(found, exact * (1 - 1e-14));
  EXPECT_NEAR(found, exact, 1e-3 * exact);
  // g = diag(1, 1, 0), c = 0, a double largest root: the slowest case, where the first
  // excess of 1/3 only halves in each of three rounds
  const Real flat = fastestStrainMode(2.0, 1.0, 0.0, 0.0);
  EXPECT_GE(flat, 1);
  EXPECT_LT(flat, 1.06);
  // g = identity, c = 0: three equal roots
  EXPECT_NEAR(fastestStrainMode(3.0, 3.0, 1.0, 0.0), 1.0, 1e-7);
}

TEST(StableStep, isNeverAboveTheLimitOfADistortedElementAndSeldomFarBelow)
{
  for (const ElementType type : allTypes)
    for (const Real poissonRatio : {0.0, 0.3, 0.49})
      for (const Real hourglass : {0.05, 0.8})
        for (unsigned seed = 0; seed < 6; ++seed)
        {
          const TestMesh mesh = single(type, 0.25, seed);
          ElementBlock block(type, makeLinearElastic(30e9, poissonRatio, 2500), {hourglass, 0},
                             noViscosity, mesh.connectivity);
          const Real exact = 2 / std::sqrt(omegaSquared(block, mesh));
          const Real step = block.stableStep()(0);
          EXPECT_LE(step, exact * (1 + 1e-6));
          EXPECT_GT(step, (hourglass < 0.1 ? 0.85 : 0.3) * exact);
        }
}

TEST(StableStep, isNeverAboveTheLimitOfAnyFormAndNotFarBelow)
{
  for (const Formulation& f : allOf(allFormulations(), revolvedFormulations()))
    for (const Real poissonRatio : {0.0, 0.3, 0.45})
      for (unsigned seed = 0; seed < 4; ++seed)
      {
        SCOPED_TRACE(nameOf(f));
        TestMesh mesh = meshOf(f, 1, 0.2, seed);
        mesh.connectivity.resize(mesh.corners());
        ElementBlock block(f.type, makeLinearElastic(30e9, poissonRatio, 2500), {}, noViscosity,
                           mesh.connectivity, f.options);
        const Real exact = 2 / std::sqrt(omegaSquared(block, mesh));
        EXPECT_LE(block.stableStep()(0), exact * (1 + 1e-6));
        // Full integration adds bounds of the volumetric and of the deviatoric part, assumed
        // strains bound the hourglass modes together.
        EXPECT_GT(block.stableStep()(0), 0.55 * exact);
      }
}

TEST(StableStep, ofARingOnTheAxisIsSafeAndNotFarBelow)
{
  for (const Formulation& f : revolvedFormulations())
    for (const Real poissonRatio : {0.0, 0.25, 0.45})
    {
      SCOPED_TRACE(nameOf(f));
      const TestMesh mesh = single(f.type, 0); // its inner side on the axis
      ElementBlock block(f.type, makeLinearElastic(30e9, poissonRatio, 2500), {}, noViscosity,
                         mesh.connectivity, f.options);
      const Real exact = 2 / std::sqrt(omegaSquared(block, mesh));
      EXPECT_LE(block.stableStep()(0), exact * (1 + 1e-6));
      // Plain full integration has only the bound of its fastest point, that next to the axis.
      const bool plain = f.options.form == ElementForm::FullIntegrationPlain;
      EXPECT_GT(block.stableStep()(0), (plain ? 0.4 : 0.55) * exact);
    }
}

TEST(StableStep, ofAGasIsThatOfItsSound)
{
  // Without shear only the volume vibrates: omega^2 = (n/rho) K tr(g), tr(g) = 2/h^2 (square, n =
  // 4) and 3/(2 h^2) (cube, n = 8), so dt = h/c over sqrt(2) and over sqrt(3).
  const Material law = makeLaw(IdealGasParameters{1.2, 1.4, 1e5});
  for (const ElementType type : {ElementType::Quad4, ElementType::Hex8})
  {
    const TestMesh mesh = distorted(type, 1, 0);
    ElementBlock block(type, law, {0, 0}, noViscosity, mesh.connectivity);
    block.initialise(mesh.x);
    block.update(mesh.x, NodeVectors("v", mesh.nodes()), 0);
    const Real dimension = isFlat(type) ? 2 : 3;
    EXPECT_NEAR(block.stableStep()(0) * soundSpeed(law), 1 / std::sqrt(dimension), 1e-5);
  }
}

TEST(StableStep, viscosityShortensIt)
{
  // One cube in pure dilatation: damping = (n/rho) rho l b1 c tr(g), n = 8, tr g = 3 / (2 h^2), l =
  // h: 12 b1 c / h.
  const TestMesh mesh = distorted(ElementType::Hex8, 1, 0);
  const Material law = makeLinearElastic(30e9, 0.2, 2500);
  ElementBlock block(ElementType::Hex8, law, {}, {0.06, 0}, mesh.connectivity);
  block.initialise(mesh.x);
  block.update(mesh.x, NodeVectors("v", mesh.nodes()), 0);
  const Real omega = 2 / std::sqrt(2.0 / 3) * soundSpeed(law);
  const Real z = 12 * 0.06 * soundSpeed(law) / (2 * omega);
  EXPECT_NEAR(block.stableStep()(0), 2 / omega * (std::sqrt(1 + z * z) - z), 1e-12 / omega);
}
