#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/Real.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace coplane
{
/// Sum of doubles without rounding: a fixed-point number wide enough for every double, so the
/// result, rounded once at the end, does not depend on the order, hence not on ranks, threads or
/// back end. Not finite terms make the sum not a number.
class ExactSum
{
public:
  void add(Real value)
  {
    if (value != 0) // of many terms most are
      addTerm(value);
  }
  void add(const ExactSum& other);

  /// The sum so far on this rank, correctly rounded to within one unit in the last place, a
  /// function of the exact sum alone.
  Real value() const;

  /// Sums of all ranks, one value per accumulator, the same bits on every rank. One message for
  /// all. Collective.
  static std::vector<Real> overRanks(std::vector<ExactSum>& sums, const Comm& comm);
  /// The same, exact. Collective.
  static std::vector<ExactSum> totals(std::vector<ExactSum>& sums, const Comm& comm);

  /// The exact sum as whole numbers, each exact in a Real, for checkpoints.
  static constexpr int digitCount = 69;
  std::array<Real, digitCount> digits() const;
  static ExactSum fromDigits(const Real* digits);

private:
  // Limb i holds a signed count of 2^(32 i - 1088). Each add puts at most 2^32 into a limb, so 2^30
  // additions fit before a carry is needed; carries are propagated well before.
  static constexpr int limbs = digitCount - 1;
  static constexpr int lowestBit = -1088;
  static constexpr std::int64_t additionsBeforeCarry = std::int64_t(1) << 29;

  void addTerm(Real value);
  void carry();

  std::array<std::int64_t, limbs> limb_{};
  std::int64_t additions_ = 0;
  std::int64_t notFinite_ = 0;
};

/// Several of them; as many on both sides of add().
struct ExactSums
{
  std::vector<ExactSum> each;

  ExactSum& operator[](std::size_t i) { return each[i]; }
  void add(const ExactSums& others)
  {
    for (std::size_t i = 0; i < each.size(); ++i)
      each[i].add(others.each[i]);
  }
};
} // namespace coplane
