#include "TestMeshes.hpp"

#include <coplane_material/PseudoCap.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

using namespace coplane;
using namespace coplane::testMeshes;

namespace
{
constexpr Real strength = 1e8, young = 200e9;
const Material ductile = makeJ2Plasticity(makeLinearElastic(young, 0.3, 7850), strength, 0);

struct Bending
{
  const char* name;
  ElementType type;
  HourglassOptions hourglass;
  ElementForm form = ElementForm::OnePoint;
  Vec3 axis{1, 0, 0};      ///< of the turn of the element
  Real angle = 0;          ///< [rad]
  Vec3 size{1, 1, 1};      ///< edges of the brick [m]
  bool alongOther = false; ///< bends along y instead of x
  bool twists = false;     ///< moves along z instead
};
void PrintTo(const Bending& bending, std::ostream* stream)
{
  *stream << bending.name;
}

/// A brick, turned, that bends by its mode along one axis, linear along another.
class Bent
{
public:
  explicit Bent(const Bending& how, const Material& law = ductile)
      : how_(how), mesh_(distorted(how.type, 1, 0)),
        block_(how.type, law, how.hourglass, noViscosity, mesh_.connectivity, {how.form})
  {
    start_ = NodeVectors("start", mesh_.nodes());
    mode_ = NodeVectors("mode", mesh_.nodes());
    for (int n = 0; n < mesh_.nodes(); ++n)
    {
      const Vec3 p = at(mesh_.x, n);
      set(start_, n, turned({p.x * how.size.x, p.y * how.size.y, p.z * how.size.z}));
      const Real sign = (2 * p.x - 1) * (2 * p.y - 1);
      set(mode_, n,
          turned(how.twists       ? Vec3{0, 0, sign}
                 : how.alongOther ? Vec3{0, sign, 0}
                                  : Vec3{sign, 0, 0}));
    }
    x_ = plus(start_, 0, mode_);
    block_.initialise(start_);
  }

  /// By the amplitude q [m] in small steps, beside a velocity of its own.
  void bend(Real q, int steps, const NodeVectors& beside = {})
  {
    NodeVectors v("v", mesh_.nodes());
    for (int n = 0; n < mesh_.nodes(); ++n)
      set(v, n, q * at(mode_, n) + (beside.extent(0) > 0 ? at(beside, n) : Vec3{}));
    for (int s = 0; s < steps; ++s)
    {
      x_ = plus(x_, 1.0 / steps, v);
      const Real before = force();
      block_.update(x_, v, 1.0 / steps);
      work_ += 0.5 * (before + force()) * q / steps;
    }
  }
  /// Resistance against the amplitude [N].
  Real force() const
  {
    Real sum = 0;
    for (int c = 0; c < mesh_.corners(); ++c)
      for (int i = 0; i < 3; ++i)
        sum -= block_.cornerForce()(0, c, i) * mode_(mesh_.connectivity[c], i);
    return sum;
  }
  /// Of a section that flows throughout: amplitude times force is twice the moment times the turn.
  Real limit() const
  {
    const Real length = how_.alongOther ? how_.size.y : how_.size.x,
               volume = how_.size.x * how_.size.y * (isFlat(how_.type) ? 1 : how_.size.z);
    if (how_.twists) // shears by its stiffness, c / Lx and c / Ly, with 3 (2/3 tau)^2 = Y^2
      return volume / 3 * std::sqrt(0.75) * strength *
             std::sqrt(4 / (how_.size.x * how_.size.x) + 4 / (how_.size.y * how_.size.y));
    // Without motion across: in plane strain half the stress there, in a hexahedron what Poisson's
    // ratio gives, if its control knows it.
    const Real across = isFlat(how_.type)                         ? 0.5
                        : how_.form == ElementForm::AssumedStrain ? 0.3
                                                                  : 0.0;
    return strength / std::sqrt(1 - across + across * across) * volume / length;
  }
  Real energy(ElementEnergy kind) const { return block_.energy(0, kind); }
  Real history(int k) const { return block_.history()(k, 0); }
  Real work() const { return work_; }
  const NodeVectors& start() const { return start_; }
  ElementBlock& block() { return block_; }

private:
  Vec3 turned(const Vec3& p) const
  {
    const Vec3 a = (1 / norm(how_.axis)) * how_.axis;
    return std::cos(how_.angle) * p + std::sin(how_.angle) * cross(a, p) +
           ((1 - std::cos(how_.angle)) * dot(a, p)) * a;
  }

