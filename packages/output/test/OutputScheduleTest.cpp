#include <coplane_output/OutputSchedule.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
/// Cycles of 1 s, counted from 1, in which output is due.
std::vector<int> dueCycles(OutputSchedule schedule, int cycles)
{
  std::vector<int> due;
  schedule.startAt(0);
  for (int cycle = 1; cycle <= cycles; ++cycle)
    if (schedule.isDue(cycle))
      due.push_back(cycle);
  return due;
}
} // namespace

TEST(OutputSchedule, firstCycleAtOrAfterEachMultipleIsDue)
{
  // Multiples of 2.5: 2.5, 5, 7.5, 10.
  EXPECT_EQ(dueCycles(OutputSchedule({2.5, {}}), 10), (std::vector<int>{3, 5, 8, 10}));
}

TEST(OutputSchedule, stepsAreCountedBeforehand)
{
  for (const OutputTimes& when :
       {OutputTimes{0, {}}, OutputTimes{0, {0.3, 0.7}}, OutputTimes{0.1, {}}, OutputTimes{0.3, {}},
        OutputTimes{0.1, {0.55, 0.3, 0.999}}, OutputTimes{2, {5}}})
    for (const double begin : {0.0, 0.25})
    {
      OutputSchedule schedule(when);
      schedule.startAt(begin);
      constexpr int cycles = 10000;
      int steps = 1; // the first state
      for (int cycle = 1; cycle <= cycles; ++cycle)
        steps += schedule.isDue(begin + (1 - begin) * cycle / cycles) || cycle == cycles;
      EXPECT_EQ(outputSteps(when, begin, 1), steps) << when.every << " from " << begin;
    }
}

TEST(OutputSchedule, explicitTimesAreDueInAnyOrder)
{
  EXPECT_EQ(dueCycles(OutputSchedule({0, {7.2, 3}}), 10), (std::vector<int>{3, 8}));
}

TEST(OutputSchedule, severalDueTimesInOneCycleGiveOneOutput)
{
  // Every 0.25 s and at 2.5 and 2.75 s: each cycle of 1 s passes several.
  EXPECT_EQ(dueCycles(OutputSchedule({0.25, {2.5, 2.75}}), 3), (std::vector<int>{1, 2, 3}));
}

TEST(OutputSchedule, nothingIsDueWithoutTimes)
{
  EXPECT_TRUE(dueCycles(OutputSchedule(OutputTimes{}), 10).empty());
}

TEST(OutputSchedule, multiplesDoNotDrift)
{
  // 0.1 is no binary fraction: summing it 10^5 times drifts by many units in the last place, but
  // the cycle of each output stays k * 10.
  OutputSchedule schedule({0.1, {}});
  schedule.startAt(0);
  Real time = 0;
  for (int cycle = 1; cycle <= 100000; ++cycle)
  {
    time += 0.01;
    ASSERT_EQ(schedule.isDue(time), cycle % 10 == 0) << "cycle " << cycle;
  }
}

TEST(OutputSchedule, whatLiesBeforeTheStartIsNotDue)
{
  OutputSchedule schedule({1, {0.5, 3.5}});
  schedule.startAt(3);
  EXPECT_FALSE(schedule.isDue(3.25));
  EXPECT_TRUE(schedule.isDue(3.5));
  EXPECT_FALSE(schedule.isDue(3.75));
  EXPECT_TRUE(schedule.isDue(4));
}

TEST(OutputSchedule, everyCycleIsDueHoweverSmallTheInterval)
{
  for (const Real every : {1e-9, 1e-25, 1e-300, 5e-324})
    EXPECT_EQ(dueCycles(OutputSchedule({every, {}}), 4), (std::vector<int>{1, 2, 3, 4})) << every;
}
} // namespace coplane
