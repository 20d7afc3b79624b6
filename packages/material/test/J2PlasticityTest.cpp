#include "Advance.hpp"

#include <coplane_core/Lanes.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace coplane;
using coplane::testing::advance;

namespace
{
const J2Plasticity steel = makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 400e6, 1e9);
const J2Plasticity perfect = makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 400e6, 0);

Real vonMises(const SymTensor& s)
{
  const Real p = (s.xx + s.yy + s.zz) / 3;
  return std::sqrt(1.5 * ((s.xx - p) * (s.xx - p) + (s.yy - p) * (s.yy - p) +
                          (s.zz - p) * (s.zz - p) + 2 * (s.xy * s.xy + s.yz * s.yz + s.zx * s.zx)));
}
} // namespace

TEST(J2Plasticity, uniaxialStrainYieldsAtTheHugoniotElasticLimit)
{
  // Uniaxial strain: q = 2 G e, sigma_xx = M e. Yield at e = Y / 2G, so HEL = Y M / 2G = Y
  // (1-nu)/(1-2nu) = 1.75 Y = 700 MPa.
  SymTensor stress;
  Real plasticStrain = 0;
  const Real twoG = 2 * perfect.elastic.shearModulus;
  advance(perfect, SymTensor{-400e6 / twoG * (1 - 1e-12), 0, 0, 0, 0, 0}, stress, plasticStrain);
  EXPECT_EQ(plasticStrain, 0);
  EXPECT_NEAR(stress.xx, -700e6, 1e-3);

  // Beyond it the stress grows with K: the deviator stays at 2/3 Y.
  const Real more = 2e-3;
  advance(perfect, SymTensor{-more, 0, 0, 0, 0, 0}, stress, plasticStrain);
  EXPECT_NEAR(stress.xx, -700e6 - perfect.elastic.bulkModulus * more, 1);
  EXPECT_NEAR(stress.xx - stress.yy, -400e6, 1e-3);
}

TEST(J2Plasticity, returnEndsOnTheHardenedSurfaceAndKeepsThePressure)
{
  SymTensor stress{100e6, -50e6, 20e6, 30e6, -10e6, 5e6};
  const Real pressureBefore = stress.xx + stress.yy + stress.zz;
  Real plasticStrain = 0.01;
  const SymTensor increment{4e-3, -3e-3, 1e-3, 2e-3, -1e-3, 3e-3};
  const Real dissipation = advance(steel, increment, stress, plasticStrain);
  const Real yield = 400e6 + 1e9 * plasticStrain;
  EXPECT_GT(plasticStrain, 0.01);
  EXPECT_NEAR(vonMises(stress), yield, 1e-14 * 10 * yield); // a dozen roundings
  EXPECT_NEAR(stress.xx + stress.yy + stress.zz,
              pressureBefore + 3 * steel.elastic.bulkModulus * 2e-3, 1e-5);
  EXPECT_NEAR(dissipation, yield * (plasticStrain - 0.01), 1e-12 * dissipation);
}

TEST(J2Plasticity, pureShearFollowsTheElastoplasticSlope)
{
  // q = sqrt(3) tau. Tensor shear g in one step from nothing: q_trial = sqrt(3) 2 G g, dep =
  // (q_trial - Y) / (3G + H), tau = (Y + H dep) / sqrt(3).
  const Real g = 5e-3, shear = steel.elastic.shearModulus;
  const Real plastic = (std::sqrt(3.0) * 2 * shear * g - 400e6) / (3 * shear + 1e9);
  SymTensor stress;
  Real plasticStrain = 0;
  advance(steel, SymTensor{0, 0, 0, g, 0, 0}, stress, plasticStrain);
  EXPECT_NEAR(plasticStrain, plastic, 1e-15);
  EXPECT_NEAR(stress.xy, (400e6 + 1e9 * plastic) / std::sqrt(3.0), 1e-6);
  EXPECT_EQ(stress.xx, 0);
}

TEST(J2Plasticity, belowYieldHasTheBitsOfTheElasticLaw)
{
  const SymTensor increment{1e-4, -2e-4, 3e-5, 4e-5, -5e-5, 6e-5};
  SymTensor elastic{1e6, 2e6, 3e6, 4e6, 5e6, 6e6}, plastic = elastic;
  Real strainA = 0, strainB = 0;
  advance(steel.elastic, increment, elastic, strainA);
  EXPECT_EQ(advance(steel, increment, plastic, strainB), 0);
  EXPECT_EQ(elastic.xx, plastic.xx);
  EXPECT_EQ(elastic.zz, plastic.zz);
  EXPECT_EQ(elastic.zx, plastic.zx);
  EXPECT_EQ(strainB, 0);
}

TEST(J2Plasticity, noStrainAtNoStressIsNotDividedByZero)
{
  SymTensor stress;
  Real plasticStrain = 0;
  EXPECT_EQ(advance(steel, SymTensor{}, stress, plasticStrain), 0);
  EXPECT_EQ(stress.xx, 0);
}

TEST(J2Plasticity, everyLaneHasTheBitsOfTheScalar)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<Real> strain(-3e-3, 3e-3), start(-2e8, 2e8);
  for (int trial = 0; trial < 100; ++trial)
  {
    Real e[6][laneCount], s[6][laneCount], p[laneCount];
    for (int lane = 0; lane < laneCount; ++lane)
    {
      for (int k = 0; k < 6; ++k)
      {
        e[k][lane] = strain(random) * (lane % 2 ? 1 : 0.1); // lanes 0 and 2 mostly elastic
        s[k][lane] = start(random);
      }
      p[lane] = 1e-3 * lane;
    }
    const auto lanes = [](const Real* from) { return Lanes(from, stdx::element_aligned); };
    SymTensorOf<Lanes> stress{lanes(s[0]), lanes(s[1]), lanes(s[2]),
                              lanes(s[3]), lanes(s[4]), lanes(s[5])};
    Lanes plasticStrain = lanes(p);
    const Lanes dissipation = advance(steel,
                                      SymTensorOf<Lanes>{lanes(e[0]), lanes(e[1]), lanes(e[2]),
                                                         lanes(e[3]), lanes(e[4]), lanes(e[5])},
                                      stress, plasticStrain);
    for (int lane = 0; lane < laneCount; ++lane)
    {
      SymTensor one{s[0][lane], s[1][lane], s[2][lane], s[3][lane], s[4][lane], s[5][lane]};
      Real strainOne = p[lane];
      const Real lost = advance(
          steel, SymTensor{e[0][lane], e[1][lane], e[2][lane], e[3][lane], e[4][lane], e[5][lane]},
          one, strainOne);
      EXPECT_EQ(Real(dissipation[lane]), lost);
      EXPECT_EQ(Real(plasticStrain[lane]), strainOne);
      EXPECT_EQ(Real(stress.xx[lane]), one.xx);
      EXPECT_EQ(Real(stress.yy[lane]), one.yy);
      EXPECT_EQ(Real(stress.zz[lane]), one.zz);
      EXPECT_EQ(Real(stress.xy[lane]), one.xy);
      EXPECT_EQ(Real(stress.yz[lane]), one.yz);
      EXPECT_EQ(Real(stress.zx[lane]), one.zx);
    }
  }
}
