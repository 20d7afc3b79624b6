#include "TestMeshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

// Average nodal pressure: an element that changes its volume while its nodes are told of none
// resists by a pressure -K y^3, y = (r - 1/r) / 2, r its volume over the first one.

using namespace coplane;
using namespace coplane::testMeshes;

namespace
{
const Material driftingSteel = makeLinearElastic(200e9, 0.3, 7850);

class VolumeDrift : public testing::TestWithParam<Formulation>
{
protected:
  /// One element, off the axis.
  TestMesh element() const
  {
    TestMesh mesh = distorted(GetParam().type, 1, 0);
    const int corners = mesh.corners();
    mesh.connectivity.resize(corners);
    for (int n = 0; n < mesh.nodes(); ++n)
      mesh.x(n, 0) += 1;
    return mesh;
  }
  /// Power of a scale of all lengths by which the volume grows; that of rings has the radius in it.
  int power() const
  {
    return isFlat(GetParam().type) && GetParam().options.geometry != Geometry::Axisymmetric ? 2 : 3;
  }
  /// Scales the element to `scale` in equal steps. `told`: share of its dilatation that its nodes
  /// are told of.
  ElementBlock scaled(const TestMesh& mesh, Real scale, int steps, Real told) const
  {
    ElementBlock block(GetParam().type, driftingSteel, {}, noViscosity, mesh.connectivity,
                       GetParam().options);
    block.initialise(mesh.x);
    const Real dt = 1e-9;
    for (int i = 0; i < steps; ++i)
    {
      const Real before = 1 + (scale - 1) * i / steps, after = 1 + (scale - 1) * (i + 1) / steps;
      const NodeVectors v = field(mesh.x, [&](const Vec3& p) { return (after - before) / dt * p; });
      Array<Real> dilatation("dilatation", mesh.nodes());
      Kokkos::deep_copy(dilatation, told * power() * (after - before) / (0.5 * (after + before)));
      block.update(field(mesh.x, [&](const Vec3& p) { return after * p; }), v, dt, dilatation);
    }
    return block;
  }
};

Real hourglassEnergy(const ElementBlock& block)
{
  return block.energy(0, ElementEnergy::Hourglass);
}
} // namespace

TEST_P(VolumeDrift, takesTheEnergyOfItsPressure)
{
  const TestMesh mesh = element();
  for (const Real scale : {0.8, 1.3})
  {
    const ElementBlock block = scaled(mesh, scale, 400, 0);
    // K V0 int ((s - 1/s) / 2)^3 ds from 1 to r
    const Real r = std::pow(scale, power());
    const auto integral = [](Real s)
    { return (s * s * s * s / 4 - 1.5 * s * s + 3 * std::log(s) + 0.5 / (s * s)) / 8; };
    const Real exact = elasticity(driftingSteel).bulkModulus * block.referenceVolume()(0) *
                       (integral(r) - integral(1));
    ASSERT_GT(exact, 0);
    EXPECT_NEAR(hourglassEnergy(block), exact, 1e-4 * exact) << scale;
  }
}

TEST_P(VolumeDrift, isNothingWhereTheNodesAgreeAndLittleWhereTheyHardlyDiffer)
{
  const TestMesh mesh = element();
  const ElementBlock agreed = scaled(mesh, 0.8, 400, 1);
  EXPECT_LT(hourglassEnergy(agreed), 1e-9 * agreed.energy(0, ElementEnergy::Internal));
  const ElementBlock small = scaled(mesh, 0.999, 10, 0);
  const Real strain = 1e-3 * power();
  EXPECT_LT(hourglassEnergy(small), std::pow(strain, 4) * elasticity(driftingSteel).bulkModulus *
                                        small.referenceVolume()(0));
}

