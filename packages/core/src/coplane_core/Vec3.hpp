#pragma once

#include <coplane_core/Real.hpp>

#include <Kokkos_Core.hpp>

#include <cmath>

namespace coplane
{
/// Vector in the global axes. In two dimensions z is zero. T is Real, or Lanes for several elements
/// side by side.
template <class T>
struct Vec3Of
{
  T x{}, y{}, z{};

  KOKKOS_FORCEINLINE_FUNCTION constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  KOKKOS_FORCEINLINE_FUNCTION constexpr const T& operator[](int i) const
  {
    return i == 0 ? x : i == 1 ? y : z;
  }
  KOKKOS_FORCEINLINE_FUNCTION constexpr Vec3Of& operator+=(const Vec3Of& b)
  {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  KOKKOS_FORCEINLINE_FUNCTION constexpr Vec3Of& operator-=(const Vec3Of& b)
  {
    x -= b.x;
    y -= b.y;
    z -= b.z;
    return *this;
  }
};

using Vec3 = Vec3Of<Real>;

template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr Vec3Of<T> operator+(const Vec3Of<T>& a, const Vec3Of<T>& b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr Vec3Of<T> operator-(const Vec3Of<T>& a, const Vec3Of<T>& b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr Vec3Of<T> operator-(const Vec3Of<T>& a)
{
  return {-a.x, -a.y, -a.z};
}
template <class T, class S>
KOKKOS_FORCEINLINE_FUNCTION constexpr Vec3Of<T> operator*(const S& s, const Vec3Of<T>& a)
{
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr T dot(const Vec3Of<T>& a, const Vec3Of<T>& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr Vec3Of<T> cross(const Vec3Of<T>& a, const Vec3Of<T>& b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
KOKKOS_FORCEINLINE_FUNCTION Real norm(const Vec3& a)
{
  return std::sqrt(dot(a, a));
}
KOKKOS_FORCEINLINE_FUNCTION Vec3 normalised(const Vec3& a)
{
  return (1.0 / norm(a)) * a;
}

/// Matrix of 3 x 3 numbers, row by row.
template <class T>
struct Mat3Of
{
  T a[3][3]{};
  KOKKOS_FORCEINLINE_FUNCTION constexpr T& operator()(int i, int j) { return a[i][j]; }
  KOKKOS_FORCEINLINE_FUNCTION constexpr const T& operator()(int i, int j) const { return a[i][j]; }
};
using Mat3 = Mat3Of<Real>;

template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr Vec3Of<T> operator*(const Mat3Of<T>& m, const Vec3Of<T>& v)
{
  return {m.a[0][0] * v.x + m.a[0][1] * v.y + m.a[0][2] * v.z,
          m.a[1][0] * v.x + m.a[1][1] * v.y + m.a[1][2] * v.z,
          m.a[2][0] * v.x + m.a[2][1] * v.y + m.a[2][2] * v.z};
}

template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr Mat3Of<T> operator*(const Mat3Of<T>& m, const Mat3Of<T>& n)
{
  Mat3Of<T> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r.a[i][j] = m.a[i][0] * n.a[0][j] + m.a[i][1] * n.a[1][j] + m.a[i][2] * n.a[2][j];
  return r;
}

template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr T determinant(const Mat3Of<T>& m)
{
  return m.a[0][0] * (m.a[1][1] * m.a[2][2] - m.a[1][2] * m.a[2][1]) -
         m.a[0][1] * (m.a[1][0] * m.a[2][2] - m.a[1][2] * m.a[2][0]) +
         m.a[0][2] * (m.a[1][0] * m.a[2][1] - m.a[1][1] * m.a[2][0]);
}

/// Inverse by cofactors; the caller sees to it that the matrix is regular.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr Mat3Of<T> inverse(const Mat3Of<T>& m)
{
  const T d = T(1.0) / determinant(m);
  Mat3Of<T> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const int p = (j + 1) % 3, q = (j + 2) % 3, s = (i + 1) % 3, t = (i + 2) % 3;
      r.a[i][j] = d * (m.a[p][s] * m.a[q][t] - m.a[p][t] * m.a[q][s]);
    }
  return r;
}

/// Symmetric tensor in the order xx, yy, zz, xy, yz, zx (that of the Exodus variables). Stress:
/// tension positive [Pa].
template <class T>
struct SymTensorOf
{
  T xx{}, yy{}, zz{}, xy{}, yz{}, zx{};
};
using SymTensor = SymTensorOf<Real>;
} // namespace coplane
