#include <coplane_core/CompensatedSum.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
TEST(CompensatedSum, losesNoSmallTerms)
{
  Vec3 sum{4.5e6, -5.2e6, 0}, rest{};
  const Vec3 step{1e-10, -3e-11, 7e-12};
  Vec3 plain = sum;
  for (int i = 0; i < 100000; ++i)
  {
    addCompensated(sum, rest, step);
    plain += step;
  }
  EXPECT_EQ(plain.x, 4.5e6); // what it is for
  EXPECT_NEAR((sum.x - 4.5e6) + rest.x, 1e-5, 1e-16);
  EXPECT_NEAR((sum.y + 5.2e6) + rest.y, -3e-6, 1e-16);
  EXPECT_NEAR(sum.z + rest.z, 7e-7, 1e-20);
  EXPECT_LT(std::abs(rest.x), 1e-9);
}

TEST(CompensatedSum, isNoWorseThanASumWhateverTheTermsAre)
{
  for (const Real large : {1.0, 1e10, -3e5})
  {
    Real sum = .1, rest = 0;
    addCompensated(sum, rest, large);
    addCompensated(sum, rest, -large);
    EXPECT_NEAR(sum + rest, .1, 1.2e-16 * std::abs(large)) << large;
  }
  Real sum = 3, rest = 0;
  for (int i = 0; i < 10; ++i)
    addCompensated(sum, rest, 0);
  EXPECT_EQ(sum, 3);
  EXPECT_EQ(rest, 0);
}
} // namespace
} // namespace coplane
