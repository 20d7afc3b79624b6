#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_element/detail/Cofactors.hpp>
#include <coplane_element/detail/HughesWinget.hpp>

namespace coplane
{
/// Stress after a step of the spin W by the first-order rule s + dt (W s - s W).
template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> turnedFirstOrder(const SymTensorOf<T>& s,
                                                       const Mat3Of<T>& displacementGradient)
{
  const Mat3Of<T>& l = displacementGradient;
  const T half(0.5);
  const T wxy = half * (l(0, 1) - l(1, 0)), wyz = half * (l(1, 2) - l(2, 1)),
          wzx = half * (l(2, 0) - l(0, 2));
  const T full[3][3] = {{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}};
  const T w[3][3] = {{T(0.0), wxy, -wzx}, {-wxy, T(0.0), wyz}, {wzx, -wyz, T(0.0)}};
  const auto change = [&](int i, int j)
  {
    T sum(0.0);
    for (int k = 0; k < 3; ++k)
      sum += w[i][k] * full[k][j] + w[j][k] * full[k][i];
    return sum;
  };
  return {s.xx + change(0, 0), s.yy + change(1, 1), s.zz + change(2, 2),
          s.xy + change(0, 1), s.yz + change(1, 2), s.zx + change(2, 0)};
}

template <class T>
KOKKOS_INLINE_FUNCTION Mat3Of<T> inverseTransposed(const Mat3Of<T>& a)
{
  Mat3Of<T> c;
  inverseTransposed(a.a, c.a);
  return c;
}

/// Rotation of the polar decomposition of a matrix with positive determinant: Newton's iteration
/// R <- (R + R^-T)/2 (Higham 1986), a fixed number of rounds, so that every lane does the same.
/// Ten rounds reach rounding for stretches between 1/30 and 30; in a plane the answer is closed.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3Of<T> polarRotation(Mat3Of<T> r, int rounds = 10)
{
  for (int round = 0; round < rounds; ++round)
  {
    const Mat3Of<T> other = inverseTransposed(r);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        r(i, j) = T(0.5) * (r(i, j) + other(i, j));
  }
  return r;
}

template <class T>
KOKKOS_INLINE_FUNCTION Mat3Of<T> polarRotationInPlane(const Mat3Of<T>& f)
{
  const T c = f(0, 0) + f(1, 1), s = f(1, 0) - f(0, 1), zero(0.0);
  const T scale = T(1.0) / branchFree::squareRoot(c * c + s * s);
  return {{{scale * c, -scale * s, zero}, {scale * s, scale * c, zero}, {zero, zero, T(1.0)}}};
}

template <class T>
KOKKOS_INLINE_FUNCTION Mat3Of<T> timesTransposed(const Mat3Of<T>& a, const Mat3Of<T>& b)
{
  Mat3Of<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c(i, j) = a(i, 0) * b(j, 0) + a(i, 1) * b(j, 1) + a(i, 2) * b(j, 2);
  return c;
}

/// The deformation gradient after a step whose displacement gradient, by the positions in its
/// middle, is l: F <- (1 - l/2)^-1 (1 + l/2) F, exact for a homogeneous deformation.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3Of<T> advancedDeformation(const Mat3Of<T>& l, const Mat3Of<T>& f)
{
  Mat3Of<T> minus, plusF;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const T half = T(0.5) * l(i, j);
      minus(i, j) = T(i == j ? 1.0 : 0.0) - half;
      plusF(i, j) = f(i, j) + T(0.5) * (l(i, 0) * f(0, j) + l(i, 1) * f(1, j) + l(i, 2) * f(2, j));
    }
  const Mat3Of<T> inverse = inverseTransposed(minus);
  Mat3Of<T> result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      result(i, j) =
          inverse(0, i) * plusF(0, j) + inverse(1, i) * plusF(1, j) + inverse(2, i) * plusF(2, j);
  return result;
}

/// Green and Naghdi (1965): rotation of the step from the polar decompositions at its ends, strain
/// increment turned from the middle to the end of the step.
/// @param f deformation gradient, at the start and afterwards at the end
template <int dim, class T>
KOKKOS_INLINE_FUNCTION void greenNaghdi(const Mat3Of<T>& l, Mat3Of<T>& f, Mat3Of<T>& rotation,
                                        SymTensorOf<T>& strainIncrement)
{
  const auto polar = [](const Mat3Of<T>& m)
  {
    if constexpr (dim == 3)
      return polarRotation(m);
    else
      return polarRotationInPlane(m);
  };
  const Mat3Of<T> end = advancedDeformation(l, f);
  Mat3Of<T> middle;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      middle(i, j) = T(0.5) * (f(i, j) + end(i, j));
  const Mat3Of<T> atEnd = polar(end);
  rotation = timesTransposed(atEnd, polar(f));
  strainIncrement = rotated(strainIncrement, timesTransposed(atEnd, polar(middle)));
  f = end;
}
} // namespace coplane
