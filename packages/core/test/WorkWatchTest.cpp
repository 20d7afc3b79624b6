#include <coplane_core/WorkWatch.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

namespace coplane
{
TEST(WorkWatch, countsWorkAndNotWaiting)
{
  double waited = 0, worked = 0;
  {
    const WorkWatch watch(waited);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  {
    const WorkWatch watch(worked);
    volatile double sum = 0;
    for (int i = 1; i < 100000; ++i)
      sum = sum + std::sqrt(double(i));
  }
  EXPECT_LT(waited, 0.05); // of 0.1 s, in which the processor did other things
  EXPECT_GT(worked, 0);
}

TEST(WorkWatch, addsToWhatIsThere)
{
  double sum = 5;
  {
    const WorkWatch watch(sum);
  }
  EXPECT_GE(sum, 5);
  EXPECT_LT(sum, 6);
}
} // namespace coplane