  Bending how_;
  TestMesh mesh_;
  ElementBlock block_;
  NodeVectors start_, mode_, x_;
  Real work_ = 0;
};

class HourglassReturn : public ::testing::TestWithParam<Bending>
{
};
} // namespace

TEST_P(HourglassReturn, anElementBendsUpToItsPlasticMoment)
{
  Bent element(GetParam());
  const Real q = 100 * strength / young; // far beyond yield with any control
  element.bend(q, 400);
  EXPECT_NEAR(element.force() / element.limit(), 1, 2e-3);
  const Real plastic = element.energy(ElementEnergy::PlasticBending);
  EXPECT_GT(plastic, 0.8 * element.work());
  EXPECT_NEAR(plastic + element.energy(ElementEnergy::Hourglass), element.work(),
              2e-3 * element.work());
  EXPECT_EQ(element.energy(ElementEnergy::PlasticDissipation), plastic);

  // What is stored comes back, and then it flows the other way.
  element.bend(-q, 400);
  EXPECT_NEAR(element.force() / element.limit(), -1, 2e-3);
  EXPECT_GT(element.energy(ElementEnergy::Hourglass), 0);
}

INSTANTIATE_TEST_SUITE_P(
    , HourglassReturn,
    ::testing::Values(
        Bending{"Quad", ElementType::Quad4, {}}, Bending{"QuadStiff", ElementType::Quad4, {0.3, 0}},
        Bending{"QuadAssumedStrain", ElementType::Quad4, {}, ElementForm::AssumedStrain},
        Bending{"QuadLong", ElementType::Quad4, {}, ElementForm::OnePoint, {0, 0, 1}, 0, {2, 1, 1}},
        Bending{"QuadTurned",
                ElementType::Quad4,
                {},
                ElementForm::AssumedStrain,
                {0, 0, 1},
                0.7,
                {1, 1.5, 1},
                true},
        Bending{"Hex", ElementType::Hex8, {}}, Bending{"HexStiff", ElementType::Hex8, {0.3, 0}},
        Bending{"HexAssumedStrain", ElementType::Hex8, {}, ElementForm::AssumedStrain},
        Bending{
            "HexTurned", ElementType::Hex8, {}, ElementForm::OnePoint, {1, 2, 3}, 1.1, {1, 2, 1.5}},
        Bending{"HexTurnedAssumedStrain",
                ElementType::Hex8,
                {},
                ElementForm::AssumedStrain,
                {1, 2, 3},
                1.1,
                {1, 2, 1.5},
                true},
        Bending{"HexTwists",
                ElementType::Hex8,
                {},
                ElementForm::AssumedStrain,
                {1, 2, 3},
                1.1,
                {3, 1, 0.4},
                false,
                true}),
    [](const auto& info) { return info.param.name; });

TEST(BendingWithinElements, bendingWithinTheSurfaceIsElastic)
{
  Bent element({"", ElementType::Hex8, {}, ElementForm::AssumedStrain});
  const Real q = 0.5 * strength / young;
  element.bend(q, 10);
  EXPECT_EQ(element.energy(ElementEnergy::PlasticBending), 0);
  element.bend(-q, 10);
  EXPECT_NEAR(element.force() / element.limit(), 0, 1e-6);
}

TEST(BendingWithinElements, bendingRelaxesWithTheFlowOfTheElement)
{
  // Shear flows steadily at the rate d of equivalent plastic strain while bending goes on at q.
  // Stress follows the rate: s / Y = (rate of s if nothing flowed) / (3 G d) for small ones.
  Bent element({"", ElementType::Quad4, {}, ElementForm::AssumedStrain});
  const Real rate = 2e-2, shear = young / 2.6;
  const NodeVectors beside = field(element.start(),
                                   [&](const Vec3& p) {
                                     return Vec3{std::sqrt(3.0) * rate * p.y, 0, 0};
                                   });
  const Real q = 1e-3;
  element.bend(q, 4000, beside);
  // K = V/3 E/(1 - nu^2) / L^2 on q
  const Real stiffness = 1.0 / 3 * young / (1 - 0.09) / 0.25;
  EXPECT_NEAR(element.force() / (stiffness * q * strength / (3 * shear * rate)), 1, 5e-3);
}

