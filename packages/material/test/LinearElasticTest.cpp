#include "Advance.hpp"

#include <coplane_core/Lanes.hpp>

#include <gtest/gtest.h>

using namespace coplane;
using coplane::testing::advance;

namespace
{
const LinearElastic steel = makeLinearElastic(200e9, 0.3, 7850);
}

TEST(LinearElastic, uniaxialStrainFeelsTheModulusM)
{
  // E = 200, nu = 0.3: lambda = E nu / ((1+nu)(1-2nu)) = 115.384615.., 2G = 153.846153.., M =
  // lambda + 2G [GPa]
  SymTensor stress;
  Real plasticStrain = 0;
  const Real dissipation = advance(steel, SymTensor{1e-3, 0, 0, 0, 0, 0}, stress, plasticStrain);
  EXPECT_NEAR(stress.xx, 3500e6 / 13, 3500e6 * 1e-15); // (1500 + 2000) / 13 MPa
  EXPECT_NEAR(stress.yy, 1500e6 / 13, 1500e6 * 1e-15);
  EXPECT_EQ(stress.yy, stress.zz);
  EXPECT_EQ(stress.xy, 0);
  EXPECT_EQ(dissipation, 0);
  EXPECT_EQ(plasticStrain, 0);
}

TEST(LinearElastic, pureShearFeelsTwiceTheShearModulusPerTensorComponent)
{
  // Tensor shear 1e-3 is an engineering shear of 2e-3: stress 2e-3 G, G = 200 / 2.6 GPa.
  SymTensor stress;
  Real plasticStrain = 0;
  advance(steel, SymTensor{0, 0, 0, 1e-3, 2e-3, 3e-3}, stress, plasticStrain);
  EXPECT_NEAR(stress.xy, 2e-3 * 200e9 / 2.6, 1e-6);
  EXPECT_NEAR(stress.yz, 4e-3 * 200e9 / 2.6, 1e-6);
  EXPECT_NEAR(stress.zx, 6e-3 * 200e9 / 2.6, 1e-6);
  EXPECT_EQ(stress.xx, 0);
}

TEST(LinearElastic, volumeChangeFeelsThreeTimesTheBulkModulus)
{
  // K = E / (3 (1 - 2 nu)) = 500/3 GPa; equal strains e give 3 K e on every axis.
  SymTensor stress;
  Real plasticStrain = 0;
  advance(steel, SymTensor{-1e-4, -1e-4, -1e-4, 0, 0, 0}, stress, plasticStrain);
  EXPECT_NEAR(stress.xx, -50e6, 1e-7);
  EXPECT_NEAR(stress.zz, -50e6, 1e-7);
}

TEST(LinearElastic, incrementsAddToTheStressThatIsThere)
{
  SymTensor stress{1, 2, 3, 4, 5, 6};
  Real plasticStrain = 0.5;
  advance(steel, SymTensor{}, stress, plasticStrain);
  EXPECT_EQ(stress.xx, 1);
  EXPECT_EQ(stress.zx, 6);
  EXPECT_EQ(plasticStrain, 0.5);
}
