#include "TestMeshes.hpp"

#include <coplane_element/detail/HughesWinget.hpp>

#include <gtest/gtest.h>

using namespace coplane;
using namespace coplane::testMeshes;

namespace
{
const Material steel = makeLinearElastic(200e9, 0.3, 7850);

class Patch : public testing::TestWithParam<Formulation>
{
protected:
  bool flat() const { return isFlat(GetParam().type); }
  /// A velocity field whose gradient is the same everywhere at the middle of the step.
  Vec3 linear(const Vec3& x) const
  {
    return {1 + 2 * x.x - 3 * x.y + (flat() ? 0 : 0.5 * x.z), -2 + 3 * x.x + 4 * x.y + 0.3 * x.z,
            flat() ? 0 : 0.7 * x.x + 0.2 * x.y - 1.5 * x.z};
  }
};

/// Only these have options of hourglass control.
class OnePointPatch : public Patch
{
};

/// The first-order rate stretches the stress by the angle squared in every step.
class OrthogonalRate : public Patch
{
};
} // namespace

TEST_P(Patch, linearVelocityGivesTheExactUniformStressOnADistortedMesh)
{
  const TestMesh mesh = distorted(GetParam().type, 4, 0.2);
  ElementBlock block(GetParam().type, steel, {}, noViscosity, mesh.connectivity,
                     GetParam().options);
  block.initialise(mesh.x);
  // v is linear in the positions at mid-step, where the rates are taken: x(n+1/2) is the mesh
  // itself here.
  const Real dt = 1e-7;
  const NodeVectors v = field(mesh.x, [&](const Vec3& x) { return linear(x); });
  advance(block, plus(mesh.x, dt / 2, v), v, dt);

  const Real lambda = lameLambda(elasticity(steel)), mu = elasticity(steel).shearModulus;
  const Real trace = flat() ? 6 : 4.5;
  const SymTensor middle{(lambda * trace + 2 * mu * 2) * dt,
                         (lambda * trace + 2 * mu * 4) * dt,
                         (lambda * trace + (flat() ? 0 : -3 * mu)) * dt,
                         0,
                         flat() ? 0 : mu * 0.5 * dt,
                         flat() ? 0 : mu * 1.2 * dt};
  // Turned to the end of the step by half the curl of the velocity, but for the first-order rate.
  const Vec3 spin = flat() ? Vec3{0, 0, 3} : Vec3{-0.05, -0.1, 3};
  const bool turns = GetParam().options.rate != ObjectiveRate::Jaumann;
  const SymTensor end = turns ? rotated(middle, hughesWinget(0.25 * dt * spin)) : middle;
  const Real expected[6] = {end.xx, end.yy, end.zz, end.xy, end.yz, end.zx};
  for (int e = 0; e < block.count(); ++e)
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR(block.stress()(k, e), expected[k], 1e-12 * expected[1]) << k;
}

TEST_P(Patch, uniformStressLeavesInteriorNodesInBalance)
{
  const TestMesh mesh = distorted(GetParam().type, 4, 0.2);
  ElementBlock block(GetParam().type, steel, {}, noViscosity, mesh.connectivity,
                     GetParam().options);
  block.initialise(mesh.x);
  const Real dt = 1e-6;
  const NodeVectors v = field(mesh.x, [&](const Vec3& x) { return linear(x); });
  advance(block, plus(mesh.x, dt / 2, v), v, dt);
  const NodeVectors f = nodalForces(block, mesh.nodes());
  const Real scale = largest(f);
  ASSERT_GT(scale, 0);
  for (int node = 0; node < mesh.nodes(); ++node)
  {
    if (mesh.interior[node])
    {
      EXPECT_LT(norm(at(f, node)), 1e-12 * scale);
    }
  }
}

