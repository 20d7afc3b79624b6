#include <coplane_core/Backend.hpp>
#include <coplane_core/ExactSum.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace coplane::testing
{
namespace
{
struct Whole
{
  std::int64_t value = 0;

  void add(const Whole& other) { value += other.value; }
};
} // namespace

TEST(Backend, sumsInPartsTakeAllOnce)
{
  for (const std::size_t n : {0, 1, 2, 511, 512, 513, 100000})
  {
    const Whole sum = sumInParts(
        "sum", n, Whole{}, [](Whole& mine, std::size_t i) { mine.value += std::int64_t(i) + 1; });
    EXPECT_EQ(sum.value, std::int64_t(n) * std::int64_t(n + 1) / 2) << n;
  }
}

TEST(Backend, exactSumsInPartsAreThoseOfOneThread)
{
  constexpr std::size_t n = 3000;
  const auto term = [](std::size_t i)
  { return std::sin(Real(i)) * std::pow(10.0, int(i % 37) - 18); };
  std::vector<ExactSum> alone(2);
  for (std::size_t i = 0; i < n; ++i)
  {
    alone[0].add(term(i));
    alone[1].add(-3 * term(i));
  }
  const ExactSums together = sumInParts("sum", n, ExactSums{std::vector<ExactSum>(2)},
                                        [&](ExactSums& mine, std::size_t i)
                                        {
                                          mine[0].add(term(i));
                                          mine[1].add(-3 * term(i));
                                        });
  for (std::size_t s = 0; s < 2; ++s)
    EXPECT_EQ(together.each[s].value(), alone[s].value());
}

TEST(Backend, unevenWorkIsDoneOnceEach)
{
  for (const int n : {0, 1, 3, 1000})
  {
    std::vector<int> done(std::size_t(n), 0);
    parallelForUneven("work", n, [&](const int i) { ++done[std::size_t(i)]; });
    EXPECT_EQ(done, std::vector<int>(std::size_t(n), 1));
  }
}
} // namespace coplane::testing
