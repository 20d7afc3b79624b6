#include "TestMeshes.hpp"

#include <gtest/gtest.h>

using namespace coplane;
using namespace coplane::testMeshes;

namespace
{
struct Balance
{
  Real nodal =
      0; ///< largest difference of kinetic energy and nodal work, relative to the first energy
  Real element = 0; ///< largest error of kinetic plus element energies, relative
  Real hourglass = 0, lost = 0;
  Vec3 momentum{};
};

/// A free cube, set off with a shear, a stretch, a spin and an hourglass motion, for a fixed time
/// at a fixed step.
Balance vibrate(ElementType type, int n, const Material& law, HourglassOptions hourglass,
                BulkViscosity viscosity, int steps, ElementOptions options = {})
{
  const TestMesh mesh = meshOf({type, options}, n, 0.1);
  ElementBlock block(type, law, hourglass, viscosity, mesh.connectivity, options);
  NodeVectors x = plus(mesh.x, 0, mesh.x);
  block.initialise(x);
  std::vector<Real> mass(mesh.nodes(), 0.0);
  for (int e = 0; e < block.count(); ++e)
    for (int c = 0; c < mesh.corners(); ++c)
      mass[block.connectivity()(e, c)] += block.cornerMass(e, c);
  const bool flat = isFlat(type);
  NodeVectors v = field(x,
                        [flat](const Vec3& p)
                        {
                          const Real warp = p.x * p.y * (flat ? 1 : p.z);
                          return Vec3{-30 * p.x + 20 * p.y + 10 * warp, 15 * p.y - 25 * p.x,
                                      flat ? 0 : 20 * p.z + 5 * p.x - 8 * warp};
                        });
  NodeVectors f("f", mesh.nodes());
  const auto kinetic = [&](const NodeVectors& a, const NodeVectors& b)
  {
    Real sum = 0;
    for (int node = 0; node < mesh.nodes(); ++node)
      sum += 0.5 * mass[node] * dot(at(a, node), at(b, node));
    return sum;
  };

  const Real dt = 1.2e-3 / steps;
  const Real first = kinetic(v, v);
  Real work = 0;
  Balance balance;
  for (int step = 0; step < steps; ++step)
  {
    // v(n+1/2) from v(n-1/2); half a kick in the first step, where f = 0
    NodeVectors next("v", mesh.nodes());
    for (int node = 0; node < mesh.nodes(); ++node)
      set(next, node, at(v, node) + (step == 0 ? 0.5 : 1.0) * dt / mass[node] * at(f, node));
    const Real energy = kinetic(v, next);
    Real elements = 0;
    balance.hourglass = balance.lost = 0;
    for (int e = 0; e < block.count(); ++e)
    {
      elements += block.energy(e, ElementEnergy::Internal) +
                  block.energy(e, ElementEnergy::Hourglass) +
                  block.energy(e, ElementEnergy::Viscous);
      balance.hourglass += block.energy(e, ElementEnergy::Hourglass);
      balance.lost += block.energy(e, ElementEnergy::PlasticDissipation) +
                      block.energy(e, ElementEnergy::Viscous);
    }
    balance.nodal = std::max(balance.nodal, std::abs(energy - first - work) / first);
    balance.element = std::max(balance.element, std::abs(energy + elements - first) / first);
    v = next;
    x = plus(x, dt, v);
    advance(block, x, v, dt);
    const NodeVectors force = nodalForces(block, mesh.nodes());
    for (int node = 0; node < mesh.nodes(); ++node)
      work += 0.5 * dt * dot(at(f, node) + at(force, node), at(v, node));
    f = force;
  }
  EXPECT_EQ(block.invertedElement(), -1);
  EXPECT_LT(dt, block.smallestStableStep());
  return balance;
}

const Material vibratingSteel = makeLinearElastic(200e9, 0.3, 7850);
} // namespace

TEST(FreeVibration, nodalWorkBalancesTheKineticEnergyToRounding)
{
  // With a constant step E_k(n+1) - E_k(n) = (f(n) + f(n+1))/2 . dx is an identity of central
  // differences.
  EXPECT_LT(vibrate(ElementType::Hex8, 1, vibratingSteel, {}, noViscosity, 100).nodal, 1e-12);
  EXPECT_LT(vibrate(ElementType::Quad4, 2, vibratingSteel, {}, {}, 200).nodal, 1e-12);
  EXPECT_LT(vibrate(ElementType::Tet4, 1, vibratingSteel, {}, noViscosity, 200).nodal, 1e-12);
  EXPECT_LT(vibrate(ElementType::Tri3, 2, vibratingSteel, {}, {}, 200).nodal, 1e-12);
}

TEST(FreeVibration, elementEnergiesBalanceToSecondOrderInTheStep)
{
  for (const Formulation& f : allOf(allFormulations(), revolvedFormulations()))
    for (const int n : {1, 2})
    {
      if (f.options.rate == ObjectiveRate::Jaumann)
        continue; // first order
      SCOPED_TRACE(nameOf(f));
      const auto error = [&](int steps) {
        return vibrate(f.type, n, vibratingSteel, {0.05, 0}, noViscosity, steps, f.options).element;
      };
      const Real coarse = error(200), fine = error(400);
      EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2);
      EXPECT_LT(coarse, 1e-3);
    }
}

TEST(FreeVibration, elementEnergiesBalanceWithPlasticityAndAllViscosities)
{
  const Material plastic = makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 50e6, 1e9);
  for (const Formulation& f : allOf(allFormulations(), revolvedFormulations()))
  {
    SCOPED_TRACE(nameOf(f));
    const Balance balance = vibrate(f.type, 2, plastic, {0.05, 0.03}, {0.06, 1.5}, 400, f.options);
    EXPECT_LT(balance.element, 1e-3);
    EXPECT_LT(balance.nodal, 1e-12);
    EXPECT_GT(balance.lost, 0);
    if ((f.type == ElementType::Hex8 || f.type == ElementType::Quad4) &&
        !isFullyIntegrated(f.options.form))
    {
      EXPECT_GT(balance.hourglass, 0);
    }
  }
}
