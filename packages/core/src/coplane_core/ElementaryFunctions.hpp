#pragma once

#include <coplane_core/BranchFree.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

// Exponential, logarithm and the cosine of a third of an angle, in operations that IEEE 754 defines
// to the last bit: the same for one number (Real) and for several side by side (Lanes), for any
// number of lanes, and for any version of the mathematics library, without a call for each lane.
namespace coplane::branchFree
{
namespace elementary
{
/// Integers of 64 bits, as many as T has numbers.
template <class T>
struct BitsOf
{
  using Type = std::uint64_t;
};
template <>
struct BitsOf<Lanes>
{
  using Type = stdx::rebind_simd_t<std::uint64_t, Lanes>;
};
template <class T>
using Bits = typename BitsOf<T>::Type;

template <class T>
KOKKOS_FORCEINLINE_FUNCTION Bits<T> bitsOf(const T& a)
{
  Bits<T> bits;
  static_assert(sizeof bits == sizeof a, "a double has 64 bits");
  std::memcpy(static_cast<void*>(&bits), &a, sizeof bits);
  return bits;
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T numberOf(const Bits<T>& bits)
{
  T a;
  std::memcpy(static_cast<void*>(&a), &bits, sizeof a);
  return a;
}

constexpr int mantissaBits = 52, bias = 1023;
/// 1.5 2^52: a sum with it has a whole number in its last bits.
constexpr Real whole = 6755399441055744.0;
/// ln 2 in two parts; the first one times a whole number below 2^20 is exact.
constexpr Real ln2High = 6.93147180369123816490e-01, ln2Low = 1.90821492927058770002e-10;

/// 2^n of a whole number n between -1022 and 1023, given as n + whole.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T powerOfTwo(const T& nAndWhole)
{
  const Bits<T> n = bitsOf(nAndWhole) - bitsOf(T(whole));
  return numberOf<T>((n + Bits<T>(bias)) << mantissaBits);
}
} // namespace elementary

/// e^a, within one unit in the last place; 0 and infinity beyond the range of doubles.
///
/// With a = n ln 2 + r, |r| <= ln 2 / 2: the function r (e^r + 1) / (e^r - 1) is even and nearly
/// 2 + r^2/6, so a short polynomial in r^2 gives it; e^r follows.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T exponential(const T& a)
{
  using namespace elementary;
  constexpr Real least = -745.2, largest = 709.79; // beyond: 0, infinity
  const T x = choose(a < T(largest), choose(a > T(least), a, T(least)), T(largest));
  const T nAndWhole = x * T(1.44269504088896338700) + T(whole);
  const T n = nAndWhole - T(whole);
  const T high = x - n * T(ln2High), low = n * T(ln2Low);
  const T r = high - low, z = r * r;
  const T c =
      r - z * (T(1.66666666666666019037e-01) +
               z * (T(-2.77777777770155933842e-03) +
                    z * (T(6.61375632143793436117e-05) + z * (T(-1.65339022054652515390e-06) +
                                                              z * T(4.13813679705723846039e-08)))));
  const T power = T(1.0) - ((low - (r * c) / (T(2.0) - c)) - high);
  // In two steps, each within the range of exponents.
  const T halfAndWhole = T(0.5) * n + T(whole), half = halfAndWhole - T(whole);
  const T scaled = power * powerOfTwo(halfAndWhole) * powerOfTwo(T((n - half) + T(whole)));
  return choose(a == a, scaled, a);
}

/// Natural logarithm, within one unit in the last place; -infinity of zero, not a number below.
///
/// With a = 2^k (1 + f), s = f / (2 + f): ln(1 + f) = 2 s + 2/3 s^3 + ..., of which what lies
/// beyond f - f^2/2 is a polynomial in s^2.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T logarithm(const T& a)
{
  using namespace elementary;
  constexpr Real leastNormal = 2.2250738585072014e-308, twoTo54 = 18014398509481984.0;
  const auto isSmall = a < T(leastNormal);
  const T x = choose(isSmall, a * T(twoTo54), a);
  // 1 + f lies between the root of 1/2 and the root of 2.
  const Bits<T> rootOfHalf(0x3FE6A09E667F3BCDull), one(std::uint64_t(bias) << mantissaBits);
  const Bits<T> biased = ((bitsOf(x) - rootOfHalf) + one) >> mantissaBits;
  const Bits<T> exponent = biased - Bits<T>(bias);
  const T f = numberOf<T>(bitsOf(x) - (exponent << mantissaBits)) - T(1.0);
  const T k =
      (numberOf<T>(exponent + bitsOf(T(whole))) - T(whole)) - choose(isSmall, T(54.0), T(0.0));
  const T s = f / (T(2.0) + f), z = s * s, w = z * z;
  const T odd = z * (T(6.666666666666735130e-01) +
                     w * (T(2.857142874366239149e-01) +
                          w * (T(1.818357216161805012e-01) + w * T(1.479819860511658591e-01))));
  const T even = w * (T(3.999999999940941908e-01) +
                      w * (T(2.222219843214978396e-01) + w * T(1.531383769920937332e-01)));
  const T halfSquare = T(0.5) * f * f;
  const T result =
      k * T(ln2High) - ((halfSquare - (s * (halfSquare + (odd + even)) + k * T(ln2Low))) - f);
  constexpr Real infinite = std::numeric_limits<Real>::infinity();
  const T special = choose(a == T(0.0), T(-infinite),
                           choose(a > T(0.0), a, T(std::numeric_limits<Real>::quiet_NaN())));
  return choose(a > T(0.0) && a < T(infinite), result, special);
}

/// cos(arccos(c) / 3) for c in [-1, 1], within two units in the last place: between 1/2 and 1.
/// Less counts as -1, more, and what is no number, as 1.
///
/// It is the largest root y of 4 y^3 - 3 y = c. With u = 2 y - 1 that is u^2 (u + 3) = 2 (1 + c),
/// which is well conditioned where angles meet at c = -1; Newton's method needs three rounds.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T cosineOfThird(const T& c)
{
  using namespace elementary;
  const T clamped = choose(c < T(1.0), choose(c > T(-1.0), c, T(-1.0)), T(1.0));
  const T q = T(2.0) * (T(1.0) + clamped);
  const T first = squareRoot(q * T(1.0 / 3.0));
  const T nearly = first * (T(1.0) - T(0.134) * first);     // within 3 %
  T u = first / squareRoot(T(1.0) + nearly * T(1.0 / 3.0)); // within 0.4 %
  for (int round = 0; round < 3; ++round)
  {
    const T slope = (T(3.0) * u + T(6.0)) * u;
    const T step = ((u + T(3.0)) * u * u - q) / choose(slope > T(0.0), slope, T(1.0));
    u = u - step;
  }
  return T(0.5) * (T(1.0) + u);
}
} // namespace coplane::branchFree