TEST_P(OnePointPatch, linearVelocityDoesNotWakeTheHourglassForces)
{
  const TestMesh mesh = distorted(GetParam().type, 3, 0.25);
  ElementBlock with(GetParam().type, steel, {0.5, 0.3}, noViscosity, mesh.connectivity);
  ElementBlock without(GetParam().type, steel, {0, 0}, noViscosity, mesh.connectivity);
  const Real dt = 1e-6;
  const NodeVectors v = field(mesh.x, [&](const Vec3& x) { return linear(x); });
  const NodeVectors end = plus(mesh.x, dt / 2, v);
  for (ElementBlock* block : {&with, &without})
  {
    block->initialise(mesh.x);
    block->update(end, v, dt);
  }
  const NodeVectors f = nodalForces(with, mesh.nodes());
  const NodeVectors g = nodalForces(without, mesh.nodes());
  EXPECT_LT(largest(plus(f, -1, g)), 1e-12 * largest(g));
}

TEST_P(OrthogonalRate, aStepForthAndBackLeavesNoStress)
{
  // Else bodies that vibrate in shear gain energy in every cycle. Strains of one per cent, spins
  // too.
  const TestMesh mesh = distorted(GetParam().type, 4, 0.2);
  ElementBlock block(GetParam().type, steel, {}, noViscosity, mesh.connectivity,
                     GetParam().options);
  block.initialise(mesh.x);
  const Real dt = 3e-3;
  const NodeVectors v = field(mesh.x, [&](const Vec3& x) { return linear(x); });
  advance(block, plus(mesh.x, dt, v), v, dt);
  const Real before = std::abs(block.stress()(1, 0));
  EXPECT_GT(before, 1e9);
  advance(block, mesh.x, plus(v, -2, v), dt);
  for (int e = 0; e < block.count(); ++e)
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR(block.stress()(k, e), 0, 1e-5 * before) << k;
}

TEST_P(OrthogonalRate, rigidRotationBy90DegreesTurnsTheStressAndKeepsItsSize)
{
  const TestMesh mesh = distorted(GetParam().type, 2, 0.2);
  ElementBlock block(GetParam().type, steel, {}, noViscosity, mesh.connectivity,
                     GetParam().options);
  block.initialise(mesh.x);
  block.setInitialStress({100e6, -20e6, 30e6, 40e6, flat() ? 0 : 15e6, flat() ? 0 : -25e6});
  const int steps = 1000;
  const auto turned = [&](Real angle)
  {
    return field(mesh.x,
                 [angle](const Vec3& x)
                 {
                   return Vec3{std::cos(angle) * x.x - std::sin(angle) * x.y,
                               std::sin(angle) * x.x + std::cos(angle) * x.y, x.z};
                 });
  };
  const Real dt = 1e-6;
  for (int step = 0; step < steps; ++step)
  {
    const NodeVectors before = turned(pi / 2 * step / steps);
    const NodeVectors after = turned(pi / 2 * (step + 1) / steps);
    advance(block, after,
            field(plus(after, -1, before), [dt](const Vec3& d) { return 1 / dt * d; }), dt);
  }
  // A quarter turn about z: xx and yy change places, xy its sign, (yz, zx) turns like a vector.
  const Real size = 130e6;
  const Real expected[6] = {-20e6, 100e6, 30e6, -40e6, flat() ? 0 : -25e6, flat() ? 0 : -15e6};
  for (int e = 0; e < block.count(); ++e)
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR(block.stress()(k, e), expected[k], 1e-10 * size) << "component " << k;
}

INSTANTIATE_TEST_SUITE_P(Elements, Patch, testing::ValuesIn(allFormulations()), nameOfParam);
INSTANTIATE_TEST_SUITE_P(Elements, OnePointPatch,
                         testing::ValuesIn(those(allFormulations(),
                                                 [](const Formulation& f) {
                                                   return f.options.form == ElementForm::OnePoint;
                                                 })),
                         nameOfParam);
INSTANTIATE_TEST_SUITE_P(Elements, OrthogonalRate,
                         testing::ValuesIn(those(allFormulations(),
                                                 [](const Formulation& f) {
                                                   return f.options.rate != ObjectiveRate::Jaumann;
                                                 })),
                         nameOfParam);
