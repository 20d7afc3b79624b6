#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// Principal values, falling, and their directions as the columns of `axes`.
template <class T>
struct Principal
{
  T value[3];
  Mat3Of<T> axes;
};

/// Jacobi's rotations, six times around: exact to rounding.
template <class T>
KOKKOS_INLINE_FUNCTION Principal<T> principalOf(const SymTensorOf<T>& s)
{
  using branchFree::choose;
  const T zero(0.0), one(1.0), two(2.0);
  T a[3][3] = {{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}};
  Principal<T> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r.axes(i, j) = i == j ? one : zero;
  for (int sweep = 0; sweep < 6; ++sweep)
    for (int i = 0; i < 2; ++i)
      for (int j = i + 1; j < 3; ++j)
      {
        const auto needed = branchFree::absolute(a[i][j]) > zero;
        const T theta = (a[j][j] - a[i][i]) / (two * choose(needed, a[i][j], one));
        const T size =
            one / (branchFree::absolute(theta) + branchFree::squareRoot(theta * theta + one));
        const T t = choose(needed, choose(theta < zero, -size, size), zero);
        const T c = one / branchFree::squareRoot(t * t + one), d = t * c;
        const T off = a[i][j];
        a[i][i] -= t * off;
        a[j][j] += t * off;
        a[i][j] = a[j][i] = zero;
        const int k = 3 - i - j;
        const T ki = a[k][i], kj = a[k][j];
        a[k][i] = a[i][k] = c * ki - d * kj;
        a[k][j] = a[j][k] = d * ki + c * kj;
        for (int m = 0; m < 3; ++m)
        {
          const T mi = r.axes(m, i), mj = r.axes(m, j);
          r.axes(m, i) = c * mi - d * mj;
          r.axes(m, j) = d * mi + c * mj;
        }
      }
  for (int i = 0; i < 3; ++i)
    r.value[i] = a[i][i];
  const auto order = [&](int i, int j)
  {
    const auto swap = r.value[i] < r.value[j];
    const auto exchange = [&](T& x, T& y)
    {
      const T kept = x;
      x = choose(swap, y, x);
      y = choose(swap, kept, y);
    };
    exchange(r.value[i], r.value[j]);
    for (int m = 0; m < 3; ++m)
      exchange(r.axes(m, i), r.axes(m, j));
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return r;
}

/// q = sqrt(3/2 s:s) of principal stresses.
template <class T>
KOKKOS_INLINE_FUNCTION T vonMisesOf(const T (&s)[3])
{
  const T a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return branchFree::squareRoot(T(0.5) * (a * a + b * b + c * c));
}

/// The tensor with these principal values.
template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> tensorOf(const Principal<T>& p)
{
  const auto entry = [&](int i, int j)
  {
    return p.value[0] * p.axes(i, 0) * p.axes(j, 0) + p.value[1] * p.axes(i, 1) * p.axes(j, 1) +
           p.value[2] * p.axes(i, 2) * p.axes(j, 2);
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)};
}
} // namespace coplane