TEST_P(VolumeDrift, pushesTheNodesApartAndShortensTheStep)
{
  const TestMesh mesh = element();
  const Real scale = 0.9;
  const ElementBlock with = scaled(mesh, scale, 100, 0);
  // What update() gives is the deviator, on the volume that the nodes know of, and the drift.
  const Real r = std::pow(scale, power()), y = 0.5 * (r - 1 / r);
  const Real pressure = -elasticity(driftingSteel).bulkModulus * y * y * y;
  EXPECT_GT(pressure, 0);
  ElementOptions usual = GetParam().options;
  usual.form = ElementForm::OnePoint;
  ElementBlock plain(GetParam().type, driftingSteel, {}, noViscosity, mesh.connectivity, usual);
  plain.initialise(field(mesh.x, [&](const Vec3& p) { return scale * p; }));
  const auto stress = [&](int k) { return with.stress()(k, 0); };
  const Real mean = (stress(0) + stress(1) + stress(2)) / 3;
  plain.setInitialStress({(stress(0) - mean) / r - pressure, (stress(1) - mean) / r - pressure,
                          (stress(2) - mean) / r - pressure, stress(3) / r,
                          isFlat(mesh.type) ? 0 : stress(4) / r,
                          isFlat(mesh.type) ? 0 : stress(5) / r});
  plain.update(field(mesh.x, [&](const Vec3& p) { return scale * p; }),
               NodeVectors("v", mesh.nodes()), 0);
  const NodeVectors f = nodalForces(with, mesh.nodes()), g = nodalForces(plain, mesh.nodes());
  EXPECT_LT(largest(plus(f, -1, g)), 1e-9 * largest(g));
  // As bulk modulus K + 3 K y^2 (r + 1/r) / 2 all squared frequencies are at most so much larger.
  // The mass of `plain` is that of its smaller volume.
  const Real stiffer = (1 + 1.5 * y * y * (r + 1 / r)) / r; // the nodes know of all its volume
  EXPECT_NEAR(with.stableStep()(0) * std::sqrt(stiffer * r) / plain.stableStep()(0), 1, 1e-9);
}

/// The energy of a mesh of an elastic law is a function of where its nodes are, though the volumes
/// of neighbours trade and differ much: what it takes to get there by two ways is the same, and on
/// the way back it is returned.
TEST_P(VolumeDrift, isAPartOfAnEnergyThatDoesNotHangOnTheWay)
{
  const TestMesh mesh = distorted(GetParam().type, 3, .2);
  const bool flat = isFlat(mesh.type);
  const Material rubber = NeoHookean{makeLinearElastic(5e6, 0.4, 1000)};
  const auto bend = [&](const Vec3& p) {
    return Vec3{.1 * std::sin(4 * p.y), -.25 * p.y, flat ? 0 : .1 * std::sin(3 * p.x)};
  };
  const auto trade = [&](const Vec3& p)
  {
    return Vec3{.03 * std::sin(40 * p.x + 20 * p.y), .025 * std::cos(50 * p.x),
                flat ? 0 : .1 * p.y};
  };
  // Work of all forces along a way made of legs, each to a place from the one before.
  const auto workAlong = [&](const std::vector<std::array<Real, 2>>& places, int steps)
  {
    ElementBlock block(mesh.type, rubber, {}, noViscosity, mesh.connectivity, GetParam().options);
    block.initialise(mesh.x);
    NodeVectors x = plus(mesh.x, 0, mesh.x), before = nodalForces(block, mesh.nodes());
    Real work = 0;
    std::array<Real, 2> from{0, 0};
    for (const std::array<Real, 2>& to : places)
    {
      for (int i = 0; i < steps; ++i)
      {
        const NodeVectors v = field(mesh.x,
                                    [&](const Vec3& p) {
                                      return (1.0 / steps) * ((to[0] - from[0]) * bend(p) +
                                                              (to[1] - from[1]) * trade(p));
                                    });
        x = plus(x, 1, v);
        advance(block, x, v, 1);
        const NodeVectors now = nodalForces(block, mesh.nodes());
        for (int n = 0; n < mesh.nodes(); ++n)
          work -= 0.5 * dot(at(before, n) + at(now, n), at(v, n));
        before = now;
        for (int e = 0; e < block.count(); ++e)
          EXPECT_GT(block.volume(e), 0);
      }
      from = to;
    }
    Real booked = 0;
    for (int e = 0; e < block.count(); ++e)
      booked +=
          block.energy(e, ElementEnergy::Internal) + block.energy(e, ElementEnergy::Hourglass);
    return std::array<Real, 2>{work, booked};
  };
  const auto [first, firstBooked] = workAlong({{1, 0}, {1, 1}}, 400);
  const auto [second, secondBooked] = workAlong({{0, 1}, {1, 1}}, 400);
  const auto [back, backBooked] = workAlong({{1, 0}, {1, 1}, {0, 1}, {0, 0}}, 400);
  EXPECT_GT(first, 0);
  EXPECT_NEAR(second / first, 1, 1e-3);
  EXPECT_NEAR(back / first, 0, 1e-3);
  EXPECT_NEAR(firstBooked / first, 1, 1e-3);
  EXPECT_NEAR(secondBooked / first, 1, 1e-3);
  EXPECT_NEAR(backBooked / first, 0, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Elements, VolumeDrift,
                         testing::ValuesIn(those(allOf(allFormulations(), revolvedFormulations()),
                                                 [](const Formulation& f) {
                                                   return f.options.form ==
                                                          ElementForm::NodalPressure;
                                                 })),
                         nameOfParam);
