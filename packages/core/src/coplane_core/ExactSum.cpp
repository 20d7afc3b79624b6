#include <coplane_core/ExactSum.hpp>

#include <cmath>
#include <cstring>

namespace coplane
{
void ExactSum::addTerm(Real value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  const int biased = int((bits >> 52) & 0x7ff);
  if (biased == 0x7ff)
  {
    ++notFinite_;
    return;
  }
  const std::uint64_t fraction = bits & 0xfffffffffffffull;
  const std::uint64_t mantissa = biased == 0 ? fraction : fraction | 0x10000000000000ull;
  const int exponent = (biased == 0 ? 1 : biased) - 1075; // value = mantissa * 2^exponent
  const int position = exponent - lowestBit;
  const int first = position / 32;
  const int shift = position % 32;
  // mantissa << shift has at most 84 bits: three limbs.
  const unsigned __int128 wide = static_cast<unsigned __int128>(mantissa) << shift;
  // Signs of momenta are as good as random: no branch. (x ^ -1) - (-1) = -x.
  const std::int64_t sign = std::int64_t(bits) >> 63;
  const auto add = [&](int limb, std::uint64_t digit)
  { limb_[limb] += (std::int64_t(digit & 0xffffffffull) ^ sign) - sign; };
  add(first, std::uint64_t(wide));
  add(first + 1, std::uint64_t(wide >> 32));
  add(first + 2, std::uint64_t(wide >> 64));
  if (++additions_ >= additionsBeforeCarry)
    carry();
}

void ExactSum::add(const ExactSum& other)
{
  ExactSum copy = other;
  copy.carry();
  carry();
  for (int i = 0; i < limbs; ++i)
    limb_[i] += copy.limb_[i];
  notFinite_ += copy.notFinite_;
  additions_ += 2;
}

void ExactSum::carry()
{
  for (int i = 0; i + 1 < limbs; ++i)
  {
    const std::int64_t over = limb_[i] >> 32; // floor division, also for negative limbs
    limb_[i] -= over * (std::int64_t(1) << 32);
    limb_[i + 1] += over;
  }
  additions_ = 1;
}

Real ExactSum::value() const
{
  if (notFinite_ > 0)
    return std::numeric_limits<Real>::quiet_NaN();
  ExactSum copy = *this;
  copy.carry();
  const bool negative = copy.limb_[limbs - 1] < 0;
  if (negative)
  {
    for (auto& limb : copy.limb_)
      limb = -limb;
    copy.carry();
  }
  // All limbs are now in [0, 2^32): the four leading ones hold at least 96 significant bits.
  int top = limbs - 1;
  while (top > 0 && copy.limb_[top] == 0)
    --top;
  Real result = 0;
  for (int i = std::max(0, top - 3); i <= top; ++i)
    result += std::ldexp(Real(copy.limb_[i]), 32 * i + lowestBit);
  return negative ? -result : result;
}

std::vector<Real> ExactSum::overRanks(std::vector<ExactSum>& sums, const Comm& comm)
{
  std::vector<Real> values;
  values.reserve(sums.size());
  for (const ExactSum& total : totals(sums, comm))
    values.push_back(total.value());
  return values;
}

std::array<Real, ExactSum::digitCount> ExactSum::digits() const
{
  ExactSum copy = *this;
  copy.carry();
  std::array<Real, digitCount> digits{};
  for (int i = 0; i < limbs; ++i)
    digits[i] = Real(copy.limb_[i]);
  digits[limbs] = Real(notFinite_);
  return digits;
}

ExactSum ExactSum::fromDigits(const Real* digits)
{
  ExactSum sum;
  for (int i = 0; i < limbs; ++i)
    sum.limb_[i] = std::int64_t(digits[i]);
  sum.notFinite_ = std::int64_t(digits[limbs]);
  sum.additions_ = 1;
  return sum;
}

std::vector<ExactSum> ExactSum::totals(std::vector<ExactSum>& sums, const Comm& comm)
{
  std::vector<std::int64_t> all;
  all.reserve(sums.size() * (limbs + 1));
  for (auto& sum : sums)
  {
    sum.carry();
    all.insert(all.end(), sum.limb_.begin(), sum.limb_.end());
    all.push_back(sum.notFinite_);
  }
  if (!all.empty())
    comm.sum(all);
  std::vector<ExactSum> totals(sums.size());
  for (std::size_t s = 0; s < sums.size(); ++s)
  {
    ExactSum& total = totals[s];
    for (int i = 0; i < limbs; ++i)
      total.limb_[i] = all[s * (limbs + 1) + i];
    total.notFinite_ = all[s * (limbs + 1) + limbs];
    total.carry();
  }
  return totals;
}
} // namespace coplane
