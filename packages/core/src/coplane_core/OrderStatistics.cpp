#include <coplane_core/OrderStatistics.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace coplane
{
namespace
{
constexpr std::uint64_t signBit = std::uint64_t(1) << 63;

/// Bits of a double as a number with the same order.
std::uint64_t orderOf(Real value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits & signBit ? ~bits : bits | signBit;
}

Real valueOf(std::uint64_t order)
{
  const std::uint64_t bits = order & signBit ? order & ~signBit : ~order;
  Real value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
} // namespace

std::vector<Real> orderStatistics(std::vector<Real> mine, const std::vector<Real>& fractions,
                                  const Comm& comm)
{
  const std::int64_t count = comm.sum(std::int64_t(mine.size()));
  if (count == 0)
    return {};
  std::vector<std::uint64_t> orders;
  for (const Real value : mine)
    orders.push_back(orderOf(value));
  std::sort(orders.begin(), orders.end());

  // Bisection over the 64 bits: the smallest number that enough values do not exceed.
  std::vector<std::uint64_t> found(fractions.size(), 0);
  for (int bit = 63; bit >= 0; --bit)
  {
    std::vector<std::int64_t> below(fractions.size());
    for (std::size_t i = 0; i < fractions.size(); ++i)
      below[i] =
          std::lower_bound(orders.begin(), orders.end(), found[i] + (std::uint64_t(1) << bit)) -
          orders.begin();
    comm.sum(below);
    for (std::size_t i = 0; i < fractions.size(); ++i)
    {
      const std::int64_t wanted =
          std::max<std::int64_t>(1, std::int64_t(std::ceil(fractions[i] * Real(count))));
      if (below[i] < wanted)
        found[i] += std::uint64_t(1) << bit;
    }
  }
  std::vector<Real> values;
  for (const std::uint64_t order : found)
    values.push_back(valueOf(order));
  return values;
}
} // namespace coplane