TEST(BendingWithinElements, flowBesideStretchDoesNotDependOnTheStep)
{
  // Both rates are alike: neither half of the strength is found twice, nor forgotten.
  for (const ElementType type : {ElementType::Quad4, ElementType::Hex8})
  {
    Real before = 0;
    for (const int steps : {250, 1000, 4000})
    {
      Bent element({"", type, {}, ElementForm::AssumedStrain});
      const Real face = 0.02; // strain of bending at the faces
      const NodeVectors beside = field(element.start(),
                                       [&](const Vec3& p) {
                                         return Vec3{0.3 * face * p.x, 0, 0};
                                       });
      element.bend(0.5 * face, steps, beside);
      const Real bending = element.force() / element.limit(),
                 mean = element.block().vonMises(0) / strength;
      EXPECT_NEAR(bending * bending + mean * mean, 1, type == ElementType::Hex8 ? 0.1 : 0.03);
      EXPECT_GT(bending, 0.5);
      if (before != 0)
      {
        EXPECT_NEAR(bending, before, 0.01);
      }
      before = bending;
    }
  }
}

TEST(BendingWithinElements, hardensTheMaterial)
{
  // Half of the strain at the faces, on average, by the law that hardens with it.
  const Real modulus = 2e9, face = 0.05;
  Bent element({"", ElementType::Quad4, {}, ElementForm::AssumedStrain},
               makeJ2Plasticity(makeLinearElastic(young, 0.3, 7850), strength, modulus));
  element.bend(0.5 * face, 1000);
  const Real strain = element.block().history()(0, 0);
  EXPECT_NEAR(strain / (0.5 * face), 1.15, 0.15);
  EXPECT_NEAR(element.force() / element.limit(), 1 + modulus * strain / strength, 0.05);
}

TEST(BendingWithinElements, restsOnTheSurface)
{
  Bent element({"", ElementType::Hex8, {}});
  const NodeVectors beside = field(element.start(),
                                   [&](const Vec3& p) {
                                     return Vec3{2e-3 * p.x, 0, 0};
                                   });
  element.bend(2e-3, 100, beside);
  const Real held = element.force();
  EXPECT_GT(held, 0);
  element.bend(0, 1000);
  EXPECT_NEAR(element.force(), held, 1e-9 * held);
}

TEST(BendingWithinElements, brokenElementsRestAsTheyAre)
{
  // Pulled apart with a little bending: what resists the modes of material that bears nothing does
  // not flow, neither with more steps nor afterwards at rest.
  HolmquistJohnsonCook concrete{};
  concrete.elastic = {2440, 0, 14.86e9};
  concrete.strength = 48e6;
  concrete.cohesion = 0.79;
  concrete.pressureFactor = 1.6;
  concrete.pressureExponent = 0.61;
  concrete.mostStrength = 7;
  concrete.tension = 4e6;
  concrete.leastFracture = 0.01;
  concrete.damage1 = 0.04;
  concrete.damage2 = 1;
  concrete.crushPressure = 16e6;
  concrete.crushCompression = 0.001;
  concrete.lockPressure = 800e6;
  concrete.lockCompression = 0.1;
  concrete.locked[0] = 85e9;
  const Material law = completed(concrete);
  std::vector<Real> damages;
  for (const int steps : {500, 2000})
  {
    Bent element({"", ElementType::Hex8, {}}, law);
    const NodeVectors apart = field(element.start(),
                                    [](const Vec3& p) {
                                      return Vec3{p.x * 2e-4, p.y * 2e-4, p.z * 2e-4};
                                    });
    element.bend(1e-4, steps, apart);
    damages.push_back(element.history(HolmquistJohnsonCook::Damage));
    EXPECT_GT(damages.back(), 0);
    element.bend(0, 2000);
    EXPECT_NEAR(element.history(HolmquistJohnsonCook::Damage), damages.back(), 1e-6);
  }
  EXPECT_NEAR(damages[1], damages[0], 0.05 * damages[0]);
}

TEST(BendingWithinElements, brokenConcreteGivesItsBendingEnergyUp)
{
  // Bent within its strength, then pulled apart: what the modes had stored is lost with the crack.
  const Material concrete = makeLaw(concreteC40());
  Bent element({"", ElementType::Hex8, {}, ElementForm::OnePoint}, concrete);
  element.bend(1e-6, 10);
  const Real stored = element.energy(ElementEnergy::Hourglass);
  EXPECT_GT(stored, 0);
  EXPECT_EQ(element.energy(ElementEnergy::PlasticBending), 0);
  const NodeVectors apart = field(element.start(),
                                  [](const Vec3& p) {
                                    return Vec3{p.x * 5e-3, 0, 0};
                                  });
  element.bend(0, 2000, apart);
  EXPECT_NEAR(element.energy(ElementEnergy::PlasticBending), stored, 0.03 * stored);
  EXPECT_LT(std::abs(element.energy(ElementEnergy::Hourglass)), 0.03 * stored);
}
