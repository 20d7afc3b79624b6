#include <coplane_core/Error.hpp>
#include <coplane_material/Material.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace coplane;

TEST(Material, modulusOfCompressionWavesFollowsFromYoungAndPoisson)
{
  // M = E (1-nu) / ((1+nu)(1-2nu)) = 200 * 0.7 / (1.3 * 0.4) GPa; c = sqrt(M / rho)
  const Material steel = makeLinearElastic(200e9, 0.3, 7850);
  EXPECT_NEAR(pWaveModulus(steel), 140e9 / 0.52, 1e-3);
  EXPECT_NEAR(soundSpeed(steel), std::sqrt(140e9 / 0.52 / 7850), 1e-9);
  EXPECT_NEAR(lameLambda(elasticity(steel)), 60e9 / 0.52, 1e-3);
  EXPECT_EQ(density(steel), 7850);
}

TEST(Material, plasticLawsHaveTheElasticPartOfTheirConstants)
{
  const Material plastic = makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 400e6, 0);
  EXPECT_EQ(soundSpeed(plastic), soundSpeed(makeLinearElastic(200e9, 0.3, 7850)));
}

TEST(Material, impossibleConstantsAreRefusedWithTheNumberAndTheRange)
{
  try
  {
    makeLinearElastic(200e9, 0.5, 7850);
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Deck);
    EXPECT_NE(std::string(error.what()).find("Poisson's ratio is 0.5"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("between -1 and 0.5"), std::string::npos);
  }
  EXPECT_THROW(makeLinearElastic(-1, 0.3, 7850), Error);
  EXPECT_THROW(makeLinearElastic(200e9, 0.3, 0), Error);
  EXPECT_THROW(makeLinearElastic(std::nan(""), 0.3, 1), Error);
  EXPECT_THROW(makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 0, 0), Error);
  EXPECT_THROW(makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 1, -1), Error);
}
